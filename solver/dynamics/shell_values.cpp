// SPDX-License-Identifier: GPL-3.0-or-later
// What shells bear: forces and moments per length, stress and axes, of pairs of sites across the thickness.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/shell_shape.hpp"
#include "dynamics/stress_recovery.hpp"
#include "model/mesh.hpp"

namespace hilo {
namespace {

constexpr double enough = 0.342;  // sine of 20 degrees
constexpr double along = 1e-3;    // sine below which an axis has no projection

double sine(const Vec3& normal, int axis) { return normal.cross(Vec3::Unit(axis)).norm(); }

Mat3 matrix(const Vec6& s) {
  Mat3 m;
  m << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
  return m;
}

}  // namespace

/// Collective, as it sums normals over the cells of all ranks.
void StressRecovery::find_pairs() const {
  const System& s = system_;
  paired_ = true;
  pair_.assign(site_.size(), {});
  constexpr int width = 5;  // normal, cells below whose lower and upper face the site is
  std::vector<double> sums(site_.size() * width, 0.0), others(site_.size() * 2, -1.0);
  for (size_t b = 0; b < batches_.size(); ++b) {
    const SolidBatch& batch = *batches_[b];
    if (batch.shape != shell8) continue;
    for (size_t e = 0; e < batch.cells.size(); ++e) {
      const int *site = site_of_[b].data() + e * 8, *node = batch.nodes.data() + e * 8;
      const auto middle = [&](int a) { return Vec3((s.X[node[a % 4]] + s.X[node[a % 4 + 4]]) / 2); };
      for (int a = 0; a < 8; ++a) {
        const auto i = static_cast<size_t>(site[a]);
        Eigen::Map<Vec3>(sums.data() + i * width) += (middle(a + 1) - middle(a)).cross(middle(a + 3) - middle(a));
        sums[i * width + (a < 4 ? 3 : 4)] += 1;
        pair_[i].other = site[(a + 4) % 8];
        const auto number = static_cast<double>(s.mesh->node_global[node[(a + 4) % 8]] + 1);
        others[2 * i] = std::max(others[2 * i], number), others[2 * i + 1] = std::max(others[2 * i + 1], 1 / number);
      }
    }
  }
  sites_->combine(sums, width), sites_->combine(others, 2, Sharing::By::largest);
  const size_t n_regions = s.mesh->mesh.region_name.size();
  std::vector<double> nearest(3 * n_regions, 0.0);  // of the axes to normals: 1 - sine, so that the largest is wanted
  s.comm->together([&] {
    if (!any_shells_)
      throw Error("output.fields", "\"shell\": the run has no shells that deform", "leave it out, or write shell = true in a region");
    for (size_t i = 0; i < site_.size(); ++i) {
      if (pair_[i].other < 0) continue;
      const auto refuse = [&](const char* why, const char* hint) {
        const Vec3& X = s.X[site_[i].node];
        throw Error("output.fields",
                    fmt::format("\"shell\": region \"{}\" {} at ({:.4g}, {:.4g}, {:.4g})",
                                s.mesh->mesh.region_name[static_cast<size_t>(site_[i].region / 2)], why, X[0], X[1], X[2]),
                    hint);
      };
      if (others[2 * i] * others[2 * i + 1] > 1 + 1e-12)
        refuse("has more than one layer of shells", "mesh it in one layer, or take stress of its nodes");
      if (sums[i * width + 3] > 0 && sums[i * width + 4] > 0)
        refuse("has cells whose upper faces lie on both sides",
               "number the nodes of all cells alike, from the lower face to the upper one");
      Pair& p = pair_[i];
      p.top = sums[i * width + 4] > 0;
      p.normal = Eigen::Map<const Vec3>(sums.data() + i * width).normalized();
      p.across = (p.top ? 1 : -1) * (s.X[site_[i].node] - s.X[site_[static_cast<size_t>(p.other)].node]);
      for (int k = 0; k < 3; ++k) {
        double& at = nearest[3 * static_cast<size_t>(site_[i].region / 2) + static_cast<size_t>(k)];
        at = std::max(at, 1 - sine(p.normal, k));
      }
    }
  });
  s.comm->max(nearest);
  for (size_t i = 0; i < site_.size(); ++i) {
    Pair& p = pair_[i];
    if (p.other < 0) continue;
    const double* off = nearest.data() + 3 * static_cast<size_t>(site_[i].region / 2);
    int axis = 0;
    while (axis < 3 && 1 - off[axis] < enough) ++axis;
    if (axis == 3) axis = static_cast<int>(std::min_element(off, off + 3) - off);
    if (sine(p.normal, axis) < along) axis = (axis + 1) % 3;
    p.axis = (Vec3::Unit(axis) - p.normal[axis] * p.normal).normalized();
  }
}

/// through: the stress that is linear across (n_sites x 6).
void StressRecovery::add_shells(const std::vector<double>& at_site, const std::vector<double>& through, Result& out) const {
  if (!paired_) find_pairs();
  out.shell.resize(site_.size());
  const size_t n_values = site_.empty() ? 0 : at_site.size() / site_.size();
  const auto gradient = [&](size_t i) { return Mat3(Eigen::Map<const Mat3>(at_site.data() + i * n_values + 7)); };
  const auto stress = [&](size_t i) { return matrix(Eigen::Map<const Vec6>(through.data() + i * 6)); };
  for (size_t i = 0; i < site_.size(); ++i) {
    const Pair& p = pair_[i];
    if (p.other < 0) continue;
    const auto other = static_cast<size_t>(p.other), top = p.top ? i : other, bottom = p.top ? other : i;
    const Mat3 F = (gradient(top) + gradient(bottom)) / 2, dF = (gradient(top) - gradient(bottom)) / 2,
               S = (stress(top) + stress(bottom)) / 2, dS = (stress(top) - stress(bottom)) / 2;
    const Vec3 area = F.determinant() * F.inverse().transpose() * p.normal;  // of the moment, of a unit of the reference
    Mat3 axes;
    axes.col(2) = area.normalized();
    const Vec3 one = F * p.axis;
    axes.col(0) = (one - one.dot(axes.col(2)) * axes.col(2)).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    const double H = p.normal.dot(p.across), h = axes.col(2).dot(F * p.across);
    const auto own = [&](const Mat3& s) { return Mat3(axes.transpose() * (s + s.transpose()) / 2 * axes); };
    // F and S are linear across, their products integrated
    const Mat3 n = own(H * (F * S + dF * dS / 3) * F.transpose() / area.norm()),
               m = own(h * H / 6 * (F * dS + dF * S) * F.transpose() / area.norm()), face = own(matrix(out.stress[i]));
    constexpr int I[] = {0, 1, 0, 0, 1}, J[] = {0, 1, 1, 2, 2};
    ShellValues& to = out.shell[i];
    for (int c = 0; c < 5; ++c) to.force[c] = n(I[c], J[c]);
    for (int c = 0; c < 3; ++c) to.moment[c] = m(I[c], J[c]), to.stress[c] = face(I[c], J[c]), to.stress[3 + c] = n(I[c], J[c]) / h;
    to.axis = axes.col(0);
  }
}

}  // namespace hilo
