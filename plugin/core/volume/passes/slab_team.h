#pragma once
// How several threads make a pass over a volume mesh, slab by slab.

#include "base/parallel.h"
#include "volume/passes/passes.h"

#include <utility>

namespace anistar {

/// A further thread's own view and passes.
struct VolumePasses::Helper {
  Volume view;
  VolumePasses passes;

  explicit Helper(VolumePasses &first)
      : view(first.volume_.view()), passes(view, first.run_) {}
};

/// Gives the cells that are free to the slabs, for `n_items[k]` items each. The arrays
/// must not grow later on.
[[nodiscard]] std::vector<std::vector<Index>>
deal_free_cells(Volume &volume, const std::vector<std::vector<Index>> &items);

/// Visits the items of one slab. @param put_off those that want what is outside of it
template <class Visit>
void VolumePasses::visit_in_slab(std::span<const Index> items, Visit visit,
                                 std::vector<Index> &put_off) {
  for (Index item : items) {
    volume_.is_put_off = false;
    visit(*this, item);
    if (volume_.is_put_off)
      put_off.push_back(item);
  }
  volume_.is_put_off = false;
}

/// Visits items in the slabs of one round after another, each on some thread, and then
/// what was put off on the calling one. All depends on the mesh alone.
/// @param slab_of gives the slab of an item in a round
/// @param visit(passes, item) changes nothing outside of the slab of passes
template <class SlabOf, class Visit>
void VolumePasses::in_slabs(std::vector<Index> items, SlabOf slab_of, Visit visit) {
  const Slabs &slabs = volume_.state.slabs;
  const bool is_alone = slabs.n == 1 || volume_.surface.has_projection();
  for (int round = 0; round < Slabs::n_rounds && !is_alone; ++round) {
    const std::size_t n = slabs.count(round);
    std::vector<std::vector<Index>> waiting(n), put_off(n), removed(n);
    std::vector<Index> rest;
    for (Index item : items) {
      const std::size_t k = slab_of(item, round);
      (k == Slabs::nowhere ? rest : waiting[k]).push_back(item);
    }
    std::vector<std::vector<Index>> free_cells = deal_free_cells(volume_, waiting);
    const auto caller = std::this_thread::get_id();
    std::atomic<bool> stopped = run_.is_stopped();
    std::atomic<std::size_t> next = 0;
    while (std::cmp_less(team_.size() + 1, run_.threads))
      team_.push_back(std::make_shared<Helper>(*this));
    parallel_items(n, run_.threads, [&] {
      VolumePasses &passes =
          std::this_thread::get_id() == caller ? *this : team_[next++]->passes;
      return [&](std::size_t k) {
        if (std::this_thread::get_id() == caller &&
            !run_.monitor.look(static_cast<double>(k) / static_cast<double>(n)))
          stopped = true;
        if (stopped)
          return;
        Volume &view = passes.volume_;
        view.slab = slabs.slab(k, round);
        view.free_cells = std::move(free_cells[k]);
        passes.visit_in_slab(waiting[k], visit, put_off[k]);
        view.slab.reset();
        free_cells[k] = std::move(view.free_cells);
        removed[k] = std::exchange(view.removed, {});
      };
    });
    items = std::move(rest);
    const auto append = [](std::vector<Index> &to, const std::vector<Index> &from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    for (std::size_t k = 0; k < n; ++k) {
      append(items, put_off[k]);
      append(volume_.free_vertices, removed[k]);
      append(volume_.mesh.free_cells, free_cells[k]);
    }
    for (const auto &helper : team_)
      counts_ += std::exchange(helper->passes.counts_, {});
  }
  for (std::size_t k = 0; k < items.size() && go_on(k, items.size()); ++k)
    visit(*this, items[k]);
}

} // namespace anistar
