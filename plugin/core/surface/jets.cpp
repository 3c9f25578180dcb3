#include "surface/jets.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace anistar {
namespace {

/// Rings of neighbours, and the number of points at which no further ring is taken.
constexpr int max_rings = 4;
constexpr std::size_t enough_points = 16;
/// Points needed for a fit of degree two and three.
constexpr std::size_t for_quadratic = 5, for_cubic = 9;
/// Fits, each over the tangent plane of the one before and with its bend: of degree two
/// until the bend, in units of the reach, changes by less than the first of these, then
/// of degree three until it changes by less than the second. With a wrong bend a cubic
/// passes through the few points beside a ridge by leaning over.
constexpr int max_fits = 12;
constexpr double settled_square = 1e-3, settled_cubic = 1e-9;
/// Of the way to the bend of a square fit, which lies as far beyond the mark as the
/// last bend was short of it, times the mean of (w / u)^2.
constexpr double relaxation = .7;
/// The bend times the height of a point of a sphere, up to the height of its centre.
constexpr double most_bent = .5;

/// Facets that turn away from the vertex by more (the cosine) are not fitted: beyond,
/// the surface is no graph over the tangent plane.
constexpr double most_turned = .5;
/// Terms that the points do not tell apart by this fraction are left out of the fit:
/// two rows along a cylinder also lie on a sphere, and on everything between.
constexpr double rank_tolerance = 1e-2;

class Fitter {
public:
  Fitter(std::span<const Vector<3>> points, std::span<const Facet<3>> facets,
         const Features &features)
      : points_(points), facets_(facets) {
    collect(features);
    stamp_.assign(out_.vertex.size(), none);
  }

  Jets run() {
    out_.jets.resize(out_.vertex.size());
    for (std::size_t s = 0; s < out_.vertex.size(); ++s)
      out_.jets[s] = fit(static_cast<Index>(s));
    return std::move(out_);
  }

private:
  std::span<const Vector<3>> points_;
  std::span<const Facet<3>> facets_;
  Jets out_;
  std::vector<Index> first_, facets_at_; ///< of every jet
  std::vector<Index> stamp_;
  std::vector<Index> ring_;

  [[nodiscard]] const Vector<3> &point(Index v) const { return points_[v]; }
  [[nodiscard]] const Vector<3> &at(Index jet) const { return point(out_.vertex[jet]); }
  [[nodiscard]] std::span<const Index> facets_of(Index jet) const {
    const std::size_t s = jet;
    return {facets_at_.data() + first_[s],
            static_cast<std::size_t>(first_[s + 1] - first_[s])};
  }

  /// One jet for every side of a ridge at a vertex.
  void collect(const Features &features) {
    out_.facet_jets = features.facet_sides;
    out_.vertex.resize(features.n_sides);
    first_.assign(features.n_sides + 1, 0);
    for (const Facet<3> &sides : features.facet_sides)
      for (Index side : sides)
        ++first_[side + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    facets_at_.resize(3 * facets_.size());
    std::vector<Index> next(first_.begin(), first_.end() - 1);
    for (std::size_t f = 0; f < facets_.size(); ++f)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t side = features.facet_sides[f][i];
        out_.vertex[side] = facets_[f][i];
        facets_at_[next[side]++] = static_cast<Index>(f);
      }
  }

  [[nodiscard]] Vector<3> facet_normal(Index f) const {
    const Facet<3> &t = facets_[f];
    return (point(t[1]) - point(t[0])).cross(point(t[2]) - point(t[0]));
  }

  /// Exact at the vertices of a polyhedron inscribed in a sphere (Max, Weights for
  /// computing vertex normals from facet normals, 1999). Facets may be oriented anyhow.
  [[nodiscard]] Vector<3> weighted_normal(Index jet) const {
    const Index v = out_.vertex[jet];
    Vector<3> sum = Vector<3>::Zero();
    for (Index f : facets_of(jet)) {
      const Facet<3> &t = facets_[f];
      const std::size_t k = t[0] == v ? 0 : t[1] == v ? 1 : 2;
      const Vector<3> a = point(t[(k + 1) % 3]) - point(v);
      const Vector<3> b = point(t[(k + 2) % 3]) - point(v);
      const Vector<3> weighted = a.cross(b) / (a.squaredNorm() * b.squaredNorm());
      sum += sum.dot(weighted) < 0 ? Vector<3>(-weighted) : weighted;
    }
    return sum.normalized();
  }

  /// The jets around one, ring after ring, as far as the surface faces its normal.
  /// Around the end of a ridge that may be the jet of the other side, which says
  /// nothing.
  void gather(Index jet, const Vector<3> &normal) {
    const Index v = out_.vertex[jet];
    ring_.assign(1, jet);
    stamp_[jet] = jet;
    std::size_t begin = 0;
    for (int ring = 0; ring < max_rings && ring_.size() <= enough_points; ++ring) {
      const std::size_t end = ring_.size();
      for (; begin < end; ++begin)
        for (Index f : facets_of(ring_[begin])) {
          const Vector<3> m = facet_normal(f);
          if (std::abs(m.dot(normal)) < most_turned * m.norm())
            continue;
          for (Index other : out_.facet_jets[f])
            if (std::exchange(stamp_[other], jet) != jet && out_.vertex[other] != v)
              ring_.push_back(other);
        }
    }
  }

