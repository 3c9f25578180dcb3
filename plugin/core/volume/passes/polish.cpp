// The last touch: moves and swaps for the quality that reports take, in the metric of
// the densest corner. The passes before it improve the quality in the mean of the four
// metrics; the two differ where the metric varies much within a cell.

#include "volume/mesh/cavity_operator.h"
#include "volume/mesh/densest_shapes.h"
#include "volume/mesh/shell.h"
#include "volume/mesh/vertex_trial.h"
#include "volume/passes/passes.h"

namespace anistar {
namespace {

/// A star is worth the sum of its qualities less this many times what its cells miss
/// below `poor_quality`.
constexpr double poor_weight = 4, poor_quality = .55;
/// What a step must add to be taken.
constexpr double smallest_gain = .006;
/// Steps in the metric, halved from the first to the last.
constexpr double longest_step = .16, shortest_step = .03;
/// A star whose mean quality is above is left alone.
constexpr double good_mean = .9;
/// Swaps for cells below, and what they must gain.
constexpr double swapped_below = .7, swap_gain = 1e-3;
/// What the mean of the metrics may say of a cell that a swap makes.
constexpr double mean_floor = .05;
constexpr std::size_t longest_ring = 9;
/// The metric is steep when the densities within a cell differ by this at the median.
constexpr double steep_ratio = 1.5;

/// The mean of the metrics is rarely this much kinder to a cell than the densest.
constexpr double largest_difference = .3;

double measured(const Triangulation<3> &mesh, const Cell<3> &cell) {
  return quality(mesh.vertex(cell[0]), mesh.vertex(cell[1]), mesh.vertex(cell[2]),
                 mesh.vertex(cell[3]));
}

/// Whether a cell may be below a quality in the measure of the reports, and is.
bool is_below(const Volume &volume, Index c, double quality) {
  return volume.quality_of(c) < quality + largest_difference &&
         measured(volume.mesh, volume.mesh.at(c)) < quality;
}

class Polish {
public:
  Polish(Volume &volume, const Run &run)
      : volume_(volume), mesh_(volume.mesh), run_(run), operator_(volume),
        trial_(volume, run.hausdorff.surface) {}

  VolumeCounts counts;

  void polish_vertices(double below, std::uint32_t since) {
    const std::size_t n = mesh_.vertices.size();
    const PerVertex<std::uint8_t> is_wanted = vertices_of(below, since);
    for (std::size_t k = 0; k < n && run_.goes_on(k, n); ++k)
      if (is_wanted[k] != 0 && mesh_.feature[k] != Triangulation<3>::corner)
        counts.moves += polish_vertex(static_cast<Index>(k));
  }

  void polish_cells(double below) {
    const std::size_t n = mesh_.cells.size();
    for (std::size_t k = 0; k < n && run_.goes_on(k, n); ++k) {
      const auto c = static_cast<Index>(k);
      if (!mesh_.is_alive(c) || !is_below(volume_, c, below))
        continue;
      if (remove_an_edge(c))
        ++counts.edge_swaps;
      else if (swap_a_facet(c))
        ++counts.face_swaps;
    }
  }

private:
  Volume &volume_;
  const Triangulation<3> &mesh_;
  const Run &run_;
  CavityOperator operator_;
  VertexTrial trial_;
  DensestShapes densest_;
  std::vector<Index> star_;
  Shell shell_;

  /// The vertices of the cells below a quality that changed since then.
  [[nodiscard]] PerVertex<std::uint8_t> vertices_of(double below,
                                                    std::uint32_t since) const {
    PerVertex<std::uint8_t> found(mesh_.vertices.size(), 0);
    for (std::size_t k = 0; k < mesh_.cells.size(); ++k) {
      const auto c = static_cast<Index>(k);
      if (mesh_.is_alive(c) && volume_.cell_clock[c] >= since &&
          is_below(volume_, c, below))
        for (Index v : mesh_.at(c))
          found[v] = 1;
    }
    return found;
  }

  [[nodiscard]] bool gather(Index v) {
    star_of(volume_, v, star_);
    if (star_.size() >= DensestShapes::capacity || !trial_.gather(v, star_))
      return false;
    densest_.clear();
    for (Index c : star_) {
      const Facet<3> t = facet_of<3>(mesh_.at(c), mesh_.local_index(c, v));
      densest_.add(mesh_.vertex(t[0]), mesh_.vertex(t[1]), mesh_.vertex(t[2]));
    }
    return true;
  }

  /// What the star is worth with the vertex there.
  [[nodiscard]] double worth(const Vertex<3> &vertex) {
    densest_.evaluate(vertex, poor_quality);
    return densest_.sum() - poor_weight * densest_.missing();
  }

