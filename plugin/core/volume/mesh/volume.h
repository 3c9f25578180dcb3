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

/// A mesh on its surfaces and ridges and what the passes remember of it: a value, of
/// which a copy is a snapshot. The constraint of a facet is its patch.
struct VolumeMesh {
  Triangulation<3> triangulation;
  std::vector<Index> free_vertices;
  RidgeGraph ridges;
  PerVertex<Index> support; ///< patch of a vertex on a surface, curve of one on a ridge
  PerCell<float> quality;
  PerCell<std::uint8_t> walled; ///< whether a cell has a constrained facet
  /// When a cell, or a cell at a vertex, last changed, in passes.
  PerCell<std::uint32_t> cell_clock;
  PerVertex<std::uint32_t> vertex_clock;
  /// Vertices whose stars agreed and have kept their cells: what improves shapes leaves
  /// them alone but for a clear gain.
  PerVertex<std::uint8_t> at_rest;
  Slabs slabs;
  /// No operation may take the worst cell below this, nor further below.
  double kept_quality = 0;
  /// All cells at the vertices where bodies only touch: they are not joined by facets,
  /// so that a walk sees some of them alone.
  std::unordered_map<Index, std::vector<Index>> fans;
};

/// A view: what one thread sees of a mesh, of what its facets and edges lie on and of
/// its metric, with marks of its own. It changes everything, or what is inside of a
/// slab: cells all of whose vertices are in it. Cells between slabs stay as they are
/// while there are several threads, so that none of them reads or writes what another
/// one writes.
class Volume {
  /// What all views share.
  struct Shared {
    const Background<3> &background;
    SurfaceShape surface;
    VolumeMesh state{};
    std::uint32_t clock = 1;
  };
  std::shared_ptr<Shared> shared_;

  explicit Volume(std::shared_ptr<Shared> shared) : shared_(std::move(shared)) {}

public:
  Volume(const Background<3> &field, SurfaceShape shape)
      : Volume(std::make_shared<Shared>(Shared{field, std::move(shape)})) {}
  Volume(const Volume &) = delete; // it would be a view, not a copy
  Volume(Volume &&) = default;
  /// Another view of the same, without a slab.
  [[nodiscard]] Volume view() const { return Volume(shared_); }

  VolumeMesh &state = shared_->state; ///< may be put back to a copy of it
  Triangulation<3> &mesh = state.triangulation;
  const Background<3> &background = shared_->background;
  SurfaceShape &surface = shared_->surface;
  RidgeGraph &ridges = state.ridges;
  PerVertex<Index> &support = state.support;
  PerCell<float> &quality = state.quality;
  PerCell<std::uint8_t> &walled = state.walled;
  PerCell<std::uint32_t> &cell_clock = state.cell_clock;
  PerVertex<std::uint32_t> &vertex_clock = state.vertex_clock;
  PerVertex<std::uint8_t> &at_rest = state.at_rest;
  std::uint32_t &clock = shared_->clock;
  std::unordered_map<Index, std::vector<Index>> &fans = state.fans;
  std::vector<Index> &free_vertices = state.free_vertices;

  std::optional<Slab> slab;      ///< none: no bound
  std::vector<Index> free_cells; ///< those of the slab
  std::vector<Index> removed;    ///< vertices, in the slab
  bool is_put_off = false;       ///< an operation would have left the slab

  [[nodiscard]] bool is_inside(Index v) const {
    return slab->contains(state.slabs.strip[v]);
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
  [[nodiscard]] bool is_at_rest(Index v) const { return at_rest[v] != 0; }

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

/// Renumbers along a Hilbert curve, and cuts into slabs. @returns the old index of
/// every cell
PerCell<Index> renumber(Volume &volume, int threads = 1);

} // namespace anistar
