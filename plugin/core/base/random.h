#pragma once
// Random numbers from a counter: the same for every number of threads and any order.

#include <cstdint>

namespace anistar {

/// Who draws: no two uses that may draw for one item in one pass have one stream.
enum class Stream : std::uint64_t {
  relocate,          ///< better places of a vertex
  polish,            ///< the same, where only edges become nearer to one
  pick,              ///< candidates of pick_valid
  reenter,           ///< where a vertex of a bad cell leaves and enters again
  repair_facet,      ///< what is tried at a facet that fails
  mend,              ///< places where a star becomes Delaunay
  pick_site,         ///< candidates of pick_valid for a star set
  wander,            ///< moves that make nothing worse, when no other helps
  refinement_region, ///< picks of a new point in its refinement region
};

/// Where a stream begins. The first ones follow the seed, one after another; mend is
/// further from it than they are (no sum of the bits of its mask, of any signs, is
/// below 10431), pick_site and refinement_region still further, and wander on the other
/// side of all seeds below 2^63 - 2. The values are part of the meshes: others make
/// other ones.
[[nodiscard]] constexpr std::uint64_t start_of(Stream stream, std::uint64_t seed) {
  constexpr std::uint64_t mask = 0x5741u;
  switch (stream) {
  case Stream::mend:
    return seed ^ mask;
  case Stream::pick_site:
    return seed ^ mask << 16;
  case Stream::wander:
    return ~seed;
  case Stream::refinement_region:
    return seed ^ mask << 32;
  default:
    return seed + static_cast<std::uint64_t>(stream);
  }
}

/// Whether all streams of a seed begin apart.
[[nodiscard]] constexpr bool are_apart(std::uint64_t seed) {
  for (int one = 0; one <= static_cast<int>(Stream::refinement_region); ++one)
    for (int other = 0; other < one; ++other)
      if (start_of(static_cast<Stream>(one), seed) ==
          start_of(static_cast<Stream>(other), seed))
        return false;
  return true;
}
static_assert(are_apart(0) && are_apart(1) && are_apart(0x5741) &&
              are_apart((std::uint64_t{1} << 63) - 3));

/// The user's seed, and the round of what visits the same items in every round.
struct Seed {
  std::uint64_t value = 0;
  std::uint32_t round = 0;
};

/// A sequence keyed by (seed, round, stream, item, pass); the mixing function is
/// splitmix64 (Steele, Lea, Flood, Fast splittable pseudorandom number generators,
/// 2014).
class CounterRandom {
public:
  /// @param item a vertex, a cell or a facet
  CounterRandom(Seed seed, Stream stream, std::int32_t item, std::uint32_t pass)
      : state_(key(seed, stream, static_cast<std::uint64_t>(item), pass)) {}

  /// Uniform in [0, 1).
  [[nodiscard]] double uniform() {
    state_ += golden;
    return static_cast<double>(mix(state_) >> 11) * 0x1p-53;
  }
  /// Uniform in 0 .. n - 1.
  [[nodiscard]] std::size_t below(std::size_t n) {
    return static_cast<std::size_t>(static_cast<double>(n) * uniform());
  }

private:
  static constexpr std::uint64_t golden = 0x9e3779b97f4a7c15u;
  std::uint64_t state_;

  [[nodiscard]] static std::uint64_t key(Seed seed, Stream stream, std::uint64_t item,
                                         std::uint64_t pass) {
    const std::uint64_t of_item = mix(mix(start_of(stream, seed.value)) + item);
    return mix(of_item + (std::uint64_t{seed.round} << 32 | pass));
  }
  [[nodiscard]] static std::uint64_t mix(std::uint64_t z) {
    z += golden;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
};

} // namespace anistar
