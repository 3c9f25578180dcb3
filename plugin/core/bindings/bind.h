#pragma once
// One function per concept; module.cpp calls them all.

#include <nanobind/nanobind.h>

namespace anistar::bindings {

void bind_certify(nanobind::module_ &module);
void bind_combination(nanobind::module_ &module);
void bind_elementary(nanobind::module_ &module);
void bind_facet_pairs(nanobind::module_ &module);
void bind_facet_shapes(nanobind::module_ &module);
void bind_gradation(nanobind::module_ &module);
void bind_locator(nanobind::module_ &module);
void bind_nearest(nanobind::module_ &module);
void bind_pieces(nanobind::module_ &module);
void bind_remesh(nanobind::module_ &module);
void bind_spectra(nanobind::module_ &module);
void bind_supermesh(nanobind::module_ &module);
void bind_symmetric_system(nanobind::module_ &module);
void bind_vertex_graph(nanobind::module_ &module);
void bind_surface(nanobind::module_ &module);
void bind_volume_remesh(nanobind::module_ &module);

} // namespace anistar::bindings
