#pragma once
// Blocks of a mesh that threads change side by side.
//
// After renumber() the vertices follow a Hilbert curve, so that a range of them is a
// compact part of the mesh. A thread may change what lies inside its block: cells all
// of whose vertices are in the range. Cells between blocks stay as they are, so no two
// threads ever write or read the same thing; what concerns them is done afterwards, in
// order, by one thread. The blocks depend on the mesh alone, and so does the result.

#include "base/monitor.h"
#include "base/parallel.h"
#include "mesh/triangulation.h"

#include <algorithm>
#include <limits>
#include <mutex>
#include <span>

namespace anistar {

/// Vertices first <= v < last, by default all, and new ones in a range of their own.
struct VertexRange {
  Index first = 0, last = std::numeric_limits<Index>::max();
  Index first_new = 0, last_new = 0;

  [[nodiscard]] bool is_unbounded() const {
    return last == std::numeric_limits<Index>::max();
  }
  [[nodiscard]] bool contains(Index v) const {
    return (first <= v && v < last) || (first_new <= v && v < last_new);
  }
  template <std::size_t n>
  [[nodiscard]] bool contains(const std::array<Index, n> &cell) const {
    return std::all_of(cell.begin(), cell.end(), [&](Index v) { return contains(v); });
  }
};

/// Ranges of equal size that cover n vertices: few enough that little lies in between,
/// enough of them for some threads.
class Blocks {
public:
  explicit Blocks(std::size_t n_vertices)
      : n_(n_vertices),
        size_(std::max<std::size_t>(1, std::clamp(n_ / fewest, smallest, largest))) {}

  [[nodiscard]] std::size_t size() const {
    return std::max<std::size_t>(1, n_ / size_);
  }
  [[nodiscard]] VertexRange operator[](std::size_t k) const {
    return {begin(k), begin(k + 1)};
  }
  /// The block of vertex v.
  [[nodiscard]] std::size_t of(Index v) const {
    const std::size_t k = static_cast<std::size_t>(v) * size() / n_;
    return v < begin(k + 1) ? k : k + 1;
  }

private:
  static constexpr std::size_t fewest = 8, smallest = 1024, largest = 8192;
  std::size_t n_, size_;

  [[nodiscard]] Index begin(std::size_t k) const {
    return static_cast<Index>(n_ * k / size());
  }
};

/// Visits vertices block by block, side by side, each block in the given order; then on
/// the calling thread, block after block, those that were put off.
///
/// @param make gives each thread its visitor: visit(v, range) returns false, without a
/// change, when it would touch anything outside of the range or of the cells;
/// leave(block), after every block, is called by one thread at a time
/// @param last visits what was put off, with an unbounded range
/// @returns false when the monitor stopped it
template <class Make, class Visitor>
bool visit_in_blocks(const Blocks &blocks, std::span<const Index> vertices, int threads,
                     Monitor &monitor, double fraction, Make make, Visitor &last) {
  std::vector<std::vector<Index>> waiting(blocks.size()), put_off(blocks.size());
  for (Index v : vertices)
    waiting[blocks.of(v)].push_back(v);
  StopSignal stop(!monitor.look(fraction));
  std::mutex leaving;
  parallel_items(blocks.size(), threads, [&] {
    return [&, visitor = make()](std::size_t k) mutable {
      if (!stop.goes_on([&] { return monitor.look(fraction); }))
        return;
      for (Index v : waiting[k])
        if (!visitor.visit(v, blocks[k]))
          put_off[k].push_back(v);
      const std::lock_guard lock(leaving);
      visitor.leave(k);
    };
  });
  for (const std::vector<Index> &vertices_of_block : put_off)
    for (Index v : vertices_of_block) {
      if (stop.is_stopped() || !monitor.keep_going(0, fraction))
        return false;
      (void)last.visit(v, VertexRange{});
    }
  return !stop.is_stopped();
}

} // namespace anistar
