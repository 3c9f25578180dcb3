#include "generate/checking/check.h"

#include "base/range.h"
#include "generate/checking/borders.h"
#include "generate/checking/contact.h"
#include "generate/checking/gap.h"
#include "generate/checking/pieces.h"
#include "generate/checking/separation.h"
#include "search/box_tree.h"

#include <algorithm>
#include <map>
#include <optional>

namespace anistar::generate {
namespace {

/// A surface that meets itself more often is not looked at to its end.
constexpr std::size_t max_meetings = 1 << 20;
/// In smaller complexes products of lengths have no digits left.
constexpr double smallest_diagonal = 1 / largest_coordinate;

using Pair = std::array<Index, 2>;

Box<3> box_of(std::span<const Vector<3>> points, std::span<const Index> of) {
  Box<3> box;
  for (const Index v : of)
    box.extend(points[v]);
  return box;
}

/// The smallest distance of a corner from the opposite edge, and the edge.
double height_of(const std::array<Vector<3>, 3> &x) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    longest = std::max(longest, (x[(k + 1) % 3] - x[k]).norm());
  return longest > 0 ? (x[1] - x[0]).cross(x[2] - x[0]).norm() / longest : 0;
}

/// Fills the list of problems, kind by kind.
class Check {
public:
  Check(const Plc &plc, std::span<const Index> points_kept,
        const CheckSettings &settings, Monitor &monitor)
      : plc_(plc), points_kept_(points_kept), settings_(settings), monitor_(monitor) {}

  Problems run() {
    if (!is_in_range())
      return std::move(out_);
    pieces_ = pieces_of(plc_, points_kept_);
    look_at_each();
    look_at_pairs();
    look_at_borders();
    std::stable_sort(
        out_.listed.begin(), out_.listed.end(),
        [](const Problem &a, const Problem &b) { return a.flaw < b.flaw; });
    return std::move(out_);
  }

private:
  const Plc &plc_;
  std::span<const Index> points_kept_;
  const CheckSettings &settings_;
  Monitor &monitor_;
  Pieces pieces_;
  double diagonal_ = 0;
  Problems out_;

  [[nodiscard]] const Vector<3> &at(Index v) const { return plc_.points[v]; }

  void add(Problem problem) {
    std::size_t &total = out_.totals[static_cast<std::size_t>(problem.flaw)];
    if (total++ < settings_.listed)
      out_.listed.push_back(std::move(problem));
  }

  bool is_in_range() {
    Box<3> box;
    for (std::size_t v = 0; v < plc_.points.size(); ++v) {
      const Vector<3> &x = plc_.points[v];
      box.extend(x);
      if (!anistar::is_in_range<3>(x))
        add({Flaw::out_of_range,
             {},
             {},
             {static_cast<Index>(v)},
             x,
             x.cwiseAbs().maxCoeff()});
    }
    if (out_.totals[static_cast<std::size_t>(Flaw::out_of_range)] > 0)
      return false;
    diagonal_ = plc_.points.empty() ? 0 : (box.high - box.low).norm();
    if (diagonal_ > 0 && diagonal_ < smallest_diagonal) {
      add({Flaw::out_of_range, {}, {}, {}, box.low, diagonal_});
      return false;
    }
    return true;
  }

  void look_at_each() {
    for (const auto &[first, again] : pieces_.repeated_points)
      add({Flaw::repeated_point, {}, {}, {first, again}, at(again), 0});
    for (const Index s : pieces_.empty_segments) {
      const Segment &ends = plc_.segments[s];
      add({Flaw::empty_edge, {}, {ends}, {}, at(ends[0]), 0});
    }
    for (const Index t : pieces_.degenerate_triangles)
      add({Flaw::degenerate_triangle, {t}, {}, {}, centre(plc_.triangles[t]), 0});
    for (std::size_t t = 0; t < plc_.triangles.size(); ++t) {
      const auto &[a, b, c] = plc_.triangles[t];
      const double height = height_of({at(a), at(b), at(c)});
      const bool is_flat =
          std::binary_search(pieces_.degenerate_triangles.begin(),
                             pieces_.degenerate_triangles.end(), static_cast<Index>(t));
      if (!is_flat && height < reach())
        add({Flaw::thin_triangle,
             {static_cast<Index>(t)},
             {},
             {},
             centre(plc_.triangles[t]),
             height});
    }
  }
  [[nodiscard]] double reach() const { return settings_.near_distance * diagonal_; }
  [[nodiscard]] Vector<3> centre(const Facet<3> &triangle) const {
    return at(triangle[0]) / 3 + at(triangle[1]) / 3 + at(triangle[2]) / 3;
  }

  /// What two pieces have in common, or nearly.
  struct Found {
    Flaw flaw;
    std::array<Index, 3> key; ///< facets, or numbers of segments and points
    Pair pieces;
    Landing landing;
    std::optional<Gap> gap;
    Vector<3> where;
    double measure;
  };

