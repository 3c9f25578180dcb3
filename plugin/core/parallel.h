#pragma once
// Loops over independent items on several threads.

#include <algorithm>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace anistar {

/// Calls body(begin, end) on disjoint ranges that cover 0..n, one to a thread. What one
/// of them throws is thrown here.
template <class Body> void parallel_ranges(std::size_t n, int threads, Body body) {
  const auto n_threads = static_cast<std::size_t>(std::max(1, threads));
  if (n_threads == 1 || n < 2 * n_threads) {
    body(std::size_t{0}, n);
    return;
  }
  std::vector<std::exception_ptr> errors(n_threads);
  {
    std::vector<std::jthread> team;
    for (std::size_t k = 0; k < n_threads; ++k)
      team.emplace_back([&, k] {
        try {
          body(n * k / n_threads, n * (k + 1) / n_threads);
        } catch (...) {
          errors[k] = std::current_exception();
        }
      });
  }
  for (const std::exception_ptr &error : errors)
    if (error)
      std::rethrow_exception(error);
}

} // namespace anistar
