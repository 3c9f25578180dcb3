#pragma once
// The certificate of a mesh that is being changed: half of it is of no use.

#include "base/run.h"
#include "certificate/certificate.h"

namespace anistar {

/// Lets the certificate end whatever the budgets say. What the user's callback throws
/// still ends it.
[[nodiscard]] inline Look to_the_end(Monitor &monitor) {
  return [&monitor](double fraction) {
    (void)monitor.look(fraction);
    return true;
  };
}
/// The same as a part of something longer, this part of which is done.
[[nodiscard]] inline Look to_the_end(Monitor &monitor, double done) {
  return [&monitor, done](double) {
    (void)monitor.look(done);
    return true;
  };
}

template <std::size_t d>
[[nodiscard]] DelaunayBits certify_all(const Triangulation<d> &mesh, const Run &run) {
  return delaunay_bits<d>(certified(mesh), run.threads, to_the_end(run.monitor));
}

} // namespace anistar
