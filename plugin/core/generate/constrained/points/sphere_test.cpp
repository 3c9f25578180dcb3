#include "generate/constrained/points/sphere_test.h"

#include <algorithm>

namespace anistar::generate {
namespace {

constexpr double round_off = anistar::detail::round_off;
/// Roundings that a term goes through, rounded up.
constexpr double determinant_bound = 8 * round_off, normal_bound = 16 * round_off,
                 value_bound = 8 * round_off;

double reach_of(const Vector<3> &u) { return u.cwiseAbs().maxCoeff(); }

} // namespace

SphereTest::SphereTest(const ExactPoints &points, const Cell<3> &cell, double error)
    : points_(&points), cell_(cell), origin_(points.rounded(cell[0])),
      apart_(2 * error) {
  const Vector<3> u = points.rounded(cell[1]) - origin_,
                  v = points.rounded(cell[2]) - origin_,
                  w = points.rounded(cell[3]) - origin_;
  const Vector<3> v_w = v.cross(w);
  leading_ = u.dot(v_w);
  normal_ = u.squaredNorm() * v_w + v.squaredNorm() * w.cross(u) +
            w.squaredNorm() * u.cross(v);
  const double U = reach_of(u) + apart_, V = reach_of(v) + apart_,
               W = reach_of(w) + apart_;
  const double product = U * V * W, sum = U + V + W, slope = V * W + U * W + U * V;
  const double leading = 6 * product, normal = 6 * product * sum;
  const double leading_error = determinant_bound * leading + 6 * apart_ * slope;
  const double normal_error =
      normal_bound * normal + 6 * apart_ * (slope * sum + 3 * product);
  quadratic_ = 3 * (leading_error + value_bound * leading);
  linear_ = 3 * (normal_error + value_bound * normal) + 6 * apart_ * leading;
  constant_ = 3 * apart_ * normal;
}

bool SphereTest::contains(Index p) const {
  const Vector<3> x = points_->rounded(p) - origin_;
  const double value = leading_ * x.squaredNorm() - normal_.dot(x);
  const double reach = reach_of(x) + apart_;
  const double bound = (quadratic_ * reach + linear_) * reach + constant_;
  if (bound > anistar::detail::underflow_guard) {
    if (value > bound)
      return false;
    if (value < -bound)
      return true;
  }
  return points_->is_in_sphere(cell_, p);
}

} // namespace anistar::generate
