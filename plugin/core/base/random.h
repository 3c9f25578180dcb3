#pragma once
// Random numbers from a counter: the same for every number of threads and any order.

#include <cstdint>

namespace anistar {

/// A stream keyed by (seed, vertex, pass); the mixing function is splitmix64 (Steele,
/// Lea, Flood, Fast splittable pseudorandom number generators, 2014).
class CounterRandom {
public:
  CounterRandom(std::uint64_t seed, std::uint64_t vertex, std::uint64_t pass)
      : state_(mix(mix(mix(seed) + vertex) + pass)) {}

  /// Uniform in [0, 1).
  [[nodiscard]] double uniform() {
    state_ += 0x9e3779b97f4a7c15u;
    return static_cast<double>(mix(state_) >> 11) * 0x1p-53;
  }

private:
  std::uint64_t state_;

  [[nodiscard]] static std::uint64_t mix(std::uint64_t z) {
    z += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
};

} // namespace anistar
