#pragma once
// What stops a long call: the user, a clock, a budget.

#include <chrono>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>

namespace anistar {

enum class StopReason { finished, max_vertices, max_seconds };

/// Thrown by Monitor::insist, where what a phase has made so far is of no use.
struct BudgetSpent {};

/// Asked now and then by every long loop.
class Monitor {
public:
  /// Phase, how far it is, and vertices of the mesh, 0 while that is not known.
  using Progress = std::function<void(const std::string &, double, std::size_t)>;
  using Clock = std::chrono::steady_clock;

  Monitor(Progress progress, std::size_t max_vertices, double max_seconds)
      : progress_(std::move(progress)), max_vertices_(max_vertices),
        max_seconds_(max_seconds) {}

  /// Tells the user; may throw what the callback throws, to interrupt the call.
  void enter(const std::string &phase) {
    phase_ = phase;
    tell(0);
  }
  /// @returns false when the phase must end; cheap enough for every iteration.
  [[nodiscard]] bool keep_going(std::size_t n_vertices, double fraction) {
    if (n_vertices > 0)
      n_vertices_ = n_vertices;
    if (n_vertices >= max_vertices_)
      reason_ = StopReason::max_vertices;
    if (++calls_ % calls_between_glances == 0 && elapsed() > next_look_)
      return look(fraction);
    return reason_ == StopReason::finished;
  }
  /// The same in a loop within an item of another, which tells how far the phase is.
  [[nodiscard]] bool keep_going() { return keep_going(0, told_); }
  /// For a loop that cannot end halfway.
  /// @throws BudgetSpent when it must; that there is no room for so many vertices ends
  /// this loop only, a coarser mesh may have it.
  void insist(std::size_t n_vertices) {
    if (!has_room(n_vertices) || !keep_going())
      throw BudgetSpent{};
  }
  /// The same, looking at the clock and at the user every time: for what takes a while.
  [[nodiscard]] bool look(double fraction) {
    tell(fraction);
    note_time();
    next_look_ = elapsed() + seconds_between_looks;
    return reason_ == StopReason::finished;
  }
  /// Notes how large the mesh is, which the user hears of at the next look.
  void note_size(std::size_t n_vertices) { n_vertices_ = n_vertices; }
  /// Looks at the clock alone: after what may take long each time, as the user's own
  /// functions do.
  void note_time() {
    if (reason_ == StopReason::finished && elapsed() > max_seconds_)
      reason_ = StopReason::max_seconds;
  }
  [[nodiscard]] StopReason reason() const { return reason_; }
  [[nodiscard]] bool has_room(std::size_t n_vertices) const {
    return n_vertices < max_vertices_;
  }
  [[nodiscard]] double elapsed() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
  }

private:
  /// A glance at the clock costs as much as a cheap iteration; some iterations are a
  /// million times as expensive, so that their number says little about the time.
  static constexpr std::size_t calls_between_glances = 64;
  static constexpr double seconds_between_looks = .02;

  Progress progress_;
  std::size_t max_vertices_;
  double max_seconds_;
  Clock::time_point start_ = Clock::now();
  std::string phase_;
  std::size_t calls_ = 0;
  double next_look_ = 0;
  double told_ = 0; ///< of the phase
  std::size_t n_vertices_ = 0;
  StopReason reason_ = StopReason::finished;

  void tell(double fraction) {
    told_ = fraction;
    if (progress_)
      progress_(phase_, fraction, n_vertices_);
  }
};

} // namespace anistar
