#pragma once
// What is tested apart from the functions of the package that it serves.

#include <nanobind/nanobind.h>

namespace anistar::bindings {

namespace nb = nanobind;

void bind_directed_steps(nb::module_ &module);
void bind_predicates(nb::module_ &module);
void bind_renewed_bits(nb::module_ &module);
void bind_tet_shape(nb::module_ &module);

} // namespace anistar::bindings
