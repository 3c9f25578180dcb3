#pragma once
// A bounding-volume hierarchy over axis-parallel boxes. (CGAL's AABB tree has 3D
// primitives only in the releases that we support; this one serves both dimensions.)

#include "base/tensor.h"
#include "mesh/adjacency.h"
#include "mesh/hilbert.h"

#include <limits>
#include <vector>

namespace anistar {

template <std::size_t d> struct Box {
  Vector<d> low = Vector<d>::Constant(std::numeric_limits<double>::infinity());
  Vector<d> high = Vector<d>::Constant(-std::numeric_limits<double>::infinity());

  void extend(const Vector<d> &p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  void extend(const Box &other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  [[nodiscard]] double squared_distance(const Vector<d> &p) const {
    return (low - p).cwiseMax(p - high).cwiseMax(0).squaredNorm();
  }
  [[nodiscard]] bool meets(const Box &other) const {
    return (low.array() <= other.high.array()).all() &&
           (other.low.array() <= high.array()).all();
  }
};

/// A complete binary tree over the boxes in Hilbert order: node k has children 2k+1 and
/// 2k+2, so there are no links to store.
template <std::size_t d> class BoxTree {
public:
  explicit BoxTree(const std::vector<Box<d>> &boxes, int threads = 1)
      : BoxTree(
            boxes.size(), [&](std::size_t k) { return boxes[k]; }, threads) {}
  /// The box of item k < n is box_of(k).
  template <class BoxOf> BoxTree(std::size_t n, BoxOf box_of, int threads = 1);

  /// Calls visit(item, bound) for boxes nearer to p than the bound, nearest subtree
  /// first; `visit` returns the squared distance beyond which boxes are of no interest.
  template <class Visit>
  void nearest(const Vector<d> &p, double bound, Visit visit) const {
    if (!items_.empty())
      descend_nearest(0, p, bound, visit);
  }

  /// Calls visit(item) for every box that meets `query`, in a fixed order, until it
  /// returns false.
  template <class Visit> void meeting(const Box<d> &query, Visit visit) const {
    if (!items_.empty())
      descend_meeting(0, query, visit);
  }

  /// Enlarges the box of an item.
  void extend(Index item, const Vector<d> &p);

private:
  static constexpr std::size_t leaf_size = 4;
  std::vector<Index> items_;
  std::vector<Index>
      position_; ///< of every item in items_; empty until one is extended
  std::vector<Box<d>> item_boxes_;
  std::vector<Box<d>> nodes_;
  std::size_t first_leaf_ = 0;

  void make_nodes();

  template <class Visit>
  bool descend_meeting(std::size_t node, const Box<d> &query, Visit &visit) const {
    if (!nodes_[node].meets(query))
      return true;
    if (node < first_leaf_)
      return descend_meeting(2 * node + 1, query, visit) &&
             descend_meeting(2 * node + 2, query, visit);
    const std::size_t begin = (node - first_leaf_) * leaf_size;
    for (std::size_t k = begin; k < std::min(begin + leaf_size, items_.size()); ++k)
      if (item_boxes_[k].meets(query) && !visit(items_[k]))
        return false;
    return true;
  }

  template <class Visit>
  void descend_nearest(std::size_t node, const Vector<d> &p, double &bound,
                       Visit &visit) const {
    if (node >= first_leaf_) {
      const std::size_t begin = (node - first_leaf_) * leaf_size;
      for (std::size_t k = begin; k < std::min(begin + leaf_size, items_.size()); ++k)
        if (item_boxes_[k].squared_distance(p) <= bound)
          bound = visit(items_[k], bound);
      return;
    }
    std::size_t near = 2 * node + 1, far = 2 * node + 2;
    double to_near = nodes_[near].squared_distance(p),
           to_far = nodes_[far].squared_distance(p);
    if (to_far < to_near) {
      std::swap(near, far);
      std::swap(to_near, to_far);
    }
    if (to_near <= bound)
      descend_nearest(near, p, bound, visit);
    if (to_far <= bound)
      descend_nearest(far, p, bound, visit);
  }
};

template <std::size_t d>
template <class BoxOf>
BoxTree<d>::BoxTree(std::size_t n, BoxOf box_of, int threads) {
  std::vector<Vector<d>> centres(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Box<d> box = box_of(k);
    centres[k] = .5 * (box.low + box.high);
  }
  items_ = hilbert_order<d>(centres, threads);
  centres = {}; // the boxes take their place
  item_boxes_.reserve(n);
  for (Index item : items_)
    item_boxes_.push_back(box_of(item));
  make_nodes();
}

} // namespace anistar
