#pragma once
// The cells around one vertex in the measure that reports take.

#include "volume/mesh/tet_shape.h"

namespace anistar {

/// Mean ratios in the metric of the corner where each cell is densest
/// (mesh/measures.h), for many trial positions of the vertex.
class DensestShapes {
public:
  static constexpr std::size_t capacity = StarShapes::capacity;

  void clear() { n_ = 0; }
  /// @pre (a, b, c, vertex) is positive, and there are less than `capacity`.
  void add(const Vertex<3> &a, const Vertex<3> &b, const Vertex<3> &c);
  /// Qualities with the vertex at x; below `poor` they are missing something.
  void evaluate(const Vertex<3> &x, double poor);
  [[nodiscard]] std::size_t size() const { return n_; }
  [[nodiscard]] double minimum() const { return minimum_; }
  [[nodiscard]] double sum() const { return sum_; }
  [[nodiscard]] double missing() const { return missing_; } ///< sum of (poor - q)+

private:
  std::size_t n_ = 0;
  double a_[3][capacity], b_[3][capacity], c_[3][capacity];
  double m_[6][capacity], weight_[capacity]; ///< of the densest of the three
  double cubed_[capacity];
  float quality_[capacity];
  double minimum_ = 0, sum_ = 0, missing_ = 0;
};

} // namespace anistar
