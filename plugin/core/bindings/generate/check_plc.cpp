#include "bindings/bind.h"
#include "bindings/support/geometry.h"
#include "bindings/support/interrupt.h"
#include "generate/checking/check.h"
#include "generate/checking/check_plane.h"

#include <nanobind/stl/array.h>
#include <nanobind/stl/vector.h>

#include <limits>

namespace anistar::bindings {
namespace {

using generate::Flaw;
using generate::Problem;
using generate::Problems;

void require_points(std::span<const Index> indices, std::size_t n_points) {
  for (const Index v : indices)
    if (v < 0 || std::cmp_greater_equal(v, n_points))
      throw std::invalid_argument("vertex " + std::to_string(v) + " is not a point");
}

template <std::size_t width>
[[nodiscard]] std::span<const Index>
flat(std::span<const std::array<Index, width>> rows) {
  return {rows.empty() ? nullptr : rows.front().data(), rows.size() * width};
}

Monitor watching_signals() {
  return {[](const std::string &, double, std::size_t) { look_for_signals(); },
          std::numeric_limits<std::size_t>::max(),
          std::numeric_limits<double>::infinity()};
}

Problems check_plc(const Array2<double> &points, const Array2<Index> &triangles,
                   const Array1<Index> &triangle_facets, const Array2<Index> &segments,
                   const Array1<Index> &points_kept, std::size_t listed,
                   double near_distance) {
  const auto p = points_of<3>(points);
  const auto t = facets_of<3>(triangles);
  const auto f = indices_of(triangle_facets);
  const auto s = pairs_of(segments);
  const auto kept = indices_of(points_kept);
  require_points(flat(t), p.size());
  require_points(flat(s), p.size());
  require_points(kept, p.size());
  if (f.size() != t.size())
    throw std::invalid_argument("every triangle needs a facet");
  nb::gil_scoped_release release;
  const generate::Plc plc{{p.begin(), p.end()},
                          {t.begin(), t.end()},
                          {f.begin(), f.end()},
                          {s.begin(), s.end()}};
  Monitor monitor = watching_signals();
  return generate::check(plc, kept, {listed, near_distance}, monitor);
}

Problems check_pslg(const Array2<double> &points, const Array2<Index> &segments,
                    const Array1<Index> &points_kept, std::size_t listed,
                    double near_distance) {
  const auto p = points_of<2>(points);
  const auto s = pairs_of(segments);
  const auto kept = indices_of(points_kept);
  require_points(flat(s), p.size());
  require_points(kept, p.size());
  nb::gil_scoped_release release;
  Monitor monitor = watching_signals();
  return generate::check_plane(p, s, kept, {listed, near_distance}, monitor);
}

} // namespace

void bind_check_plc(nb::module_ &module) {
  nb::enum_<Flaw>(module, "Flaw", "What can be wrong with a complex.")
      .value("out_of_range", Flaw::out_of_range)
      .value("repeated_point", Flaw::repeated_point)
      .value("empty_edge", Flaw::empty_edge)
      .value("repeated_edge", Flaw::repeated_edge)
      .value("degenerate_triangle", Flaw::degenerate_triangle)
      .value("repeated_triangle", Flaw::repeated_triangle)
      .value("overlap", Flaw::overlap)
      .value("crossing", Flaw::crossing)
      .value("touching", Flaw::touching)
      .value("point_on_edge", Flaw::point_on_edge)
      .value("point_on_facet", Flaw::point_on_facet)
      .value("open_border", Flaw::open_border)
      .value("thin_triangle", Flaw::thin_triangle)
      .value("near_miss", Flaw::near_miss)
      .value("crowded_edge", Flaw::crowded_edge);
  nb::class_<Problem>(module, "Problem", "Something that is wrong with a complex.")
      .def_ro("flaw", &Problem::flaw)
      .def_ro("triangles", &Problem::triangles)
      .def_ro("edges", &Problem::edges)
      .def_ro("points", &Problem::points)
      .def_prop_ro("where",
                   [](const Problem &self) {
                     return std::array{self.where[0], self.where[1], self.where[2]};
                   })
      .def_ro("measure", &Problem::measure);
  nb::class_<Problems>(module, "Problems",
                       "What is wrong with a complex, a few of a kind.")
      .def_ro("listed", &Problems::listed)
      .def_prop_ro("totals",
                   [](const Problems &self) {
                     return std::vector(self.totals.begin(), self.totals.end());
                   })
      .def_ro("is_complete", &Problems::is_complete);
  module.def("check_plc", &check_plc, nb::arg("points").noconvert(),
             nb::arg("triangles").noconvert(), nb::arg("triangle_facets").noconvert(),
             nb::arg("segments").noconvert(), nb::arg("points_kept").noconvert(),
             nb::arg("listed"), nb::arg("near_distance"),
             "What is wrong with a complex in space; `near_distance` in diagonals.");
  module.def("check_pslg", &check_pslg, nb::arg("points").noconvert(),
             nb::arg("segments").noconvert(), nb::arg("points_kept").noconvert(),
             nb::arg("listed"), nb::arg("near_distance"),
             "What is wrong with segments and points in the plane.");
}

} // namespace anistar::bindings
