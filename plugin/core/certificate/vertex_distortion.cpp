#include "certificate/vertex_distortion.h"

#include "base/parallel.h"
#include "mesh/statistics.h"

namespace anistar {

template <std::size_t d>
PerVertex<double> vertex_distortion(std::span<const Vertex<d>> vertices,
                                    std::span<const Cell<d>> cells, int threads,
                                    const Look &look) {
  const auto edges = edges_of<d>(cells, vertices.size());
  std::vector<double> gamma(edges.size());
  watched_ranges(edges.size(), threads, look, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e)
      gamma[e] = distortion(vertices[edges[e][0]].M, vertices[edges[e][1]].M);
  });
  PerVertex<double> worst(vertices.size(), 1);
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (Index v : edges[e])
      worst[v] = std::max(worst[v], gamma[e]);
  return worst;
}

template PerVertex<double> vertex_distortion(std::span<const Vertex<2>>,
                                             std::span<const Cell<2>>, int,
                                             const Look &);
template PerVertex<double> vertex_distortion(std::span<const Vertex<3>>,
                                             std::span<const Cell<3>>, int,
                                             const Look &);

} // namespace anistar
