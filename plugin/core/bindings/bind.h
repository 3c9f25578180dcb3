#pragma once
// One function per concept; module.cpp calls them all.

#include <nanobind/nanobind.h>

namespace anistar::bindings {

namespace nb = nanobind;

void bind_errors(nb::module_ &module);
void bind_mesh_arrays(nb::module_ &module);

void bind_certify(nb::module_ &module);

void bind_combination(nb::module_ &module);
void bind_elementary(nb::module_ &module);
void bind_gradation(nb::module_ &module);
void bind_pieces(nb::module_ &module);
void bind_spectra(nb::module_ &module);
void bind_vertex_graph(nb::module_ &module);

void bind_facet_pairs(nb::module_ &module);
void bind_locator(nb::module_ &module);
void bind_nearest(nb::module_ &module);

void bind_constrained(nb::module_ &module);
void bind_check_plc(nb::module_ &module);
void bind_refined(nb::module_ &module);
void bind_repair(nb::module_ &module);

void bind_supermesh(nb::module_ &module);
void bind_symmetric_system(nb::module_ &module);

void bind_remesh_settings(nb::module_ &module);
void bind_remesh_result(nb::module_ &module);
void bind_remesh(nb::module_ &module);
void bind_facet_shapes(nb::module_ &module);
void bind_surface(nb::module_ &module);

void bind_facets(nb::module_ &module);
void bind_plane(nb::module_ &module);

} // namespace anistar::bindings
