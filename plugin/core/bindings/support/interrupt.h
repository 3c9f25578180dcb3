#pragma once
// Ctrl-C while the core runs.

#include <nanobind/nanobind.h>

namespace anistar::bindings {

/// Lets a signal unwind the core, which runs without the interpreter's lock.
inline void look_for_signals() {
  nanobind::gil_scoped_acquire acquire;
  if (PyErr_CheckSignals() != 0)
    throw nanobind::python_error();
}

} // namespace anistar::bindings
