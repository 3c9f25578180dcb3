#include "volume/stars/star_mending.h"

#include "stars/star_mending.h"
#include "volume/stars/relocation.h"

namespace anistar {

std::size_t mend_stars(Volume &volume, const Run &run, DelaunayBits &known) {
  AgreementState state(volume, run.hausdorff.surface);
  VolumeRelocation relocation(state);
  return mend_failures(volume.mesh, relocation, run, known);
}

} // namespace anistar
