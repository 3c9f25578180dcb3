#include "bindings/bind.h"

NB_MODULE(_core, module) {
  module.doc() = "The compiled core of anistar.";
  anistar::bindings::bind_certify(module);
  anistar::bindings::bind_combination(module);
  anistar::bindings::bind_elementary(module);
  anistar::bindings::bind_facet_pairs(module);
  anistar::bindings::bind_facet_shapes(module);
  anistar::bindings::bind_gradation(module);
  anistar::bindings::bind_locator(module);
  anistar::bindings::bind_nearest(module);
  anistar::bindings::bind_pieces(module);
  anistar::bindings::bind_remesh(module);
  anistar::bindings::bind_spectra(module);
  anistar::bindings::bind_supermesh(module);
  anistar::bindings::bind_symmetric_system(module);
  anistar::bindings::bind_vertex_graph(module);
  anistar::bindings::bind_surface(module);
  anistar::bindings::bind_volume_remesh(module);
}
