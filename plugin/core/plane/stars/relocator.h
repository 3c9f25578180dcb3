#pragma once
// What agreement does at one vertex: it is moved to the best of some trial places.

#include "base/run.h"
#include "plane/mesh/flips.h"
#include "plane/mesh/protecting_ball.h"
#include "plane/mesh/vertex_trial.h"
#include "stars/agreement.h"

#include <optional>
#include <utility>

namespace anistar {

/// Passes over the vertices at disagreeing edges; the radius of the trial places grows
/// from one to the next.
inline constexpr int max_agreement_passes = 10;

/// Moves vertices of a range of the mesh, one after another; an object to a thread.
class Relocator {
public:
  using Edges = PlaneTrial::Edges;

  Relocator(Workspace &w, Legaliser &legaliser, Seed seed)
      : w_(w), mesh_(w.mesh), legaliser_(legaliser), seed_(seed), trial_(w) {
    heed(Edges::inner);
  }

  /// Which edges are to agree.
  void heed(Edges edges) {
    edges_ = edges;
    trial_.count(edges);
  }

  /// The three ways to move v. Each @returns false, without a change, when that would
  /// touch or ask anything outside of the range.
  bool relocate(Index v, int pass, const VertexRange &range);
  /// A random move that does not raise the count, when no other is found.
  bool wander(Index v, int round, const VertexRange &range);
  /// A move that brings edges nearer to one and causes no new disagreement.
  bool polish(Index v, int sweep, const VertexRange &range);

  /// The vertices at disagreeing edges that were met, some of them more than once.
  [[nodiscard]] std::vector<Index> take_listed() { return std::exchange(listed_, {}); }
  [[nodiscard]] AgreementCounts take_counts() { return std::exchange(counts_, {}); }

private:
  Workspace &w_;
  Triangulation<2> &mesh_;
  Legaliser &legaliser_;
  Seed seed_;
  PlaneTrial trial_;
  Edges edges_{};
  std::optional<ProtectingBall> ball_; ///< once a vertex on a shell is met
  VertexRange range_;
  AgreementCounts counts_;
  std::vector<Index> changed_, listed_;

  bool enter(Index v, const VertexRange &range);
  bool move(Index v, double radius, int pass);
  bool move_freely(Index v, double radius, CounterRandom &random);
  bool move_on_curve(Index v, CounterRandom &random, int least_drop);
  bool resize_ball(Index v, CounterRandom &random, int least_drop);
  void move_randomly(Index v, int round);
  std::pair<Place, StarScore> try_at(const Vector<2> &x);
  void settle(Index v);
  void list_around(Index v);
  void list_if_disagreeing(HalfFacet edge);
};

/// Calls list(v) for the vertices of the cells at an edge.
template <class List>
void for_quad(const Triangulation<2> &mesh, HalfFacet edge, List list) {
  const auto [a, b] = mesh.facet(edge);
  for (Index v : {a, b, mesh.apex(edge)})
    list(v);
  if (const HalfFacet other = mesh.opposite(edge); other.exists())
    list(mesh.apex(other));
}

} // namespace anistar
