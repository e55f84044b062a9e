// SPDX-License-Identifier: GPL-3.0-or-later
// What the cells of a flexible region cannot do, told when a scene has them (docs/elements.md has the figures).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "physics/shape/hex20.hpp"
#include "physics/shape/tet10.hpp"
#include "system/build/builder.hpp"

namespace hilo {
namespace {

/// How far a hexahedron is from a parallelepiped: the angle, in radians, by which its opposite edges are turned against each other in the
/// second worst of its three planes.  With x = m_r xi_r + p_r xi_j xi_k + ... the angle of plane jk is |p_r|/min(|m_j|, |m_k|).  A taper in
/// one plane alone (rings, fans) hinders only what bends in that plane; it counts, in the same measure, in cells of thin walls.
double skew(const Mesh& mesh, std::int64_t c) {
  Vec3 m[3] = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}, p[3] = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  const auto nodes = mesh.cell(c);
  for (int a = 0; a < 8; ++a)
    for (int r = 0; r < 3; ++r) {
      const double* h = hex_corner[a];
      m[r] += h[r] * mesh.X[nodes[a]], p[r] += h[(r + 1) % 3] * h[(r + 2) % 3] * mesh.X[nodes[a]];
    }
  double angle[3], length[3];
  for (int r = 0; r < 3; ++r) angle[r] = p[r].norm() / std::min(m[(r + 1) % 3].norm(), m[(r + 2) % 3].norm()), length[r] = m[r].norm();
  std::sort(angle, angle + 3), std::sort(length, length + 3);
  constexpr double thin = 4, worst_over_second = 1.7;  // of corners moved at random
  return std::max(angle[1], length[1] > thin * length[0] ? angle[2] / worst_over_second : 0);
}

/// How many times a hexahedron's longest edges (mean of four) are as long as its shortest.
double slenderness(const Mesh& mesh, std::int64_t c) {
  Vec3 along[3] = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  const auto nodes = mesh.cell(c);
  for (int a = 0; a < 8; ++a)
    for (int r = 0; r < 3; ++r) along[r] += hex_corner[a][r] * mesh.X[nodes[a]];
  const auto [least, most] = std::minmax({along[0].norm(), along[1].norm(), along[2].norm()});
  return most / least;
}

/// How far the longest way an edge of a quadratic cell leaves the straight line goes across the cell, along its shortest edge and over that
/// edge's length: bulge over thickness of a curved wall.
template <size_t n>
double bulge(const Mesh& mesh, std::int64_t c, const int (&edges)[n][2], int n_corners) {
  const auto nodes = mesh.cell(c);
  Vec3 shortest = Vec3::Constant(1e300);
  for (const auto& [a, b] : edges)
    if (const Vec3 along = mesh.X[nodes[b]] - mesh.X[nodes[a]]; along.squaredNorm() < shortest.squaredNorm()) shortest = along;
  double worst = 0;
  for (size_t e = 0; e < n; ++e) {
    const Vec3 away = mesh.X[nodes[n_corners + e]] - (mesh.X[nodes[edges[e][0]]] + mesh.X[nodes[edges[e][1]]]) / 2;
    worst = std::max(worst, std::abs(away.dot(shortest)) / shortest.squaredNorm());
  }
  return worst;
}
constexpr int wedge15_edge[9][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}};

/// The measure of a cell that its shape is judged by: skew of hex8, or slenderness where they flow, bulge of the quadratic shapes that lock
/// by it.
double measure(const Mesh& mesh, std::int64_t c, bool flows) {
  switch (static_cast<Shape>(mesh.shape[c])) {
    case Shape::hex8:
      return flows ? slenderness(mesh, c) : skew(mesh, c);
    case Shape::hex20:
      return bulge(mesh, c, Hex20::edge, 8);
    case Shape::tet10:
      return bulge(mesh, c, Tet10::edge, 4);
    case Shape::wedge15:
      return bulge(mesh, c, wedge15_edge, 6);
    default:
      return 0;
  }
}

