#pragma once
// Which cells of a star are Delaunay in the metric of its vertex, by one walk.
//
// In the metric of v the power of y in the ball of a cell c at v is |y|^2 - g_c.y, with
// the same square for all (certificate/star_ball.h). Let
//     P(y) = |y|^2 - max g_c.y,
// the least of the powers: y is inside the ball of one of the cells when P(y) < 0. The
// maximum of linear functions is convex, so that for barycentric coordinates b_i of a
// facet with corners q_i
//     P(sum b_i q_i) >= sum b_i P(q_i) - sum_{i<j} b_i b_j |q_i - q_j|^2.
// Only where the right side falls below 0 the facet can meet a ball.
//
// One walk from all cells of the star through such facets, not across walls, comes to
// every cell that the walk of the definition comes to from one of them through its own
// ball. Cells of which it finds no vertex inside are Delaunay. Nothing is assumed of
// the star: it may end at walls, or touch itself in v.
//
// A cell is not Delaunay when a vertex across one of its facets is inside; other cells
// with a vertex inside, and balls that rounding blurs, go to the walk of the
// definition.

#include "certificate/circumball.h"
#include "certificate/delaunay_test.h"
#include "certificate/star_ball.h"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace anistar {

/// One object to a thread, for one star after another.
template <std::size_t d> class StarTest {
public:
  explicit StarTest(CertifiedMesh<d> mesh)
      : mesh_(mesh), cell_stamps_(mesh.cells.size(), 0), marks_(mesh.vertices.size()) {}

  /// Asked now and then, also between the cells of a star that are decided alone.
  using GoesOn = std::function<bool()>;

  /// @param star the cells at v, each as the half-facet opposite v
  /// @param passes for each of them, 1 when it is Delaunay in the metric of v, else 0
  /// @returns false when it is not to go on; there are no answers then
  bool decide(Index v, std::span<const HalfFacet> star, std::span<std::uint8_t> passes,
              const GoesOn &goes_on);
  /// How many cells away from the star the last answers looked.
  [[nodiscard]] std::uint8_t reach() const { return reach_; }

private:
  enum class Answer : std::uint8_t { open, no, doubtful };
  /// The number that the star gave to a vertex.
  struct Mark {
    std::uint32_t star = 0, number = 0;
  };
  struct NearVertex {
    StarPoint<d> at;
    Index vertex;
    double least = 0; ///< P is not below
    double root = -1; ///< not above its root; negative before it is seen
  };
  /// A cell that is walked to, by the facet from beyond.
  struct Visit {
    HalfFacet entry;
    std::uint8_t depth; ///< in cells
  };
  /// For doubts.
  struct ExactBall {
    std::size_t place;
    Simplex<d> simplex;
    Circumball<d> ball;
    ExactBall(std::size_t of, const SymmetricTensor<d> &M, const Simplex<d> &s)
        : place(of), simplex(s), ball(M, simplex) {}
  };
  using Numbers = std::array<std::uint32_t, d + 1>; ///< of the vertices of a cell

  CertifiedMesh<d> mesh_;
  std::vector<std::uint32_t> cell_stamps_; ///< the star that looked at a cell last
  std::vector<Mark> marks_;
  std::uint32_t epoch_ = 0;
  std::optional<DelaunayTest<d>> exact_test_; ///< made when it is needed
  std::size_t n_visits_ = 0, next_look_ = 0;  ///< in cells

  // of the star
  Index v_ = none;
  std::span<const HalfFacet> star_;
  StarFrame<d> frame_;
  std::vector<NearVertex> vertices_; ///< v first
  std::vector<Answer> answers_;      ///< by the place in the star
  std::vector<StarBall<d>> balls_;
  std::optional<ExactBall> exact_;
  std::uint8_t reach_ = 0;

  // of the walk
  Eigen::Matrix<double, Eigen::Dynamic, static_cast<int>(d)>
      gradients_;                 ///< of open cells
  double length_ = 0, error_ = 0; ///< bounds for all of them
  std::size_t n_open_ = 0;
  std::vector<Visit> visits_;

  void enter_star(Index v, std::span<const HalfFacet> star);
  [[nodiscard]] std::uint32_t number(Index vertex) {
    const Mark &mark = marks_[vertex];
    return mark.star == epoch_ ? mark.number : add_vertex(vertex);
  }
  [[nodiscard]] std::uint32_t add_vertex(Index vertex);
  void add_ball(HalfFacet cell);
  [[nodiscard]] bool lies_inside(std::size_t place, std::uint32_t vertex);
  [[nodiscard]] Side exact_side(std::size_t place, std::uint32_t vertex);
  [[nodiscard]] bool is_across(std::size_t place, Index vertex) const;
  [[nodiscard]] Answer decide_alone(Index cell, const SymmetricTensor<d> &M);
  void walk();
  void begin_walk();
  void pass(HalfFacet door, std::uint8_t depth);
  void see(std::uint32_t vertex);
  void find_inside(std::uint32_t vertex, double blur);
  void go_on(const Visit &at);
  [[nodiscard]] bool may_meet(const Numbers &corners, std::size_t facet) const;
};

} // namespace anistar
