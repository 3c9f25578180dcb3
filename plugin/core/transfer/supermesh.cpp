#include "transfer/supermesh.h"

#include "base/parallel.h"
#include "mesh/hilbert.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

namespace anistar {
namespace {

/// Target cells that are assembled together, consecutive along a Hilbert curve. What
/// they give depends on nothing else, so any thread may take them.
constexpr std::size_t chunk_size = 1024;
/// Chunks a thread assembles between two looks at the user.
constexpr std::size_t chunks_per_look = 8;

struct RowEntry {
  Index row, column;
  double value;
};

/// Sums entries of equal place, by rows, with columns in order. Works in the memory of
/// its last call.
class Compressor {
public:
  Compressor(std::size_t n_rows, std::size_t n_columns)
      : row_number_(n_rows, none), slot_(n_columns, none) {}

  /// Rows in the order of their first entry. @returns their numbers.
  std::vector<Index> compress(const std::vector<RowEntry> &entries, SparseRows &out) {
    std::vector<Index> rows;
    std::vector<std::size_t> starts{0};
    for (const RowEntry &entry : entries) {
      Index &number = row_number_[entry.row];
      if (number == none) {
        number = static_cast<Index>(rows.size());
        rows.push_back(entry.row);
        starts.push_back(0);
      }
      ++starts[number + 1];
    }
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    std::vector<std::size_t> fill(starts.begin(), starts.end() - 1);
    std::vector<std::size_t> order(entries.size());
    for (std::size_t k = 0; k < entries.size(); ++k)
      order[fill[row_number_[entries[k].row]]++] = k;
    out.starts.assign(1, 0);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (std::size_t k = starts[r]; k < starts[r + 1]; ++k)
        add(entries[order[k]].column, entries[order[k]].value);
      finish_row(out);
      row_number_[rows[r]] = none;
    }
    return rows;
  }

  void add(Index column, double value) {
    Index &slot = slot_[column];
    if (slot == none) {
      slot = static_cast<Index>(row_.size());
      row_.emplace_back(column, 0.);
    }
    row_[slot].second += value;
  }

  void finish_row(SparseRows &out) {
    for (const auto &[column, value] : row_)
      slot_[column] = none;
    std::sort(row_.begin(), row_.end());
    for (const auto &[column, value] : row_) {
      out.columns.push_back(column);
      out.values.push_back(value);
    }
    out.starts.push_back(static_cast<std::int64_t>(out.columns.size()));
    row_.clear();
  }

private:
  std::vector<Index> row_number_, slot_;
  std::vector<std::pair<Index, double>> row_;
};

template <std::size_t d> struct Chunk {
  std::vector<Index> rows; ///< target points
  SparseRows points;
  std::vector<Index> targets, n_pairs; ///< target cells
  std::vector<double> uncovered, distance;
  std::vector<Index> sources; ///< of all pairs
  std::vector<double> volumes, covered;
  std::vector<Moments<d>> blocks;
};

/// The cells of one region of both meshes.
template <std::size_t d> struct Region {
  std::vector<Index> sources, targets; ///< targets in Hilbert order
  Locator<d> locator;
};

template <std::size_t d> class Assembly {
public:
  Assembly(const RegionMesh<d> &source, const RegionMesh<d> &target,
           const SupermeshSettings &settings, Monitor &monitor)
      : source_(source), target_(target), settings_(settings), monitor_(monitor),
        loads_(target.cells.size() * (d + 1) * settings.n_columns, 0.) {}

  Supermesh<d> run() {
    monitor_.enter("supermesh");
    const auto sources = by_region(source_), targets = by_region(target_);
    for (std::size_t region = 0; region < targets.size(); ++region) {
      if (targets[region].empty())
        continue;
      if (region >= sources.size() || sources[region].empty())
        throw std::invalid_argument("the source has no region " +
                                    std::to_string(region));
      assemble({sources[region], in_order(targets[region]), located(sources[region])});
    }
    return gathered();
  }

private:
  const RegionMesh<d> &source_, &target_;
  const SupermeshSettings &settings_;
  Monitor &monitor_;
  std::vector<Chunk<d>> chunks_;
  std::size_t n_done_ = 0;
  std::vector<double> loads_; ///< every target cell is written by one thread only

  static std::vector<std::vector<Index>> by_region(const RegionMesh<d> &mesh) {
    std::vector<std::vector<Index>> cells;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      const std::size_t region = mesh.regions[c];
      if (region >= cells.size())
        cells.resize(region + 1);
      cells[region].push_back(static_cast<Index>(c));
    }
    return cells;
  }

