// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/welds.hpp"

#include <fmt/format.h>

#include <set>

#include "system/collocation.hpp"
#include "system/mode_forces.hpp"

namespace hilo {
namespace {

constexpr int pair_a[3] = {0, 1, 2}, pair_b[3] = {1, 2, 0};
using Map = Eigen::Matrix<double, 3, Eigen::Dynamic>;
using Matrix = ModeForces::Matrix;

std::vector<Vec3> shapes_of_direction(const Weld& w, int i) {
  std::vector<Vec3> out;
  for (const Mat3& g : w.stretch) out.emplace_back(g.col(i));
  return out;
}

/// Of the row of a pair of axes; 0 where it is left out.
double factor(const Weld& w, int i) { return i < w.left_out ? 0 : 1 / (w.share[pair_a[i]] + w.share[pair_b[i]]); }

/// Of the row of a stretch.
double stretch_factor(const Weld& w, size_t i) { return 0.5 / (w.share[w.stretches[i].first] * w.share[w.stretches[i].second]); }

/// What the unknowns of a region move a vector by: columns of translation, rotation, amplitudes.
Map region_map(bool point, const Vec3& arm, const Mat3& turn, const std::vector<Vec3>& shapes) {
  Map out = Map::Zero(3, 6 + static_cast<Eigen::Index>(shapes.size()));
  if (point) out.leftCols<3>().setIdentity();
  out.middleCols<3>(3) = -skew(arm);
  for (size_t j = 0; j < shapes.size(); ++j) out.col(6 + static_cast<Eigen::Index>(j)) = turn * shapes[j];
  return out;
}

/// Rows over the unknowns of the region and the body (3 n_blocks x 6 + 3 n_mode_blocks + 6) where the region is turned by `turn` and moves
/// its directions by `of`; arms from the centres of both.
template <class Place>
Matrix gradient_at(const Weld& w, const Place& x, const Vec3& arm, const Vec3& arm_body, const Mat3& turn, const Map (&of)[3]) {
  const Eigen::Index n = of[0].cols();
  Matrix G = Matrix::Zero(3 * w.n_blocks(), n + 6);
  G.topLeftCorner(3, n) = region_map(true, arm, turn, w.mean);
  for (int i = 0; i < 3; ++i) G(i, n + i) = -1;
  G.block<3, 3>(0, n + 3) = skew(arm_body);
  for (int i = 0; i < 3; ++i) {
    const int a = pair_a[i], b = pair_b[i];
    G.row(3 + i).head(n) = factor(w, i) * (x.t[a].transpose() * of[b] - x.t[b].transpose() * of[a]);
    G.row(3 + i).segment<3>(n + 3) = factor(w, i) * (x.t[a].cross(x.d[b]) - x.t[b].cross(x.d[a])).transpose();
  }
  for (size_t i = 0; i < w.stretches.size(); ++i) {
    const auto& [a, b] = w.stretches[i];
    G.row(6 + static_cast<Eigen::Index>(i)).head(n) = stretch_factor(w, i) * (x.d[a].transpose() * of[b] + x.d[b].transpose() * of[a]);
  }
  return G;
}

}  // namespace

void Welds::number(Layout& layout) {
  block_.clear(), clique_.clear();
  for (size_t k = 0; k < list.size(); ++k) {
    const Modes& m = points_.modes[list[k].modes];
    block_.push_back(layout.add_rows(static_cast<int>(k), list[k].n_blocks()));
    std::vector<int> blocks;
    const auto add_body = [&](int body) {
      const int first = points_.body_block[body];
      blocks.push_back(first), blocks.push_back(first < 0 ? -1 : first + 1);
    };
    add_body(m.body);
    for (int b = 0; b < m.n_blocks; ++b) blocks.push_back(m.block + b);
    add_body(list[k].body);
    for (int b = 0; b < list[k].n_blocks(); ++b) blocks.push_back(block_[k] + b);
    clique_.push_back(layout.cliques.add(blocks));
  }
}

std::string Welds::owner(int block) const {
  for (size_t k = 0; k < list.size(); ++k)
    if (block >= block_[k] && block < block_[k] + list[k].n_blocks())
      return fmt::format("the bond of \"{}\" and \"{}\"", points_.bodies[points_.modes[list[k].modes].body].name, list[k].name);
  return "";
}

Welds::Place Welds::place(const Weld& w, const Config& q) const {
  const Modes& m = points_.modes[w.modes];
  const Mat3 &R = q.R[m.body], &B = q.R[w.body];
  Place p;
  p.y = q.c[m.body] + R * (w.at - points_.bodies[m.body].Xc);
  for (int i = 0; i < 3; ++i) p.d[i] = w.share[i] * (R * w.axes.col(i)), p.t[i] = B * w.axes.col(i);
  for (size_t j = 0; j < w.mean.size(); ++j) {
    const Mat3& Y = q.Y[3 * m.first + j];
    p.y += Y * w.mean[j];
    for (int i = 0; i < 3; ++i) p.d[i] += Y * w.stretch[j].col(i);
  }
  p.y_body = q.c[w.body] + B * (w.at - points_.bodies[w.body].Xc);
  return p;
}

std::vector<double> Welds::values(const Weld& w, const Config& q) const {
  const Place p = place(w, q);
  std::vector<double> g(w.n_rows());
  for (int i = 0; i < 3; ++i) {
    g[i] = p.y[i] - p.y_body[i];
    g[3 + i] = factor(w, i) * (p.t[pair_a[i]].dot(p.d[pair_b[i]]) - p.t[pair_b[i]].dot(p.d[pair_a[i]]));
  }
  for (size_t i = 0; i < w.stretches.size(); ++i) {
    const auto& [a, b] = w.stretches[i];
    g[6 + i] = stretch_factor(w, i) * p.d[a].dot(p.d[b]) - (a == b ? 0.5 : 0);
  }
  return g;
}

void Welds::evaluate(Pass& p) const {
  const Stage& s = p.s;
  if (s.rates_alone) return;
  for (size_t k = 0; k < list.size(); ++k) {
    const Weld& w = list[k];
    if (!points_.counts(static_cast<int>(k))) continue;
    const Modes& m = points_.modes[w.modes];
    const Place left = place(w, *s.left), end = place(w, *s.end);
    auto g = values(w, *s.end);
    if (s.step) {  // increments, of which the sum over the stages is g(q1)
      const auto open = values(w, *s.step->start), before = values(w, *s.w0);
      g = values(w, *s.w1);
      for (size_t i = 0; i < g.size(); ++i) g[i] += open[i] - before[i];
    }
    for (size_t i = 0; i < g.size(); ++i) p.out.r[3 * block_[k] + i] = p.sigma * g[i];
    const double* lambda = p.lambda.data() + 3 * (block_[k] - points_.first_joint_block());

    // forces on the vectors of both sides
    const Vec3 f(lambda[0], lambda[1], lambda[2]);
    Vec3 h[3], t[3];
    for (int i = 0; i < 3; ++i) h[i].setZero(), t[i].setZero();
    for (int i = 0; i < 3; ++i) {
      const int a = pair_a[i], b = pair_b[i];
      const double push = factor(w, i) * lambda[3 + i];
      h[b] += push * left.t[a], h[a] -= push * left.t[b];
      t[a] += push * left.d[b], t[b] -= push * left.d[a];
    }
    for (size_t i = 0; i < w.stretches.size(); ++i) {
      const auto& [a, b] = w.stretches[i];
      const double push = stretch_factor(w, i) * lambda[6 + i];
      h[a] += push * left.d[b], h[b] += push * left.d[a];
    }
    const Vec3 arm = left.y - s.left->c[m.body], arm_end = end.y - s.end->c[m.body];
    const Vec3 arm_body = left.y_body - s.left->c[w.body], arm_body_end = end.y_body - s.end->c[w.body];
    Vec6 &on_region = p.body[m.body], &on_body = p.body[w.body];
    on_region.head<3>() += f, on_region.tail<3>() += arm.cross(f);
    on_body.head<3>() -= f, on_body.tail<3>() -= arm_body.cross(f);
    for (int i = 0; i < 3; ++i) on_region.tail<3>() += left.d[i].cross(h[i]), on_body.tail<3>() += left.t[i].cross(t[i]);
    p.scale(f.norm());
    ModeForces of_modes(m, p);
    of_modes.add(w.mean, f);
    std::vector<Vec3> shapes[3];
    for (int i = 0; i < 3; ++i) of_modes.add(shapes[i] = shapes_of_direction(w, i), h[i]);
    if (p.K) {
      auto turns = of_modes.tangent().block<3, 3>(3, 3);
      turns += s.slope * skew(f) * skew(arm_end);
      for (int i = 0; i < 3; ++i) turns += s.slope * skew(h[i]) * skew(end.d[i]);
    }
    of_modes.finish();
    if (!p.K) continue;

    const Mat3 hat = left_turn(s, m.body), &R = s.end->R[m.body];
    const Eigen::Index n = 6 + 3 * m.n_blocks, at_body = n, at_rows = n + 6, rows = 3 * w.n_blocks(), all = at_rows + rows;
    Matrix K = Matrix::Zero(all, all);
    Map L[3], Z[3];  // of the directions
    for (int i = 0; i < 3; ++i) L[i] = region_map(false, left.d[i], hat, shapes[i]), Z[i] = region_map(false, end.d[i], R, shapes[i]);
    const Matrix G_left = gradient_at(w, left, arm, arm_body, hat, L), G_right = gradient_at(w, end, arm_end, arm_body_end, R, Z);
    K.block<3, 3>(at_body + 3, at_body + 3) -= s.slope * skew(f) * skew(arm_body_end);
    for (int i = 0; i < 3; ++i) {
      const int a = pair_a[i], b = pair_b[i];
      K.block<3, 3>(at_body + 3, at_body + 3) += s.slope * skew(t[i]) * skew(end.t[i]);
      const double push = s.slope * factor(w, i) * lambda[3 + i];
      K.block(0, at_body + 3, n, 3) += push * (L[a].transpose() * skew(end.t[b]) - L[b].transpose() * skew(end.t[a]));
      K.block(at_body + 3, 0, 3, n) += push * (skew(left.t[a]) * Z[b] - skew(left.t[b]) * Z[a]);
    }
    for (size_t i = 0; i < w.stretches.size(); ++i) {
      const auto& [a, b] = w.stretches[i];
      const double by = stretch_factor(w, i), push = s.slope * by * lambda[6 + i];
      K.topLeftCorner(n, n) += push * (L[a].transpose() * Z[b] + L[b].transpose() * Z[a]);
    }
    K.block(0, at_rows, n + 6, rows) = p.sigma * G_left.transpose();
    K.block(at_rows, 0, rows, n + 6) = p.sigma * G_right;
    for (int i = 0; i < w.left_out; ++i) K(at_rows + 3 + i, at_rows + 3 + i) = p.sigma;
    p.K->add(clique_[k], K.data());
  }
}

Eigen::MatrixXd Welds::gradient(const Weld& w, const Config& q) const {
  const int region = points_.modes[w.modes].body;
  const Place at = place(w, q);
  Map of[3];
  for (int i = 0; i < 3; ++i) of[i] = region_map(false, at.d[i], q.R[region], shapes_of_direction(w, i));
  return gradient_at(w, at, at.y - q.c[region], at.y_body - q.c[w.body], q.R[region], of).topRows(w.n_rows());
}

void Welds::look_at_rows(const Config& q, double, double, Violation& worst) const {
  for (size_t k = 0; k < list.size(); ++k)
    for (const double g : values(list[k], q))
      if (!(std::abs(g) <= worst.kept))
        worst.kept = std::isnan(g) ? 1e300 : std::abs(g), worst.kept_block = block_[k] - points_.first_joint_block();
}

/// Of degree two: differences are exact.
void Welds::add_row_rates(const Rates& at, std::vector<double>& rate, std::vector<double>* acceleration) const {
  for (size_t k = 0; k < list.size(); ++k) {
    if (!points_.counts(static_cast<int>(k))) continue;
    const int base = 3 * (block_[k] - points_.first_joint_block());
    const auto forward = values(list[k], at.forward), backward = values(list[k], at.backward);
    for (size_t i = 0; i < forward.size(); ++i) rate[base + i] = (forward[i] - backward[i]) / (2 * at.tau);
    if (!acceleration) continue;
    const auto here = values(list[k], at.q), up = values(list[k], at.up), down = values(list[k], at.down);
    for (size_t i = 0; i < forward.size(); ++i)
      (*acceleration)[base + i] = (forward[i] + backward[i] - 2 * here[i]) / (at.tau * at.tau) + (up[i] - down[i]) / (2 * at.sigma);
  }
}

void Welds::mark_rows(std::vector<char>& on) const {
  for (size_t k = 0; k < list.size(); ++k) {
    const auto first = on.begin() + 3 * (block_[k] - points_.first_joint_block());
    std::fill_n(first, list[k].n_rows(), 1);
    std::fill_n(first + 3, list[k].left_out, 0);
  }
}

Vec3 Weld::turn(const Modes& m, const Config& q) const {
  Vec3 out = Vec3::Zero();
  for (size_t j = 0; j < stretch.size(); ++j) {
    const double eta = q.eta[m.first + static_cast<int>(j) / 3][static_cast<int>(j) % 3];
    for (int i = 0; i < 3; ++i) {
      const int a = pair_a[i], b = pair_b[i];
      out += eta * factor(*this, i) * (axes.col(b).dot(stretch[j].col(a)) - axes.col(a).dot(stretch[j].col(b))) * axes.col(3 - a - b);
    }
  }
  return out;
}

/// A face that is turned by linear modes is stretched by the square of its turn, and so is the region beside it.
void Welds::commit(const Config& q, const Config*) {
  constexpr double far = 0.05, far_where_it_stiffens = 0.25;  // [rad], docs/fidelity.md
  told_.resize(list.size(), 0);
  for (size_t k = 0; k < list.size(); ++k) {
    const Modes& m = points_.modes[list[k].modes];
    const double turn = list[k].turn(m, q).norm(), limit = m.stiffens ? far_where_it_stiffens : far;
    if (!(turn > limit) || told_[k]) continue;
    constexpr size_t named = 3;  // regions, each at one face; all are in the table at the end of the run
    std::set<int> regions;
    for (size_t i = 0; i < list.size(); ++i)
      if (told_[i]) regions.insert(list[i].modes);
    told_[k] = 1;
    if (points_.comm->rank == 0 && !regions.contains(list[k].modes) && regions.size() < named)
      warn(points_.bodies[m.body].name,
           fmt::format("turns by {:.2g} rad at \"{}\": beyond {:g} {} are off by more than a few per cent ({})", turn, list[k].name, limit,
                       m.stiffens ? "modes with stiffening" : "linear modes", m.better()));
  }
}

void Welds::tie(Ties& ties) const {
  for (const Weld& w : list)
    if (w.body > 0 && points_.body_block[w.body] >= 0) ties.exclude(w.body);
}

}  // namespace hilo
