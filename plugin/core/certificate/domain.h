#pragma once
// Whether points lie in the domain of a mesh.

#include "base/deferred.h"
#include "certificate/certificate.h"
#include "search/locator.h"

namespace anistar {

/// A closed domain. Safe for concurrent use.
template <std::size_t d> class Domain {
public:
  explicit Domain(CertifiedMesh<d> mesh);

  /// @param start a cell near x; afterwards the one of x, where a short walk found it
  [[nodiscard]] bool holds(const Vector<d> &x, Index &start) const;

private:
  CertifiedMesh<d> mesh_;
  Box<d> box_;                   ///< of the domain, a little larger
  Deferred<Locator<d>> locator_; ///< few points are not found by a short walk

  [[nodiscard]] const Locator<d> &locator() const;
  /// The facet of a cell beyond which x lies; d + 1: none, x is in the cell.
  [[nodiscard]] std::size_t way_out(Index cell, const Vector<d> &x) const;
  [[nodiscard]] Index walk(const Vector<d> &x, Index start) const;
};

} // namespace anistar
