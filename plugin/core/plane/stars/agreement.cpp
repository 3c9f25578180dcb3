#include "plane/stars/agreement.h"

#include <algorithm>
#include <memory>

namespace anistar {
namespace {

/// The walk on the plateau: only while this fraction of the edges disagrees, because it
/// would ruin the mesh on hopeless metrics, or this number, for small meshes.
constexpr double plateau_fraction = .002;
constexpr int always_few = 10;
constexpr int max_plateau_rounds = 60;
constexpr double edges_per_cell = 1.5;
/// Now and then the neighbours of the vertices are moved as well.
constexpr int rounds_between_rings = 3;
constexpr int max_polish_sweeps = 4;

/// Vertices to visit, each once, in the order in which they came.
class Worklist {
public:
  explicit Worklist(std::size_t n_vertices) : is_in_(n_vertices, false) {}

  void add(Index v) {
    if (!is_in_[v]) {
      is_in_[v] = true;
      items_.push_back(v);
    }
  }
  [[nodiscard]] std::vector<Index> take() {
    for (Index v : items_)
      is_in_[v] = false;
    return std::exchange(items_, {});
  }
  [[nodiscard]] std::size_t size() const { return items_.size(); }

private:
  std::vector<Index> items_;
  std::vector<bool> is_in_;
};

/// A relocator of its own for each thread; what it lists is kept by block.
template <class Move> class BlockRelocator {
public:
  BlockRelocator(Workspace &w, Legaliser &legaliser, Seed seed, Move move,
                 AgreementCounts &counts, std::vector<std::vector<Index>> &listed)
      : total_(legaliser), counts_(counts), listed_(listed),
        own_(std::make_unique<Legaliser>(w.mesh)), relocator_(w, *own_, seed),
        move_(move) {}

  void heed(Relocator::Edges edges) { relocator_.heed(edges); }
  bool visit(Index v, const VertexRange &range) { return move_(relocator_, v, range); }
  void leave(std::size_t block) {
    total_.take_counts(*own_);
    counts_ += relocator_.take_counts();
    listed_[block] = relocator_.take_listed();
  }

private:
  Legaliser &total_;
  AgreementCounts &counts_;
  std::vector<std::vector<Index>> &listed_;
  std::unique_ptr<Legaliser> own_;
  Relocator relocator_;
  Move move_;
};

class Agreement {
public:
  Agreement(Workspace &w, const Run &run)
      : w_(w), mesh_(w.mesh), run_(run), blocks_(mesh_.vertices.size()),
        relocator_(w, w.legaliser, run.seed), work_(mesh_.vertices.size()) {}

  AgreementCounts run() {
    scan();
    if (relocate() && walk_on_plateau() && relocate_at_curves())
      polish();
    count_left();
    return counts_;
  }

private:
  Workspace &w_;
  Triangulation<2> &mesh_;
  const Run &run_;
  Blocks blocks_;
  AgreementCounts counts_;
  Relocator relocator_; ///< for what concerns more than one block
  Relocator::Edges edges_ = Relocator::Edges::inner;
  Worklist work_;

  /// Moves vertices in blocks and adds to the worklist what they list.
  template <class Move>
  bool visit(const std::vector<Index> &vertices, double fraction, Move move) {
    std::vector<std::vector<Index>> listed(blocks_.size() + 1);
    struct Last {
      Relocator &relocator;
      Move move;
      bool visit(Index v, const VertexRange &range) {
        return move(relocator, v, range);
      }
    } last{relocator_, move};
    const bool going = visit_in_blocks(
        blocks_, vertices, run_.threads, run_.monitor, fraction,
        [&] {
          BlockRelocator made(w_, w_.legaliser, run_.seed, move, counts_, listed);
          made.heed(edges_);
          return made;
        },
        last);
    counts_ += relocator_.take_counts();
    listed.back() = relocator_.take_listed();
    for (const std::vector<Index> &of_block : listed)
      for (Index v : of_block)
        work_.add(v);
    if (!going) // some of them were not visited
      for (Index v : vertices)
        work_.add(v);
    return going;
  }

  bool relocate() {
    bool going = true;
    for (int pass = 0; going && pass < max_agreement_passes && work_.size() > 0; ++pass)
      going = visit(work_.take(), double(pass) / max_agreement_passes,
                    [pass](Relocator &relocator, Index v, const VertexRange &range) {
                      return relocator.relocate(v, pass, range);
                    });
    return going;
  }