  void look_at_pairs() {
    const std::vector<Piece> &pieces = pieces_.pieces;
    std::vector<Box<3>> boxes(pieces.size());
    const Vector<3> margin = Vector<3>::Constant(reach());
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      boxes[k] = box_of(plc_.points, pieces[k].points());
      boxes[k].low -= margin;
      boxes[k].high += margin;
    }
    const BoxTree<3> tree(boxes);
    const Surroundings around(pieces, plc_.points.size());
    const Separation separation(plc_.points, pieces, reach());
    std::vector<Found> found;
    std::vector<Index> met;
    monitor_.enter("check");
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      met.clear();
      tree.meeting(boxes[k], [&](Index j) {
        if (std::cmp_greater(j, k) &&
            (n_shared(pieces[k], pieces[j]) > 0 ||
             !separation.is_certain(static_cast<Index>(k), j)))
          met.push_back(j);
        return true;
      });
      std::sort(met.begin(), met.end());
      for (const Index j : met)
        look_at({static_cast<Index>(k), j}, around, found);
      if (found.size() > max_meetings ||
          !monitor_.keep_going(0, double(k) / double(pieces.size()))) {
        out_.is_complete = false;
        break;
      }
    }
    add_distinct(std::move(found));
  }

  void look_at(const Pair &pair, const Surroundings &around,
               std::vector<Found> &found) const {
    const Piece &a = pieces_.pieces[pair[0]], &b = pieces_.pieces[pair[1]];
    const Meeting meeting = meeting_of(plc_.points, a, b);
    const auto note = [&](Flaw flaw) {
      found.push_back(
          {flaw, facets_of(pair), pair, {}, {}, meeting.where, meeting.extent});
    };
    switch (meeting.contact) {
    case Contact::none:
      if (const auto gap = gap_between(plc_.points, pieces_.pieces, around, pair[0],
                                       pair[1], reach()))
        found.push_back({Flaw::near_miss,
                         facets_of(pair),
                         pair,
                         {},
                         gap,
                         gap->where,
                         gap->distance});
      break;
    case Contact::at_point:
      for (const Landing &landing : meeting.landings)
        note_landing(pair, landing, found);
      break;
    case Contact::along:
      note(Flaw::touching);
      break;
    case Contact::crossing:
      note(Flaw::crossing);
      break;
    case Contact::overlap:
      note(Flaw::overlap);
      break;
    case Contact::repeated:
      note(a.is_triangle() ? Flaw::repeated_triangle : Flaw::repeated_edge);
      break;
    }
  }
  void note_landing(const Pair &pair, const Landing &landing,
                    std::vector<Found> &found) const {
    const bool is_inside = landing.edge[0] == none;
    const auto [a, b] = std::minmax(landing.edge[0], landing.edge[1]);
    const Index on = pieces_.pieces[pair[0]].has(landing.point) ? pair[1] : pair[0];
    const std::array<Index, 3> key{landing.point, is_inside ? owner(on) : a, b};
    found.push_back({is_inside ? Flaw::point_on_facet : Flaw::point_on_edge,
                     key,
                     Pair{on, on},
                     landing,
                     {},
                     at(landing.point),
                     0});
  }

  /// The facet of a triangle; beyond all facets, the number of any other piece.
  [[nodiscard]] Index owner(Index piece) const {
    if (pieces_.pieces[piece].is_triangle())
      return plc_.triangle_facets[pieces_.sources[piece]];
    return -2 - piece;
  }
  [[nodiscard]] std::array<Index, 3> facets_of(const Pair &pair) const {
    const auto [a, b] = std::minmax({owner(pair[0]), owner(pair[1])});
    return {a, b, none};
  }

  /// Names each pair of facets, and each point on something, once.
  void add_distinct(std::vector<Found> found) {
    const auto rank = [](const Found &f) { return std::tie(f.flaw, f.key); };
    std::stable_sort(found.begin(), found.end(),
                     [&](const Found &a, const Found &b) { return rank(a) < rank(b); });
    for (std::size_t k = 0; k < found.size(); ++k)
      if (k == 0 || rank(found[k - 1]) != rank(found[k]))
        add(problem_of(found[k]));
  }
  [[nodiscard]] Problem problem_of(const Found &found) const {
    Problem out{found.flaw, {}, {}, {}, found.where, found.measure};
    const bool is_at_point =
        found.flaw == Flaw::point_on_edge || found.flaw == Flaw::point_on_facet;
    if (is_at_point)
      out.points.push_back(found.landing.point);
    if (found.flaw == Flaw::point_on_edge) {
      out.edges.push_back(found.landing.edge);
    } else {
      name(found.pieces[0], out);
      if (!is_at_point)
        name(found.pieces[1], out);
    }
    if (found.gap && found.gap->point != none)
      out.points.push_back(found.gap->point);
    return out;
  }
  void name(Index piece, Problem &out) const {
    const Index source = pieces_.sources[piece];
    if (pieces_.pieces[piece].is_triangle())
      out.triangles.push_back(source);
    else if (pieces_.pieces[piece].is_segment())
      out.edges.push_back(plc_.segments[source]);
    else
      out.points.push_back(source);
  }

  void look_at_borders() {
    std::vector<Piece> triangles;
    for (const Facet<3> &t : plc_.triangles) {
      const Piece piece = pieces_.of(t);
      const auto &[a, b, c] = piece.corners;
      if (a != b && b != c && c != a)
        triangles.push_back(piece);
    }
    const Borders borders = borders_of(plc_.points, triangles);
    for (const Border &border : borders.borders)
      if (border.is_of_open_surface)
        add({Flaw::open_border,
             {},
             edges_of(border),
             border.points,
             at(border.points.front()),
             border.length});
    for (const CrowdedEdge &edge : borders.crowded)
      add({Flaw::crowded_edge,
           {},
           {edge.ends},
           {},
           .5 * (at(edge.ends[0]) + at(edge.ends[1])),
           static_cast<double>(edge.n_triangles)});
  }
  [[nodiscard]] static std::vector<Segment> edges_of(const Border &border) {
    std::vector<Segment> edges;
    for (std::size_t k = 1; k < border.points.size(); ++k)
      edges.push_back({border.points[k - 1], border.points[k]});
    return edges;
  }
};

} // namespace

Problems check(const Plc &plc, std::span<const Index> points_kept,
               const CheckSettings &settings, Monitor &monitor) {
  return Check(plc, points_kept, settings, monitor).run();
}

} // namespace anistar::generate
