#include "plane/passes/refine.h"

#include "mesh/blocks.h"
#include "mesh/mesh_walk.h"
#include "plane/mesh/edits.h"

#include <cmath>
#include <memory>
#include <numeric>

namespace anistar {
namespace {

/// Circumradius above which a cell is refined. A unit equilateral triangle has
/// 1/sqrt 3 = .577; with this value the edges of the result have mean length one.
constexpr double largest_radius = .78;
/// Smallest metric distance between a new vertex and those around it.
constexpr double separation = .6;
/// Constrained edges shorter than this are not split by refinement.
constexpr double shortest_split = 1.3;
/// Nearer than this to a longer edge that cannot be split, nothing is inserted.
constexpr double least_height = .5;
/// A cell this much larger than the target whose circumcentre is hidden behind a
/// constraint is refined at its centroid.
constexpr double hidden_radius = 3 * largest_radius;
constexpr int flip_cap = 200;
/// Radii are sorted into buckets.
constexpr std::size_t n_buckets = 64;
constexpr double buckets_per_octave = 4;
/// Blocks are refined side by side when there are so many vertices that are not on
/// curves, and the target is still as far as this.
constexpr std::size_t vertices_for_blocks = 2048;
constexpr double worth_levels = 2 * largest_radius;
/// The blocks of every other level lie along a curve that turns elsewhere, see
/// hilbert_order.
constexpr double shift_of_blocks = .25;
/// Levels at the target itself, for what lay between the blocks of the first one.
constexpr int levels_at_target = 2;
/// A level has room for that many new vertices per vertex: four are expected.
constexpr double least_growth = .1, most_growth = 8;

/// The mean of three metrics, whose density is their geometric mean.
SymmetricTensor<2> mean_metric(const Vertex<2> &a, const Vertex<2> &b,
                               const Vertex<2> &c) {
  SymmetricTensor<2> M = a.weight * a.M + b.weight * b.M + c.weight * c.M;
  const double density = 1 / elementary::cube_root(a.weight * b.weight * c.weight);
  return M *= density / std::sqrt(determinant<2>(M));
}

class Refinement {
public:
  Refinement(Workspace &w, Legaliser &legaliser)
      : w_(w), legaliser_(legaliser), cavity_(w.mesh) {}

  /// From now on changes nothing outside of the range, and refines to this radius.
  void restrict_to(const VertexRange &range, Slots *slots, double radius) {
    range_ = range;
    target_ = radius;
    cavity_.take_from(slots);
    legaliser_.restrict_to(range);
  }

  void push(std::size_t first_cell, std::size_t last_cell) {
    for (std::size_t c = first_cell; c < last_cell; ++c)
      push(static_cast<Index>(c));
  }
  /// Treats the next cell. @returns false when none is left or there is no more room.
  bool step() {
    if (cavity_.slots() && !cavity_.slots()->has_room())
      return false;
    const Index cell = pop();
    if (cell != none)
      treat(cell);
    return cell != none;
  }
  /// No cell that waits has a larger radius.
  [[nodiscard]] double level() const {
    return largest_radius *
           elementary::exp2(static_cast<double>(top_ + 1) / buckets_per_octave);
  }
  void clear() {
    for (std::vector<Entry> &bucket : buckets_)
      bucket.clear();
    head_.fill(0);
    top_ = 0;
  }
  [[nodiscard]] RefineCounts take_counts() { return std::exchange(counts_, {}); }

private:
  struct Entry { ///< a cell as it was when pushed
    Index cell;
    Cell<2> vertices;
  };

  Workspace &w_;
  Legaliser &legaliser_;
  Cavity cavity_;
  VertexRange range_;
  double target_ = largest_radius;
  RefineCounts counts_;
  std::array<std::vector<Entry>, n_buckets> buckets_;
  std::array<std::size_t, n_buckets> head_{};
  std::size_t top_ = 0; ///< no bucket above this one has entries
  std::vector<Index> changed_;

  [[nodiscard]] Circumcircle circle_of(Index cell) const {
    const Cell<2> &v = w_.mesh.at(cell);
    const Vertex<2> &a = w_.mesh.vertex(v[0]), &b = w_.mesh.vertex(v[1]),
                    &c = w_.mesh.vertex(v[2]);
    return circumcircle(mean_metric(a, b, c), a.x, b.x, c.x);
  }

  void push(Index cell) {
    if (!w_.mesh.is_alive(cell) || !range_.contains(w_.mesh.at(cell)))
      return;
    const double radius = circle_of(cell).radius;
    if (!(radius > target_)) // also when round-off has made it NaN
      return;
    const double level = buckets_per_octave * elementary::log2(radius / largest_radius);
    const std::size_t b = std::min(n_buckets - 1, static_cast<std::size_t>(level));
    buckets_[b].push_back({cell, w_.mesh.at(cell)});
    top_ = std::max(top_, b);
  }

