#pragma once
// Rows of vertices that all exist.

#include "mesh/adjacency.h"

#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace anistar::bindings {

/// @throws std::invalid_argument names the row with a vertex that is no point
template <class Row>
[[nodiscard]] std::vector<Row>
checked_rows(std::span<const Row> rows, std::size_t n_points, const std::string &name) {
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (const Index v : rows[k])
      if (v < 0 || std::cmp_greater_equal(v, n_points))
        throw std::invalid_argument("vertex " + std::to_string(v) + " of " + name +
                                    " " + std::to_string(k) + " is not a point");
  return {rows.begin(), rows.end()};
}

} // namespace anistar::bindings
