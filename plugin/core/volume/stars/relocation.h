#pragma once
// Moves of one vertex of a volume mesh that make the metrics around it agree.

#include "volume/mesh/vertex_trial.h"
#include "volume/stars/facet_margins.h"

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
      : state_(state), volume_(state.volume) {}

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
  template <class Accept>
  bool relocate_where(Index v, double radius, CounterRandom &random, Accept accept) {
    if (!gather(v))
      return false;
    const Score before = here();
    const Vertex<3> from = trial_;
    const Index from_cell = volume_.mesh.background_cell[v];
    const std::size_t n_changed = state_.changed.size();
    for (int k = 0; k < n_places; ++k) {
      Index at = from_cell;
      if (!try_near(from, radius * (k + 1) / n_places, before, random, at))
        continue;
      remember();
      commit(trial_, at);
      if (accept())
        return true;
      keep_trial();
      commit(from, from_cell);
      state_.changed.resize(n_changed);
    }
    return false;
  }
  /// A step towards better shapes at which no more facets fail, and not by more.
  bool polish(Index v);

  [[nodiscard]] std::size_t trials() const { return trials_; }

private:
  static constexpr int n_places = 16;

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

  AgreementState &state_;
  Volume &volume_;
  Index v_ = none;
  Vertex<3> trial_;
  std::vector<Index> star_;
  std::vector<Index> ring_; ///< the vertices that v has edges with
  std::vector<TestedFacet> facets_;
  std::vector<float> margins_, best_margins_, qualities_, best_qualities_;
  StarShapes shapes_;
  std::size_t trials_ = 0;

  [[nodiscard]] bool gather(Index v);
  void gather_facets(Index c, std::size_t at);
  [[nodiscard]] Score here();
  [[nodiscard]] bool place(const Vector<3> &x, Index &background_cell);
  [[nodiscard]] bool evaluate(double floor, double limit, Score &score);
  [[nodiscard]] double length_penalty() const;
  void keep_trial();
  void remember();
  [[nodiscard]] bool try_near(const Vertex<3> &from, double radius, const Score &before,
                              CounterRandom &random, Index &background_cell);
  void commit(const Vertex<3> &vertex, Index background_cell);
};

} // namespace anistar