/// Root mean square skew and bulge from which a region is warned of: a beam (two cells high) or a wall bent is then 4 to 6 % too stiff.
constexpr double much_skew = 0.1, much_bulge = 0.15;
/// How much too stiff a beam of skewed hex8 is: this times skew^2, over the square of the cells across.
constexpr double stiffness_of_skew = 24;
/// How much too stiff a beam of hex8 with 2 x 2 x 2 points and one mean dilatation is, times the square of the cells across.  A cell that
/// bends to a curvature k has shear strains k x, and no change of volume to go with the axial strains k y.
double stiffness_of_plastic_hex8(const Lame& c, double slenderness_squared) {
  const double G_over_E = (c.lambda + c.mu) / (3 * c.lambda + 2 * c.mu);
  return G_over_E * slenderness_squared - (1 - 4. / 3 * G_over_E);
}
/// Share of a region's cells below which a shape is not worth a word: fillers between better ones.
constexpr double few = 0.05;
constexpr double nearly_incompressible = 0.45;

}  // namespace

void Builder::warn_of_limits() const {
  if (!mesh_) return;
  const Mesh& mesh = mesh_->mesh;
  constexpr int columns = 2 * n_shapes;  // by shape: cells, and squares of their measure
  const auto flows = [](const Region& region) { return region.material && material_kinds().at(region.material->kind).n_state > 0; };
  std::vector<double> sums(regions_.size() * columns, 0.0);
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c) {
    if (regions_[mesh.region[c]].fidelity == Fidelity::rigid || mesh.shape[c] >= n_shapes) continue;
    if (!shell_axis_.empty() && shell_axis_[static_cast<size_t>(c)] > 0) continue;
    double* row = sums.data() + static_cast<size_t>(mesh.region[c]) * columns;
    row[mesh.shape[c]] += 1, row[n_shapes + mesh.shape[c]] += std::pow(measure(mesh, c, flows(regions_[mesh.region[c]])), 2);
  }
  comm_.sum(sums);
  std::vector<double> reduced = reduced_;
  comm_.sum(reduced);
  if (comm_.rank != 0) return;
  for (size_t r = 0; r < regions_.size(); ++r) {
    if (reduced[r] > 0)
      warn(regions_[r].name, "plastic hex20 cells are integrated with 2 x 2 x 2 points (hex20r), since they lock with 3 x 3 x 3");
    const double* row = sums.data() + r * columns;
    const Region& region = regions_[r];
    const bool metal = flows(region);
    if (metal && region.fidelity == Fidelity::linear)
      warn(region.name,
           "a linear region does not yield: stresses above the yield stress are those of an elastic material (tag it nonlinear)");
    double all = 0;
    for (int s = 0; s < n_shapes; ++s) all += row[s];
    for (int s = 0; s < n_shapes; ++s) {
      if (!(row[s] > few * all)) continue;
      const auto shape = static_cast<Shape>(s);
      const double mean = std::sqrt(row[n_shapes + s] / row[s]);
      if (shape == Shape::tet4 || shape == Shape::wedge6) {
        const Lame c = linear_moduli(material_of(region));
        const double nu = c.lambda / (2 * (c.lambda + c.mu));
        warn(region.name,
             fmt::format("linear {} lock in bending{}{}; expect too stiff an answer (hilo-import --order 2 makes them quadratic)",
                         shape == Shape::tet4 ? "tetrahedra" : "wedges", metal ? " and in plastic flow" : "",
                         nu > nearly_incompressible ? fmt::format(" and at a Poisson's ratio of {:.4g}", nu) : ""));
      } else if (shape == Shape::hex8 && metal)
        warn(region.name,
             fmt::format(
                 "plastic hex8, edges in the ratio {:.2g} (mean): a wall bent along the longest, its thickness along the shortest, is "
                 "{:+.0f} % too stiff with two cells across, four times that with one, a quarter with four (hex20r: hilo-import "
                 "--order 2; or shorter cells)",
                 mean, 100 * stiffness_of_plastic_hex8(linear_moduli(material_of(region)), mean * mean) / 4));
      else if (shape == Shape::hex8 && mean > much_skew)
        warn(region.name,
             fmt::format("skewed hex8, opposite edges turned by {:.2g} rad (mean): in bending about {:.0f} % too stiff with two cells "
                         "across, a quarter of that with four (smaller cells, or hilo-import --order 2)",
                         mean, 100 * stiffness_of_skew * mean * mean / 4));
      else if (mean > much_bulge)
        warn(region.name,
             fmt::format("curved walls of {}, edges bulge by {:.2g} of the thickness (mean): bending locks, 5 % too stiff at 0.17, 13 % at "
                         "0.4 (smaller cells, or hex20r: C3D20R)",
                         info(shape).name, mean));
    }
  }
}

}  // namespace hilo
