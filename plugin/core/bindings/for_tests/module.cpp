#include "bindings/for_tests/bind.h"

NB_MODULE(_core_for_tests, module) {
  module.doc() = "Concepts of the compiled core that only its tests call.";
  anistar::bindings::bind_directed_steps(module);
  anistar::bindings::bind_predicates(module);
  anistar::bindings::bind_renewed_bits(module);
  anistar::bindings::bind_tet_shape(module);
}
