#include "jets.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace anistar {
namespace {

/// Rings of neighbours, and the number of points at which no further ring is taken.
constexpr int max_rings = 4;
constexpr std::size_t enough_points = 16;
/// Points needed for a fit of degree two and three.
constexpr std::size_t for_quadratic = 5, for_cubic = 10;
/// Where few points leave the fit undetermined, a square of the height, with which it
/// is exact on spheres and cylinders, is this much preferred to cubic terms.
constexpr double cubic_reluctance = .01;
/// Fits over a tangent plane, each over that of the one before.
constexpr int max_fits = 4;

/// Facets that turn away from the vertex by more (the cosine) are not fitted: beyond,
/// the surface is no graph over the tangent plane.
constexpr double most_turned = .5;
/// Directions in which the points do not vary by this fraction are left out of the fit.
constexpr double rank_tolerance = 1e-5;

class Fitter {
public:
  Fitter(std::span<const Vector<3>> points, std::span<const Facet<3>> facets,
         std::span<const Index> patches)
      : points_(points), facets_(facets) {
    collect(patches);
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

  [[nodiscard]] const Vector<3> &point(Index v) const {
    return points_[static_cast<std::size_t>(v)];
  }
  [[nodiscard]] const Vector<3> &at(Index jet) const {
    return point(out_.vertex[static_cast<std::size_t>(jet)]);
  }
  [[nodiscard]] std::span<const Index> facets_of(Index jet) const {
    const auto s = static_cast<std::size_t>(jet);
    return {facets_at_.data() + first_[s],
            static_cast<std::size_t>(first_[s + 1] - first_[s])};
  }

  /// One jet for every vertex and patch that meet.
  void collect(std::span<const Index> patches) {
    struct Corner {
      Index vertex, patch, facet;
      std::size_t k;
    };
    std::vector<Corner> corners;
    for (std::size_t f = 0; f < facets_.size(); ++f)
      for (std::size_t k = 0; k < 3; ++k)
        corners.push_back({facets_[f][k], patches[f], static_cast<Index>(f), k});
    std::sort(corners.begin(), corners.end(), [](const Corner &a, const Corner &b) {
      return std::tie(a.vertex, a.patch, a.facet) <
             std::tie(b.vertex, b.patch, b.facet);
    });
    out_.facet_jets.resize(facets_.size());
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Corner &here = corners[k];
      if (k == 0 || here.vertex != corners[k - 1].vertex ||
          here.patch != corners[k - 1].patch) {
        out_.vertex.push_back(here.vertex);
        first_.push_back(static_cast<Index>(k));
      }
      facets_at_.push_back(here.facet);
      out_.facet_jets[static_cast<std::size_t>(here.facet)][here.k] =
          static_cast<Index>(out_.vertex.size() - 1);
    }
    first_.push_back(static_cast<Index>(corners.size()));
  }

  [[nodiscard]] Vector<3> facet_normal(Index f) const {
    const Facet<3> &t = facets_[static_cast<std::size_t>(f)];
    return (point(t[1]) - point(t[0])).cross(point(t[2]) - point(t[0]));
  }

  /// Exact at the vertices of a polyhedron inscribed in a sphere (Max, Weights for
  /// computing vertex normals from facet normals, 1999). Facets may be oriented anyhow.
  [[nodiscard]] Vector<3> weighted_normal(Index jet) const {
    const Index v = out_.vertex[static_cast<std::size_t>(jet)];
    Vector<3> sum = Vector<3>::Zero();
    for (Index f : facets_of(jet)) {
      const Facet<3> &t = facets_[static_cast<std::size_t>(f)];
      const std::size_t k = t[0] == v ? 0 : t[1] == v ? 1 : 2;
      const Vector<3> a = point(t[(k + 1) % 3]) - point(v);
      const Vector<3> b = point(t[(k + 2) % 3]) - point(v);
      const Vector<3> weighted = a.cross(b) / (a.squaredNorm() * b.squaredNorm());
      sum += sum.dot(weighted) < 0 ? Vector<3>(-weighted) : weighted;
    }
    return sum.normalized();
  }

