#pragma once
// What is wrong with a facet, in words that name it.

#include "mesh/adjacency.h"

#include <sstream>
#include <stdexcept>

namespace anistar::generate {

/// "facet 7: " and the parts, one after the other.
template <class... Parts>
[[nodiscard]] std::invalid_argument facet_error(std::size_t facet,
                                                const Parts &...parts) {
  std::ostringstream text;
  text.precision(3);
  text << "facet " << facet << ": ";
  (text << ... << parts);
  return std::invalid_argument(text.str());
}

/// "(3, 8)"
[[nodiscard]] inline std::string told(Index a, Index b) {
  std::ostringstream text;
  text << "(" << a << ", " << b << ")";
  return text.str();
}

} // namespace anistar::generate
