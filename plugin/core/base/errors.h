#pragma once
// What the core throws where there is no mesh to make.

#include "base/tensor.h"

#include <stdexcept>
#include <string>
#include <vector>

namespace anistar {

/// Failure to make a mesh. The place is apart from the message, because the caller may
/// measure in other units.
class MeshingError : public std::runtime_error {
public:
  template <class Coordinates>
  MeshingError(const std::string &message, const Eigen::MatrixBase<Coordinates> &place)
      : std::runtime_error(message), place_(place.begin(), place.end()) {}
  /// In the plane two coordinates, in space three.
  [[nodiscard]] const std::vector<double> &place() const { return place_; }

private:
  std::vector<double> place_;
};

} // namespace anistar
