#include "plane/geometry/length_table.h"

#include <algorithm>
#include <cmath>

namespace anistar {
namespace {

/// Pieces of a curve over which its metric length is taken by the trapezium-like rule
/// of mean_length: short against the unit edge.
constexpr double sample_length = .25;
/// A piece is halved where its halves add up to another length, by this part of the
/// above.
constexpr double largest_error = .05;
constexpr int max_sample_depth = 24;

/// Where the piecewise linear function through (x, y) takes the value y for x = at.
double interpolated(const std::vector<double> &x, const std::vector<double> &y,
                    double at) {
  const auto above = std::upper_bound(x.begin() + 1, x.end() - 1, at);
  const std::size_t k = above - x.begin();
  const double width = x[k] - x[k - 1];
  const double r = width > 0 ? (at - x[k - 1]) / width : 0;
  return y[k - 1] + r * (y[k] - y[k - 1]);
}

struct Sampler {
  const Curve &curve;
  const Background<2> &background;
  double limit;
  std::size_t n_vertices;
  Monitor &monitor;
  LengthTable table{};
  Index hint = none;

  Vertex<2> sample(double t) { return background.vertex(curve.at(t), hint); }

  /// A frozen curve needs its own points, however long it is.
  void look() const {
    const double needed = curve.is_frozen ? 0 : std::min(table.total(), limit);
    monitor.insist(n_vertices + static_cast<std::size_t>(needed));
  }

  void piece(double t0, const Vertex<2> &a, double t1, const Vertex<2> &b, int depth) {
    look();
    const double whole = edge_length(a, b);
    const double t = .5 * (t0 + t1);
    if (depth < max_sample_depth && table.total() < limit) {
      const Vertex<2> m = sample(t);
      const double halves = edge_length(a, m) + edge_length(m, b);
      if (halves > sample_length ||
          std::abs(halves - whole) > largest_error * sample_length) {
        piece(t0, a, t, m, depth + 1);
        piece(t, m, t1, b, depth + 1);
        return;
      }
    }
    table.parameter.push_back(t1);
    table.length.push_back(table.total() + whole);
  }

  LengthTable run() {
    Vertex<2> a = sample(0);
    for (std::size_t k = 0; k < curve.n_segments(); ++k) {
      const double t = static_cast<double>(k);
      const Vertex<2> b = sample(t + 1);
      piece(t, a, t + 1, b, 0);
      a = b;
    }
    return std::move(table);
  }
};

} // namespace

double LengthTable::parameter_at(double s) const {
  return interpolated(length, parameter, s);
}

double LengthTable::length_at(double t) const {
  return interpolated(parameter, length, t);
}

LengthTable tabulate_length(const Curve &curve, const Background<2> &background,
                            double limit, std::size_t n_vertices, Monitor &monitor) {
  return Sampler{curve, background, limit, n_vertices, monitor}.run();
}

} // namespace anistar
