#include "generate/checking/check_plane.h"

#include "generate/checking/pieces.h"
#include "mesh/disjoint_sets.h"
#include "search/box_tree.h"

#include <algorithm>

namespace anistar::generate {
namespace {

/// Chains of segments that end somewhere, and bound nothing.
class OpenChains {
public:
  OpenChains(const std::vector<Vector<3>> &points, const std::vector<Piece> &segments)
      : points_(points), segments_(segments), around_(segments, points.size()),
        parts_(points.size()), boxes_(points.size()), is_closed_(points.size(), false) {
    take_leaves();
    for (const Piece &s : segments)
      parts_.join(s.corners[0], s.corners[1]);
    for (std::size_t k = 0; k < segments.size(); ++k) {
      const std::size_t part = parts_.root(segments[k].corners[0]);
      if (!is_leaf_[k])
        is_closed_[part] = true;
      for (const Index v : segments[k].points())
        boxes_[part].extend(points[v]);
    }
    for (std::size_t part = 0; part < points.size(); ++part)
      if (is_closed_[part])
        closed_.push_back(part);
  }

  /// Ends of chains that are in no box around something closed.
  std::vector<Problem> problems() {
    std::vector<Problem> out;
    for (std::size_t v = 0; v < points_.size(); ++v) {
      const std::span<const Index> around = around_.of(static_cast<Index>(v));
      if (around.size() != 1 || !is_open(v))
        continue;
      const auto &[a, b] = segments_[around[0]].edge(0);
      out.push_back({Flaw::open_border,
                     {},
                     {{a, b}},
                     {static_cast<Index>(v)},
                     points_[v],
                     (points_[b] - points_[a]).norm()});
    }
    return out;
  }

private:
  const std::vector<Vector<3>> &points_;
  const std::vector<Piece> &segments_;
  Surroundings around_;
  DisjointSets parts_;
  std::vector<Box<3>> boxes_;
  std::vector<bool> is_closed_;
  std::vector<std::size_t> closed_;
  std::vector<bool> is_leaf_; ///< of each segment: no part of a loop

  /// Takes away segments that end in nothing, as long as there are any.
  void take_leaves() {
    is_leaf_.assign(segments_.size(), false);
    std::vector<std::size_t> valence(points_.size());
    std::vector<Index> ends;
    for (std::size_t v = 0; v < points_.size(); ++v) {
      valence[v] = around_.of(static_cast<Index>(v)).size();
      if (valence[v] == 1)
        ends.push_back(static_cast<Index>(v));
    }
    while (!ends.empty()) { // every round takes an end from the list, or a segment
      const Index v = ends.back();
      ends.pop_back();
      for (const Index k : around_.of(v)) {
        if (is_leaf_[k])
          continue;
        is_leaf_[k] = true;
        for (const Index w : segments_[k].points())
          if (--valence[w] == 1)
            ends.push_back(w);
      }
    }
  }
  [[nodiscard]] bool is_open(std::size_t v) {
    const std::size_t part = parts_.root(v);
    const Box<3> &box = boxes_[part];
    return !is_closed_[part] &&
           std::none_of(closed_.begin(), closed_.end(), [&](std::size_t other) {
             return (boxes_[other].low.array() <= box.low.array()).all() &&
                    (boxes_[other].high.array() >= box.high.array()).all();
           });
  }
};

} // namespace

Problems check_plane(std::span<const Vector<2>> points,
                     std::span<const Segment> segments,
                     std::span<const Index> points_kept, const CheckSettings &settings,
                     Monitor &monitor) {
  // in space, where it lies in a plane
  Plc plc;
  for (const Vector<2> &x : points)
    plc.points.emplace_back(x[0], x[1], 0);
  plc.segments.assign(segments.begin(), segments.end());
  Problems out = check(plc, points_kept, settings, monitor);
  if (out.totals[static_cast<std::size_t>(Flaw::out_of_range)] > 0)
    return out;
  std::vector<Piece> pieces = pieces_of(plc, points_kept).pieces;
  std::erase_if(pieces, [](const Piece &piece) { return !piece.is_segment(); });
  for (Problem &problem : OpenChains(plc.points, pieces).problems()) {
    std::size_t &total = out.totals[static_cast<std::size_t>(Flaw::open_border)];
    if (total++ < settings.listed)
      out.listed.push_back(std::move(problem));
  }
  std::stable_sort(out.listed.begin(), out.listed.end(),
                   [](const Problem &a, const Problem &b) { return a.flaw < b.flaw; });
  return out;
}

} // namespace anistar::generate
