#pragma once
// Finds the number of an edge by its two ends.

#include "mesh/adjacency.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace anistar::generate {

/// A hash table with linear probing; nothing depends on the order of its slots.
class EdgeTable {
public:
  void reserve(std::size_t n) {
    std::size_t size = least_size;
    while (size < 2 * n)
      size *= 2;
    if (size > slots_.size())
      rebuild(size);
  }
  /// The number of the edge, `none` if it is not in the table.
  [[nodiscard]] Index find(Index a, Index b) const {
    return slots_.empty() ? none : slots_[place_of(key_of(a, b))].number;
  }
  /// Gives an edge a number, in place of the one that it had.
  void put(Index a, Index b, Index number) {
    reserve(n_ + 1);
    Slot &slot = slots_[place_of(key_of(a, b))];
    n_ += slot.number == none;
    slot = {key_of(a, b), number};
  }
  void erase(Index a, Index b) {
    std::size_t hole = place_of(key_of(a, b));
    if (slots_[hole].number == none)
      return;
    --n_;
    // what the probing has pushed behind the hole moves up
    for (std::size_t next = after(hole); slots_[next].number != none;
         next = after(next)) {
      const std::size_t wanted = home_of(slots_[next].key);
      if (distance(wanted, next) >= distance(hole, next)) {
        slots_[hole] = slots_[next];
        hole = next;
      }
    }
    slots_[hole].number = none;
  }

private:
  static constexpr std::size_t least_size = 64;
  struct Slot {
    std::uint64_t key = 0;
    Index number = none;
  };
  std::vector<Slot> slots_; ///< a power of two
  std::size_t n_ = 0;

  [[nodiscard]] static std::uint64_t key_of(Index a, Index b) {
    const auto [low, high] = std::minmax(a, b);
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(low)) << 32 |
           static_cast<std::uint32_t>(high);
  }
  [[nodiscard]] std::size_t after(std::size_t place) const {
    return (place + 1) & (slots_.size() - 1);
  }
  [[nodiscard]] std::size_t distance(std::size_t from, std::size_t to) const {
    return (to - from) & (slots_.size() - 1);
  }
  [[nodiscard]] std::size_t home_of(std::uint64_t key) const {
    key *= 0x9e3779b97f4a7c15u;
    return (key ^ key >> 32) & (slots_.size() - 1);
  }
  [[nodiscard]] std::size_t place_of(std::uint64_t key) const {
    std::size_t place = home_of(key);
    while (slots_[place].number != none && slots_[place].key != key)
      place = after(place);
    return place;
  }
  void rebuild(std::size_t size) {
    std::vector<Slot> old(size);
    old.swap(slots_);
    for (const Slot &slot : old)
      if (slot.number != none)
        slots_[place_of(slot.key)] = slot;
  }
};

} // namespace anistar::generate
