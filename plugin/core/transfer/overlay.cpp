#include "transfer/overlay.h"

#include "mesh/measures.h"

#include <algorithm>
#include <numeric>

namespace anistar {
namespace {

/// An overlap by less than this part of the smaller cell is round-off of the clipping.
constexpr double overlap_round_off = 1e-13;

template <std::size_t d> Box<d> box_of(const Simplex<d> &s) {
  Box<d> box;
  for (const Vector<d> &corner : s)
    box.extend(corner);
  return box;
}

template <std::size_t d> double total(const std::array<double, d> &terms) {
  return std::accumulate(terms.begin(), terms.end(), 0.);
}

template <std::size_t d>
void add_product(Moments<d> &moments, const std::array<double, d + 1> &rows,
                 const std::array<double, d + 1> &columns) {
  for (std::size_t i = 0; i <= d; ++i)
    for (std::size_t j = 0; j <= d; ++j)
      moments[i][j] += rows[i] * columns[j];
}

/// Barycentric coordinates in the source of the centroid of an overlap.
template <std::size_t d>
std::array<double, d + 1> source_centroid(const Overlap<d> &overlap) {
  std::array<double, d + 1> mean{};
  for (const auto &row : overlap.moments)
    for (std::size_t j = 0; j <= d; ++j)
      mean[j] += row[j];
  const double sum = total(mean);
  for (double &coordinate : mean)
    coordinate /= sum;
  return mean;
}

} // namespace

template <std::size_t d>
Overlay<d>::Overlay(const Locator<d> &source)
    : source_(&source), seen_(source.cells().size(), none) {}

template <std::size_t d> const Cover<d> &Overlay<d>::cover(const Simplex<d> &target) {
  cover_.overlaps.clear();
  cover_.uncovered = cover_.distance = 0;
  cover_.filled = false;
  ++visit_;
  const double volume = anistar::volume<d>(target);
  const Box<d> box = box_of<d>(target);
  advance(target, box, volume);
  if (total(gap(volume)) > coverage_round_off * volume)
    source_->cell_tree().meeting(box, [&](Index cell) {
      try_cell(target, box, volume, cell, false);
      return true;
    });
  std::sort(cover_.overlaps.begin(), cover_.overlaps.end(),
            [](const auto &a, const auto &b) { return a.source < b.source; });
  close_gap(target, volume);
  return cover_;
}

template <std::size_t d>
void Overlay<d>::advance(const Simplex<d> &target, const Box<d> &box, double volume) {
  Vector<d> centroid = Vector<d>::Zero();
  for (const Vector<d> &corner : target)
    centroid += corner / (d + 1);
  hint_ = source_->locate(centroid, hint_).cell;
  front_.clear();
  try_cell(target, box, volume, hint_, true);
  while (!front_.empty()) {
    const Index cell = front_.back();
    front_.pop_back();
    try_cell(target, box, volume, cell, true);
  }
}

/// Adds the overlap with a source cell; with `spread`, and if there is one, the
/// neighbours beyond whose facets the target reaches join the front.
template <std::size_t d>
bool Overlay<d>::try_cell(const Simplex<d> &target, const Box<d> &box, double volume,
                          Index cell, bool spread) {
  Index &seen = seen_[cell];
  if (seen == visit_)
    return false;
  seen = visit_;
  const Simplex<d> source = source_->simplex(cell);
  if (!box.meets(box_of<d>(source)))
    return false;
  const Sides<d> at = sides<d>(target, source);
  for (const auto &row : at)
    if (*std::max_element(row.begin(), row.end()) <= 0)
      return false;
  Overlap<d> overlap{cell, intersection_moments<d>(at, volume), 0};
  overlap.volume = total(row_sums<d>(overlap.moments));
  if (!(overlap.volume >
        overlap_round_off * std::min(volume, anistar::volume<d>(source))))
    return false;
  cover_.overlaps.push_back(overlap);
  if (spread)
    for (std::size_t j = 0; j <= d; ++j) {
      const Index beyond = source_->neighbours()[cell][j].cell();
      if (beyond != none && seen_[beyond] != visit_ &&
          *std::min_element(at[j].begin(), at[j].end()) < 0)
        front_.push_back(beyond);
    }
  return true;
}

/// Integrals of the target's barycentric coordinates over what is not covered.
template <std::size_t d>
std::array<double, d + 1> Overlay<d>::gap(double volume) const {
  std::array<double, d + 1> open;
  open.fill(volume / (d + 1));
  for (const Overlap<d> &overlap : cover_.overlaps) {
    const auto covered = row_sums<d>(overlap.moments);
    for (std::size_t i = 0; i <= d; ++i)
      open[i] -= covered[i];
  }
  return open;
}

template <std::size_t d>
void Overlay<d>::close_gap(const Simplex<d> &target, double volume) {
  const auto open = gap(volume);
  const double size = total(open);
  if (size <= coverage_round_off * volume && !cover_.overlaps.empty()) {
    auto &largest = *std::max_element(
        cover_.overlaps.begin(), cover_.overlaps.end(),
        [](const auto &a, const auto &b) { return a.volume < b.volume; });
    add_product<d>(largest.moments, open, source_centroid<d>(largest));
    return;
  }
  Vector<d> middle = Vector<d>::Zero();
  for (std::size_t i = 0; i <= d; ++i)
    middle += std::max(0., open[i]) * target[i];
  double positive = 0;
  for (const double part : open)
    positive += std::max(0., part);
  middle /= positive;
  const Location<d> nearest = source_->locate(middle, none);
  Overlap<d> fill{nearest.cell, {}, size};
  add_product<d>(fill.moments, open, nearest.barycentric);
  cover_.overlaps.push_back(fill);
  cover_.uncovered = size;
  cover_.distance = nearest.distance;
  cover_.filled = true;
}

template class Overlay<2>;
template class Overlay<3>;

} // namespace anistar
