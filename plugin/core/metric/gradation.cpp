#include "metric/gradation.h"

#include <algorithm>
#include <limits>

namespace anistar {
namespace {

/// Buckets of the queue per factor 2 of the determinant. Dense vertices ask most of the
/// others: to go through them first, as Dijkstra does, takes several times fewer raises
/// than to take all. Thinner buckets save a few raises more, and cost many rounds.
constexpr double buckets_per_octave = 2;
/// Shifts the borders of the buckets away from the powers of two of round sizes.
constexpr double bucket_shift = 0.17;
/// The last bucket takes what is beyond: 2^-1000 of the largest determinant.
constexpr double last_bucket = 1000 * buckets_per_octave;
/// Determinants count as equal when their logarithms are, to this many parts of one:
/// symmetric places are then taken in the order of their points, whatever round-off
/// does.
constexpr double log_steps = 1 << 20;
/// Share of the entries by which round-off can shift the leading minors, with a margin.
constexpr double minor_error = 1e-13;
/// Error of the eigenvalues of a tensor that is taken apart and put together, relative
/// to the largest: some units of round-off.
constexpr double spectrum_error = 8 * std::numeric_limits<double>::epsilon();

/// Vertices that ask between two looks at the user: some hundredths of a second.
constexpr std::size_t looks_every = 1 << 14;

/// The order of the queue; positive even where round-off eats the determinant.
template <std::size_t d> double density(const SymmetricTensor<d> &M) {
  return std::max(determinant(M), std::numeric_limits<double>::min());
}

double eighth_root(double x) { return std::sqrt(std::sqrt(std::sqrt(x))); }

template <std::size_t d> double trace(const SymmetricTensor<d> &M) {
  double sum = 0;
  for (std::size_t i = 0; i < d; ++i)
    sum += M(i, i);
  return sum;
}

/// Whether M - N is positive definite, with leading minors beyond all round-off. Most
/// requests end here; the others take the careful way of `raise`.
template <std::size_t d>
bool is_clearly_below(const SymmetricTensor<d> &N, const SymmetricTensor<d> &M) {
  const SymmetricTensor<d> D = M + -1.0 * N;
  const double size = trace(D);
  double error = minor_error * trace(M);
  if (!(D(0, 0) > error))
    return false;
  error *= size;
  if (!(D(0, 0) * D(1, 1) - D(0, 1) * D(0, 1) > error))
    return false;
  if constexpr (d == 2)
    return true;
  else
    return determinant(D) > error * size;
}

/// Whether the density of a raised metric grew, by the pivots of its factor. Round-off
/// eats what is added far below the largest eigenvalue: the same would be asked again
/// and again. What grows each time comes to an end, and soon where the growth is no
/// round-off of the smallest eigenvalue, which neighbours would hand to each other.
template <std::size_t d>
bool is_denser(const SymmetricTensor<d> &raised, const SymmetricTensor<d> &before,
               double tolerance) {
  const Matrix<d> after = lower_factor(raised), L = lower_factor(before);
  double growth = 1, least = L(0, 0), largest = least;
  for (int i = 0; i < static_cast<int>(d); ++i) {
    growth *= after(i, i) / L(i, i);
    least = std::min(least, L(i, i));
    largest = std::max(largest, L(i, i));
  }
  const double ratio = largest / least;
  // a quarter is half of what the square root must grow by
  return growth > 1 + std::max(.25 * tolerance, spectrum_error * ratio * ratio);
}

template <std::size_t d> class Gradation {
public:
  Gradation(std::span<const Vector<d>> points, std::vector<SymmetricTensor<d>> metric,
            std::span<const std::int32_t> offsets,
            std::span<const std::int32_t> neighbours, const GradationOptions &options)
      : points_(points), offsets_(offsets), neighbours_(neighbours), options_(options),
        bucket_(metric.size(), idle), queue_(std::size_t(last_bucket) + 1) {
    result_.metric = std::move(metric);
    for (const auto &M : result_.metric)
      densest_ = std::max(densest_, density(M));
    for (std::size_t v = 0; v < result_.metric.size(); ++v)
      enqueue(v);
  }

  Graded<d> run() && {
    while (collect()) {
      if (result_.rounds == options_.max_rounds) {
        result_.stop = GradationStop::RoundLimit;
        break;
      }
      ++result_.rounds;
      for (const Asking &asking : front_)
        spread(asking);
    }
    return std::move(result_);
  }

private:
  static constexpr std::size_t idle = std::numeric_limits<std::size_t>::max();

  /// A vertex of the front, as it was before the round raised any other: what a round
  /// asks must not depend on what the same round has already raised.
  struct Asking {
    std::size_t vertex;
    double order;
    SymmetricTensor<d> metric;
    Spectrum<d> spectrum;
  };

  /// Metrics only grow, so a vertex can only move to an earlier bucket; the entry it
  /// leaves behind no longer matches and is passed over.
  void enqueue(std::size_t v) {
    const double octaves = elementary::log2(densest_ / density(result_.metric[v]));
    const auto bucket = static_cast<std::size_t>(
        std::clamp(octaves * buckets_per_octave + bucket_shift, 0.0, last_bucket));
    if (bucket == bucket_[v])
      return;
    bucket_[v] = bucket;
    queue_[bucket].push_back(v);
    first_ = std::min(first_, bucket);
  }

  /// Takes the densest bucket of the queue, the densest vertex first.
  bool collect() {
    front_.clear();
    for (; front_.empty() && first_ < queue_.size(); ++first_) {
      for (const std::size_t v : queue_[first_])
        if (bucket_[v] == first_) {
          bucket_[v] = idle;
          front_.push_back(asking(v));
        }
      queue_[first_].clear();
    }
    std::sort(front_.begin(), front_.end(), [&](const Asking &a, const Asking &b) {
      if (a.order != b.order)
        return a.order > b.order;
      const Vector<d> &x = points_[a.vertex], &y = points_[b.vertex];
      return std::lexicographical_compare(x.begin(), x.end(), y.begin(), y.end());
    });
    return !front_.empty();
  }

  Asking asking(std::size_t v) const {
    const SymmetricTensor<d> &M = result_.metric[v];
    const double order = std::rint(elementary::log(density(M)) * log_steps);
    return {v, order, M, needs_spectrum() ? spectrum(M) : Spectrum<d>{}};
  }

  [[nodiscard]] bool needs_spectrum() const {
    return options_.model == GrowthModel::Physical ||
           options_.model == GrowthModel::Mixed;
  }

  void spread(const Asking &asking) {
    if (++spread_ % looks_every == 0)
      options_.look();
    const std::size_t p = asking.vertex;
    for (auto k = offsets_[p]; k < offsets_[p + 1]; ++k) {
      const std::size_t q = neighbours_[k];
      const SymmetricTensor<d> request = grown(asking, points_[q] - points_[p]);
      SymmetricTensor<d> &M = result_.metric[q];
      if (is_clearly_below(request, M))
        continue;
      SymmetricTensor<d> raised = M;
      if (!raise(raised, request, options_.tolerance) ||
          !is_denser(raised, M, options_.tolerance))
        continue;
      M = raised;
      enqueue(q);
      ++result_.updates;
    }
  }

  /// What a vertex asks at the end of the edge `v`.
  [[nodiscard]] SymmetricTensor<d> grown(const Asking &at, const Vector<d> &v) const {
    const double metric_length = std::sqrt(quadratic(at.metric, v));
    const double metric_growth = 1 + metric_length * options_.log_factor;
    const double bound = 1 + metric_length * options_.max_distortion;
    if (!needs_spectrum()) {
      const double growth = options_.model == GrowthModel::Metric
                                ? std::min(metric_growth, bound)
                                : bound;
      return 1 / (growth * growth) * at.metric;
    }
    const double length = v.norm();
    Vector<d> values = at.spectrum.values;
    for (double &value : values) {
      value = std::max(value, 0.0); // round-off may make the smallest negative
      double growth = 1 + std::sqrt(value) * length * options_.log_factor;
      if (options_.model == GrowthModel::Mixed)
        growth = metric_growth * eighth_root(growth / metric_growth);
      growth = std::min(growth, bound);
      value /= growth * growth;
    }
    return compose<d>(values, at.spectrum.vectors);
  }

  std::span<const Vector<d>> points_;
  std::span<const std::int32_t> offsets_, neighbours_;
  GradationOptions options_;
  double densest_ = 0;
  std::vector<std::size_t> bucket_; // where each vertex is queued, or idle
  std::vector<std::vector<std::size_t>> queue_;
  std::size_t first_ = 0; // no bucket before it has entries
  std::vector<Asking> front_;
  std::size_t spread_ = 0;
  Graded<d> result_;
};

} // namespace

template <std::size_t d>
Graded<d>
graded(std::span<const Vector<d>> points, std::vector<SymmetricTensor<d>> metric,
       std::span<const std::int32_t> offsets, std::span<const std::int32_t> neighbours,
       const GradationOptions &options) {
  return Gradation<d>(points, std::move(metric), offsets, neighbours, options).run();
}

template Graded<2> graded<2>(std::span<const Vector<2>>,
                             std::vector<SymmetricTensor<2>>,
                             std::span<const std::int32_t>,
                             std::span<const std::int32_t>, const GradationOptions &);
template Graded<3> graded<3>(std::span<const Vector<3>>,
                             std::vector<SymmetricTensor<3>>,
                             std::span<const std::int32_t>,
                             std::span<const std::int32_t>, const GradationOptions &);

} // namespace anistar
