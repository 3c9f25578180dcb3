#pragma once
// The rules of the slides, by their names: refine-edge, conditionally-refine-facet and
// conditionally-refine-tet, with the rules that Terminator 3D adds at small angles and,
// in the second phase, picks that avoid small slivers.

#include "generate/refinement/mesh/cavity.h"
#include "generate/refinement/mesh/facet_walk.h"
#include "generate/refinement/mesh/size_field.h"
#include "generate/refinement/mesh/spheres.h"
#include "generate/refinement/refinement.h"
#include "generate/refinement/rules/clusters.h"
#include "generate/refinement/rules/queues.h"
#include "generate/refinement/slivers/picks.h"

#include <map>
#include <optional>
#include <vector>

namespace anistar::generate {

/// What a rule has come to.
enum class Outcome {
  inserted,  ///< the point that it is about
  elsewhere, ///< one on a face that this point encroaches upon
  refused,
};

/// Why a point v is wanted: what Terminator's rules ask about its ancestors.
struct Cause {
  double r_g; ///< insertion radius of the most recently inserted ancestor
  double r_rejected =
      0; ///< that of the rejected point p that is the parent; 0: a vertex
  bool needs_no_longer =
      false; ///< a size is wanted or a sliver must go: no test by r_g
  bool frees_facet =
      false; ///< p is a vertex of the complex or on a face disjoint from F
  bool must_improve = false; ///< a sliver: only for better dihedral angles
  bool is_in_wedge = false;  ///< between acute facets: slivers of any size are avoided
};

class Rules {
public:
  Rules(const Tetrahedralisation &input, const Sizes &sizes,
        const RefinementSettings &settings);

  /// Queues everything.
  void queue_all();
  /// Queues the slivers; from now on picks avoid small ones and the floor is l_2.
  void begin_sliver_elimination();

  /// Rules 1 to 4: each takes one from its queue and says whether there was one.
  bool apply_rule_1();
  bool apply_rule_2();
  bool apply_rule_3();
  bool apply_rule_4();

  Outcome refine_edge(const Segment &e, const Cause &cause);
  Outcome conditionally_refine_facet(HalfFacet f, const Cause &cause);
  Outcome conditionally_refine_tet(Index t);

  [[nodiscard]] const WalledMesh &mesh() const { return mesh_; }
  [[nodiscard]] std::size_t n_waiting() const { return queues_.size(); }
  [[nodiscard]] RefinementRecord &record() { return record_; }
  /// Measures what is left and why.
  void finish_record();

private:
  /// What rule 3 looks at.
  struct CellShape {
    Ball ball; ///< (c, r_t)
    double shortest;
    Segment shortest_edge; ///< its ends, the last inserted one second
    [[nodiscard]] double ratio() const { return ball.radius / shortest; }
  };
  /// The best site in a refinement region so far.
  struct BestPick {
    std::optional<Site> site;
    double cosine = 2;
  };

  RefinementSettings settings_;
  WalledMesh mesh_;
  PlcFaces faces_;
  Clusters clusters_;
  SizeField size_;
  Queues queues_;
  Cavity cavity_;
  RefinementRecord record_;
  PickRule pick_rule_;
  PickRule wedge_pick_rule_{}; ///< on facets, for slivers between acute ones
  double floor_;               ///< no shorter edge is made
  Insertions *insertions_;
  bool eliminates_slivers_ = false;
  std::int32_t n_regions_ = 0; ///< refinement regions so far
  std::vector<WaitingEdge> put_off_;
  std::size_t edges_at_last_try_ = 0;
  std::map<Segment, std::size_t> blocked_at_; ///< number of points at the failure
  std::vector<Segment> edges_;
  std::vector<Index> fan_;

  // encroachment.cpp
  [[nodiscard]] bool exists(const Segment &e);
  [[nodiscard]] bool is_encroached(const Segment &e);
  [[nodiscard]] bool is_long(const Segment &e) const;
  [[nodiscard]] Ball diametral_ball_of(HalfFacet f) const;
  [[nodiscard]] bool is_encroached_by(HalfFacet f, Index v) const;
  [[nodiscard]] Index encroaching_apex(HalfFacet f) const;
  [[nodiscard]] bool is_large(HalfFacet f) const;
  [[nodiscard]] CellShape shape_of(Index t) const;
  [[nodiscard]] bool is_large(const CellShape &shape) const;
  void consider_walls(Index c);
  void consider_cell(Index c);

  // rules.cpp
  Outcome refuse(Refusal refusal) {
    ++record_.of(refusal);
    return Outcome::refused;
  }
  bool try_put_off_edges();
  [[nodiscard]] bool is_blocked(const Segment &e) const;
  [[nodiscard]] bool takes(const Site &site, double r_tau, BestPick &best);
  Outcome insert(const Site &site);
  Outcome insert_best(const BestPick &best, const Cause &cause, Refusal otherwise);
  [[nodiscard]] Site edge_site(const Segment &e, double fraction);
  [[nodiscard]] Site facet_site(HalfFacet f, const Vector<3> &x) const;
  Outcome refine_encroached_edges(const Cause &cause);
  Outcome refine_encroached_facets(std::span<const HalfFacet> facets,
                                   const Vector<3> &p, const Cause &cause);
  [[nodiscard]] HalfFacet facet_below(HalfFacet f, const Vector<3> &p) const;
  [[nodiscard]] std::optional<Refusal> acute_refusal(Index t,
                                                     const CellShape &shape) const;
  void find_encroached_edges(const Vector<3> &p);
  [[nodiscard]] std::vector<HalfFacet> encroached_facets(const Vector<3> &p) const;

  // sliver_elimination.cpp
  [[nodiscard]] double small_sliver_cosine(const Site &site, double r_tau) const;
  [[nodiscard]] double cavity_cosine() const;
  [[nodiscard]] bool is_sliver(Index t) const;
  [[nodiscard]] bool is_flatter_than_its_wedge(Index t) const;
};

} // namespace anistar::generate