  /// A locator of some source cells, with no other points than theirs.
  Locator<d> located(const std::vector<Index> &sources) const {
    std::vector<Cell<d>> cells;
    std::vector<Index> used;
    for (const Index c : sources) {
      cells.push_back(source_.cells[c]);
      used.insert(used.end(), cells.back().begin(), cells.back().end());
    }
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    std::vector<Vector<d>> points;
    for (const Index v : used)
      points.push_back(source_.points[v]);
    for (Cell<d> &cell : cells)
      for (Index &v : cell)
        v = static_cast<Index>(std::lower_bound(used.begin(), used.end(), v) -
                               used.begin());
    return Locator<d>(points, cells);
  }

  std::vector<Index> in_order(const std::vector<Index> &targets) const {
    std::vector<Vector<d>> centroids;
    for (const Index c : targets) {
      centroids.push_back(Vector<d>::Zero());
      for (const Index v : target_.cells[c])
        centroids.back() += target_.points[v];
    }
    std::vector<Index> ordered;
    for (const Index k : hilbert_order<d>(centroids))
      ordered.push_back(targets[k]);
    return ordered;
  }

  void assemble(const Region<d> &region) {
    const std::size_t n = (region.targets.size() + chunk_size - 1) / chunk_size;
    const std::size_t first = chunks_.size();
    chunks_.resize(first + n);
    const std::size_t batch =
        chunks_per_look * static_cast<std::size_t>(std::max(1, settings_.threads));
    for (std::size_t begin = 0; begin < n; begin += batch) {
      const std::size_t count = std::min(batch, n - begin);
      parallel_ranges(count, settings_.threads, [&](std::size_t from, std::size_t to) {
        Overlay<d> overlay(region.locator);
        Compressor compressor(target_.points.size(), source_.points.size());
        for (std::size_t k = begin + from; k < begin + to; ++k)
          chunks_[first + k] = chunk(region, k, overlay, compressor);
      });
      n_done_ +=
          std::min(count * chunk_size, region.targets.size() - begin * chunk_size);
      (void)monitor_.look(static_cast<double>(n_done_) /
                          static_cast<double>(target_.cells.size()));
    }
  }

  Chunk<d> chunk(const Region<d> &region, std::size_t number, Overlay<d> &overlay,
                 Compressor &compressor) {
    Chunk<d> out;
    std::vector<RowEntry> entries;
    overlay.restart();
    const std::size_t begin = number * chunk_size;
    const std::size_t end = std::min(begin + chunk_size, region.targets.size());
    for (std::size_t k = begin; k < end; ++k) {
      const Index cell = region.targets[k];
      const Cell<d> &corners = target_.cells[cell];
      Simplex<d> simplex;
      for (std::size_t i = 0; i <= d; ++i)
        simplex[i] = target_.points[corners[i]];
      const Cover<d> &cover = overlay.cover(simplex);
      record(region, cell, cover, out);
      add_loads(region, cell, cover);
      if (settings_.points)
        collect(region, corners, cover, entries, compressor);
    }
    if (settings_.points)
      out.rows = compressor.compress(entries, out.points);
    return out;
  }

  void record(const Region<d> &region, Index cell, const Cover<d> &cover,
              Chunk<d> &out) const {
    out.targets.push_back(cell);
    out.n_pairs.push_back(static_cast<Index>(cover.overlaps.size()));
    out.uncovered.push_back(cover.uncovered);
    out.distance.push_back(cover.distance);
    for (std::size_t k = 0; k < cover.overlaps.size(); ++k) {
      const Overlap<d> &overlap = cover.overlaps[k];
      const bool is_fill = cover.filled && k + 1 == cover.overlaps.size();
      const auto sums = row_sums<d>(overlap.moments);
      out.sources.push_back(region.sources[overlap.source]);
      out.volumes.push_back(std::accumulate(sums.begin(), sums.end(), 0.));
      out.covered.push_back(is_fill ? 0 : overlap.volume);
      if (settings_.blocks)
        out.blocks.push_back(overlap.moments);
    }
  }

  void add_loads(const Region<d> &region, Index cell, const Cover<d> &cover) {
    const std::size_t width = settings_.n_columns;
    double *load = loads_.data() + cell * (d + 1) * width;
    for (const Overlap<d> &overlap : cover.overlaps) {
      const std::size_t source = region.sources[overlap.source];
      const double *values = settings_.nodal.data() + source * (d + 1) * width;
      for (std::size_t i = 0; i <= d; ++i)
        for (std::size_t j = 0; j <= d; ++j)
          for (std::size_t c = 0; c < width; ++c)
            load[i * width + c] += overlap.moments[i][j] * values[j * width + c];
    }
  }