  Index pop() {
    for (;;) {
      std::vector<Entry> &bucket = buckets_[top_];
      std::size_t &head = head_[top_];
      while (head < bucket.size()) {
        const Entry entry = bucket[head++];
        if (w_.mesh.at(entry.cell) == entry.vertices)
          return entry.cell;
      }
      bucket.clear();
      head = 0;
      if (top_ == 0)
        return none;
      --top_;
    }
  }

  /// Legalises around a new star and queues what changed.
  void settle(std::span<const HalfFacet> star) {
    changed_.clear();
    for (HalfFacet h : star) {
      changed_.push_back(h.cell());
      legaliser_.push(h);
    }
    legaliser_.run(flip_cap, &changed_);
    for (Index c : changed_)
      push(c);
  }

  bool split(HalfFacet wall) {
    if (w_.length(wall) < shortest_split || split_edge(w_, wall) == none)
      return false;
    ++counts_.boundary_splits;
    settle(w_.cavity.star());
    return true;
  }

  void treat(Index cell) {
    const Cell<2> before = w_.mesh.at(cell);
    const Circumcircle circle = circle_of(cell);
    if (!circle.centre.allFinite())
      return;
    const Walk at = walk_to(w_.mesh, cell, circle.centre, range_);
    Offer answer = Offer::walled;
    if (at.cell != none)
      answer = offer(circle.centre, at.cell);
    else if (!range_.is_unbounded())
      answer = Offer::put_off;
    else if (at.wall.exists() && split(at.wall))
      answer = Offer::split;
    else if (circle.radius < hidden_radius)
      answer = Offer::refused;
    if (answer == Offer::walled) {
      const Simplex<2> s = w_.mesh.simplex(cell);
      answer = offer((s[0] + s[1] + s[2]) / 3, cell);
    }
    switch (answer) {
    case Offer::taken:
      ++counts_.inserted;
      settle(cavity_.star());
      break;
    case Offer::split:
      again(cell, before);
      break;
    case Offer::put_off:
      break;
    case Offer::walled:
    case Offer::refused: // in a block it will be asked again
      counts_.rejected += range_.is_unbounded();
    }
  }

  enum class Offer {
    taken,
    split,   ///< a constrained edge instead
    walled,  ///< too near to a long edge that cannot be split
    put_off, ///< not in this block
    refused
  };

  /// Offers x to the cell that contains it.
  Offer offer(const Vector<2> &x, Index cell) {
    if (!range_.is_unbounded() && !is_inside(cell))
      return Offer::put_off;
    Index hint = w_.mesh.background_cell[w_.mesh.at(cell)[0]];
    const Vertex<2> vertex = w_.background.vertex(x, hint);
    for (std::size_t i = 0; i < 3; ++i) {
      const HalfFacet edge(cell, i);
      if (!encroaches(w_.mesh, vertex, edge))
        continue;
      if (!range_.is_unbounded())
        return Offer::put_off; // curves are no block's
      if (w_.length(edge) < shortest_split)
        return Offer::refused;
      if (split(edge))
        return Offer::split;
      if (height(vertex, edge) < least_height)
        return Offer::walled;
    }
    if (is_crowded(vertex, cell) ||
        insert_in_cell(w_.mesh, cavity_, cell, vertex, hint) == none)
      return Offer::refused;
    return Offer::taken;
  }

  /// The cell and those across its edges are in the range.
  [[nodiscard]] bool is_inside(Index cell) const {
    const Neighbours<2> &around = w_.mesh.neighbours[cell];
    return range_.contains(w_.mesh.at(cell)) &&
           std::all_of(around.begin(), around.end(), [&](HalfFacet h) {
             return !h.exists() || range_.contains(w_.mesh.at(h.cell()));
           });
  }

  void again(Index cell, const Cell<2> &before) {
    if (w_.mesh.at(cell) == before)
      push(cell);
  }

  /// Distance of p from the line of an edge in its own metric.
  [[nodiscard]] double height(const Vertex<2> &p, HalfFacet edge) const {
    const auto [ia, ib] = w_.mesh.facet(edge);
    const Vector<2> &a = w_.mesh.vertex(ia).x, u = w_.mesh.vertex(ib).x - a;
    const double area = std::abs(cross(u, p.x - a)) / p.weight;
    return area / std::sqrt(quadratic<2>(p.M, u));
  }