  /// Edges of curves come last: few disagree when all others agree, and some between
  /// the legs of sharp corners cannot agree, for which nothing is to drift.
  bool relocate_at_curves() {
    edges_ = Relocator::Edges::all;
    relocator_.heed(edges_);
    for (HalfFacet edge : disagreeing_edges())
      if (mesh_.constraint(edge) != none)
        for_quad(mesh_, edge, [&](Index v) { work_.add(v); });
    return relocate();
  }

  /// The one search for disagreeing edges.
  void scan() {
    const std::vector<HalfFacet> edges = disagreeing_edges();
    counts_.before = edges.size();
    for (HalfFacet edge : edges)
      if (mesh_.constraint(edge) == none)
        for_quad(mesh_, edge, [&](Index v) { work_.add(v); });
  }

  [[nodiscard]] std::vector<HalfFacet> disagreeing_edges() const {
    return parallel_search<HalfFacet>(
        mesh_.cells.size(), run_.threads, [&](std::size_t c, const auto &add) {
          for (std::size_t i = 0; i < 3; ++i) {
            const HalfFacet edge(static_cast<Index>(c), i),
                other = mesh_.opposite(edge);
            if (mesh_.is_alive(edge.cell()) &&
                (!other.exists() || other.cell() > edge.cell()) &&
                disagrees(mesh_, edge))
              add(edge);
          }
        });
  }

  /// Random moves that do not raise the count, to leave local minima.
  bool walk_on_plateau() {
    // four vertices are listed for an edge
    const double few = 4 * std::max(static_cast<double>(always_few),
                                    plateau_fraction * edges_per_cell *
                                        static_cast<double>(mesh_.n_cells()));
    bool going = true;
    for (int round = 0; going && round < max_plateau_rounds; ++round) {
      if (work_.size() == 0 || static_cast<double>(work_.size()) > few)
        break;
      std::vector<Index> vertices = work_.take();
      if (round % rounds_between_rings == rounds_between_rings - 1)
        vertices = with_rings(vertices);
      going = visit(vertices, double(round) / max_plateau_rounds,
                    [round](Relocator &relocator, Index v, const VertexRange &range) {
                      return relocator.wander(v, round, range);
                    });
    }
    return going;
  }

  [[nodiscard]] std::vector<Index> with_rings(const std::vector<Index> &vertices) {
    Worklist once(mesh_.vertices.size());
    std::vector<HalfFacet> star;
    for (Index v : vertices) {
      once.add(v);
      star_of(mesh_, v, star);
      for (HalfFacet h : star)
        for (Index u : mesh_.facet(h))
          once.add(u);
    }
    return once.take();
  }

  /// Takes back what agreement cost in lengths.
  void polish() {
    std::vector<Index> free;
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v)
      if (mesh_.feature[v] == Triangulation<2>::interior &&
          mesh_.is_used(static_cast<Index>(v)))
        free.push_back(static_cast<Index>(v));
    for (int sweep = 0; sweep < max_polish_sweeps; ++sweep) {
      const std::size_t before = counts_.moves;
      const bool going = visit(
          free, 1, [sweep](Relocator &relocator, Index v, const VertexRange &range) {
            return relocator.polish(v, sweep, range);
          });
      if (!going || counts_.moves == before)
        return;
    }
  }

  /// The disagreeing edges at the vertices that are still listed, each once, and those
  /// of curves.
  void count_left() {
    std::vector<std::pair<Index, std::size_t>> left;
    std::vector<HalfFacet> star;
    const auto count = [&](HalfFacet e) {
      if (!disagrees(mesh_, e))
        return;
      const HalfFacet other = mesh_.opposite(e);
      const HalfFacet first = other.exists() && other.cell() < e.cell() ? other : e;
      left.emplace_back(first.cell(), first.facet());
    };
    for (HalfFacet edge : disagreeing_edges())
      if (mesh_.constraint(edge) != none)
        count(edge);
    for (Index v : work_.take()) {
      star_of(mesh_, v, star);
      for (HalfFacet h : star) {
        count(h);
        count(HalfFacet(h.cell(), (h.facet() + 2) % 3));
      }
    }
    std::sort(left.begin(), left.end());
    counts_.after =
        static_cast<std::size_t>(std::unique(left.begin(), left.end()) - left.begin());
  }
};

} // namespace

AgreementCounts agree(Workspace &w, const Run &run) { return Agreement(w, run).run(); }

} // namespace anistar
