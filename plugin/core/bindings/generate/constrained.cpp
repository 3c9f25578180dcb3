#include "generate/constrained/constrained.h"
#include "base/errors.h"
#include "bindings/bind.h"
#include "bindings/generate/checked_rows.h"
#include "bindings/support/geometry.h"
#include "bindings/support/interrupt.h"

#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>

#include <limits>
#include <map>
#include <utility>

namespace anistar::bindings {
namespace {

using generate::Constrained;
using generate::ConstrainedCounts;
using generate::ConstrainedSettings;
using generate::Plc;
using generate::RegionRule;
using generate::SteinerPoint;

/// A complex as NumPy arrays.
struct PlcArrays {
  Array2<double> points;         ///< (n, 3)
  Array2<Index> triangles;       ///< (t, 3)
  Array1<Index> triangle_facets; ///< (t,)
  Array2<Index> segments;        ///< (s, 2)
  Array1<Index> kept_points;     ///< (k,)
  Array2<double> seeds;          ///< (r, 3)
  Array1<Index> seed_tags;       ///< (r,)
  Array2<double> holes;          ///< (h, 3)
};

Plc plc_of(const PlcArrays &arrays) {
  const auto points = points_of<3>(arrays.points);
  const auto facets = indices_of(arrays.triangle_facets);
  auto triangles =
      checked_rows(facets_of<3>(arrays.triangles), points.size(), "triangle");
  auto segments = checked_rows(pairs_of(arrays.segments), points.size(), "segment");
  if (facets.size() != triangles.size())
    throw std::invalid_argument("there are " + std::to_string(triangles.size()) +
                                " triangles, but facets of " +
                                std::to_string(facets.size()));
  return {{points.begin(), points.end()},
          std::move(triangles),
          {facets.begin(), facets.end()},
          std::move(segments)};
}

RegionRule rule_of(const std::string &name) {
  if (name == "parity")
    return RegionRule::parity;
  if (name == "nonzero")
    return RegionRule::nonzero;
  if (name == "winding")
    return RegionRule::winding;
  throw std::invalid_argument("rule '" + name +
                              "' is none of 'parity', 'nonzero', 'winding'");
}

ConstrainedSettings settings_of(const PlcArrays &arrays, const std::string &rule,
                                bool facets_may_flip) {
  const auto places = points_of<3>(arrays.seeds);
  const auto tags = indices_of(arrays.seed_tags);
  if (places.size() != tags.size())
    throw std::invalid_argument("there are " + std::to_string(places.size()) +
                                " seeds, but tags of " + std::to_string(tags.size()));
  ConstrainedSettings settings;
  for (const Index v : indices_of(arrays.kept_points)) {
    if (v < 0 || std::cmp_greater_equal(v, arrays.points.shape(0)))
      throw std::invalid_argument("kept point " + std::to_string(v) +
                                  " is not a point");
    settings.kept_points.push_back(v);
  }
  settings.regions.rule = rule_of(rule);
  for (std::size_t k = 0; k < places.size(); ++k)
    settings.regions.seeds.push_back({places[k], tags[k]});
  const auto holes = points_of<3>(arrays.holes);
  settings.regions.holes.assign(holes.begin(), holes.end());
  settings.facets_may_flip = facets_may_flip;
  return settings;
}

std::map<std::string, std::size_t> as_map(const ConstrainedCounts &counts) {
  return {{"missing_edges", counts.missing_edges},
          {"steiner_points", counts.steiner_points},
          {"steiner_points_in_facets", counts.steiner_points_in_facets},
          {"flips", counts.flips},
          {"rigid_facets", counts.rigid_facets},
          {"missing_facets", counts.missing_facets},
          {"cavities", counts.cavities},
          {"largest_cavity", counts.largest_cavity},
          {"rejections", counts.rejections},
          {"peeled", counts.peeled},
          {"removed", counts.removed},
          {"steiner_points_in_volumes", counts.steiner_points_in_volumes},
          {"flat_left", counts.flat_left},
          {"flat_on_flat_walls", counts.flat_on_flat_walls},
          {"moved", counts.moved},
          {"predicates", counts.predicates},
          {"exact_predicates", counts.exact_predicates}};
}

auto column(std::vector<Index> &&values) {
  const std::size_t n = values.size();
  return owned(std::move(values), {n});
}

/// Points of the plane of a Steiner point, and its fraction of the way between them.
std::pair<std::vector<std::array<Index, 2>>, std::vector<double>>
columns_of(const std::vector<SteinerPoint> &points) {
  std::pair<std::vector<std::array<Index, 2>>, std::vector<double>> out;
  for (const auto &[a, b, t] : points) {
    out.first.push_back({a, b});
    out.second.push_back(t);
  }
  return out;
}

nb::typed<nb::dict, nb::str, nb::any> as_dict(Constrained &&made) {
  auto &mesh = made.mesh;
  auto [ends, fractions] = columns_of(mesh.steiner_points);
  const std::size_t n_steiner = fractions.size();
  nb::dict out;
  out["points"] = rows<double, 3>(std::move(mesh.points));
  out["cells"] = rows<Index, 4>(std::move(mesh.cells));
  out["cell_regions"] = column(std::move(mesh.cell_regions));
  out["walls"] = rows<Index, 3>(std::move(mesh.walls));
  out["wall_facets"] = column(std::move(mesh.wall_facets));
  out["edges"] = rows<Index, 2>(std::move(mesh.edges));
  out["edge_segments"] = column(std::move(mesh.edge_segments));
  out["steiner_ends"] = rows<Index, 2>(std::move(ends));
  out["steiner_fractions"] = owned(std::move(fractions), {n_steiner});
  out["counts"] = as_map(made.counts);
  return out;
}

Constrained made_of(const PlcArrays &arrays, const ConstrainedSettings &settings,
                    double max_seconds, nb::handle callback) {
  const Plc plc = plc_of(arrays);
  Monitor monitor(progress_of(callback), std::numeric_limits<Index>::max(),
                  max_seconds);
  const nb::gil_scoped_release release;
  try {
    return constrained_tetrahedralisation(plc, settings, monitor);
  } catch (const BudgetSpent &) {
    throw MeshingError("the time is up before the facets were in the mesh",
                       plc.points[0]);
  }
}

} // namespace

void bind_constrained(nb::module_ &module) {
  module.def(
      "constrained_tetrahedra",
      [](const Array2<double> &points, const Array2<Index> &triangles,
         const Array1<Index> &triangle_facets, const Array2<Index> &segments,
         const Array1<Index> &kept_points, const Array2<double> &seeds,
         const Array1<Index> &seed_tags, const Array2<double> &holes,
         const std::string &rule, bool facets_may_flip, double max_seconds,
         const nb::object &callback) {
        const PlcArrays arrays{points,      triangles, triangle_facets, segments,
                               kept_points, seeds,     seed_tags,       holes};
        return as_dict(made_of(arrays, settings_of(arrays, rule, facets_may_flip),
                               max_seconds, callback));
      },
      nb::kw_only(), nb::arg("points").noconvert(), nb::arg("triangles").noconvert(),
      nb::arg("triangle_facets").noconvert(), nb::arg("segments").noconvert(),
      nb::arg("kept_points").noconvert(), nb::arg("seeds").noconvert(),
      nb::arg("seed_tags").noconvert(), nb::arg("holes").noconvert(), nb::arg("rule"),
      nb::arg("facets_may_flip"), nb::arg("max_seconds"), nb::arg("callback").none(),
      "Constrained Delaunay tetrahedra of a piecewise linear complex, as arrays by "
      "name.");
}

} // namespace anistar::bindings
