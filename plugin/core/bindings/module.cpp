#include <nanobind/nanobind.h>

namespace anistar::bindings {}

NB_MODULE(_core, module) { module.doc() = "The compiled core of anistar."; }
