#include "generate/checking/pieces.h"

#include "generate/checking/view.h"

#include <algorithm>
#include <numeric>

namespace anistar::generate {
namespace {

[[nodiscard]] bool precedes(const Vector<3> &a, const Vector<3> &b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

/// Numbers that stand for the points: the first of those in one place.
std::vector<Index> first_in_place(std::span<const Vector<3>> points) {
  std::vector<Index> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return precedes(points[a], points[b]); });
  std::vector<Index> first(points.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool is_again = k > 0 && points[order[k]] == points[order[k - 1]];
    first[order[k]] = is_again ? first[order[k - 1]] : order[k];
  }
  return first;
}

Segment sorted(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

/// The edges of triangles, sorted.
std::vector<Segment> sides_of(std::span<const Piece> triangles) {
  std::vector<Segment> sides;
  sides.reserve(3 * triangles.size());
  for (const Piece &triangle : triangles)
    for (std::size_t k = 0; k < triangle.n_edges(); ++k)
      sides.push_back(sorted(triangle.edge(k)[0], triangle.edge(k)[1]));
  std::sort(sides.begin(), sides.end());
  return sides;
}

} // namespace

Piece Pieces::of(std::span<const Index> points) const {
  Piece piece{{none, none, none}, points.size()};
  for (std::size_t k = 0; k < points.size(); ++k)
    piece.corners[k] = same[points[k]];
  return piece;
}

Pieces pieces_of(const Plc &plc, std::span<const Index> points_kept) {
  Pieces out;
  std::vector<bool> is_used = used_points(plc, points_kept);
  out.same = first_in_place(plc.points);
  std::vector<Index> used_as(plc.points.size(), none);
  for (std::size_t v = 0; v < plc.points.size(); ++v) {
    Index &as = used_as[out.same[v]];
    if (is_used[v] && as != none)
      out.repeated_points.push_back({as, static_cast<Index>(v)});
    else if (is_used[v])
      as = static_cast<Index>(v);
  }
  const auto add = [&](const Piece &piece, std::size_t source) {
    out.pieces.push_back(piece);
    out.sources.push_back(static_cast<Index>(source));
    for (const Index v : piece.points())
      is_used[v] = false; // no longer a point by itself
  };
  const auto at = [&](Index v) { return plc.points[v]; };
  for (std::size_t t = 0; t < plc.triangles.size(); ++t) {
    const Piece piece = out.of(plc.triangles[t]);
    const auto &[a, b, c] = piece.corners;
    if (view_of(at(a), at(b), at(c)))
      add(piece, t);
    else
      out.degenerate_triangles.push_back(static_cast<Index>(t));
  }
  // their edges are edges of the complex, even though they are no pieces
  std::vector<Piece> all = out.pieces;
  for (const Index t : out.degenerate_triangles)
    all.push_back(out.of(plc.triangles[t]));
  const std::vector<Segment> sides = sides_of(all);
  for (std::size_t s = 0; s < plc.segments.size(); ++s) {
    const Piece piece = out.of(plc.segments[s]);
    const Segment ends = sorted(piece.corners[0], piece.corners[1]);
    if (ends[0] == ends[1])
      out.empty_segments.push_back(static_cast<Index>(s));
    else if (!std::binary_search(sides.begin(), sides.end(), ends))
      add(piece, s);
  }
  for (const Index v : points_kept)
    if (is_used[out.same[v]])
      add(out.of(std::array{v}), static_cast<std::size_t>(v));
  return out;
}

Surroundings::Surroundings(std::span<const Piece> pieces, std::size_t n_points)
    : begin_(n_points + 1, 0) {
  for (const Piece &piece : pieces)
    for (const Index v : piece.points())
      ++begin_[v + 1];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  around_.resize(static_cast<std::size_t>(begin_.back()));
  std::vector<Index> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t k = 0; k < pieces.size(); ++k)
    for (const Index v : pieces[k].points())
      around_[next[v]++] = static_cast<Index>(k);
}

} // namespace anistar::generate
