#pragma once
// How several threads make a pass over a volume mesh, slab by slab (see
// volume/mesh/slabs.h).

#include "base/parallel.h"
#include "base/run.h"
#include "volume/mesh/volume.h"

#include <deque>

namespace anistar {

/// What concerns one slab in one round.
struct SlabWork {
  std::vector<Index> waiting;    ///< items to visit
  std::vector<Index> put_off;    ///< those that want what is outside of it
  std::vector<Index> free_cells; ///< that it may use
  std::vector<Index> removed;    ///< vertices
};

/// Gives the cells that are free to the slabs, as the items that wait may need them.
/// The arrays must not grow later on.
void deal_free_cells(Volume &volume, std::vector<SlabWork> &work);
/// Gives back what the slabs have left. @returns the items that were put off
[[nodiscard]] std::vector<Index> collect(Volume &volume,
                                         const std::vector<SlabWork> &work);

/// Threads with a view of the volume and a visitor each: visit(item) changes nothing
/// outside of the slab of the view, `counts` is what it has done and can be added up.
template <class Visitor> class SlabTeam {
public:
  using Counts = decltype(Visitor::counts);

  /// @param make(view) makes a visitor
  template <class Make>
  SlabTeam(Volume &volume, const Run &run, Make make) : volume_(volume), run_(run) {
    members_.emplace_back(volume, make);
    for (int k = 1; k < run.threads && !is_alone(); ++k)
      members_.emplace_back(views_.emplace_back(volume.view()), make);
  }

  /// Visits items in the slabs of one round after another, each on some thread, and
  /// then what was put off on the calling one. All depends on the mesh alone.
  /// @param slab_of(item, round) gives the slab of an item
  /// @returns what was done
  template <class SlabOf> Counts visit(std::vector<Index> items, SlabOf slab_of) {
    for (int round = 0; round < Slabs::n_rounds && !is_alone(); ++round)
      items = visit_round(items, slab_of, round);
    for (std::size_t k = 0; k < items.size() && run_.goes_on(k, items.size()); ++k)
      first().visit(items[k]);
    Counts counts{};
    for (const Member &member : members_)
      counts += member.visitor.counts;
    return counts;
  }
  /// The visitor of the calling thread.
  [[nodiscard]] Visitor &first() { return members_.front().visitor; }

private:
  struct Member {
    Volume &view;
    Visitor visitor;

    template <class Make>
    Member(Volume &seen, Make make) : view(seen), visitor(make(seen)) {}

    void visit(SlabWork &work, Slab slab) {
      view.slab = slab;
      view.free_cells = std::move(work.free_cells);
      for (Index item : work.waiting) {
        view.is_put_off = false;
        visitor.visit(item);
        if (view.is_put_off)
          work.put_off.push_back(item);
      }
      view.is_put_off = false;
      view.slab.reset();
      work.free_cells = std::move(view.free_cells);
      work.removed = std::exchange(view.removed, {});
    }
  };

  Volume &volume_;
  const Run &run_;
  std::deque<Volume> views_; ///< of all threads but the calling one
  std::deque<Member> members_;

  [[nodiscard]] bool is_alone() const {
    return volume_.state.slabs.n == 1 || volume_.surface.has_projection();
  }

  /// @returns what has no slab in this round, or was put off.
  template <class SlabOf>
  [[nodiscard]] std::vector<Index> visit_round(const std::vector<Index> &items,
                                               SlabOf slab_of, int round) {
    const Slabs &slabs = volume_.state.slabs;
    std::vector<SlabWork> work(slabs.count(round));
    std::vector<Index> rest;
    for (Index item : items) {
      const std::size_t k = slab_of(item, round);
      (k == Slabs::nowhere ? rest : work[k].waiting).push_back(item);
    }
    deal_free_cells(volume_, work);
    StopSignal stop(run_.is_stopped());
    std::atomic<std::size_t> next = 1;
    parallel_items(work.size(), run_.threads, [&] {
      Member &member = members_[stop.is_caller() ? 0 : next++];
      return [&](std::size_t k) {
        if (stop.goes_on([&] { return run_.look(k, work.size()); }))
          member.visit(work[k], slabs.slab(k, round));
      };
    });
    const std::vector<Index> put_off = collect(volume_, work);
    rest.insert(rest.end(), put_off.begin(), put_off.end());
    return rest;
  }
};

} // namespace anistar
