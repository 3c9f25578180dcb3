#pragma once
// The passes over a volume mesh: split, swap, the vertex pass, and repair.

#include "base/run.h"
#include "remesh/remesh_settings.h"
#include "volume/mesh/cavity_operator.h"
#include "volume/mesh/densest_shapes.h"
#include "volume/mesh/shell.h"
#include "volume/mesh/vertex_star.h"
#include "volume/mesh/vertex_trial.h"

#include <map>
#include <memory>
#include <string>

namespace anistar {

/// Operations made.
struct VolumeCounts {
  std::size_t splits = 0, collapses = 0, edge_swaps = 0, face_swaps = 0, moves = 0,
              insertions = 0, repairs = 0;

  VolumeCounts &operator+=(const VolumeCounts &other);
};

/// Which cells and vertices a pass looks at: those that changed since it last ran.
enum class Pass { split, swap, vertex, polish };

struct SplitRule {
  double longest;     ///< edges above are split
  double floor;       ///< of the quality
  double closest = 0; ///< nearest a new vertex may come to the others around the edge
  double share = 0;   ///< of the old quality that is enough too (see Acceptance)
  bool follows_curve = false; ///< split only what is then nearer to its curved feature
};

struct VertexRule {
  double shortest, longest; ///< edges below are collapsed unless that makes some above
  bool reinsert;
  double collapse_floor = .15;
  double reinsertion_floor = .5;
};

/// Everything the passes share.
class VolumePasses {
public:
  VolumePasses(Volume &volume, const Run &run)
      : volume_(volume), run_(run), operator_(volume), trial_(volume, run.hausdorff.surface) {}

  /// Splits the longest edge of every cell that is too long, and edges that stray from
  /// their curved surface or ridge; @returns how many.
  std::size_t split(const SplitRule &rule);
  /// Splits edges of curved surfaces and ridges that stray from them, while the cells
  /// there are thick enough to let the new vertices pass; @returns how many.
  std::size_t follow_surfaces();
  /// Edge removals and facet swaps at cells below `quality`, where they improve.
  void swap(double quality);
  /// Collapse, move and metric-Delaunay re-insertion of every vertex.
  void vertices(const VertexRule &rule);
  /// Swaps, collapses and splits at cells below `quality`, whatever improves.
  void repair(double quality);
  /// Moves and swaps at cells below `quality` in the measure of the reports.
  void polish(double quality);
  /// Whether that measure differs from the one of the other passes almost everywhere:
  /// the metric varies much within half of the cells.
  [[nodiscard]] bool is_metric_steep() const;
  /// Makes a pass look at everything the next time.
  void look_everywhere(Pass pass) { last_[static_cast<std::size_t>(pass)] = 0; }
  [[nodiscard]] double longest_edge() const;
  /// Of the cells, in the measure of the passes.
  [[nodiscard]] double least_quality() const;
  [[nodiscard]] const VolumeCounts &counts() const { return counts_; }
  [[nodiscard]] bool is_full() const { return is_full_; }

private:
  Volume &volume_;
  const Run &run_;
  CavityOperator operator_;
  VolumeCounts counts_;
  std::array<std::uint32_t, 4> last_{};
  bool is_full_ = false; ///< a split had to be left out for want of vertices
  std::vector<Index> star_, ring_;
  Shell shell_;
  VertexTrial trial_;
  DensestShapes densest_;
  struct Helper;
  std::vector<std::shared_ptr<Helper>> team_; ///< a helper to a further thread

  template <class SlabOf, class Visit>
  void in_slabs(std::vector<Index> items, SlabOf slab_of, Visit visit);
  template <class Visit>
  void visit_in_slab(std::span<const Index> items, Visit visit,
                     std::vector<Index> &put_off);
  [[nodiscard]] std::uint32_t begin(Pass pass);
  [[nodiscard]] bool go_on(std::size_t k, std::size_t n);

  struct LongEdge {
    Index a, b; ///< none: no edge is longer
    double length;
  };
  [[nodiscard]] LongEdge longest_edge(Index c, double above) const;
  [[nodiscard]] std::vector<std::uint8_t> due_cells(double above,
                                                    std::uint32_t since) const;
  /// Uses star_.
  [[nodiscard]] bool split_edge(Index cell, Index a, Index b, const SplitRule &rule,
                                const Acceptance &acceptance);
  [[nodiscard]] bool widen_shell(Index v);
  [[nodiscard]] Index new_vertex(const Vector<3> &x, Index dimension, Index lies_on);

  [[nodiscard]] bool swap_cell(Index c);
  [[nodiscard]] bool remove_edge(Index c, Index a, Index b);
  [[nodiscard]] bool is_ring_better(std::size_t apex, double threshold) const;

  [[nodiscard]] bool split_curved(Index c);
  [[nodiscard]] bool comes_nearer(Index dimension, Index lies_on, const Vector<3> &a,
                                  const Vector<3> &x, const Vector<3> &b) const;
  [[nodiscard]] bool is_off_curve(Index curve, const Vertex<3> &a,
                                  const Vertex<3> &b) const;

  [[nodiscard]] bool may_collapse(Index v, Index u) const;
  [[nodiscard]] bool follows_curve(Index v, Index u) const;
  void note_surface_neighbours(Index v);
  [[nodiscard]] bool collapse(Index v, Index u, const Acceptance &acceptance);
  [[nodiscard]] bool collapse_shortest(Index v, const VertexRule &rule);
  [[nodiscard]] double star_quality() const;
  void move(Index v);
  [[nodiscard]] bool try_move(const Vector<3> &x);
  void treat_vertex(Index v, const VertexRule &rule, std::uint8_t &is_placed);
  void reinsert(Index v, double floor);
  [[nodiscard]] bool repair_cell(Index c);

  void polish_vertices(double below);
  [[nodiscard]] bool polish_vertex(Index v);
  [[nodiscard]] bool polish_step(const Vector<3> &x, double floor, double &worth);
  void polish_cells(double below);
  [[nodiscard]] bool polish_edge(Index c, Index a, Index b);
  [[nodiscard]] double ring_quality(std::size_t apex, double threshold) const;
  [[nodiscard]] bool polish_facet(HalfFacet h);
};

} // namespace anistar
