#include "volume/pure/domain_oracle.h"

#include "search/nearest_on.h"

#include <algorithm>

namespace anistar {
namespace {

/// A long segment is looked for piece by piece, each of so many facets: the box of a
/// long one holds many facets that it does not come near.
constexpr double facets_per_piece = 3;
constexpr double most_pieces = 16;

/// Smooth surfaces lie no farther from the facets of the input than this part of the
/// size of those; planes no farther than rounding takes them.
constexpr double farthest_from_facet = .3, rounding_room = 1e-9;

/// Whether the segment ab meets a facet; its ends may do so on one side only.
bool meets(const std::array<Vector<3>, 3> &t, const Vector<3> &a, const Vector<3> &b) {
  const auto is_above = [&](const Vector<3> &x) {
    return orientation(t[0], t[1], t[2], x) != Orientation::negative;
  };
  if (is_above(a) == is_above(b))
    return false;
  int positive = 0, negative = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Orientation side = orientation(a, b, t[k], t[(k + 1) % 3]);
    positive += side == Orientation::positive;
    negative += side == Orientation::negative;
  }
  return positive == 0 || negative == 0;
}

Vector<3> meeting_point(const std::array<Vector<3>, 3> &t, const Vector<3> &a,
                        const Vector<3> &b) {
  const double at_a = std::abs(volume_determinant<3>({t[0], t[1], t[2], a})),
               at_b = std::abs(volume_determinant<3>({t[0], t[1], t[2], b}));
  const double sum = at_a + at_b;
  return sum > 0 ? Vector<3>(a + at_a / sum * (b - a)) : a;
}

} // namespace

DomainOracle::DomainOracle(const Volume &start, std::span<const Index> region)
    : background_(start.background), shape_(start.surface), region_(region),
      facets_(facets_of(start)), tree_(boxes()) {
  for (const Facet &facet : facets_) {
    Box<3> box;
    for (const Vector<3> &x : facet.corners)
      box.extend(x);
    box_.extend(box);
    facet_size_ += (box.high - box.low).maxCoeff() / double(facets_.size());
  }
}

std::vector<DomainOracle::Facet> DomainOracle::facets_of(const Volume &start) {
  const Triangulation<3> &mesh = start.mesh;
  std::vector<Facet> found;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(static_cast<Index>(c), i), beyond = mesh.opposite(h);
      if (mesh.constraint(h) == none || (beyond.exists() && beyond.cell() < h.cell()))
        continue;
      const anistar::Facet<3> t = mesh.facet(h);
      found.push_back({{mesh.vertex(t[0]).x, mesh.vertex(t[1]).x, mesh.vertex(t[2]).x},
                       mesh.constraint(h)});
    }
  return found;
}

std::vector<Box<3>> DomainOracle::boxes() const {
  std::vector<Box<3>> found(facets_.size());
  for (std::size_t k = 0; k < facets_.size(); ++k)
    for (const Vector<3> &x : facets_[k].corners)
      found[k].extend(x);
  return found;
}

Index DomainOracle::region(const Vector<3> &x, Index &cell) const {
  if (!box_.meets({x, x}))
    return none;
  const Location<3> at = background_.locator().locate(x, cell);
  cell = at.cell;
  return at.distance == 0 ? region_[at.cell] : none;
}

bool DomainOracle::is_on_patch(Index patch, const Vector<3> &x) const {
  const double allowed =
      facet_size_ * (shape_.is_flat(2, patch) ? rounding_room : farthest_from_facet);
  double nearest = allowed * allowed;
  bool is_near = false;
  tree_.nearest(x, nearest, [&](Index f, double bound) {
    if (facets_[f].patch != patch)
      return bound;
    const auto &t = facets_[f].corners;
    const std::array<double, 3> w = nearest_on(x, t);
    const double d = (w[0] * t[0] + w[1] * t[1] + w[2] * t[2] - x).squaredNorm();
    is_near = is_near || d <= nearest;
    return std::min(bound, d);
  });
  return is_near;
}

DomainOracle::Crossing DomainOracle::crossing(const Vector<3> &a, const Vector<3> &b,
                                              const Vector<3> &from,
                                              const SymmetricTensor<3> &M) const {
  Crossing found;
  double farthest = -1;
  const double length = (b - a).cwiseAbs().maxCoeff();
  const auto n_pieces = static_cast<int>(
      std::clamp(length / (facets_per_piece * facet_size_), 1., most_pieces));
  for (int k = 0; k < n_pieces; ++k) {
    Box<3> piece;
    piece.extend(a + double(k) / n_pieces * (b - a));
    piece.extend(k + 1 == n_pieces ? b
                                   : Vector<3>(a + double(k + 1) / n_pieces * (b - a)));
    tree_.meeting(piece, [&](Index f) {
      const auto &corners = facets_[f].corners;
      if (f != found.facet && meets(corners, a, b)) {
        const Vector<3> x = meeting_point(corners, a, b);
        if (const double d = quadratic<3>(M, x - from); d > farthest) {
          farthest = d;
          found = {f, x};
        }
      }
      return true;
    });
  }
  return found;
}

} // namespace anistar