  [[nodiscard]] bool is_crowded(const Vertex<2> &p, Index cell) const {
    const auto near = [&](Index v) {
      const Vertex<2> &q = w_.mesh.vertex(v);
      const Vector<2> r = q.x - p.x;
      return quadratic<2>(p.M, r) < separation * separation ||
             quadratic<2>(q.M, r) < separation * separation;
    };
    for (std::size_t i = 0; i < 3; ++i) {
      const HalfFacet beyond = w_.mesh.opposite(HalfFacet(cell, i));
      if (near(w_.mesh.at(cell)[i]) || (beyond.exists() && near(w_.mesh.apex(beyond))))
        return true;
    }
    return false;
  }
};

/// What refinement to a radius will make of a part of the mesh: one vertex for each
/// 1.48 r^2 of its area in the metric (measured); with a margin.
double expected_vertices(double area, double radius) {
  constexpr double area_of_vertex = 1.2;
  return area / (area_of_vertex * radius * radius);
}

/// The cells whose first vertex is in a block. @pre the mesh was just renumbered
struct CellRange {
  std::size_t first, last;
};
CellRange cells_of(const Triangulation<2> &mesh, const VertexRange &block) {
  const auto from = [&](Index v) {
    const auto at = std::partition_point(
        mesh.cells.begin(), mesh.cells.end(), [&](const Cell<2> &cell) {
          return *std::min_element(cell.begin(), cell.end()) < v;
        });
    return static_cast<std::size_t>(at - mesh.cells.begin());
  };
  return {from(block.first), from(block.last)};
}

/// Area of the block's own cells in their metric.
double metric_area(const Triangulation<2> &mesh, const CellRange &cells,
                   const VertexRange &block) {
  double sum = 0;
  for (std::size_t c = cells.first; c < cells.last; ++c) {
    if (!block.contains(mesh.cells[c]))
      continue;
    const Simplex<2> s = mesh.simplex(static_cast<Index>(c));
    double weights = 1;
    for (Index v : mesh.cells[c])
      weights *= mesh.vertex(v).weight;
    sum += .5 * cross(s[1] - s[0], s[2] - s[0]) / elementary::cube_root(weights);
  }
  return sum;
}

/// Room for new vertices in each block, by its area in the metric.
std::vector<std::size_t> expected_growth(const Workspace &w, const Run &run,
                                         const Blocks &blocks,
                                         const std::vector<CellRange> &cells,
                                         double radius) {
  std::vector<std::size_t> n_new(blocks.size());
  parallel_items(blocks.size(), run.threads, [&] {
    return [&](std::size_t k) {
      const auto n = static_cast<double>(blocks[k].last - blocks[k].first);
      const double area = metric_area(w.mesh, cells[k], blocks[k]);
      n_new[k] = static_cast<std::size_t>(std::clamp(
          expected_vertices(area, radius) - n, least_growth * n, most_growth * n));
    };
  });
  return n_new;
}

/// One level: blocks side by side. @returns false when the monitor has no room for it
/// or stopped it.
bool refine_blocks(Workspace &w, const Run &run, double radius, RefineCounts &counts) {
  Triangulation<2> &mesh = w.mesh;
  const Blocks blocks(mesh.vertices.size());
  std::vector<CellRange> cells;
  for (std::size_t k = 0; k < blocks.size(); ++k)
    cells.push_back(cells_of(mesh, blocks[k]));
  const std::vector<std::size_t> n_new = expected_growth(w, run, blocks, cells, radius);
  if (!run.monitor.has_room(mesh.vertices.size() + std::accumulate(n_new.begin(),
                                                                   n_new.end(),
                                                                   std::size_t{0})))
    return false;
  std::vector<Slots> slots;
  for (std::size_t n : n_new)
    slots.push_back(mesh.make_slots(n));

  StopSignal stop(!run.monitor.look(0));
  std::mutex counting;
  parallel_items(blocks.size(), run.threads, [&] {
    return [&, own = std::make_unique<Legaliser>(mesh),
            refinement = std::unique_ptr<Refinement>()](std::size_t k) mutable {
      if (!refinement)
        refinement = std::make_unique<Refinement>(w, *own);
      if (!stop.goes_on([&] { return run.monitor.look(0); }))
        return;
      VertexRange range = blocks[k];
      range.first_new = slots[k].vertex;
      range.last_new = slots[k].last_vertex;
      refinement->clear();
      refinement->restrict_to(range, &slots[k], radius);
      refinement->push(cells[k].first, cells[k].last);
      while (refinement->step()) {
      }
      const std::lock_guard lock(counting);
      w.legaliser.take_counts(*own);
      counts += refinement->take_counts();
    };
  });
  return !stop.is_stopped();
}

} // namespace

RefineCounts refine(Workspace &w, const Run &run) {
  Refinement refinement(w, w.legaliser);
  RefineCounts counts;
  const auto enough = w.mesh.vertices.size() + vertices_for_blocks;
  refinement.push(0, w.mesh.cells.size());
  bool is_left = true;
  const auto run_until = [&](std::size_t n_vertices) {
    while (w.mesh.vertices.size() < n_vertices && is_left &&
           run.monitor.keep_going(w.mesh.vertices.size(), 0))
      is_left = refinement.step();
  };
  run_until(enough);
  if (is_left && refinement.level() > worth_levels) {
    double radius = refinement.level();
    bool going = true;
    for (int stage = 0, at_target = 0; going && at_target < levels_at_target; ++stage) {
      renumber(w, run.threads, stage % 2 == 0 ? shift_of_blocks : 0);
      radius = std::max(largest_radius, .5 * radius);
      at_target += radius == largest_radius;
      going = refine_blocks(w, run, radius, counts);
    }
    renumber(w, run.threads);
    refinement.clear();
    refinement.push(0, w.mesh.cells.size());
  }
  run_until(std::numeric_limits<std::size_t>::max());
  counts += refinement.take_counts();
  return counts;
}

} // namespace anistar
