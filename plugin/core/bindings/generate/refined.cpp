#include "bindings/bind.h"
#include "bindings/generate/checked_rows.h"
#include "bindings/support/geometry.h"
#include "bindings/support/interrupt.h"
#include "generate/refinement/refinement.h"

#include <cmath>
#include <utility>

namespace anistar::bindings {
namespace {

using generate::LemmaCheck;
using generate::Refined;
using generate::RefinementRecord;
using generate::RefinementSettings;
using generate::SliverSettings;
using generate::Tetrahedralisation;

/// Tetrahedra that conform to a complex, as NumPy arrays.
struct TetrahedraArrays {
  Array2<double> points;       ///< (n, 3)
  Array2<Index> cells;         ///< (m, 4)
  Array1<Index> cell_regions;  ///< (m,)
  Array2<Index> walls;         ///< (w, 3)
  Array1<Index> wall_facets;   ///< (w,)
  Array2<Index> edges;         ///< (e, 2)
  Array1<Index> edge_segments; ///< (e,)
};

std::vector<Index> checked_numbers(std::span<const Index> numbers, std::size_t n_rows,
                                   const std::string &name) {
  if (numbers.size() != n_rows)
    throw std::invalid_argument("there are " + std::to_string(numbers.size()) + " " +
                                name + " for " + std::to_string(n_rows) + " rows");
  return {numbers.begin(), numbers.end()};
}

std::vector<Index> checked_faces(std::span<const Index> faces, std::size_t n_rows,
                                 const std::string &name) {
  for (const Index face : faces)
    if (face < 0)
      throw std::invalid_argument(name + " must not be negative, got " +
                                  std::to_string(face));
  return checked_numbers(faces, n_rows, name);
}

Tetrahedralisation mesh_of(const TetrahedraArrays &arrays) {
  const auto points = points_of<3>(arrays.points);
  const std::size_t n = points.size();
  Tetrahedralisation mesh;
  mesh.points.assign(points.begin(), points.end());
  mesh.cells = checked_rows(cells_of<3>(arrays.cells), n, "cell");
  mesh.cell_regions =
      checked_numbers(indices_of(arrays.cell_regions), mesh.cells.size(), "regions");
  mesh.walls = checked_rows(facets_of<3>(arrays.walls), n, "wall");
  mesh.wall_facets =
      checked_faces(indices_of(arrays.wall_facets), mesh.walls.size(), "facets");
  mesh.edges = checked_rows(pairs_of(arrays.edges), n, "edge");
  mesh.edge_segments =
      checked_faces(indices_of(arrays.edge_segments), mesh.edges.size(), "segments");
  return mesh;
}

generate::Sizes sizes_of(const Array1<double> &sizes) {
  generate::Sizes out(sizes.data(), sizes.data() + sizes.shape(0));
  for (std::size_t k = 0; k < out.size(); ++k)
    if (!(out[k] > 0))
      throw std::invalid_argument("size " + std::to_string(k) +
                                  " is not positive: " + std::to_string(out[k]));
  return out;
}

auto column(std::vector<Index> &&values) {
  const std::size_t n = values.size();
  return owned(std::move(values), {n});
}

using Dict = nb::typed<nb::dict, nb::str, nb::any>;

nb::dict as_dict(const generate::Insertions &insertions) {
  nb::dict out;
  out["edges"] = insertions.edges;
  out["facets"] = insertions.facets;
  out["tetrahedra"] = insertions.tetrahedra;
  return out;
}

nb::dict as_dict(const LemmaCheck &check) {
  nb::dict out;
  out["checked"] = check.checked;
  out["violated"] = check.violated;
  out["least"] = check.least;
  return out;
}

nb::dict as_dict(const generate::Encroached &encroached) {
  nb::dict out;
  out["edges"] = encroached.edges;
  out["facets_across_acute_angle"] = encroached.facets_across_acute_angle;
  out["facets_not_longer"] = encroached.facets_not_longer;
  out["facets_otherwise"] = encroached.facets_otherwise;
  return out;
}

nb::dict as_dict(const RefinementRecord &record) {
  nb::dict refusals;
  for (std::size_t k = 0; k < generate::n_refusals; ++k) {
    const std::string_view name = name_of(static_cast<generate::Refusal>(k));
    refusals[nb::str(name.data(), name.size())] = record.refusals[k];
  }
  nb::dict out;
  out["refinement"] = as_dict(record.refinement);
  out["sliver_elimination"] = as_dict(record.sliver_elimination);
  out["refusals"] = refusals;
  out["edge_lemma"] = as_dict(record.edge_lemma);
  out["facet_lemma"] = as_dict(record.facet_lemma);
  out["encroached"] = as_dict(record.encroached);
  out["enlarged_cavities"] = record.enlarged_cavities;
  out["reduced_cavities"] = record.reduced_cavities;
  out["not_delaunay"] = record.not_delaunay;
  out["clusters"] = record.clusters;
  out["acute_pairs"] = record.acute_pairs;
  out["above_bound"] = record.above_bound;
  out["slivers"] = record.slivers;
  out["largest_ratio"] = record.largest_ratio;
  out["least_dihedral"] = record.least_dihedral;
  out["l_1"] = record.l_1;
  out["l_2"] = record.l_2;
  out["seconds_refining"] = record.seconds_refining;
  out["seconds_eliminating"] = record.seconds_eliminating;
  return out;
}

Dict as_dict(Refined &&refined) {
  Tetrahedralisation &mesh = refined.mesh;
  nb::dict out;
  out["points"] = rows<double, 3>(std::move(mesh.points));
  out["cells"] = rows<Index, 4>(std::move(mesh.cells));
  out["cell_regions"] = column(std::move(mesh.cell_regions));
  out["walls"] = rows<Index, 3>(std::move(mesh.walls));
  out["wall_facets"] = column(std::move(mesh.wall_facets));
  out["edges"] = rows<Index, 2>(std::move(mesh.edges));
  out["edge_segments"] = column(std::move(mesh.edge_segments));
  out["record"] = as_dict(refined.record);
  out["stop_reason"] = refined.record.stop;
  return out;
}

Refined refined_of(const TetrahedraArrays &arrays, const Array1<double> &sizes,
                   const RefinementSettings &settings, nb::handle callback) {
  const Tetrahedralisation mesh = mesh_of(arrays);
  const generate::Sizes wanted = sizes_of(sizes);
  const Monitor::Progress progress = progress_of(callback);
  const nb::gil_scoped_release release;
  return generate::refine(mesh, wanted, settings, progress);
}

} // namespace

void bind_refined(nb::module_ &module) {
  nb::class_<SliverSettings>(module, "SliverSettings",
                             "What Li's elimination of slivers may choose.")
      .def(nb::init<>())
      .def_rw("are_eliminated", &SliverSettings::are_eliminated)
      .def_rw("least_dihedral", &SliverSettings::least_dihedral)
      .def_rw("delta", &SliverSettings::delta)
      .def_rw("rho_0", &SliverSettings::rho_0)
      .def_rw("C", &SliverSettings::C)
      .def_rw("n_picks", &SliverSettings::n_picks)
      .def("meet_conditions", &SliverSettings::meet_conditions);
  nb::class_<RefinementSettings>(module, "RefinementSettings",
                                 "What Delaunay refinement is told.")
      .def(nb::init<>())
      .def_rw("bound", &RefinementSettings::bound)
      .def_rw("shortest_edge", &RefinementSettings::shortest_edge)
      .def_rw("slivers", &RefinementSettings::slivers)
      .def_rw("max_vertices", &RefinementSettings::max_vertices)
      .def_rw("max_seconds", &RefinementSettings::max_seconds)
      .def_rw("seed", &RefinementSettings::seed);
  module.def(
      "refined_tetrahedra",
      [](const Array2<double> &points, const Array2<Index> &cells,
         const Array1<Index> &cell_regions, const Array2<Index> &walls,
         const Array1<Index> &wall_facets, const Array2<Index> &edges,
         const Array1<Index> &edge_segments, const Array1<double> &sizes,
         const RefinementSettings &settings, const nb::object &callback) {
        return as_dict(refined_of(
            {points, cells, cell_regions, walls, wall_facets, edges, edge_segments},
            sizes, settings, callback));
      },
      nb::kw_only(), nb::arg("points").noconvert(), nb::arg("cells").noconvert(),
      nb::arg("cell_regions").noconvert(), nb::arg("walls").noconvert(),
      nb::arg("wall_facets").noconvert(), nb::arg("edges").noconvert(),
      nb::arg("edge_segments").noconvert(), nb::arg("sizes").noconvert(),
      nb::arg("settings"), nb::arg("callback").none(),
      "Tetrahedra after Delaunay refinement, and what the rules did, by name.");
}

} // namespace anistar::bindings
