#pragma once
// Changes of topology that make the metrics of a volume mesh agree.

#include "base/monitor.h"
#include "base/random.h"
#include "volume/mesh/cavity_operator.h"
#include "volume/mesh/shell.h"
#include "volume/stars/agreement_state.h"

namespace anistar {

/// Tries what the cavity operator can do at a failing facet, scored by the exact change
/// in AgreementCost before anything is changed.
class FacetRepair {
public:
  FacetRepair(AgreementView &view, Monitor &monitor)
      : view_(view), volume_(view.volume), operator_(view.volume), monitor_(monitor) {}

  /// What the cost must do: go down, or count fewer facets.
  enum class Demand { lower_cost, fewer_failing };

  /// The facet becomes an edge, or one of its edges is removed; at a wall, the facets
  /// and edges of its cells.
  bool swap(HalfFacet facet, Demand demand);
  /// The star of v grows to its Delaunay star in the metric of v.
  bool reinsert(Index v);
  /// One of the five vertices of the facet is collapsed, or an edge between them split,
  /// when fewer facets fail after that.
  bool collapse_or_insert(HalfFacet facet, CounterRandom &random);

private:
  AgreementView &view_;
  Volume &volume_;
  CavityOperator operator_;
  Monitor &monitor_;
  Shell shell_;
  std::vector<Index> star_, new_cells_;

  [[nodiscard]] bool replace(std::span<const Index> cells, Index apex,
                             std::array<Index, 2> lost, const Acceptance &acceptance,
                             Demand demand);
  [[nodiscard]] bool is_worth_it(std::span<const Index> cells, Demand demand);
  [[nodiscard]] AgreementCost cost_of(std::span<const Index> cells);
  [[nodiscard]] AgreementCost cost_of_proposal() const;
  [[nodiscard]] bool swap_wall(HalfFacet wall, Demand demand);
  [[nodiscard]] bool into_edge(HalfFacet facet, Demand demand);
  [[nodiscard]] bool remove_edge(Index c, Index a, Index b, Demand demand);
  [[nodiscard]] bool collapse(Index v, Index u);
  [[nodiscard]] bool insert(Index c, Index a, Index b, CounterRandom &random);
};

} // namespace anistar
