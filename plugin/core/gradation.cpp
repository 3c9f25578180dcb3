#include "gradation.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace anistar {
namespace {

/// A round takes the raised vertices whose determinant is at least this share of the
/// largest one. Dense vertices ask most of the others: to go through them first, as
/// Dijkstra does, takes 4 to 10 times fewer raises than to take all; a narrow band
/// takes more rounds. The share is relative, so that the unit of length does not
/// matter.
constexpr double band = 0.25;

/// The order of the queue; positive even where round-off eats the determinant.
template <std::size_t d> double density(const SymmetricTensor<d> &M) {
  return std::max(determinant(M), std::numeric_limits<double>::min());
}

double eighth_root(double x) { return std::sqrt(std::sqrt(std::sqrt(x))); }

/// The eigenvalues of what p asks at the end of the edge `v`.
template <std::size_t d>
Vector<d> grown(const Spectrum<d> &at, const Vector<d> &v,
                const GradationOptions &options) {
  const double length = v.norm();
  double metric_growth = 1;
  if (options.model != GrowthModel::Physical) {
    double square = 0;
    for (int k = 0; k < static_cast<int>(d); ++k) {
      const double along = at.vectors.col(k).dot(v);
      square += at.values[k] * along * along;
    }
    metric_growth += std::sqrt(square) * options.log_factor;
  }
  Vector<d> values;
  for (int k = 0; k < static_cast<int>(d); ++k) {
    double growth = metric_growth;
    if (options.model != GrowthModel::Metric)
      growth = 1 + std::sqrt(at.values[k]) * length * options.log_factor;
    if (options.model == GrowthModel::Mixed)
      growth = metric_growth * eighth_root(growth / metric_growth);
    values[k] = at.values[k] / (growth * growth);
  }
  return values;
}

template <std::size_t d> class Gradation {
public:
  Gradation(std::span<const Vector<d>> points, std::vector<SymmetricTensor<d>> metric,
            std::span<const std::int32_t> offsets,
            std::span<const std::int32_t> neighbours, const GradationOptions &options)
      : points_(points), offsets_(offsets), neighbours_(neighbours), options_(options),
        raised_(metric.size()), queue_(metric.size()) {
    for (std::size_t v = 0; v < metric.size(); ++v)
      raised_[v] = density(metric[v]);
    std::iota(queue_.begin(), queue_.end(), std::size_t{0});
    result_.metric = std::move(metric);
  }

  Graded<d> run() && {
    collect();
    while (!front_.empty()) {
      if (result_.rounds == options_.max_rounds) {
        result_.stop = GradationStop::RoundLimit;
        break;
      }
      ++result_.rounds;
      spread();
      collect();
    }
    return std::move(result_);
  }

private:
  /// The densest of the raised vertices in increasing order, with their spectra of this
  /// moment: what a round asks must not depend on what the same round has already
  /// raised.
  void collect() {
    front_.clear();
    spectra_.clear();
    double densest = 0;
    for (const std::size_t v : queue_)
      densest = std::max(densest, raised_[v]);
    std::erase_if(queue_, [&](std::size_t v) {
      const bool dense = raised_[v] >= band * densest;
      if (dense)
        front_.push_back(v);
      return dense;
    });
    std::sort(front_.begin(), front_.end());
    for (const std::size_t v : front_) {
      spectra_.push_back(spectrum(result_.metric[v]));
      raised_[v] = 0;
    }
  }

  void spread() {
    for (std::size_t i = 0; i < front_.size(); ++i) {
      const std::size_t p = front_[i];
      for (auto k = offsets_[p]; k < offsets_[p + 1]; ++k) {
        const auto q = static_cast<std::size_t>(neighbours_[k]);
        const Vector<d> values =
            grown<d>(spectra_[i], points_[q] - points_[p], options_);
        if (raise(result_.metric[q], compose<d>(values, spectra_[i].vectors),
                  options_.tolerance)) {
          if (raised_[q] == 0)
            queue_.push_back(q);
          raised_[q] = density(result_.metric[q]);
          ++result_.updates;
        }
      }
    }
  }

  std::span<const Vector<d>> points_;
  std::span<const std::int32_t> offsets_, neighbours_;
  GradationOptions options_;
  std::vector<double> raised_; // densities of the raised vertices, else zero
  std::vector<std::size_t> queue_, front_;
  std::vector<Spectrum<d>> spectra_;
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
