#pragma once
// Things that are joined into sets.

#include "mesh/adjacency.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace anistar {

/// Union-find over the numbers below n.
class DisjointSets {
public:
  explicit DisjointSets(std::size_t n) : parent_(n) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t i, std::size_t j) {
    i = root(i);
    j = root(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }
  /// A number from 0 for every set, in the order of their first members.
  std::vector<Index> numbers(std::size_t &count) {
    std::vector<Index> number(parent_.size(), none);
    count = 0;
    for (std::size_t i = 0; i < parent_.size(); ++i) {
      Index &of_root = number[root(i)];
      if (of_root == none)
        of_root = static_cast<Index>(count++);
      number[i] = of_root;
    }
    return number;
  }

private:
  std::vector<std::size_t> parent_;
};

} // namespace anistar
