#include "volume/mesh/start.h"

#include "surface/matched_ridges.h"

#include <stdexcept>
#include <string>

namespace anistar {
namespace {

/// Where nothing turns by more (degrees) there is no ridge to be found.
constexpr double flat_turn = 1e-6;

/// Finds the patch of a facet by its vertices.
class PatchTable {
public:
  PatchTable(std::span<const Facet<3>> facets, const std::vector<Index> &patch,
             std::size_t n_points)
      : first_(n_points + 1, 0), entries_(facets.size()) {
    for (const Facet<3> &facet : facets)
      ++first_[lowest(facet) + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t f = 0; f < facets.size(); ++f)
      entries_[next[lowest(facets[f])]++] = {sorted(facets[f]), patch[f], false};
  }

  Index take(const Facet<3> &facet) {
    const std::size_t v = lowest(facet);
    if (first_[v] == first_[v + 1])
      return none;
    const Facet<3> key = sorted(facet);
    for (std::size_t k = first_[v]; k < first_[v + 1]; ++k)
      if (entries_[k].key == key) {
        entries_[k].is_used = true;
        return entries_[k].patch;
      }
    return none;
  }
  [[nodiscard]] bool is_used_up() const {
    return std::all_of(entries_.begin(), entries_.end(),
                       [](const Entry &entry) { return entry.is_used; });
  }

private:
  struct Entry {
    Facet<3> key;
    Index patch;
    bool is_used;
  };
  std::vector<std::size_t> first_;
  std::vector<Entry> entries_;

  static std::size_t lowest(const Facet<3> &facet) {
    return static_cast<std::size_t>(*std::min_element(facet.begin(), facet.end()));
  }
  static Facet<3> sorted(Facet<3> facet) {
    std::sort(facet.begin(), facet.end());
    return facet;
  }
};

/// Room for a few more vertices and cells: an array that grows by itself doubles, and
/// leaves a hole where it was.
void reserve_room(Volume &volume, std::size_t n_vertices, std::size_t n_cells) {
  const auto reserve = [](std::size_t n, auto &...arrays) {
    (arrays.reserve(n + n / 8), ...);
  };
  Triangulation<3> &mesh = volume.mesh;
  reserve(n_vertices, mesh.vertices, mesh.feature, mesh.vertex_cell,
          mesh.background_cell, volume.support, volume.vertex_clock, volume.at_rest);
  reserve(n_cells, mesh.cells, mesh.neighbours, mesh.constraints, mesh.region,
          volume.quality, volume.walled, volume.cell_clock);
}

void add_cells(Volume &volume, const VolumeInput &input,
               const std::vector<Index> &facet_patch) {
  Triangulation<3> &mesh = volume.mesh;
  const std::size_t n = input.cells.size();
  mesh.cells.assign(input.cells.begin(), input.cells.end());
  mesh.region.assign(input.cell_tags.begin(), input.cell_tags.end());
  mesh.neighbours = volume.background.locator().neighbours();
  mesh.constraints.assign(n, {none, none, none, none});
  volume.quality.resize(n);
  volume.walled.assign(n, 0);
  volume.cell_clock.assign(n, 0);
  PatchTable table(input.surface.facets, facet_patch, input.surface.points.size());
  for (std::size_t c = 0; c < n; ++c)
    for (std::size_t i = 0; i < 4; ++i) {
      const Index patch = table.take(facet_of<3>(mesh.cells[c], i));
      mesh.constraints[c][i] = patch;
      if (patch != none)
        volume.walled[c] = 1;
      else if (!mesh.neighbours[c][i].exists())
        throw std::invalid_argument("a boundary facet of cell " + std::to_string(c) +
                                    " is not among the facets");
      mesh.vertex_cell[mesh.cells[c][i]] = static_cast<Index>(c);
    }
  if (!table.is_used_up())
    throw std::invalid_argument("a facet is not one of a cell");
}

/// Where bodies only touch, in an edge or a vertex, the cells around it are not joined
/// by facets: an operation would see one side of it alone. Such places stay as they
/// are, and the cells around them are kept in a list.
void freeze_touching(Volume &volume) {
  Triangulation<3> &mesh = volume.mesh;
  std::vector<Index> touching;
  std::vector<std::uint8_t> n_facets(volume.ridges.edges().size(), 0);
  std::vector<Index> n_cells(mesh.vertices.size(), 0);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(static_cast<Index>(c), i);
      ++n_cells[mesh.cells[c][i]];
      if (mesh.opposite(h).exists())
        continue;
      const Facet<3> t = mesh.facet(h);
      for (std::size_t k = 0; k < 3; ++k) {
        const Index edge = volume.ridges.find(t[k], t[(k + 1) % 3]);
        if (edge == none || ++n_facets[edge] <= 2)
          continue;
        volume.surface.freeze(volume.ridges.at(edge).curve);
        touching.insert(touching.end(), {t[k], t[(k + 1) % 3]});
      }
    }
  for (const RidgeEdge &edge : volume.ridges.edges())
    if (volume.surface.curve(edge.curve).is_frozen)
      for (Index v : edge.ends)
        mesh.feature[v] = Triangulation<3>::corner;
  std::vector<Index> star;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (mesh.feature[v] == 3 || mesh.vertex_cell[v] == none)
      continue;
    star_of(volume, static_cast<Index>(v), star);
    if (std::cmp_equal(star.size(), n_cells[v]))
      continue;
    mesh.feature[v] = Triangulation<3>::corner;
    touching.push_back(static_cast<Index>(v));
  }
  gather_fans(volume, touching);
}

} // namespace

Volume make_volume(const VolumeInput &input, std::span<const SymmetricTensor<3>> metric,
                   const Background<3> &background, const SurfaceInput &geometry,
                   SurfaceProjection projection) {
  const Features features = find_features(
      input.surface,
      [&](std::span<const Fold> folds, const auto &others,
          std::vector<bool> is_sharp) -> std::vector<bool> {
        const bool is_flat =
            std::all_of(folds.begin(), folds.end(),
                        [](const Fold &fold) { return fold.turn < flat_turn; });
        return is_flat ? is_sharp
                       : matched_ridges(SmoothSurface(geometry), input.surface.points,
                                        folds, others, is_sharp);
      });
  Volume volume(background, SurfaceShape(features.patches, features.curves, geometry,
                                         std::move(projection)));
  volume.surface.match(input.surface, features);
  const std::size_t n = input.surface.points.size();
  reserve_room(volume, n, input.cells.size());
  for (std::size_t v = 0; v < n; ++v)
    volume.add_vertex(make_vertex<3>(input.surface.points[v], metric[v]),
                      features.dimension[v], features.support[v], none);
  for (const RidgeSegment &ridge : features.ridges)
    volume.ridges.add(ridge.ends[0], ridge.ends[1], ridge.curve);
  add_cells(volume, input, features.facet_patch);
  for (std::size_t v = 0; v < n; ++v) {
    const Index cell = volume.mesh.vertex_cell[v];
    if (cell == none)
      volume.free_vertices.push_back(static_cast<Index>(v));
    volume.mesh.background_cell[v] = cell; // the mesh is its own background
  }
  freeze_touching(volume);
  renumber(volume);
  return volume;
}

} // namespace anistar
