#include "certificate/circumball.h"

#include "base/range.h"
#include "certificate/ball_equations.h"

#include <CGAL/Mpzf.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace anistar {

using namespace ball_equations;

namespace {

using Exact = CGAL::Mpzf;

/// Relative error of y^T M y and g.y with respect to the sum of the magnitudes of their
/// terms: the number of roundings that a term goes through, rounded up.
constexpr double bound = 32 * detail::round_off;

enum class Answer { no, yes, doubtful };

Answer is_positive(const Bounded &x) {
  return x.is_positive()   ? Answer::yes
         : x.is_negative() ? Answer::no
                           : Answer::doubtful;
}

/// y^T diag(M) y; by the inequality of Cauchy and Schwarz, d times it is more than the
/// magnitudes of the terms of y^T M y together.
template <std::size_t d>
double diagonal_square(const SymmetricTensor<d> &M, const Vector<d> &y) {
  double sum = 0;
  for (std::size_t i = 0; i < d; ++i) {
    const double component = y[static_cast<int>(i)];
    sum += M(i, i) * component * component;
  }
  return sum;
}

/// Whether x and the vertices are corners of one box along the axes of the metric,
/// which are those of the coordinates, as on structured grids: they lie on one
/// ellipsoid then. Only comparisons, so exact.
template <std::size_t d>
bool are_corners_of_box(const SymmetricTensor<d> &M, const Simplex<d> &simplex,
                        const Vector<d> &x) {
  for (std::size_t i = 0; i < d; ++i) {
    const int axis = static_cast<int>(i);
    double other = x[axis];
    for (const Vector<d> &corner : simplex) {
      if (other == x[axis])
        other = corner[axis];
      if (corner[axis] != x[axis] && corner[axis] != other)
        return false;
    }
    for (std::size_t j = 0; j < i; ++j)
      if (M(i, j) != 0)
        return false;
  }
  return true;
}

} // namespace

/// Everything times the determinant of its equations, which is positive.
template <std::size_t d> struct ExactBall {
  using Row = std::array<Exact, d>;
  const SymmetricTensor<d> &M;
  const Vector<d> &origin;
  Exact determinant;
  Row gradient;

  ExactBall(const SymmetricTensor<d> &metric, const Vector<d> &first,
            Solution<d, Exact> &&solution)
      : M(metric), origin(first), determinant(std::move(solution.determinant)),
        gradient(std::move(solution.gradient)) {}

  [[nodiscard]] Exact power(const Vector<d> &x) const {
    const Row y = difference<d, Exact>(x, origin);
    return determinant * bilinear<d, Exact>(M, y, y) - dot<d, Exact>(gradient, y);
  }
  /// Of the product of the gradient of the power at x and q - x.
  [[nodiscard]] CGAL::Sign slope_sign(const Vector<d> &x, const Vector<d> &q) {
    for (const Slope &known : slopes_)
      if (known.x == &x && known.q == &q)
        return known.sign;
    const CGAL::Sign sign =
        CGAL::sign(dot<d, Exact>(normal(x), difference<d, Exact>(q, x)));
    slopes_.push_back({&x, &q, sign});
    return sign;
  }

private:
  struct Slope {
    const Vector<d> *x, *q;
    CGAL::Sign sign;
  };
  /// The gradient at points on the ellipsoid, and its products with edges there: few,
  /// and met from several facets.
  std::vector<std::pair<const Vector<d> *, Row>> normals_;
  std::vector<Slope> slopes_;

  [[nodiscard]] const Row &normal(const Vector<d> &x) {
    for (const auto &[point, known] : normals_)
      if (point == &x)
        return known;
    const Row y = difference<d, Exact>(x, origin);
    Row found;
    for (std::size_t i = 0; i < d; ++i) {
      Exact half(0);
      for (std::size_t j = 0; j < d; ++j)
        half = half + Exact(M(i, j)) * y[j];
      half = half * determinant;
      found[i] = half + half - gradient[i];
    }
    return normals_.emplace_back(&x, std::move(found)).second;
  }
};

