#pragma once
// Which numbers can be computed with.

#include "base/tensor.h"

#include <sstream>
#include <stdexcept>
#include <string>

namespace anistar {

/// What has a larger coordinate is no place: products of a few such lengths leave the
/// range of doubles. A mesh that is read has none.
inline constexpr double largest_coordinate = 1e75;

/// Whether x is a place; NaN is none.
template <std::size_t d> [[nodiscard]] inline bool is_in_range(const Vector<d> &x) {
  for (int i = 0; i < static_cast<int>(d); ++i)
    if (!(std::abs(x[i]) <= largest_coordinate))
      return false;
  return true;
}

/// A failure inside of a computation whose input was checked.
template <class Numbers>
[[nodiscard]] std::domain_error out_of_range(const std::string &what,
                                             const Numbers &numbers) {
  std::ostringstream text;
  text.precision(17);
  text << what << ":";
  for (const double number : numbers)
    text << " " << number;
  return std::domain_error(text.str());
}

/// An exact number cannot be made of NaN or infinity: GMP ends the process.
template <class Numbers> void require_finite(const Numbers &numbers) {
  for (const double number : numbers)
    if (!std::isfinite(number))
      throw out_of_range("exact arithmetic was asked for numbers that are not finite",
                         numbers);
}

} // namespace anistar
