#include "generate/refinement/mesh/plc_faces.h"

#include <algorithm>

namespace anistar::generate {
namespace {

/// Two facets that meet at less are refined for what is between them by no rule: their
/// angle makes what the rules want impossible. 60 degrees is where points of one facet
/// begin to encroach upon the other for ever; the margin is measured (studies/cdt.md).
constexpr double cos_acute_dihedral = 0.34202014332566873; // of 70 degrees

/// The cosine of the angle that the inside of the domain has between two walls at an
/// edge, if it is acute in this sense.
std::optional<double> acute_cosine(const WalledMesh &mesh, const WallEdge &edge,
                                   HalfFacet next) {
  const auto [x, y, u] = mesh.turned(edge);
  const Index w = mesh.third_vertex(next, x, y);
  const Vector<3> &o = mesh.points[x], e = mesh.points[y] - o;
  const auto across = [&](Index v) -> Vector<3> {
    const Vector<3> r = mesh.points[v] - o;
    return r - e * (r.dot(e) / e.squaredNorm());
  };
  const Vector<3> r = across(u), s = across(w);
  const double cosine = r.dot(s) / std::sqrt(r.squaredNorm() * s.squaredNorm());
  // the other side of the same two half-planes has the rest of the full angle
  if (cosine <= cos_acute_dihedral ||
      orientation(mesh.points[x], mesh.points[y], mesh.points[u], mesh.points[w]) !=
          Orientation::positive)
    return {};
  return cosine;
}

} // namespace

IndexLists::IndexLists(std::vector<Pair> pairs, std::size_t n_lists) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  begin_.assign(n_lists + 1, 0);
  entries_.reserve(pairs.size());
  for (const auto &[list, entry] : pairs) {
    ++begin_[list + 1];
    entries_.push_back(entry);
  }
  for (std::size_t k = 0; k < n_lists; ++k)
    begin_[k + 1] += begin_[k];
}

bool IndexLists::contains(Index list, Index entry) const {
  const auto entries = (*this)[list];
  return std::binary_search(entries.begin(), entries.end(), entry);
}

PlcFaces::PlcFaces(const WalledMesh &mesh) {
  find_incidences(mesh);
  find_projections(mesh);
  find_acute_pairs(mesh);
}

void PlcFaces::find_incidences(const WalledMesh &mesh) {
  std::vector<IndexLists::Pair> of_vertices, of_segments, vertices_of;
  ends_.assign(mesh.n_segments, {none, none});
  for (const auto &[edge, segment] : mesh.initial_edges)
    for (Index v : edge)
      if (mesh.carriers[v].kind == Carrier::Kind::vertex)
        ends_[segment][ends_[segment][0] == none ? 0 : 1] = v;
  mesh.for_each_wall([&](HalfFacet h, Index facet) {
    const Facet<3> wall = mesh.facet(h);
    for (std::size_t k = 0; k < 3; ++k) {
      if (mesh.carriers[wall[k]].kind == Carrier::Kind::vertex) {
        of_vertices.push_back({wall[k], facet});
        vertices_of.push_back({facet, wall[k]});
      }
      const Index s = mesh.segment_of(wall[(k + 1) % 3], wall[(k + 2) % 3]);
      if (s != none)
        of_segments.push_back({s, facet});
    }
  });
  vertex_facets_ = IndexLists(std::move(of_vertices), mesh.points.size());
  facet_vertices_ = IndexLists(std::move(vertices_of), mesh.n_facets);
  segment_facets_ = IndexLists(std::move(of_segments), mesh.n_segments);
}

