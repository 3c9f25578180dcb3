#include "volume/mesh/tet_shape.h"

namespace anistar {

namespace {

/// Relative to the sum of the magnitudes of the terms of the determinant.
constexpr double ball_tolerance = 1e-9;

} // namespace

void BallTests::evaluate(const SymmetricTensor<3> &M) {
  const std::array<double, 6> m = M.entries;
  const auto square = [&](double x, double y, double z) {
    return m[0] * x * x + m[2] * y * y + m[5] * z * z +
           2 * (m[1] * x * y + m[3] * x * z + m[4] * y * z);
  };
  for (std::size_t i = 0; i < n_; ++i) {
    const double ax = a_[0][i], ay = a_[1][i], az = a_[2][i];
    const double bx = b_[0][i], by = b_[1][i], bz = b_[2][i];
    const double cx = c_[0][i], cy = c_[1][i], cz = c_[2][i];
    const double dx = d_[0][i], dy = d_[1][i], dz = d_[2][i];
    const double bcx = by * cz - bz * cy, bcy = bz * cx - bx * cz,
                 bcz = bx * cy - by * cx;
    const double adx = ay * dz - az * dy, ady = az * dx - ax * dz,
                 adz = ax * dy - ay * dx;
    const double a = (dx * bcx + (dy * bcy + dz * bcz)) * square(ax, ay, az),
                 b = (cx * adx + (cy * ady + cz * adz)) * square(bx, by, bz),
                 c = -(bx * adx + (by * ady + bz * adz)) * square(cx, cy, cz),
                 d = -(ax * bcx + (ay * bcy + az * bcz)) * square(dx, dy, dz);
    excess_[i] =
        a + b + c + d -
        ball_tolerance * (std::abs(a) + std::abs(b) + std::abs(c) + std::abs(d));
  }
}

bool StarShapes::are_positive(const Vector<3> &p) const {
  const double x = p[0], y = p[1], z = p[2];
  bool are_positive = true; // a minimum would pass over NaN
  for (std::size_t i = 0; i < n_; ++i) {
    const double ax = a_[0][i] - x, ay = a_[1][i] - y, az = a_[2][i] - z;
    const double bx = b_[0][i] - x, by = b_[1][i] - y, bz = b_[2][i] - z;
    const double cx = c_[0][i] - x, cy = c_[1][i] - y, cz = c_[2][i] - z;
    const double v =
        ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
    are_positive &= v > 0;
  }
  return are_positive;
}

void StarShapes::evaluate(const Vertex<3> &vertex) {
  const double x = vertex.x[0], y = vertex.x[1], z = vertex.x[2];
  const auto &M = vertex.M.entries;
  for (std::size_t i = 0; i < n_; ++i) {
    const double m[6] = {m_[0][i] + M[0], m_[1][i] + M[1], m_[2][i] + M[2],
                         m_[3][i] + M[3], m_[4][i] + M[4], m_[5][i] + M[5]};
    cubed_[i] = cubed_shape(a_[0][i] - x, a_[1][i] - y, a_[2][i] - z, b_[0][i] - x,
                            b_[1][i] - y, b_[2][i] - z, c_[0][i] - x, c_[1][i] - y,
                            c_[2][i] - z, m);
  }
  for (std::size_t i = 0; i < n_; ++i)
    quality_[i] = mean_ratio(cubed_[i]);
  float least = 1;
  double sum = 0;
  for (std::size_t i = 0; i < n_; ++i) {
    least = std::min(least, quality_[i]);
    sum += static_cast<double>(quality_[i]);
  }
  minimum_ = static_cast<double>(least);
  sum_ = sum;
}

} // namespace anistar
