#include "generate/facets/equal_points.h"

#include <bit>
#include <cstdint>

namespace anistar::generate {
namespace {

/// Mixes the bits of three coordinates (the finaliser of SplitMix64).
std::uint64_t hash_of(const Vector<3> &x) {
  std::uint64_t h = 0;
  for (const double coordinate : x) {
    h += std::bit_cast<std::uint64_t>(coordinate + 0.) + 0x9E3779B97F4A7C15; // no -0
    h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9;
    h = (h ^ (h >> 27)) * 0x94D049BB133111EB;
    h ^= h >> 31;
  }
  return h;
}

} // namespace

std::vector<Index> first_at_place(std::span<const Vector<3>> points) {
  // open addressing: a table at most half full, whose slots are tried one by one
  const std::size_t n_slots = std::bit_ceil(2 * points.size() + 1);
  std::vector<Index> slots(n_slots, none), first(points.size());
  for (std::size_t v = 0; v < points.size(); ++v) {
    std::size_t slot = hash_of(points[v]) & (n_slots - 1);
    while (slots[slot] != none && points[slots[slot]] != points[v])
      slot = (slot + 1) & (n_slots - 1);
    if (slots[slot] == none)
      slots[slot] = static_cast<Index>(v);
    first[v] = slots[slot];
  }
  return first;
}

} // namespace anistar::generate
