#include "transfer/supermesh.h"
#include "bindings/bind.h"
#include "bindings/support/geometry.h"
#include "bindings/support/interrupt.h"

#include <limits>

namespace anistar::bindings {
namespace {

void put_rows(nb::dict &out, const char *name, SparseRows &&rows) {
  const std::size_t n = rows.starts.size(), n_entries = rows.columns.size();
  out[name] = nb::make_tuple(owned(std::move(rows.starts), {n}),
                             owned(std::move(rows.columns), {n_entries}),
                             owned(std::move(rows.values), {n_entries}));
}

template <std::size_t d>
RegionMesh<d> region_mesh(const Array2<double> &points, const Array2<Index> &cells,
                          const Array1<Index> &regions) {
  if (regions.shape(0) != cells.shape(0))
    throw std::invalid_argument("a region is needed for every cell");
  for (const Index region : indices_of(regions))
    if (region < 0)
      throw std::invalid_argument("region " + std::to_string(region) + " is negative");
  return {points_of<d>(points), cells_of<d>(cells), indices_of(regions)};
}

template <std::size_t d>
nb::dict
supermesh_of(const Array2<double> &source_points, const Array2<Index> &source_cells,
             const Array1<Index> &source_regions, const Array2<double> &target_points,
             const Array2<Index> &target_cells, const Array1<Index> &target_regions,
             const Array2<double> &nodal, bool points, bool blocks, int threads,
             const nb::object &callback) {
  const std::size_t n_columns = nodal.shape(1);
  if (n_columns > 0 && nodal.shape(0) != source_cells.shape(0) * (d + 1))
    throw std::invalid_argument("nodal values are needed for every corner of a cell");
  const auto source = region_mesh<d>(source_points, source_cells, source_regions);
  const auto target = region_mesh<d>(target_points, target_cells, target_regions);
  Monitor monitor(progress_of(callback), std::numeric_limits<std::size_t>::max(),
                  std::numeric_limits<double>::infinity());
  Supermesh<d> made;
  {
    nb::gil_scoped_release release;
    const SupermeshSettings settings{
        points, blocks, {nodal.data(), nodal.size()}, n_columns, threads};
    made = supermesh<d>(source, target, settings, monitor);
  }
  nb::dict out;
  if (points)
    put_rows(out, "points", std::move(made.points));
  put_rows(out, "pairs", std::move(made.pairs));
  if (blocks) {
    const std::size_t n = made.blocks.size();
    auto *kept = new std::vector<Moments<d>>(std::move(made.blocks));
    nb::capsule owner(kept, [](void *p) noexcept {
      delete static_cast<std::vector<Moments<d>> *>(p);
    });
    out["blocks"] = nb::ndarray<nb::numpy, double>(
        reinterpret_cast<double *>(kept->data()), {n, d + 1, d + 1}, owner);
  }
  out["loads"] =
      owned(std::move(made.loads), {target.cells.size() * (d + 1), n_columns});
  out["uncovered"] = owned(std::move(made.uncovered), {target.cells.size()});
  out["distance"] = owned(std::move(made.distance), {target.cells.size()});
  out["covered"] = owned(std::move(made.covered), {source.cells.size()});
  return out;
}

template <std::size_t d> void bind_dimension(nb::module_ &module, const char *name) {
  module.def(name, &supermesh_of<d>, nb::arg("source_points").noconvert(),
             nb::arg("source_cells").noconvert(), nb::arg("source_regions").noconvert(),
             nb::arg("target_points").noconvert(), nb::arg("target_cells").noconvert(),
             nb::arg("target_regions").noconvert(), nb::arg("nodal").noconvert(),
             nb::kw_only(), nb::arg("points"), nb::arg("blocks"), nb::arg("threads"),
             nb::arg("callback").none(),
             "Lay two meshes over each other: matrices (starts, columns, values) "
             "between points and between cells, moments of the pairs, loads of nodal "
             "values, and coverage.");
}

} // namespace

void bind_supermesh(nb::module_ &module) {
  bind_dimension<2>(module, "supermesh2");
  bind_dimension<3>(module, "supermesh3");
}

} // namespace anistar::bindings
