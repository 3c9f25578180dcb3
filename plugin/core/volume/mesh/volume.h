#pragma once
// A tetrahedral mesh on its surfaces and ridges while it is being changed.

#include "mesh/triangulation.h"
#include "metric/background.h"
#include "surface/ridge_graph.h"
#include "surface/surface_shape.h"
#include "volume/mesh/slabs.h"
#include "volume/mesh/tet_shape.h"

#include <cstdint>
#include <memory>
#include <numeric>
#include <optional>
#include <unordered_map>

namespace anistar {

/// The mesh and what the passes remember of it. The constraint of a facet is its patch.
struct VolumeState {
  Triangulation<3> mesh;
  RidgeGraph ridges;
  PerVertex<Index> support; ///< patch of a vertex on a surface, curve of one on a ridge
  PerCell<float> quality;
  PerCell<std::uint8_t> walled; ///< whether a cell has a constrained facet
  /// When a cell, or a cell at a vertex, last changed, in passes.
  PerCell<std::uint32_t> cell_clock;
  PerVertex<std::uint32_t> vertex_clock;
  Slabs slabs;
  /// No operation may take the worst cell below this, nor further below.
  double kept_quality = 0;
  /// All cells at the vertices where bodies only touch: they are not joined by facets,
  /// so that a walk sees some of them alone.
  std::unordered_map<Index, std::vector<Index>> fans;
};

/// The same with what its facets and edges lie on, and its metric.
struct VolumeData : VolumeState {
  VolumeData(const Background<3> &field, SurfaceShape shape)
      : background(field), surface(std::move(shape)) {}

  const Background<3> &background;
  SurfaceShape surface;
  std::uint32_t clock = 1;
};

/// What one thread sees of the data, with marks of its own. It changes everything, or
/// what is inside of a slab: cells all of whose vertices are in it. Cells between slabs
/// stay as they are while there are several threads, so that none of them reads or
/// writes what another one writes.
struct Volume {
  Volume(const Background<3> &field, SurfaceShape shape)
      : data(std::make_shared<VolumeData>(field, std::move(shape))) {}
  /// Another view of the same data.
  explicit Volume(std::shared_ptr<VolumeData> shared) : data(std::move(shared)) {}
  Volume(const Volume &) = delete; // it would be a view, not a copy
  Volume(Volume &&) = default;

  std::shared_ptr<VolumeData> data;
  Triangulation<3> &mesh = data->mesh;
  const Background<3> &background = data->background;
  SurfaceShape &surface = data->surface;
  RidgeGraph &ridges = data->ridges;
  PerVertex<Index> &support = data->support;
  PerCell<float> &quality = data->quality;
  PerCell<std::uint8_t> &walled = data->walled;
  PerCell<std::uint32_t> &cell_clock = data->cell_clock;
  PerVertex<std::uint32_t> &vertex_clock = data->vertex_clock;
  std::uint32_t &clock = data->clock;
  std::unordered_map<Index, std::vector<Index>> &fans = data->fans;
  std::vector<Index> free_vertices;

  std::optional<Slab> slab;      ///< none: no bound
  std::vector<Index> free_cells; ///< those of the slab
  bool is_put_off = false;       ///< an operation would have left the slab

  [[nodiscard]] bool is_inside(Index v) const {
    return slab->contains(data->slabs.strip[v]);
  }
  [[nodiscard]] std::size_t n_vertices() const {
    return mesh.vertices.size() - free_vertices.size();
  }
  [[nodiscard]] Index feature(Index v) const { return mesh.feature[v]; }
  [[nodiscard]] Index support_of(Index v) const { return support[v]; }
  [[nodiscard]] double quality_of(Index c) const {
    return static_cast<double>(quality[c]);
  }
  [[nodiscard]] bool is_walled(Index c) const { return walled[c] != 0; }

  Index add_vertex(const Vertex<3> &vertex, Index dimension, Index lies_on,
                   Index background_cell);
  void remove_vertex(Index v);
  Index add_cell();
  void free_cell(Index c);
  void measure_cell(Index c);
  void touch(Index c);
  /// All cells at a vertex where bodies touch; null elsewhere.
  [[nodiscard]] std::vector<Index> *fans_of(Index v) const {
    const auto found = fans.find(v);
    return found == fans.end() ? nullptr : &found->second;
  }

  /// Marks cells and vertices for one search.
  void open_cells() { next_epoch(cell_epoch_, cell_stamp_, mesh.cells.size()); }
  bool mark_cell(Index c) { return mark(cell_stamp_, cell_epoch_, c); }
  [[nodiscard]] bool is_marked_cell(Index c) const {
    return cell_stamp_[c] == cell_epoch_;
  }
  void open_vertices() {
    next_epoch(vertex_epoch_, vertex_stamp_, mesh.vertices.size());
  }
  bool mark_vertex(Index v) { return mark(vertex_stamp_, vertex_epoch_, v); }
  [[nodiscard]] bool is_marked_vertex(Index v) const {
    return vertex_stamp_[v] == vertex_epoch_;
  }

private:
  std::vector<std::uint32_t> cell_stamp_, vertex_stamp_;
  std::uint32_t cell_epoch_ = 0, vertex_epoch_ = 0;

  static void next_epoch(std::uint32_t &epoch, std::vector<std::uint32_t> &stamp,
                         std::size_t size) {
    if (stamp.size() < size)
      stamp.resize(size + size / 2, 0);
    if (++epoch == 0) {
      std::fill(stamp.begin(), stamp.end(), 0);
      epoch = 1;
    }
  }
  static bool mark(std::vector<std::uint32_t> &stamp, std::uint32_t epoch, Index i) {
    std::uint32_t &s = stamp[i];
    if (s == epoch)
      return false;
    s = epoch;
    return true;
  }
};

/// The cells of the star of v, marked.
void star_of(Volume &volume, Index v, std::vector<Index> &cells);

/// Finds all cells at the vertices where bodies touch.
void gather_fans(Volume &volume, std::span<const Index> touching);

/// Renumbers along a Hilbert curve, and cuts into slabs.
void renumber(Volume &volume, int threads = 1);

} // namespace anistar
