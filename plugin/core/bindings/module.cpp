#include "bindings/bind.h"

NB_MODULE(_core, module) {
  using namespace anistar::bindings;
  module.doc() = "The compiled core of anistar.";
  bind_errors(module);
  bind_mesh_arrays(module);
  bind_certify(module);
  bind_combination(module);
  bind_elementary(module);
  bind_gradation(module);
  bind_pieces(module);
  bind_spectra(module);
  bind_vertex_graph(module);
  bind_facet_pairs(module);
  bind_locator(module);
  bind_nearest(module);
  bind_constrained(module);
  bind_check_plc(module);
  bind_repair(module);
  bind_supermesh(module);
  bind_symmetric_system(module);
  bind_remesh_settings(module); // and what is told in their terms
  bind_remesh_result(module);
  bind_remesh(module);
  bind_facet_shapes(module);
  bind_surface(module);
  bind_facets(module);
  bind_plane(module);
  bind_refined(module); // its stop reasons are those of remeshing
}
