#pragma once
// What the remeshers of both dimensions are told.

#include "base/monitor.h"
#include "bindings/support/arrays.h"
#include "remesh/domain_shape.h"
#include "remesh/remesh_settings.h"

namespace anistar::bindings {

/// The settings by the names of the core.
/// @throws std::invalid_argument for an unknown mode
[[nodiscard]] RemeshSettings settings_of(const nb::dict &given);

/// What the facets mean, by the names of the core.
/// @throws std::invalid_argument for an unknown kind
[[nodiscard]] DomainShape shape_of(const nb::dict &given);

/// Tells Python about progress and lets it interrupt: Ctrl-C, or an exception in the
/// user's callback, unwinds the core.
/// A handle, not an object: it is copied and destroyed while the GIL is released.
[[nodiscard]] Monitor::Progress progress_of(nb::handle callback);

} // namespace anistar::bindings
