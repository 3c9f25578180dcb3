#include "bind.h"

namespace anistar::bindings {

void bind_gradation(nanobind::module_ &module);

} // namespace anistar::bindings

NB_MODULE(_core, module) {
  module.doc() = "The compiled core of anistar.";
  anistar::bindings::bind_gradation(module);
  anistar::bindings::bind_locator(module);
}
