#include "certificate/sharp_corners.h"

#include <algorithm>
#include <map>
#include <numbers>

namespace anistar {
namespace {

constexpr double sharp_angle = std::numbers::pi / 6;
/// Of a cone whose opposite sides form the sharp angle.
const double sharp_solid_angle =
    2 * std::numbers::pi * (1 - elementary::sine_cosine(sharp_angle / 2).cosine);
constexpr int max_exempt = 8;

/// The angle between two vectors of any length (Kahan).
template <std::size_t d> double angle_between(const Vector<d> &u, const Vector<d> &v) {
  const Vector<d> p = u * v.norm(), q = v * u.norm();
  return 2 * elementary::angle_of((p - q).norm(), (p + q).norm());
}

/// The solid angle of a, b, c seen from the origin (Van Oosterom and Strackee, 1983).
double solid_angle(const Vector<3> &a, const Vector<3> &b, const Vector<3> &c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * elementary::angle_of(std::abs(a.dot(b.cross(c))),
                                  la * lb * lc + a.dot(b) * lc + b.dot(c) * la +
                                      c.dot(a) * lb);
}

/// The vertices of a cell but i and j: what two facets share.
template <std::size_t d> using Hinge = std::array<Index, d - 1>;

template <std::size_t d> class SharpCorners {
public:
  SharpCorners(const CertifiedMesh<d> &mesh, std::span<const std::uint8_t> star_ok)
      : mesh_(mesh), star_ok_(star_ok), exempt_(mesh.vertices.size(), 0) {}

  std::vector<std::uint8_t> run() {
    for (std::size_t c = 0; c < mesh_.cells.size(); ++c)
      for (std::size_t i = 0; i <= d; ++i)
        if (is_wall(static_cast<Index>(c), i))
          for (std::size_t j = 0; j <= d; ++j)
            if (j != i && turns_forward(static_cast<Index>(c), i, j))
              try_sector(static_cast<Index>(c), i, j);
    if constexpr (d == 3)
      try_tips();
    return std::move(exempt_);
  }

private:
  const CertifiedMesh<d> &mesh_;
  std::span<const std::uint8_t> star_ok_;
  std::vector<std::uint8_t> exempt_;
  std::map<Hinge<d>, int> exempt_at_; ///< vertices exempt at each corner so far

  [[nodiscard]] const Vector<d> &x(Index v) const { return mesh_.vertices[v].x; }
  [[nodiscard]] const Cell<d> &cell_at(Index c) const { return mesh_.cells[c]; }
  [[nodiscard]] bool is_wall(Index c, std::size_t i) const {
    return mesh_.constraints[c][i] != none;
  }
  [[nodiscard]] static std::size_t local(const Cell<d> &cell, Index v) {
    return static_cast<std::size_t>(std::find(cell.begin(), cell.end(), v) -
                                    cell.begin());
  }

  [[nodiscard]] Hinge<d> hinge(Index c, std::size_t i, std::size_t j) const {
    Hinge<d> out{};
    std::size_t n = 0;
    for (std::size_t k = 0; k <= d; ++k)
      if (k != i && k != j)
        out[n++] = cell_at(c)[k];
    std::sort(out.begin(), out.end());
    return out;
  }

  /// Of the two senses around a hinge, one: every sector is entered from one wall only.
  [[nodiscard]] bool turns_forward(Index c, std::size_t i, std::size_t j) const {
    if constexpr (d == 2) {
      return (i + 1) % 3 != j;
    } else {
      const Hinge<3> edge = hinge(c, i, j);
      Cell<3> turned{edge[0], edge[1], cell_at(c)[j], cell_at(c)[i]};
      bool even = true; // the permutation that takes one cell to the other
      for (std::size_t k = 0; k <= d; ++k)
        for (std::size_t n = k + 1; n <= d; ++n)
          even ^= local(cell_at(c), turned[k]) > local(cell_at(c), turned[n]);
      return even;
    }
  }

  /// The angle at the hinge between facets i and j of a cell.
  [[nodiscard]] double angle(Index c, std::size_t i, std::size_t j) const {
    const Hinge<d> h = hinge(c, i, j);
    Vector<d> u = x(cell_at(c)[j]) - x(h[0]), v = x(cell_at(c)[i]) - x(h[0]);
    if constexpr (d == 3) {
      const Vector<3> axis = (x(h[1]) - x(h[0])).normalized();
      u -= u.dot(axis) * axis;
      v -= v.dot(axis) * axis;
    }
    return angle_between<d>(u, v);
  }

  /// From the wall i of the first cell, across its facet j and on to the next wall.
  void try_sector(Index first, std::size_t i, std::size_t j) {
    const Hinge<d> at = hinge(first, i, j);
    std::vector<Index> shell(at.begin(), at.end());
    double total = 0;
    Index c = first;
    for (std::size_t n = 0; n <= mesh_.cells.size(); ++n) {
      total += angle(c, i, j);
      if (total >= sharp_angle)
        return;
      shell.push_back(cell_at(c)[j]);
      if (is_wall(c, j)) {
        shell.push_back(cell_at(c)[i]);
        break;
      }
      const HalfFacet next = mesh_.neighbours[c][j];
      if (!next.exists())
        return;
      // the vertex opposite the facet that we left through is behind the next one
      const Index pivot = cell_at(c)[i];
      c = next.cell();
      i = next.facet();
      j = local(cell_at(c), pivot);
    }
    exempt(shell, exempt_at_[at]);
  }

  void exempt(const std::vector<Index> &shell, int &n_exempt) {
    for (Index v : shell) {
      const std::size_t k = v;
      if (star_ok_[k] == 0 && exempt_[k] == 0 && n_exempt < max_exempt) {
        exempt_[k] = 1;
        ++n_exempt;
      }
    }
  }

  /// The cells around a vertex, as far as walls let them be reached, for all vertices
  /// on walls.
  void try_tips() {
    std::vector<bool> on_wall(mesh_.vertices.size(), false);
    for (std::size_t c = 0; c < mesh_.cells.size(); ++c)
      for (std::size_t i = 0; i <= d; ++i)
        if (is_wall(static_cast<Index>(c), i))
          for (Index v : facet_of<d>(mesh_.cells[c], i))
            on_wall[v] = true;
    std::vector<std::uint8_t> seen(mesh_.cells.size(), 0);
    for (std::size_t c = 0; c < mesh_.cells.size(); ++c)
      for (std::size_t k = 0; k <= d; ++k)
        if ((seen[c] >> k & 1) == 0 && on_wall[mesh_.cells[c][k]])
          try_tip(mesh_.cells[c][k], static_cast<Index>(c), seen);
  }

  void try_tip(Index tip, Index first, std::vector<std::uint8_t> &seen) {
    if constexpr (d == 3) {
      const auto visit = [&](Index c) {
        std::uint8_t &marks = seen[c];
        const auto bit = static_cast<std::uint8_t>(1u << local(cell_at(c), tip));
        const bool is_new = (marks & bit) == 0;
        marks |= bit;
        return is_new;
      };
      std::vector<Index> cells;
      visit(first);
      cells.push_back(first);
      std::vector<Index> shell{tip};
      double total = 0;
      for (std::size_t n = 0; n < cells.size(); ++n) {
        const Index c = cells[n];
        const Facet<3> far = facet_of<3>(cell_at(c), local(cell_at(c), tip));
        total +=
            solid_angle(x(far[0]) - x(tip), x(far[1]) - x(tip), x(far[2]) - x(tip));
        for (std::size_t i = 0; i <= d; ++i) {
          if (cell_at(c)[i] == tip)
            continue;
          if (total < sharp_solid_angle)
            shell.push_back(cell_at(c)[i]);
          const HalfFacet beyond = mesh_.neighbours[c][i];
          if (!is_wall(c, i) && beyond.exists() && visit(beyond.cell()))
            cells.push_back(beyond.cell());
        }
      }
      int n_exempt = 0;
      if (total < sharp_solid_angle)
        exempt(shell, n_exempt);
    }
  }
};

} // namespace

template <std::size_t d>
std::vector<std::uint8_t> exempt_vertices(const CertifiedMesh<d> &mesh,
                                          std::span<const std::uint8_t> star_ok) {
  return SharpCorners<d>(mesh, star_ok).run();
}

template std::vector<std::uint8_t> exempt_vertices(const CertifiedMesh<2> &,
                                                   std::span<const std::uint8_t>);
template std::vector<std::uint8_t> exempt_vertices(const CertifiedMesh<3> &,
                                                   std::span<const std::uint8_t>);

} // namespace anistar
