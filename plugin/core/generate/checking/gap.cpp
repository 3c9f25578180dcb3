#include "generate/checking/gap.h"

#include "search/nearest_on.h"

#include <algorithm>

namespace anistar::generate {
namespace {

/// Looks for the smallest gap between two pieces.
class GapSearch {
public:
  GapSearch(std::span<const Vector<3>> points, std::span<const Piece> pieces,
            const Surroundings &around, double reach)
      : points_(points), pieces_(pieces), around_(around), reach_(reach) {}

  std::optional<Gap> between(const Piece &a, const Piece &b) {
    if (n_shared(a, b) > 1)
      return std::nullopt;
    look_from_points(a, b);
    look_from_points(b, a);
    for (std::size_t i = 0; i < a.n_edges(); ++i)
      for (std::size_t j = 0; j < b.n_edges(); ++j)
        look_from_edge(a.edge(i), b.edge(j));
    return best_;
  }

private:
  std::span<const Vector<3>> points_;
  std::span<const Piece> pieces_;
  const Surroundings &around_;
  double reach_;
  std::optional<Gap> best_;

  [[nodiscard]] const Vector<3> &at(Index v) const { return points_[v]; }

  void look_from_points(const Piece &p, const Piece &q) {
    for (const Index v : p.points()) {
      if (q.has(v))
        continue;
      const Vector<3> foot = foot_on(at(v), q);
      const double distance = (at(v) - foot).norm();
      const std::array<Index, 1> one{v};
      if (is_better(distance) && !is_spanned(one, q.points()))
        best_ = Gap{distance, at(v), v, {}};
    }
  }
  [[nodiscard]] Vector<3> foot_on(const Vector<3> &x, const Piece &q) const {
    if (q.n_corners == 1)
      return at(q.corners[0]);
    // a segment is a triangle without width
    const std::array<Vector<3>, 3> corners{at(q.corners[0]), at(q.corners[1]),
                                           at(q.corners[q.is_triangle() ? 2 : 1])};
    const auto weights = nearest_on(x, corners);
    return weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
  }
  void look_from_edge(const Segment &e, const Segment &f) {
    for (const Index v : e)
      if (v == f[0] || v == f[1])
        return;
    // inside of both: where they end is seen from their points
    const Vector<3> u = at(e[1]) - at(e[0]), v = at(f[1]) - at(f[0]),
                    w = at(f[0]) - at(e[0]);
    const Vector<3> normal = u.cross(v);
    const double square = normal.squaredNorm();
    const double s = w.cross(v).dot(normal), t = w.cross(u).dot(normal);
    if (!(s >= 0 && s <= square && t >= 0 && t <= square && square > 0))
      return;
    const double distance = std::abs(w.dot(normal)) / std::sqrt(square);
    if (is_better(distance) && !is_spanned(e, f))
      best_ = Gap{distance, at(e[0]) + s / square * u, none, {e, f}};
  }
  [[nodiscard]] bool is_better(double distance) const {
    return distance < (best_ ? best_->distance : reach_);
  }

  /// Whether a piece leads from one set of points to the other within the gap.
  [[nodiscard]] bool is_spanned(std::span<const Index> from,
                                std::span<const Index> to) const {
    const auto is_in = [](std::span<const Index> set, Index v) {
      return std::find(set.begin(), set.end(), v) != set.end();
    };
    for (const Index v : from)
      for (const Index k : around_.of(v)) {
        std::size_t n_from = 0, n_to = 0;
        for (const Index w : pieces_[k].points()) {
          n_from += is_in(from, w) ? 1 : 0;
          n_to += is_in(to, w) ? 1 : 0;
          if (is_in(to, w) && (at(v) - at(w)).norm() < 2 * reach_)
            return true; // a short edge
        }
        if (n_to > 0 && n_from + n_to > 2)
          return true; // a thin triangle
      }
    return false;
  }
};

} // namespace

std::optional<Gap> gap_between(std::span<const Vector<3>> points,
                               std::span<const Piece> pieces,
                               const Surroundings &around, Index a, Index b,
                               double reach) {
  return GapSearch(points, pieces, around, reach).between(pieces[a], pieces[b]);
}

} // namespace anistar::generate
