#include "search/box_tree.h"

namespace anistar {

template <std::size_t d> void BoxTree<d>::make_nodes() {
  std::size_t n_leaves = 1;
  while (n_leaves * leaf_size < items_.size())
    n_leaves *= 2;
  first_leaf_ = n_leaves - 1;
  nodes_.resize(2 * n_leaves - 1); // empty leaves keep the empty box
  for (std::size_t k = 0; k < items_.size(); ++k)
    nodes_[first_leaf_ + k / leaf_size].extend(item_boxes_[k]);
  for (std::size_t node = first_leaf_; node-- > 0;) {
    nodes_[node].extend(nodes_[2 * node + 1]);
    nodes_[node].extend(nodes_[2 * node + 2]);
  }
}

template <std::size_t d> void BoxTree<d>::extend(Index item, const Vector<d> &p) {
  if (position_.empty()) {
    position_.resize(items_.size());
    for (std::size_t k = 0; k < items_.size(); ++k)
      position_[items_[k]] = static_cast<Index>(k);
  }
  const std::size_t k = position_[item];
  item_boxes_[k].extend(p);
  for (std::size_t node = first_leaf_ + k / leaf_size;; node = (node - 1) / 2) {
    nodes_[node].extend(p);
    if (node == 0)
      return;
  }
}

template class BoxTree<2>;
template class BoxTree<3>;

} // namespace anistar
