#pragma once
// What waits for rules 1, 2 and 3, in that order of priority.

#include "generate/refinement/mesh/walled_mesh.h"

#include <deque>
#include <optional>
#include <queue>

namespace anistar::generate {

struct WaitingEdge {
  Segment edge;
  int tries = 0; ///< that have failed for what was in the way
};

/// A wall by its vertices, and where it was seen.
struct WaitingFacet {
  Facet<3> vertices;
  Index cell;
};

/// A cell by its place and birth, the worst one first.
struct WaitingCell {
  float badness;
  Index cell;
  std::uint32_t birth;

  friend bool operator<(const WaitingCell &a, const WaitingCell &b) {
    return a.badness != b.badness ? a.badness < b.badness : a.birth > b.birth;
  }
};

class CellQueue {
public:
  void push(const WalledMesh &mesh, Index c, double badness) {
    cells_.push({static_cast<float>(badness), c, mesh.birth[c]});
  }
  /// The worst one that still lives.
  [[nodiscard]] std::optional<Index> pop(const WalledMesh &mesh) {
    while (!cells_.empty()) {
      const WaitingCell top = cells_.top();
      cells_.pop();
      if (mesh.is_alive(top.cell) && mesh.birth[top.cell] == top.birth)
        return top.cell;
    }
    return {};
  }
  [[nodiscard]] std::size_t size() const { return cells_.size(); }

private:
  std::priority_queue<WaitingCell> cells_;
};

/// First in, first out.
template <class Item> class Line {
public:
  void push(const Item &item) { items_.push_back(item); }
  [[nodiscard]] std::optional<Item> pop() {
    if (items_.empty())
      return {};
    const Item first = items_.front();
    items_.pop_front();
    return first;
  }
  [[nodiscard]] std::size_t size() const { return items_.size(); }

private:
  std::deque<Item> items_;
};

struct Queues {
  Line<WaitingEdge> edges;
  Line<WaitingFacet> facets;
  CellQueue cells;
  CellQueue slivers;

  [[nodiscard]] std::size_t size() const {
    return edges.size() + facets.size() + cells.size() + slivers.size();
  }
};

} // namespace anistar::generate
