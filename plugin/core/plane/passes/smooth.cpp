#include "plane/passes/smooth.h"

#include "mesh/blocks.h"
#include "plane/mesh/displacements.h"
#include "plane/mesh/sliding_vertex.h"
#include "plane/mesh/vertex_trial.h"

#include <cmath>
#include <memory>

namespace anistar {
namespace {

/// Longest move in the vertex's own metric.
constexpr double longest_move = .3;
/// And the longest one on a curve, as a part of the parameters up to the next vertex.
constexpr double longest_slide = .4;
constexpr int max_halvings = 4;
constexpr int flip_cap = 40;

class Smoother {
public:
  Smoother(Workspace &w, Legaliser &legaliser, Target target)
      : w_(w), legaliser_(legaliser), target_(target), trial_(w) {}

  /// @returns false, without a change, when the star of v leaves the range.
  bool visit(Index v, const VertexRange &range) {
    Triangulation<2> &mesh = w_.mesh;
    const Index feature = mesh.feature[v];
    if (feature == Triangulation<2>::corner)
      return true;
    if (feature == 1 && !range.is_unbounded())
      return false; // it might run into another part of the boundary
    trial_.gather(v);
    const std::vector<HalfFacet> &star = trial_.star();
    for (HalfFacet h : star)
      if (!range.contains(mesh.at(h.cell())))
        return false;
    const Vertex<2> &vertex = trial_.from().vertex;
    Vector<2> step = Vector<2>::Zero();
    if (feature != 1)
      step = target_ == Target::odt ? odt_displacement(mesh, vertex, star)
                                    : pliant_displacement(mesh, vertex, star);
    const double length = std::sqrt(quadratic<2>(vertex.M, step));
    if (length > longest_move)
      step *= longest_move / length;
    const bool moved = feature == 1 ? slide(v) : move(step);
    if (moved && (range.is_unbounded() || target_ == Target::odt))
      legaliser_.push_star(v);
    else
      legaliser_.push_finished(v, star);
    legaliser_.run(flip_cap);
    return true;
  }

private:
  Workspace &w_;
  Legaliser &legaliser_;
  Target target_;
  PlaneTrial trial_;

  bool move(Vector<2> step) {
    const Vector<2> &from = trial_.from().vertex.x;
    for (int halving = 0; halving < max_halvings; ++halving, step *= .5)
      if (trial_.may_move_to(from + step)) {
        trial_.put(trial_.at(from + step));
        return true;
      }
    return false;
  }

  /// Moves v along its curve to equal lengths on both sides, were the metric constant.
  /// Only edges of the curve pull: the others would drive it off its spacing.
  bool slide(Index v) {
    const SlidingVertex on(w_, trial_.star(), v);
    if (!on.can_slide())
      return false;
    const Vertex<2> &here = trial_.from().vertex;
    const double before = edge_length(w_.mesh.vertex(on.in().v0), here);
    const double after = edge_length(here, w_.mesh.vertex(on.out().v1));
    const double shift = .5 * (after - before);
    double dt =
        shift > 0 ? shift / after * on.room_after() : shift / before * on.room_before();
    dt = std::clamp(dt, -longest_slide * on.room_before(),
                    longest_slide * on.room_after());
    for (int halving = 0; halving < max_halvings && dt != 0; ++halving, dt *= .5)
      if (on.may_slide(dt) && trial_.may_move_to(on.at(dt))) {
        trial_.put(trial_.at(on.at(dt)));
        on.commit(dt);
        return true;
      }
    return false;
  }
};

/// A smoother of its own for each thread.
class BlockSmoother {
public:
  BlockSmoother(Workspace &w, Target target)
      : total_(w.legaliser), own_(std::make_unique<Legaliser>(w.mesh)),
        smoother_(w, *own_, target) {}

  bool visit(Index v, const VertexRange &range) {
    own_->restrict_to(range);
    return smoother_.visit(v, range);
  }
  void leave(std::size_t) { total_.take_counts(*own_); }

private:
  Legaliser &total_;
  std::unique_ptr<Legaliser> own_;
  Smoother smoother_;
};

} // namespace

void smooth(Workspace &w, const Run &run, Target target) {
  std::vector<Index> vertices;
  for (std::size_t v = 0; v < w.mesh.vertices.size(); ++v)
    if (w.mesh.is_used(static_cast<Index>(v)))
      vertices.push_back(static_cast<Index>(v));
  Smoother last(w, w.legaliser, target);
  visit_in_blocks(
      Blocks(w.mesh.vertices.size()), vertices, run.threads, run.monitor, 0,
      [&] { return BlockSmoother(w, target); }, last);
}

} // namespace anistar