  /// The jets around one, ring after ring, as far as the surface faces its normal.
  void gather(Index jet, const Vector<3> &normal) {
    ring_.assign(1, jet);
    stamp_[static_cast<std::size_t>(jet)] = jet;
    std::size_t begin = 0;
    for (int ring = 0; ring < max_rings && ring_.size() <= enough_points; ++ring) {
      const std::size_t end = ring_.size();
      for (; begin < end; ++begin)
        for (Index f : facets_of(ring_[begin])) {
          const Vector<3> m = facet_normal(f);
          if (std::abs(m.dot(normal)) < most_turned * m.norm())
            continue;
          for (Index other : out_.facet_jets[static_cast<std::size_t>(f)])
            if (std::exchange(stamp_[static_cast<std::size_t>(other)], jet) != jet)
              ring_.push_back(other);
        }
    }
  }

  [[nodiscard]] Jet fit(Index jet) {
    Jet out;
    out.normal = weighted_normal(jet);
    for (int round = 0; round < max_fits; ++round) {
      gather(jet, out.normal);
      stamp_[static_cast<std::size_t>(jet)] = none;
      for (Index other : ring_)
        stamp_[static_cast<std::size_t>(other)] = none;
      if (ring_.size() <= for_quadratic)
        return out;
      out = fit_over(jet, out.normal);
    }
    return out;
  }

  /// A fit over the plane with this normal.
  [[nodiscard]] Jet fit_over(Index jet, const Vector<3> &normal) const {
    const Vector<3> t = normal.unitOrthogonal(), b = normal.cross(t);
    const std::size_t n = ring_.size() - 1;
    double reach = 0;
    for (Index other : ring_)
      reach = std::max(reach, (at(other) - at(jet)).norm());
    const bool is_cubic = n >= for_cubic;
    Eigen::MatrixXd A(static_cast<Eigen::Index>(n), is_cubic ? 10 : 5);
    Eigen::VectorXd z(static_cast<Eigen::Index>(n));
    for (std::size_t k = 0; k < n; ++k) {
      const Vector<3> y = (at(ring_[k + 1]) - at(jet)) / reach;
      const double u = y.dot(t), v = y.dot(b), w = y.dot(normal), weight = 1 / y.norm();
      const auto row = static_cast<Eigen::Index>(k);
      A.row(row).head(5) << u, v, u * u, u * v, v * v;
      if (is_cubic)
        A.row(row).tail(5) << w * w, u * u * u, u * u * v, u * v * v, v * v * v;
      A.row(row) *= weight;
      z[row] = w * weight;
    }
    Eigen::VectorXd scale = A.colwise().norm().cwiseMax(1e-12).cwiseInverse();
    if (is_cubic)
      scale.tail(4) *= cubic_reluctance;
    A = A * scale.asDiagonal();
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(rank_tolerance);
    const Eigen::VectorXd c = scale.cwiseProduct(solver.compute(A).solve(z));

    // the fundamental forms of the graph of the polynomial, at the vertex
    Jet out;
    const Vector<3> tu = t + c[0] * normal, tv = b + c[1] * normal;
    out.normal = tu.cross(tv).normalized();
    const double slope = std::sqrt(1 + c[0] * c[0] + c[1] * c[1]) * reach;
    Matrix<2> first, second;
    first << tu.dot(tu), tu.dot(tv), tu.dot(tv), tv.dot(tv);
    second << 2 * c[2], c[3], c[3], 2 * c[4];
    second /= slope;
    Eigen::Matrix<double, 3, 2> tangents;
    tangents << tu, tv;
    const Matrix<2> inverse = first.inverse();
    out.curvature = as_tensor<3>(
        Matrix<3>(tangents * inverse * second * inverse * tangents.transpose()));
    return out;
  }
};

} // namespace

Jets fit_jets(std::span<const Vector<3>> points, std::span<const Facet<3>> facets,
              std::span<const Index> patches) {
  return Fitter(points, facets, patches).run();
}

} // namespace anistar