  /// Tries steps along the axes of the metric, as long as the star is worth more.
  [[nodiscard]] bool polish_vertex(Index v) {
    if (!gather(v))
      return false;
    const Vertex<3> &here = mesh_.vertex(v);
    double most = worth(here);
    if (densest_.sum() > good_mean * static_cast<double>(star_.size()))
      return false;
    const double floor = std::min(densest_.minimum(), poor_quality);
    bool has_moved = false;
    const Matrix<3> axes = lower_factor<3>(here.M).transpose().inverse();
    for (double length = longest_step; length > shortest_step; length /= 2)
      for (int k = 0; k < 3; ++k) {
        const Vector<3> step = length * axes.col(k);
        if (try_move(here.x + step, floor, most) ||
            try_move(here.x - step, floor, most))
          has_moved = true;
      }
    return has_moved;
  }

  /// Moves the vertex of the trial there when its star is worth more then.
  [[nodiscard]] bool try_move(const Vector<3> &x, double floor, double &most) {
    trial_.place(x);
    if (!trial_.is_positive() || !trial_.keeps_surfaces())
      return false;
    trial_.take_metric();
    const double value = worth(trial_.vertex());
    if (value < most + smallest_gain || densest_.minimum() < floor ||
        densest_.minimum() <= 0)
      return false;
    most = value;
    (void)trial_.measure();
    trial_.commit();
    return true;
  }

  /// Removes an edge of a cell where that improves the worst cell around it.
  [[nodiscard]] bool remove_an_edge(Index c) {
    const Cell<3> cell = mesh_.at(c);
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j)
        if (remove_edge(c, cell[i], cell[j]))
          return true;
    return false;
  }

  [[nodiscard]] bool remove_edge(Index c, Index a, Index b) {
    const auto walls = walls_of_removable(volume_, c, a, b, longest_ring, shell_);
    if (!walls)
      return false;
    double worst = 1;
    for (Index cell : shell_.all())
      worst = std::min(worst, measured(mesh_, mesh_.at(cell)));
    const Acceptance acceptance{.floor = mean_floor,
                                .gain = swap_gain,
                                .hausdorff_number = run_.hausdorff.surface};
    for (std::size_t k = 0; k < shell_.n_ring(); ++k)
      if (walls->admits_apex(k) &&
          ring_quality(k, worst + swap_gain) > worst + swap_gain &&
          operator_.replace(shell_.all(), shell_.ring[k], {a, b}, acceptance))
        return true;
    return false;
  }

  /// The worst cell when the ring of the shell is joined to one of its vertices, or
  /// something below `threshold`.
  [[nodiscard]] double ring_quality(std::size_t apex, double threshold) const {
    const std::size_t n = shell_.n_ring();
    const Index r = shell_.ring[apex];
    double least = 1;
    for (std::size_t k = 1; k + 1 < n && least > threshold; ++k) {
      const std::size_t i = (apex + k) % n, j = (apex + k + 1) % n;
      if (!shell_.is_closed && j == 0)
        continue; // an open ring has a gap there
      const Index u = shell_.ring[i], w = shell_.ring[j];
      least = std::min({least, measured(mesh_, {shell_.a, r, u, w}),
                        measured(mesh_, {r, shell_.b, u, w})});
    }
    return least;
  }

  [[nodiscard]] bool swap_a_facet(Index c) {
    for (std::size_t i = 0; i < 4; ++i)
      if (swap_facet(HalfFacet(c, i)))
        return true;
    return false;
  }

  /// Replaces a facet between two cells by the edge between their apices.
  [[nodiscard]] bool swap_facet(HalfFacet h) {
    const HalfFacet beyond = mesh_.opposite(h);
    if (!beyond.exists() || mesh_.constraint(h) != none)
      return false;
    const Facet<3> t = mesh_.facet(h);
    const Index p = mesh_.apex(h), q = mesh_.apex(beyond);
    const double worst = std::min(measured(mesh_, mesh_.at(h.cell())),
                                  measured(mesh_, mesh_.at(beyond.cell())));
    for (std::size_t k = 0; k < 3; ++k)
      if (measured(mesh_, {t[k], t[(k + 1) % 3], q, p}) < worst + swap_gain)
        return false;
    const std::array<Index, 2> both{h.cell(), beyond.cell()};
    return operator_.replace(both, p, {none, none},
                             {.floor = mean_floor, .gain = swap_gain});
  }
};

} // namespace

bool is_metric_steep(const Volume &volume) {
  const Triangulation<3> &mesh = volume.mesh;
  std::size_t n = 0, n_steep = 0;
  for (const Cell<3> &cell : mesh.cells) {
    if (cell[0] == none)
      continue;
    double low = mesh.vertex(cell[0]).weight, high = low;
    for (Index v : cell) {
      low = std::min(low, mesh.vertex(v).weight);
      high = std::max(high, mesh.vertex(v).weight);
    }
    ++n;
    n_steep += high > steep_ratio * low;
  }
  return 2 * n_steep > n;
}

void polish(Volume &volume, const Run &run, PassLog &log, double quality) {
  Polish pass(volume, run);
  pass.polish_vertices(quality, log.begin(Pass::polish, volume));
  pass.polish_cells(std::min(quality, swapped_below));
  log.counts += pass.counts;
}

} // namespace anistar
