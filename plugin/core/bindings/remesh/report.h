#pragma once
// What the remeshers of both dimensions return.

#include "bindings/support/arrays.h"
#include "remesh/remesh_result.h"

namespace anistar::bindings {

/// The mesh as new arrays, and the report.
template <std::size_t d> [[nodiscard]] nb::dict as_dict(const RemeshResult<d> &result);

} // namespace anistar::bindings