void PlcFaces::find_projections(const WalledMesh &mesh) {
  projections_.resize(mesh.n_facets);
  std::vector<double> largest(mesh.n_facets, 0); // squares of twice the areas
  mesh.for_each_wall([&](HalfFacet h, Index facet) {
    const Facet<3> wall = mesh.facet(h);
    const Vector<3> &a = mesh.points[wall[0]];
    const Vector<3> n = (mesh.points[wall[1]] - a).cross(mesh.points[wall[2]] - a);
    if (n.squaredNorm() <= largest[facet])
      return;
    largest[facet] = n.squaredNorm();
    int axis = 0;
    for (int k = 1; k < 3; ++k)
      if (std::abs(n[k]) > std::abs(n[axis]))
        axis = k;
    projections_[facet].axis = static_cast<std::uint8_t>(axis);
  });
}

void PlcFaces::find_acute_pairs(const WalledMesh &mesh) {
  std::vector<IndexLists::Pair> pairs;
  mesh.for_each_half_wall([&](HalfFacet h, Index facet) {
    for (std::size_t k = 0; k < 3; ++k) {
      const WallEdge edge{h, k};
      const auto [x, y, u] = mesh.turned(edge);
      if (mesh.segment_of(x, y) == none)
        continue;
      const HalfFacet next = mesh.next_wall(edge);
      const Index other = next.exists() ? mesh.wall(next) : none;
      if (other == none || other == facet)
        continue;
      if (const std::optional<double> cosine = acute_cosine(mesh, edge, next)) {
        pairs.push_back({facet, other});
        pairs.push_back({other, facet});
        for (const IndexLists::Pair &pair : {pairs.back(), pairs.end()[-2]}) {
          double &largest = acute_cosines_.try_emplace(pair, *cosine).first->second;
          largest = std::max(largest, *cosine);
        }
      }
    }
  });
  acute_ = IndexLists(std::move(pairs), mesh.n_facets);
  std::size_t n = 0;
  for (std::size_t f = 0; f < mesh.n_facets; ++f)
    n += acute_[static_cast<Index>(f)].size();
  n_acute_pairs_ = n / 2;
}

std::span<const Index> PlcFaces::facets_of(const Carrier &carrier) const {
  switch (carrier.kind) {
  case Carrier::Kind::vertex:
    return vertex_facets_[carrier.face];
  case Carrier::Kind::segment:
    return segment_facets_[carrier.face];
  case Carrier::Kind::facet:
    return {&carrier.face, 1};
  case Carrier::Kind::space:
    break;
  }
  return {};
}

bool PlcFaces::is_on(const Carrier &carrier, Index facet) const {
  const auto facets = facets_of(carrier);
  return std::binary_search(facets.begin(), facets.end(), facet);
}

bool PlcFaces::are_disjoint(const Carrier &carrier, Index facet) const {
  const auto on_facet = [&](Index v) { return facet_vertices_.contains(facet, v); };
  switch (carrier.kind) {
  case Carrier::Kind::vertex:
    return !on_facet(carrier.face);
  case Carrier::Kind::segment:
    return std::none_of(ends_[carrier.face].begin(), ends_[carrier.face].end(),
                        on_facet);
  case Carrier::Kind::facet: {
    const auto vertices = facet_vertices_[carrier.face];
    return std::none_of(vertices.begin(), vertices.end(), on_facet);
  }
  case Carrier::Kind::space:
    break;
  }
  return false;
}

bool PlcFaces::is_across_acute_angle(const Carrier &carrier, Index facet) const {
  if (acute_[facet].empty() || is_on(carrier, facet))
    return false;
  const auto facets = facets_of(carrier);
  return std::any_of(facets.begin(), facets.end(),
                     [&](Index other) { return are_acute(facet, other); });
}

std::optional<double> PlcFaces::cosine_between(const Carrier &one,
                                               const Carrier &other) const {
  std::optional<double> largest;
  if (n_acute_pairs_ == 0)
    return largest;
  for (Index facet : facets_of(one)) {
    if (acute_[facet].empty() || is_on(other, facet))
      continue;
    for (Index g : facets_of(other))
      if (are_acute(facet, g) && !is_on(one, g))
        largest = std::max(largest, std::optional(acute_cosines_.at({facet, g})));
  }
  return largest;
}

} // namespace anistar::generate
