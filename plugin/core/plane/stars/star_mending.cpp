#include "plane/stars/star_mending.h"

#include "base/ellipse_sampler.h"
#include "plane/mesh/vertex_trial.h"
#include "plane/stars/star_mender.h"

namespace anistar {
namespace {

constexpr int n_places = 16;

/// What StarMender needs of a mesh of triangles.
class TrialPlaces {
public:
  explicit TrialPlaces(Workspace &w) : mesh_(w.mesh), trial_(w) {}

  [[nodiscard]] std::vector<Index> star(Index v) {
    trial_.gather(v);
    std::vector<Index> cells;
    for (HalfFacet h : trial_.star())
      cells.push_back(h.cell());
    return cells;
  }
  template <class Accept>
  bool relocate_where(Index v, double radius, CounterRandom &random, Accept accept) {
    if (mesh_.feature[v] != Triangulation<2>::interior)
      return false;
    trial_.gather(v);
    const Vertex<2> &from = trial_.from().vertex;
    const StarScore before = trial_.score();
    const EllipseSampler ellipse(from.M);
    for (int k = 0; k < n_places; ++k) {
      const Vector<2> x = from.x + ellipse.step(radius * (k + 1) / n_places, random);
      if (!trial_.may_move_to(x))
        continue;
      trial_.put(trial_.at(x));
      const StarScore found = trial_.score();
      if (found.keeps(before) && found.disagreeing <= before.disagreeing && accept())
        return true;
      trial_.put_back();
    }
    return false;
  }

private:
  const Triangulation<2> &mesh_;
  PlaneTrial trial_;
};

} // namespace

std::size_t mend_stars(Workspace &w, const Run &run, DelaunayBits &known) {
  TrialPlaces places(w);
  return mend_failures(w.mesh, places, run, known);
}

} // namespace anistar
