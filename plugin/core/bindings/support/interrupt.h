#pragma once
// Ctrl-C and the user's callback while the core runs.

#include "base/monitor.h"

#include <nanobind/nanobind.h>

namespace anistar::bindings {

/// Lets a signal unwind the core, which runs without the interpreter's lock.
inline void look_for_signals() {
  nanobind::gil_scoped_acquire acquire;
  if (PyErr_CheckSignals() != 0)
    throw nanobind::python_error();
}

/// Tells Python about progress and lets it interrupt: Ctrl-C, or an exception
/// in the user's callback, unwinds the core. A handle, not an object: it is
/// copied and destroyed while the GIL is released.
[[nodiscard]] inline Monitor::Progress progress_of(nanobind::handle callback) {
  return [callback](const std::string &phase, double fraction, std::size_t n_vertices) {
    nanobind::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0)
      throw nanobind::python_error();
    if (!callback.is_none())
      callback(phase.c_str(), fraction, n_vertices);
  };
}

} // namespace anistar::bindings