namespace {

/// The power along p + s (q - p), alpha s^2 + beta s + gamma with alpha > 0 and gamma
/// >= 0, is negative for some 0 < s < 1 when its minimum lies there and is negative.
template <std::size_t d>
bool exactly_meets_segment(const ExactBall<d> &ball, const Vector<d> &p,
                           const Vector<d> &q) {
  const auto u = difference<d, Exact>(q, p);
  const Exact alpha = ball.determinant * bilinear<d, Exact>(ball.M, u, u);
  const Exact gamma = ball.power(p);
  const Exact beta = ball.power(q) - gamma - alpha;
  return CGAL::sign(beta) < 0 && CGAL::sign(alpha + alpha + beta) > 0 &&
         CGAL::sign(beta * beta - Exact(4) * alpha * gamma) > 0;
}

/// The coefficients of the power a s^2 + 2 b s t + c t^2 + e s + f t + g on a triangle,
/// and what they say of its minimum over the plane.
template <class Number> struct PlaneMinimum {
  Number depth;               ///< positive when the minimum is negative
  std::array<Number, 3> side; ///< all positive when it lies inside the triangle
};

template <class Number>
PlaneMinimum<Number> plane_minimum(const Number &a, const Number &b, const Number &c,
                                   const Number &e, const Number &f, const Number &g) {
  const Number det = a * c - b * b;
  const Number s = b * f - c * e, t = b * e - a * f; // the minimum times 2 det
  const Number det2 = det + det, g2 = g + g;
  return {-(s * e + t * f) - g2 * det2, {s, t, det2 - s - t}};
}

/// Whether the power is negative and minimal at a point inside the triangle.
bool exactly_meets_inside(const ExactBall<3> &ball,
                          const std::array<const Vector<3> *, 3> &facet) {
  const auto u = difference<3, Exact>(*facet[1], *facet[0]);
  const auto v = difference<3, Exact>(*facet[2], *facet[0]);
  const Exact a = ball.determinant * bilinear<3, Exact>(ball.M, u, u);
  const Exact b = ball.determinant * bilinear<3, Exact>(ball.M, u, v);
  const Exact c = ball.determinant * bilinear<3, Exact>(ball.M, v, v);
  const Exact g = ball.power(*facet[0]);
  const auto minimum = plane_minimum<Exact>(a, b, c, ball.power(*facet[1]) - g - a,
                                            ball.power(*facet[2]) - g - c, g);
  return CGAL::sign(minimum.depth) > 0 &&
         std::all_of(minimum.side.begin(), minimum.side.end(),
                     [](const Exact &side) { return CGAL::sign(side) > 0; });
}

} // namespace

template <std::size_t d>
Circumball<d>::Circumball(const SymmetricTensor<d> &M, const Simplex<d> &simplex)
    : M_(M), through_(&simplex), origin_(simplex[0]) {
  const Frame<d, double> f = frame_of<d, double>(simplex);
  Vector<d> sum = Vector<d>::Zero(), size = Vector<d>::Zero();
  double determinant_size = 0;
  for (std::size_t k = 0; k < d; ++k) {
    Vector<d> edge, cofactor, cofactor_size;
    for (std::size_t i = 0; i < d; ++i) {
      edge[static_cast<int>(i)] = f.edges[k][i];
      cofactor[static_cast<int>(i)] = f.cofactors[k][i];
    }
    if constexpr (d == 2) {
      cofactor_size = cofactor.cwiseAbs();
    } else {
      const auto &p = f.edges[(k + 1) % 3], &q = f.edges[(k + 2) % 3];
      for (std::size_t i = 0; i < 3; ++i)
        cofactor_size[static_cast<int>(i)] = std::abs(p[(i + 1) % 3] * q[(i + 2) % 3]) +
                                             std::abs(p[(i + 2) % 3] * q[(i + 1) % 3]);
    }
    if (k == 0)
      determinant_size = edge.cwiseAbs().dot(cofactor_size);
    sum += quadratic<d>(M, edge) * cofactor;
    size += double(d) * diagonal_square<d>(M, edge) * cofactor_size;
  }
  gradient_ = sum / f.determinant;
  const double rest = f.determinant - bound * determinant_size;
  if (rest > detail::underflow_guard)
    gradient_error_ = bound * (size + gradient_.cwiseAbs() * determinant_size) / rest +
                      bound * gradient_.cwiseAbs();
  else
    gradient_error_.setConstant(std::numeric_limits<double>::infinity());
}