  [[nodiscard]] Jet fit(Index jet) {
    Jet out;
    out.normal = weighted_normal(jet);
    double bend = 0;
    bool is_settled = false;
    for (int round = 0; round < max_fits; ++round) {
      gather(jet, out.normal);
      stamp_[jet] = none;
      for (Index other : ring_)
        stamp_[other] = none;
      if (ring_.size() <= for_quadratic)
        return out;
      const double reach = reach_from(jet);
      out = fit_over(jet, out.normal, bend, is_settled ? 3 : 2, reach);
      const double change = bend_of(out.curvature) - bend;
      bend += (is_settled ? 1 : relaxation) * change;
      if (is_settled && std::abs(change) * reach < settled_cubic)
        break;
      is_settled = is_settled || std::abs(change) * reach < settled_square;
    }
    return out;
  }

  [[nodiscard]] double reach_from(Index jet) const {
    double reach = 0;
    for (Index other : ring_)
      reach = std::max(reach, (at(other) - at(jet)).norm());
    return reach;
  }

  /// The jet of w - g w^2 = p(u, v) over the plane with this normal, in units of the
  /// reach, where g is the bend. On spheres and cylinders of twice this curvature p is
  /// a square form.
  [[nodiscard]] Jet fit_over(Index jet, const Vector<3> &normal, double bend,
                             int degree, double reach) const {
    const Vector<3> t = normal.unitOrthogonal(), b = normal.cross(t);
    const std::size_t n = ring_.size() - 1;
    double highest = 0;
    for (Index other : ring_)
      highest = std::max(highest, std::abs((at(other) - at(jet)).dot(normal)));
    const double most = most_bent / std::max(highest, 1e-300);
    const double g = std::clamp(bend, -most, most) * reach;
    const bool is_cubic = degree == 3 && n >= for_cubic;
    Eigen::MatrixXd A(static_cast<Eigen::Index>(n), is_cubic ? 9 : 5);
    Eigen::VectorXd z(static_cast<Eigen::Index>(n));
    for (std::size_t k = 0; k < n; ++k) {
      const Vector<3> y = (at(ring_[k + 1]) - at(jet)) / reach;
      const double u = y.dot(t), v = y.dot(b), w = y.dot(normal), weight = 1 / y.norm();
      const auto row = static_cast<Eigen::Index>(k);
      A.row(row).head(5) << u, v, u * u, u * v, v * v;
      if (is_cubic)
        A.row(row).tail(4) << u * u * u, u * u * v, u * v * v, v * v * v;
      A.row(row) *= weight;
      z[row] = (w - g * w * w) * weight;
    }
    return jet_of(t, b, normal, solve(A, z), g, reach);
  }

  /// The least squares of the least coefficients, without cubic terms where the points
  /// do not tell them all apart.
  [[nodiscard]] static Eigen::VectorXd solve(Eigen::MatrixXd A,
                                             const Eigen::VectorXd &z) {
    Eigen::VectorXd scale = A.colwise().norm().cwiseMax(1e-12).cwiseInverse();
    A = A * scale.asDiagonal();
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(rank_tolerance);
    solver.compute(A);
    if (A.cols() > 5 && solver.rank() < A.cols()) {
      scale.conservativeResize(5);
      solver.compute(A.leftCols(5));
    }
    return scale.cwiseProduct(solver.solve(z));
  }

  /// The fundamental forms, at the vertex, of w - g w^2 = c0 u + c1 v + c2 u^2 + ...
  [[nodiscard]] static Jet jet_of(const Vector<3> &t, const Vector<3> &b,
                                  const Vector<3> &normal, const Eigen::VectorXd &c,
                                  double g, double reach) {
    Jet out;
    const Vector<3> tu = t + c[0] * normal, tv = b + c[1] * normal;
    out.normal = tu.cross(tv).normalized();
    const double slope = std::sqrt(1 + c[0] * c[0] + c[1] * c[1]) * reach;
    Matrix<2> first, second;
    first << tu.dot(tu), tu.dot(tv), tu.dot(tv), tv.dot(tv);
    second << c[2] + g * c[0] * c[0], c[3] / 2 + g * c[0] * c[1],
        c[3] / 2 + g * c[0] * c[1], c[4] + g * c[1] * c[1];
    second *= 2 / slope;
    Eigen::Matrix<double, 3, 2> tangents;
    tangents << tu, tv;
    const Matrix<2> inverse = first.inverse();
    out.curvature = as_tensor<3>(
        Matrix<3>(tangents * inverse * second * inverse * tangents.transpose()));
    return out;
  }

  /// Half of the curvature of a sphere or a cylinder; otherwise of a mean of the two,
  /// (k1 |k1| + k2 |k2|) / (|k1| + |k2|).
  [[nodiscard]] static double bend_of(const SymmetricTensor<3> &curvature) {
    const Matrix<3> K = as_matrix<3>(curvature);
    const double sum = K.trace(), squares = K.squaredNorm();
    const bool is_saddle = sum * sum < squares;
    return is_saddle ? sum / 2 : sum == 0 ? 0 : squares / (2 * sum);
  }
};

} // namespace

Jets fit_jets(std::span<const Vector<3>> points, std::span<const Facet<3>> facets,
              const Features &features) {
  return Fitter(points, facets, features).run();
}

} // namespace anistar
