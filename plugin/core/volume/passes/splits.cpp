#include "base/parallel.h"
#include "volume/passes/edge_split.h"
#include "volume/passes/passes.h"

namespace anistar {
namespace {

/// The six edges of a cell.
constexpr std::size_t cell_edges[6][2] = {{0, 1}, {0, 2}, {0, 3},
                                          {1, 2}, {1, 3}, {2, 3}};

/// Edges beyond this length are split even when the new vertex comes nearer to others
/// than the rule says.
constexpr double very_long = 3, relaxed = .4;

/// Splits for the sake of a curved feature may make cells of any quality, this or this
/// share of the old one: other passes improve them.
constexpr double curved_floor = 1e-4, curved_share = .1;

struct LongEdge {
  Index a, b; ///< none: no edge is longer
  double length;
};

/// The longest edge of a cell that is longer than a bound.
LongEdge longest_edge(const Triangulation<3> &mesh, Index c, double above) {
  LongEdge found{none, none, above};
  for (const auto &[i, j] : cell_edges) {
    const Index u = mesh.at(c)[i], w = mesh.at(c)[j];
    const Vertex<3> &p = mesh.vertex(u), &q = mesh.vertex(w);
    const Vector<3> e = q.x - p.x;
    const double square = found.length * found.length;
    // a mean is not above both
    if (quadratic<3>(p.M, e) <= square && quadratic<3>(q.M, e) <= square)
      continue;
    const double l = fast_length(p, q);
    if (l > found.length)
      found = {u, w, l};
  }
  return found;
}

class Splits {
public:
  Splits(Volume &volume, const Run &run)
      : volume_(volume), mesh_(volume.mesh), run_(run), operator_(volume),
        edge_(volume, operator_, run) {}

  std::size_t split(const SplitRule &rule, std::uint32_t since) {
    const std::vector<std::uint8_t> due = due_cells(rule.longest, since);
    const std::size_t n = due.size();
    std::size_t done = 0;
    for (std::size_t k = 0; k < n && run_.goes_on(k, n); ++k) {
      const auto c = static_cast<Index>(k);
      const bool is_new = volume_.cell_clock[k] == volume_.clock; // made by this pass
      if ((due[k] == 0 && !is_new) || !mesh_.is_alive(c))
        continue;
      if (const LongEdge edge = longest_edge(mesh_, c, rule.longest); edge.a != none)
        done += split_long(c, edge, rule);
      else
        done += volume_.is_walled(c) && split_curved(c);
    }
    return done;
  }

  std::size_t follow_surfaces() {
    const std::size_t n = mesh_.cells.size();
    std::size_t done = 0;
    for (std::size_t k = 0; k < n && run_.goes_on(k, n); ++k) {
      const auto c = static_cast<Index>(k);
      done += mesh_.is_alive(c) && volume_.is_walled(c) && split_curved(c);
    }
    return done;
  }

  [[nodiscard]] bool is_full() const { return edge_.is_full(); }

private:
  Volume &volume_;
  const Triangulation<3> &mesh_;
  const Run &run_;
  CavityOperator operator_;
  EdgeSplit edge_;

  /// Whether a cell that changed since then may have something to split.
  [[nodiscard]] std::vector<std::uint8_t> due_cells(double above,
                                                    std::uint32_t since) const {
    std::vector<std::uint8_t> due(mesh_.cells.size(), 0);
    parallel_ranges(due.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const auto c = static_cast<Index>(k);
        due[k] = mesh_.is_alive(c) && volume_.cell_clock[k] >= since &&
                 (volume_.is_walled(c) || longest_edge(mesh_, c, above).a != none);
      }
    });
    return due;
  }

  [[nodiscard]] bool split_long(Index c, const LongEdge &edge, const SplitRule &rule) {
    const double closest =
        edge.length > very_long ? relaxed * rule.closest : rule.closest;
    return edge_.split(c, edge.a, edge.b, {.closest = closest},
                       {.floor = rule.floor, .share = rule.share});
  }

  /// Splits the longest edge of a cell that strays from the curved feature it lies on.
  [[nodiscard]] bool split_curved(Index c) {
    Index a = none, b = none;
    double longest = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Index patch = mesh_.constraint(HalfFacet(c, i));
      if (patch == none)
        continue;
      const Facet<3> t = facet_of<3>(mesh_.at(c), i);
      for (std::size_t k = 0; k < 3; ++k) {
        const Index u = t[k], w = t[(k + 1) % 3];
        const double square = (mesh_.vertex(w).x - mesh_.vertex(u).x).squaredNorm();
        if (square <= longest || !strays(u, w, patch))
          continue;
        longest = square;
        a = u;
        b = w;
      }
    }
    return a != none && edge_.split(c, a, b, {.follows_curve = true},
                                    {.floor = curved_floor, .share = curved_share});
  }

  /// Whether an edge of a surface is off its ridge, or of its patch where it is none.
  [[nodiscard]] bool strays(Index u, Index w, Index patch) const {
    const Vertex<3> &p = mesh_.vertex(u), &q = mesh_.vertex(w);
    const Index ridge = volume_.feature(u) <= 1 && volume_.feature(w) <= 1
                            ? volume_.ridges.find(u, w)
                            : none;
    return ridge != none
               ? volume_.surface.strays(1, volume_.ridges.at(ridge).curve, p, q,
                                        run_.hausdorff.curve)
               : volume_.surface.strays(2, patch, p, q, run_.hausdorff.surface);
  }
};

void note(PassLog &log, const Splits &splits, std::size_t done) {
  log.counts.splits += done;
  log.is_full = log.is_full || splits.is_full();
}

} // namespace

std::size_t split(Volume &volume, const Run &run, PassLog &log, const SplitRule &rule) {
  Splits splits(volume, run);
  const std::size_t done = splits.split(rule, log.begin(Pass::split, volume));
  note(log, splits, done);
  return done;
}

std::size_t follow_surfaces(Volume &volume, const Run &run, PassLog &log) {
  Splits splits(volume, run);
  const std::size_t done = splits.follow_surfaces();
  note(log, splits, done);
  return done;
}

double longest_edge(const Volume &volume) {
  double longest = 0;
  for (std::size_t c = 0; c < volume.mesh.cells.size(); ++c)
    if (volume.mesh.is_alive(static_cast<Index>(c)))
      longest = longest_edge(volume.mesh, static_cast<Index>(c), longest).length;
  return longest;
}

} // namespace anistar
