#pragma once
// Moves of one vertex of a volume mesh that make the metrics around it agree.

#include "volume/mesh/vertex_trial.h"
#include "volume/stars/facet_margins.h"

#include <functional>
#include <optional>

namespace anistar {

/// The mesh with what agreement knows of it.
struct AgreementState {
  explicit AgreementState(Volume &v, double hausdorff)
      : volume(v), margins(v.mesh), hausdorff_number(hausdorff) {}

  Volume &volume;
  FacetMargins margins;
  double hausdorff_number;
  std::vector<Index> changed; ///< cells, some of them more than once
};

/// The quality below which nothing may fall that was not below before.
inline constexpr double agreement_floor = .5;

/// Moves vertices to the best of some trial places. Moves on surfaces and ridges slide
/// along them.
class VolumeRelocation {
public:
  explicit VolumeRelocation(AgreementState &state)
      : state_(state), volume_(state.volume), trial_(volume_, state.hausdorff_number) {}

  /// The cells of the star of v.
  [[nodiscard]] std::span<const Index> star(Index v) {
    star_of(volume_, v, star_);
    return star_;
  }
  /// Random places within this metric distance; @returns whether one is better by
  /// AgreementCost and lengths.
  bool relocate(Index v, double radius, CounterRandom &random);
  /// A random place where no more than one more facet fails, to leave a local minimum.
  bool wander(Index v, double radius, CounterRandom &random);
  /// Random places ever further off, up to this metric distance, where no more facets
  /// fail and no length is worse. @returns whether the caller accepted one of them, who
  /// is asked when v is there already.
  bool relocate_where(Index v, double radius, CounterRandom &random,
                      const std::function<bool()> &accept);
  /// A step towards better shapes at which no more facets fail, and not by more.
  bool polish(Index v);

  [[nodiscard]] std::size_t trials() const { return trials_; }

private:
  struct TestedFacet {
    HalfFacet at;
    FacetStar star; ///< with the trial vertex in the place of v
  };
  struct Score {
    AgreementCost cost;
    double lengths = 0; ///< the penalty for edges that are far from unit
    double quality_min = 1, quality_sum = 0;
    [[nodiscard]] double total() const { return cost.total() + lengths; }
  };
  /// A place with the margins of the facets there.
  struct Tried {
    TriedPlace place;
    std::vector<float> margins;
  };

  AgreementState &state_;
  Volume &volume_;
  VertexTrial trial_;
  Index v_ = none; ///< whose star was gathered
  std::vector<Index> star_;
  std::vector<Index> ring_; ///< the vertices that v has edges with
  std::vector<TestedFacet> facets_;
  std::vector<float> margins_; ///< at the place that is tried
  Tried best_;
  std::size_t trials_ = 0;

  [[nodiscard]] bool gather_star(Index v);
  void gather_around();
  [[nodiscard]] bool gather(Index v);
  void gather_facets(Index c, std::size_t at);
  [[nodiscard]] Score score_here();
  [[nodiscard]] Tried here();
  [[nodiscard]] bool place(const Vector<3> &x);
  [[nodiscard]] std::optional<Score> evaluate(double floor, double limit);
  [[nodiscard]] bool disagrees_no_more(const Score &before);
  [[nodiscard]] double length_penalty(const Vertex<3> &at) const;
  template <class Step, class Visit>
  bool try_places(int n, double floor, Step step, Visit visit);
  void remember();
  void commit(const Tried &tried);
  void move_here();
};

} // namespace anistar
