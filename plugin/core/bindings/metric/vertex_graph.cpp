#include "mesh/vertex_graph.h"
#include "bindings/support/arrays.h"

#include <stdexcept>
#include <string>

namespace anistar::bindings {
namespace {

nb::tuple wide(Array2<std::int32_t> cells, std::size_t n_points) {
  const std::size_t corners = cells.shape(1);
  if (corners != 3 && corners != 4)
    throw std::invalid_argument("cells must have 3 or 4 vertices, not " +
                                std::to_string(corners));
  const std::span<const std::int32_t> rows(cells.data(), cells.size());
  for (const std::int32_t v : rows)
    if (v < 0 || std::cmp_greater_equal(v, n_points))
      throw std::invalid_argument("vertex " + std::to_string(v) +
                                  " is out of range for " + std::to_string(n_points) +
                                  " points");
  VertexGraph graph;
  {
    nb::gil_scoped_release release;
    graph = wide_graph(rows, corners, n_points);
  }
  const std::size_t n_offsets = graph.offsets.size(),
                    n_neighbours = graph.neighbours.size();
  return nb::make_tuple(owned(std::move(graph.offsets), {n_offsets}),
                        owned(std::move(graph.neighbours), {n_neighbours}));
}

} // namespace

void bind_vertex_graph(nb::module_ &module) {
  module.def("wide_graph", &wide, nb::arg("cells").noconvert(), nb::arg("n_points"),
             "The graph of the edges of a mesh and of the vertices opposite across "
             "facets; returns (offsets, neighbours).");
}

} // namespace anistar::bindings
