#include "certificate/star_test.h"

#include <algorithm>

namespace anistar {
namespace {

/// Every vertex is compared with all cells of a star; for more than this the walk of
/// the definition is cheaper.
constexpr std::size_t largest_star = 1024;
/// Whoever waits is asked after so many cells, some milliseconds.
constexpr std::size_t visits_between_looks = 1 << 16;
/// A gradient that is off by more than this part says little.
/// Its ball is left out, for it would blur the bound for all others.
constexpr double blurred = 1e-6;
/// A few round-offs of what is compared.
constexpr double slack = 32 * detail::round_off;

} // namespace

template <std::size_t d>
bool StarTest<d>::decide(Index v, std::span<const HalfFacet> star,
                         std::span<std::uint8_t> passes, const GoesOn &goes_on) {
  reach_ = 1; // to what lies across the facets of the star
  answers_.assign(star.size(), Answer::doubtful);
  if (star.size() <= largest_star) {
    enter_star(v, star);
    walk();
  }
  for (std::size_t place = 0; place < star.size(); ++place) {
    if (n_visits_ >= next_look_) {
      next_look_ = n_visits_ + visits_between_looks;
      if (!goes_on())
        return false;
    }
    if (answers_[place] == Answer::doubtful)
      answers_[place] = decide_alone(star[place].cell(), mesh_.vertices[v].M);
    passes[place] = answers_[place] == Answer::open;
  }
  return true;
}

template <std::size_t d>
typename StarTest<d>::Answer StarTest<d>::decide_alone(Index cell,
                                                       const SymmetricTensor<d> &M) {
  if (!exact_test_)
    exact_test_.emplace(mesh_);
  const Index found = exact_test_->violator(cell, M);
  n_visits_ += exact_test_->n_visits();
  reach_ = std::max(reach_, exact_test_->reach());
  return found == none ? Answer::open : Answer::no;
}

template <std::size_t d>
void StarTest<d>::enter_star(Index v, std::span<const HalfFacet> star) {
  if (++epoch_ == 0) {
    std::fill(cell_stamps_.begin(), cell_stamps_.end(), 0);
    std::fill(marks_.begin(), marks_.end(), Mark{});
    epoch_ = 1;
  }
  v_ = v;
  star_ = star;
  frame_ = StarFrame<d>(mesh_.vertices[v]);
  vertices_.clear();
  balls_.clear();
  exact_.reset();
  (void)number(v);
  for (std::size_t place = 0; place < star.size(); ++place) {
    add_ball(star[place]);
    cell_stamps_[star[place].cell()] = epoch_;
    if (balls_[place].error <= blurred * balls_[place].length)
      answers_[place] = Answer::open;
  }
}

template <std::size_t d> std::uint32_t StarTest<d>::add_vertex(Index vertex) {
  const auto number = static_cast<std::uint32_t>(vertices_.size());
  marks_[vertex] = {epoch_, number};
  vertices_.push_back({.at = frame_.point(mesh_.vertices[vertex].x), .vertex = vertex});
  return number;
}

template <std::size_t d> void StarTest<d>::add_ball(HalfFacet cell) {
  const Cell<d> &vertices = mesh_.cells[cell.cell()];
  const std::size_t first = cell.facet();
  std::array<std::uint32_t, d> numbers;
  for (std::size_t k = 1; k <= d; ++k) // an even permutation
    numbers[k - 1] = number(vertices[d == 2 ? (k + first) % 3 : k ^ first]);
  std::array<const StarPoint<d> *, d> corners;
  for (std::size_t k = 0; k < d; ++k)
    corners[k] = &vertices_[numbers[k]].at;
  balls_.push_back(star_ball<d>(corners));
}

template <std::size_t d>
Side StarTest<d>::exact_side(std::size_t place, std::uint32_t vertex) {
  if (!exact_ || exact_->place != place) {
    Simplex<d> simplex;
    for (std::size_t i = 0; i <= d; ++i)
      simplex[i] = mesh_.vertices[mesh_.cells[star_[place].cell()][i]].x;
    exact_.emplace(place, mesh_.vertices[v_].M, simplex);
  }
  const Vector<d> &x = mesh_.vertices[vertices_[vertex].vertex].x;
  return exact_->ball.side(x, exact_->ball.power(x));
}

/// Whether a vertex lies inside the ball of a cell, exactly.
template <std::size_t d>
bool StarTest<d>::lies_inside(std::size_t place, std::uint32_t vertex) {
  const Bounded power = balls_[place].power(vertices_[vertex].at);
  if (power.is_positive() || power.is_negative())
    return power.is_negative();
  const Cell<d> &cell = mesh_.cells[star_[place].cell()];
  return std::find(cell.begin(), cell.end(), vertices_[vertex].vertex) == cell.end() &&
         exact_side(place, vertex) == Side::inside;
}

/// Whether a walk from a cell comes to a vertex at once.
template <std::size_t d>
bool StarTest<d>::is_across(std::size_t place, Index vertex) const {
  const std::size_t c = star_[place].cell();
  for (std::size_t i = 0; i <= d; ++i) {
    const HalfFacet beyond = mesh_.neighbours[c][i];
    if (mesh_.constraints[c][i] == none && beyond.exists() &&
        mesh_.cells[beyond.cell()][beyond.facet()] == vertex)
      return true;
  }
  return false;
}

template <std::size_t d> void StarTest<d>::walk() {
  begin_walk();
  for (std::size_t n = 0; n < visits_.size() && n_open_ > 0; ++n)
    go_on(visits_[n]);
}

template <std::size_t d> void StarTest<d>::begin_walk() {
  const auto size = static_cast<Eigen::Index>(star_.size());
  if (gradients_.rows() < size)
    gradients_.resize(size, Eigen::NoChange);
  visits_.clear();
  n_open_ = 0;
  length_ = error_ = 0;
  for (std::size_t place = 0; place < star_.size(); ++place) {
    const StarBall<d> &ball = balls_[place];
    const auto row = static_cast<Eigen::Index>(place);
    if (answers_[place] == Answer::open) {
      gradients_.row(row) = ball.gradient;
      length_ = std::max(length_, ball.length);
      error_ = std::max(error_, ball.error);
      ++n_open_;
    } else {
      gradients_.row(row).setZero(); // as of no ball at all
    }
  }
  const std::size_t n_seen = vertices_.size();
  for (std::uint32_t vertex = 1; vertex < n_seen; ++vertex)
    see(vertex);
  for (HalfFacet cell : star_) {
    const std::size_t c = cell.cell();
    if (mesh_.constraints[c][cell.facet()] == none &&
        mesh_.neighbours[c][cell.facet()].exists())
      pass(mesh_.neighbours[c][cell.facet()], 1);
  }
}

template <std::size_t d> void StarTest<d>::pass(HalfFacet door, std::uint8_t depth) {
  std::uint32_t &stamp = cell_stamps_[door.cell()];
  if (stamp == epoch_)
    return;
  stamp = epoch_;
  visits_.push_back({door, depth});
}

/// Bounds P at a vertex; cells in whose balls it lies are not open any more.
template <std::size_t d> void StarTest<d>::see(std::uint32_t vertex) {
  NearVertex &near = vertices_[vertex];
  const StarPoint<d> &p = near.at;
  const auto G = gradients_.topRows(static_cast<Eigen::Index>(star_.size()));
  double most;
  if constexpr (d == 2)
    most = (G.col(0) * p.z[0] + G.col(1) * p.z[1]).maxCoeff();
  else
    most = (G.col(0) * p.z[0] + G.col(1) * p.z[1] + G.col(2) * p.z[2]).maxCoeff();
  const double blur =
      p.sq_error + error_ * p.length + length_ * p.z_error + Bounded::underflow;
  near.least = p.square - most - blur;
  if (!(near.least > 0)) {
    find_inside(vertex, blur);
    near.least = 0;
  }
  near.root = (1 - slack) * std::sqrt(near.least);
}

/// Finds the open cells in whose balls a vertex lies.
/// @param blur bounds the error of its powers
template <std::size_t d>
void StarTest<d>::find_inside(std::uint32_t vertex, double blur) {
  const StarPoint<d> &p = vertices_[vertex].at;
  const Index own = vertices_[vertex].vertex;
  for (std::size_t place = 0; place < star_.size(); ++place) {
    if (answers_[place] != Answer::open ||
        p.square - balls_[place].gradient.dot(p.z) > blur ||
        !lies_inside(place, vertex))
      continue;
    answers_[place] = is_across(place, own) ? Answer::no : Answer::doubtful;
    gradients_.row(static_cast<Eigen::Index>(place)).setZero();
    --n_open_;
  }
}

template <std::size_t d> void StarTest<d>::go_on(const Visit &from) {
  const Visit at = from; // visits_ grows
  ++n_visits_;
  reach_ = std::max(reach_, at.depth);
  const std::size_t c = at.entry.cell();
  Numbers corners;
  for (std::size_t i = 0; i <= d; ++i)
    corners[i] = number(mesh_.cells[c][i]);
  const std::uint32_t apex = corners[at.entry.facet()];
  if (vertices_[apex].root < 0)
    see(apex);
  const auto deeper =
      static_cast<std::uint8_t>(std::min<int>(at.depth + 1, farthest_reach));
  for (std::size_t i = 0; i <= d; ++i) {
    const HalfFacet beyond = mesh_.neighbours[c][i];
    if (i != at.entry.facet() && mesh_.constraints[c][i] == none && beyond.exists() &&
        cell_stamps_[beyond.cell()] != epoch_ && may_meet(corners, i))
      pass(beyond, deeper);
  }
}

/// Whether the bound of P falls below 0 on a facet: whether the matrix with p_i on its
/// diagonal and a_ij = (p_i + p_j - |q_i - q_j|^2) / 2 is not copositive (Hadeler, On
/// copositive matrices, Linear Algebra Appl. 49, 1983). Yes when in doubt.
template <std::size_t d>
bool StarTest<d>::may_meet(const Numbers &corners, std::size_t facet) const {
  std::array<const NearVertex *, d> q;
  for (std::size_t i = 0, n = 0; i <= d; ++i)
    if (i != facet)
      q[n++] = &vertices_[corners[i]];
  std::array<double, d> a; // of q[n] and q[n + 1]
  bool is_clear = true;
  for (std::size_t n = 0; n < (d == 2 ? 1 : d); ++n) {
    const NearVertex &p = *q[n], &r = *q[(n + 1) % d];
    const Bounded square = square_between(p.at, r.at);
    const double most = square.value + square.error, roots = p.root + r.root;
    if (!(most <= roots * roots))
      return true;
    const double size = p.least + r.least + most;
    a[n] = .5 * (p.least + r.least - most) - slack * size;
    is_clear = is_clear && a[n] >= 0;
  }
  if (d == 2 || is_clear)
    return false;
  double sum = q[0]->root * q[1]->root * q[2]->root, product = 2, size = sum;
  for (std::size_t n = 0; n < d; ++n) {
    const double roots = q[n]->root * q[(n + 1) % d]->root;
    const double term = a[n] * q[(n + 2) % d]->root;
    sum += term;
    size += std::abs(term);
    product *= std::max(0., a[n] + roots - slack * (std::abs(a[n]) + roots));
  }
  return !(sum + std::sqrt(product) >= slack * size);
}

template class StarTest<2>;
template class StarTest<3>;

} // namespace anistar