template <std::size_t d>
Circumball<d>::Circumball(const SymmetricTensor<d> &M, const SurfaceFacet<d> &facet)
    : M_(M), through_(&facet), origin_(facet.corners[0]) {
  const auto [determinant, gradient] = solution_of<d, Bounded>(M, facet);
  const double least = determinant.value - determinant.error;
  for (std::size_t i = 0; i < d; ++i) {
    const double quotient = gradient[i].value / determinant.value;
    gradient_[static_cast<int>(i)] = quotient;
    gradient_error_[static_cast<int>(i)] =
        least > detail::underflow_guard
            ? (1 + bound) *
                      (gradient[i].error + std::abs(quotient) * determinant.error) /
                      least +
                  bound * std::abs(quotient)
            : std::numeric_limits<double>::infinity();
  }
}

template <std::size_t d> Circumball<d>::~Circumball() = default;

template <std::size_t d> ExactBall<d> &Circumball<d>::exact() const {
  if (!exact_) {
    require_finite(M_.entries);
    const auto solve = [&](const auto *through) {
      if constexpr (std::is_same_v<decltype(through), const SurfaceFacet<d> *>)
        require_finite(std::array{through->shift});
      return solution_of<d, Exact>(M_, *through);
    };
    exact_ = std::make_unique<ExactBall<d>>(M_, origin_, std::visit(solve, through_));
  }
  return *exact_;
}

template <std::size_t d> Bounded Circumball<d>::power(const Vector<d> &x) const {
  const Vector<d> y = x - origin_, size = y.cwiseAbs();
  return {quadratic<d>(M_, y) - gradient_.dot(y),
          bound * double(d) * diagonal_square<d>(M_, y) + gradient_error_.dot(size) +
              bound * gradient_.cwiseAbs().dot(size) + Bounded::underflow};
}

template <std::size_t d>
Side Circumball<d>::side(const Vector<d> &x, const Bounded &power) const {
  if (power.is_positive())
    return Side::outside;
  if (power.is_negative())
    return Side::inside;
  if (const auto *simplex = std::get_if<const Simplex<d> *>(&through_);
      simplex && are_corners_of_box<d>(M_, **simplex, x))
    return Side::boundary;
  const Exact value = exact().power(x);
  return static_cast<Side>(-static_cast<int>(CGAL::sign(value)));
}

template <std::size_t d> Bounded Circumball<d>::square(const Vector<d> &y) const {
  return {quadratic<d>(M_, y), bound * double(d) * diagonal_square<d>(M_, y)};
}

template <std::size_t d>
bool Circumball<d>::meets(const std::array<const Vector<d> *, d> &facet,
                          const std::array<Bounded, d> &powers) const {
  const auto is_on_ball = [](const Bounded &power) {
    return power.value == 0 && power.error == 0;
  };
  const auto on = std::find_if(powers.begin(), powers.end(), is_on_ball);
  if (on != powers.end()) {
    // an edge whose ends lie on the ellipsoid is inside it; the power is convex, so
    // that a facet with one vertex on it meets it where an edge from there does
    if (std::any_of(on + 1, powers.end(), is_on_ball))
      return true;
    return leaves_inwards(facet, on - powers.begin());
  }
  if constexpr (d == 2)
    return meets_segment(*facet[0], *facet[1], powers[0], powers[1]);
  else
    return meets_triangle(facet, powers);
}

