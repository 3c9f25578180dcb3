#include "volume/stars/star_mending.h"

#include "stars/star_mending.h"
#include "volume/stars/relocation.h"

namespace anistar {
namespace {

constexpr double radius = .3;

class VolumeMender {
public:
  VolumeMender(Volume &volume, double hausdorff_number, Seed seed)
      : volume_(volume), seed_(seed), state_(volume, hausdorff_number),
        relocation_(state_), failures_(volume.mesh) {}

  /// As in 2D; vertices on surfaces and ridges slide along them.
  bool mend(Index cell, int round) {
    for (Index v : failures_.culprits(cell)) {
      star_of(volume_, v, star_);
      failures_.surround(star_);
      const int failing = failures_.count();
      CounterRandom random(seed_, Stream::mend, v, round);
      if (relocation_.relocate_where(v, radius, random, [&] {
            return failures_.count_moved(v, failing) < failing;
          })) {
        failures_.forget();
        return true;
      }
    }
    return false;
  }
  [[nodiscard]] std::vector<Index> take_changed() {
    return std::exchange(state_.changed, {});
  }
  [[nodiscard]] StarFailures<3> &failures() { return failures_; }

private:
  Volume &volume_;
  Seed seed_;
  AgreementState state_;
  VolumeRelocation relocation_;
  StarFailures<3> failures_;
  std::vector<Index> star_;
};

} // namespace

std::size_t mend_stars(Volume &volume, Monitor &monitor, double hausdorff_number,
                       Seed seed, DelaunayBits &known) {
  VolumeMender mender(volume, hausdorff_number, seed);
  return mend_failures(volume.mesh, mender, monitor, known);
}

} // namespace anistar
