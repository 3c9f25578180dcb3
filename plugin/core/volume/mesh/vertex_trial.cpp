#include "volume/mesh/vertex_trial.h"

#include "volume/mesh/vertex_star.h"

namespace anistar {

Vector<3> in_space(const Matrix<3> &L, const Vector<3> &y) {
  Vector<3> x;
  x[2] = y[2] / L(2, 2);
  x[1] = (y[1] - L(2, 1) * x[2]) / L(1, 1);
  x[0] = (y[0] - L(1, 0) * x[1] - L(2, 0) * x[2]) / L(0, 0);
  return x;
}

Vector<3> random_in_ball(CounterRandom &random) {
  constexpr int max_draws = 64; // every second point of the cube is in the ball
  for (int k = 0; k < max_draws; ++k) {
    Vector<3> y;
    for (int i = 0; i < 3; ++i)
      y[i] = 2 * random.uniform() - 1;
    if (y.squaredNorm() <= 1)
      return y;
  }
  return Vector<3>::Zero();
}

bool VertexTrial::gather(Index v, std::span<const Index> star) {
  if (star.size() > StarShapes::capacity)
    return false;
  const Triangulation<3> &mesh = volume_.mesh;
  v_ = v;
  star_ = star;
  at_ = mesh.vertex(v);
  least_before_ = 1;
  sum_before_ = 0;
  shapes_.clear();
  for (Index c : star) {
    const Facet<3> t = facet_of<3>(mesh.at(c), mesh.local_index(c, v));
    shapes_.add(mesh.vertex(t[0]), mesh.vertex(t[1]), mesh.vertex(t[2]));
    const double q = volume_.quality_of(c);
    least_before_ = std::min(least_before_, q);
    sum_before_ += q;
  }
  return true;
}

void VertexTrial::place(const Vector<3> &x) {
  const Index dimension = volume_.feature(v_), lies_on = volume_.support_of(v_);
  if (dimension == 2 && is_in_range<3>(x)) {
    const SurfaceFoot foot = volume_.surface.foot(lies_on, x);
    at_.x = foot.x;
    normal_ = foot.normal;
  } else {
    at_.x = volume_.surface.place(dimension, lies_on, x);
    normal_ = Vector<3>::Zero();
  }
}

bool VertexTrial::keeps_surfaces() const {
  return volume_.feature(v_) == Triangulation<3>::interior ||
         anistar::keeps_surfaces(volume_, star_, v_, at_.x, hausdorff_number_);
}

void VertexTrial::take_metric() {
  background_cell_ = volume_.mesh.background_cell[v_];
  at_ = volume_.background.vertex(at_.x, background_cell_);
}

const StarShapes &VertexTrial::measure() {
  shapes_.evaluate(at_);
  return shapes_;
}

const StarShapes &VertexTrial::measure_at(const Vector<3> &x) {
  shapes_.evaluate({x, at_.M, at_.weight});
  return shapes_;
}

void VertexTrial::remember(TriedPlace &place) const {
  place.vertex = at_;
  place.background_cell = background_cell_;
  place.qualities.clear();
  for (std::size_t k = 0; k < star_.size(); ++k)
    place.qualities.push_back(shapes_.quality(k));
}

void VertexTrial::commit() {
  volume_.mesh.vertex(v_) = at_;
  volume_.mesh.background_cell[v_] = background_cell_;
  for (std::size_t k = 0; k < star_.size(); ++k) {
    volume_.quality[star_[k]] = shapes_.quality(k);
    volume_.touch(star_[k]);
  }
}

void VertexTrial::commit(const TriedPlace &place) {
  volume_.mesh.vertex(v_) = place.vertex;
  volume_.mesh.background_cell[v_] = place.background_cell;
  for (std::size_t k = 0; k < star_.size(); ++k) {
    volume_.quality[star_[k]] = place.qualities[k];
    volume_.touch(star_[k]);
  }
}

} // namespace anistar