/// Whether an edge that leaves vertex k of a facet, which lies on the ellipsoid, runs
/// inside it: the power falls along it.
template <std::size_t d>
bool Circumball<d>::leaves_inwards(const std::array<const Vector<d> *, d> &facet,
                                   std::size_t k) const {
  const Vector<d> &p = *facet[k];
  std::array<Answer, d> rises;
  for (std::size_t i = 0; i < d; ++i) {
    rises[i] = i == k ? Answer::yes : is_positive(slope(p, *facet[i]));
    if (rises[i] == Answer::no)
      return true;
  }
  for (std::size_t i = 0; i < d; ++i)
    if (rises[i] == Answer::doubtful && exact().slope_sign(p, *facet[i]) < 0)
      return true;
  return false;
}

/// The product of the gradient of the power at p and q - p.
template <std::size_t d>
Bounded Circumball<d>::slope(const Vector<d> &p, const Vector<d> &q) const {
  const Vector<d> y = p - origin_, u = q - p, length = u.cwiseAbs();
  const double product_size = double(d) * std::sqrt(diagonal_square<d>(M_, u)) *
                              std::sqrt(diagonal_square<d>(M_, y));
  return {(2 * product<d>(M_, y) - gradient_).dot(u),
          bound * (2 * product_size + gradient_.cwiseAbs().dot(length)) +
              gradient_error_.dot(length) + Bounded::underflow};
}

template <std::size_t d>
bool Circumball<d>::meets_segment(const Vector<d> &p, const Vector<d> &q,
                                  const Bounded &at_p, const Bounded &at_q) const {
  const Bounded alpha = square(q - p);
  const Bounded beta = at_q - at_p - alpha;
  const Answer falls = is_positive(-beta);
  if (falls == Answer::no)
    return false;
  const Answer rises = is_positive(twice(alpha) + beta);
  if (rises == Answer::no)
    return false;
  const Answer dips = is_positive(beta * beta - twice(twice(alpha)) * at_p);
  if (dips == Answer::no)
    return false;
  if (falls == Answer::yes && rises == Answer::yes && dips == Answer::yes)
    return true;
  return exactly_meets_segment<d>(exact(), p, q);
}

template <std::size_t d>
bool Circumball<d>::meets_triangle(const std::array<const Vector<d> *, d> &facet,
                                   const std::array<Bounded, d> &powers) const {
  if constexpr (d == 3) {
    const Vector<3> u = *facet[1] - *facet[0], v = *facet[2] - *facet[0];
    const Bounded a = square(u), c = square(v);
    const Bounded b{u.dot(product<3>(M_, v)), .5 * (a.error + c.error)};
    const auto minimum = plane_minimum<Bounded>(a, b, c, powers[1] - powers[0] - a,
                                                powers[2] - powers[0] - c, powers[0]);
    const Answer deep = is_positive(minimum.depth);
    if (deep == Answer::no)
      return false;
    Answer inside = Answer::yes;
    for (const Bounded &side : minimum.side) {
      const Answer answer = is_positive(side);
      if (answer == Answer::no || inside == Answer::no)
        inside = Answer::no;
      else if (answer == Answer::doubtful)
        inside = Answer::doubtful;
    }
    if (inside == Answer::yes && deep == Answer::yes)
      return true;
    for (std::size_t k = 0; k < 3; ++k)
      if (meets_segment(*facet[k], *facet[(k + 1) % 3], powers[k], powers[(k + 1) % 3]))
        return true;
    return inside != Answer::no && exactly_meets_inside(exact(), facet);
  } else {
    return false;
  }
}

template class Circumball<2>;
template class Circumball<3>;

} // namespace anistar
