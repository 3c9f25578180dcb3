#pragma once
// Loops over independent items on several threads.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>
#include <utility>
#include <vector>

namespace anistar {

/// Calls body(k) for 0 <= k < n on n threads at once, k = 0 on the calling one. What
/// one of them throws is thrown here, that of the smallest k first.
template <class Body> void on_threads(std::size_t n, Body body) {
  std::vector<std::exception_ptr> errors(n);
  const auto run = [&](std::size_t k) {
    try {
      body(k);
    } catch (...) {
      errors[k] = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> team;
    for (std::size_t k = 1; k < n; ++k)
      team.emplace_back(run, k);
    run(0);
  }
  for (const std::exception_ptr &error : errors)
    if (error)
      std::rethrow_exception(error);
}

/// Calls body(begin, end) on disjoint ranges that cover 0..n, one to a thread.
template <class Body> void parallel_ranges(std::size_t n, int threads, Body body) {
  const auto n_threads = static_cast<std::size_t>(std::max(1, threads));
  if (n_threads == 1 || n < n_threads) {
    body(std::size_t{0}, n);
    return;
  }
  on_threads(n_threads,
             [&](std::size_t k) { body(n * k / n_threads, n * (k + 1) / n_threads); });
}

/// Every thread calls make() once and what that returns with one item 0 <= k < n after
/// another, always the next one that nobody has taken: for items of uneven size.
template <class Make> void parallel_items(std::size_t n, int threads, Make make) {
  std::atomic<std::size_t> next = 0;
  on_threads(std::clamp(static_cast<std::size_t>(threads), std::size_t{1},
                        std::max(n, std::size_t{1})),
             [&](std::size_t) {
               auto work = make();
               try {
                 for (std::size_t k = next++; k < n; k = next++)
                   work(k);
               } catch (...) {
                 next = n; // the others need not go on
                 throw;
               }
             });
}

/// Ends a loop on several threads. Only the thread that made it looks whether to: what
/// is asked then, a function of the user among it, is not called from any other.
class StopSignal {
public:
  explicit StopSignal(bool is_stopped = false) : is_stopped_(is_stopped) {}

  [[nodiscard]] bool is_caller() const { return std::this_thread::get_id() == caller_; }
  /// Asks look() on the thread that may. @returns whether the loop goes on.
  template <class Look> bool goes_on(Look look) {
    if (is_caller() && !look())
      is_stopped_ = true;
    return !is_stopped_;
  }
  [[nodiscard]] bool is_stopped() const { return is_stopped_; }

private:
  std::thread::id caller_ = std::this_thread::get_id();
  std::atomic<bool> is_stopped_;
};

/// Calls body(begin, end) on ranges that cover 0..n, each a moment's work, and between
/// them look(fraction done) on the calling thread: what that throws ends the loop, and
/// so does false.
template <class Look, class Body>
void watched_ranges(std::size_t n, int threads, const Look &look, Body body) {
  constexpr std::size_t grain = 1 << 12;
  const std::size_t n_parts = (n + grain - 1) / grain;
  StopSignal stop;
  parallel_items(n_parts, threads, [&] {
    return [&](std::size_t part) {
      if (stop.goes_on([&] { return look(double(part) / double(n_parts)); }))
        body(part * grain, std::min(n, (part + 1) * grain));
    };
  });
}

/// The items that visit(k, add) adds for 0 <= k < n, in the order of k.
template <class Item, class Visit>
[[nodiscard]] std::vector<Item> parallel_search(std::size_t n, int threads,
                                                Visit visit) {
  constexpr std::size_t grain = 1 << 14;
  const std::size_t n_parts = (n + grain - 1) / grain;
  std::vector<std::vector<Item>> parts(n_parts);
  parallel_items(n_parts, threads, [&] {
    return [&](std::size_t part) {
      const auto add = [&](const Item &item) { parts[part].push_back(item); };
      for (std::size_t k = part * grain; k < std::min(n, (part + 1) * grain); ++k)
        visit(k, add);
    };
  });
  std::vector<Item> found;
  for (const std::vector<Item> &part : parts)
    found.insert(found.end(), part.begin(), part.end());
  return found;
}

/// Sorts values no two of which are equal.
template <class Value> void parallel_sort(std::vector<Value> &values, int threads) {
  const std::size_t n = values.size();
  std::size_t n_parts = 1;
  while (std::cmp_less(n_parts, threads) && n / n_parts > (1 << 14))
    n_parts *= 2;
  const auto at = [&](std::size_t part) {
    return values.begin() + static_cast<std::ptrdiff_t>(n * part / n_parts);
  };
  parallel_ranges(n_parts, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      std::sort(at(k), at(k + 1));
  });
  for (std::size_t width = 1; width < n_parts; width *= 2)
    parallel_items(n_parts / (2 * width), threads, [&] {
      return [&](std::size_t pair) {
        const std::size_t k = 2 * width * pair;
        std::inplace_merge(at(k), at(k + width), at(k + 2 * width));
      };
    });
}

} // namespace anistar