  /// The rows of one target cell: source points are few and shared by its overlaps, so
  /// they are summed here first.
  void collect(const Region<d> &region, const Cell<d> &corners, const Cover<d> &cover,
               std::vector<RowEntry> &entries, Compressor &compressor) const {
    SparseRows row;
    for (std::size_t i = 0; i <= d; ++i) {
      row.columns.clear();
      row.values.clear();
      for (const Overlap<d> &overlap : cover.overlaps) {
        const std::size_t source = region.sources[overlap.source];
        const Cell<d> &from = source_.cells[source];
        for (std::size_t j = 0; j <= d; ++j)
          compressor.add(from[j], overlap.moments[i][j]);
      }
      compressor.finish_row(row);
      for (std::size_t k = 0; k < row.columns.size(); ++k)
        entries.push_back({corners[i], row.columns[k], row.values[k]});
    }
  }

  Supermesh<d> gathered() {
    Supermesh<d> out;
    const std::size_t n = target_.cells.size();
    out.uncovered.assign(n, 0);
    out.distance.assign(n, 0);
    out.covered.assign(source_.cells.size(), 0);
    for (const Chunk<d> &chunk : chunks_) {
      for (std::size_t k = 0; k < chunk.targets.size(); ++k) {
        const std::size_t cell = chunk.targets[k];
        out.uncovered[cell] = chunk.uncovered[k];
        out.distance[cell] = chunk.distance[k];
      }
      for (std::size_t p = 0; p < chunk.sources.size(); ++p)
        out.covered[chunk.sources[p]] += chunk.covered[p];
    }
    out.loads = std::move(loads_);
    gather_pairs(out);
    if (settings_.points)
      gather_points(out);
    return out;
  }

  void gather_pairs(Supermesh<d> &out) {
    std::vector<std::int64_t> &starts = out.pairs.starts;
    starts.assign(target_.cells.size() + 1, 0);
    for (const Chunk<d> &chunk : chunks_)
      for (std::size_t k = 0; k < chunk.targets.size(); ++k)
        starts[chunk.targets[k] + 1] = chunk.n_pairs[k];
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    const std::size_t n_pairs = starts.back();
    out.pairs.columns.resize(n_pairs);
    out.pairs.values.resize(n_pairs);
    out.blocks.resize(settings_.blocks ? n_pairs : 0);
    for (Chunk<d> &chunk : chunks_) {
      std::size_t p = 0;
      for (std::size_t k = 0; k < chunk.targets.size(); ++k) {
        std::size_t to = starts[chunk.targets[k]];
        for (Index count = 0; count < chunk.n_pairs[k]; ++count, ++p, ++to) {
          out.pairs.columns[to] = chunk.sources[p];
          out.pairs.values[to] = chunk.volumes[p];
          if (settings_.blocks)
            out.blocks[to] = chunk.blocks[p];
        }
      }
      chunk.sources = {};
      chunk.volumes = chunk.covered = {};
      chunk.blocks = {};
    }
  }

  /// Merges the rows of the chunks; those of points inside a chunk are complete.
  void gather_points(Supermesh<d> &out) {
    struct Part {
      Index row;
      std::size_t chunk, local;
    };
    std::vector<Part> parts;
    for (std::size_t c = 0; c < chunks_.size(); ++c)
      for (std::size_t r = 0; r < chunks_[c].rows.size(); ++r)
        parts.push_back({chunks_[c].rows[r], c, r});
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Part &a, const Part &b) { return a.row < b.row; });
    Compressor compressor(0, source_.points.size());
    out.points.starts.assign(1, 0);
    std::size_t p = 0;
    for (std::size_t v = 0; v < target_.points.size(); ++v) {
      for (; p < parts.size() && std::cmp_equal(parts[p].row, v); ++p) {
        const SparseRows &rows = chunks_[parts[p].chunk].points;
        const std::size_t begin = rows.starts[parts[p].local];
        const std::size_t end = rows.starts[parts[p].local + 1];
        for (std::size_t k = begin; k < end; ++k)
          compressor.add(rows.columns[k], rows.values[k]);
      }
      compressor.finish_row(out.points);
    }
  }
};

} // namespace

template <std::size_t d>
Supermesh<d> supermesh(const RegionMesh<d> &source, const RegionMesh<d> &target,
                       const SupermeshSettings &settings, Monitor &monitor) {
  return Assembly<d>(source, target, settings, monitor).run();
}

template Supermesh<2> supermesh<2>(const RegionMesh<2> &, const RegionMesh<2> &,
                                   const SupermeshSettings &, Monitor &);
template Supermesh<3> supermesh<3>(const RegionMesh<3> &, const RegionMesh<3> &,
                                   const SupermeshSettings &, Monitor &);

} // namespace anistar
