// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/cell_stages.hpp"

#include <Eigen/LU>
#include <cmath>

namespace hilo {
namespace {

constexpr double rounding = 1e-9;  // of the energy: ways below its root are too short to do work that was missed

bool is_linear(const Material& m) { return std::holds_alternative<StVenantKirchhoff>(m) || std::holds_alternative<Orthotropic>(m); }

}  // namespace

thread_local CellStages::Store CellStages::store_;

CellStages::CellStages(const SolidBatch& b, const Collocation& step)
    : b_(b), step_(step), W_(b.kernel.width), size_(3 * info(b.shape).n_nodes * W_) {
  call_.law = parameters(b.material), call_.area = b.area;
}

void CellStages::gather_cells(int first, const double* X) {
  call_.X = X;
  start_ = put(store_.start, first, *step_.start);
  for (int j = 0; j < n; ++j) {
    before_[j] = put(store_.before[j], first, *step_.before[j]), after_[j] = put(store_.after[j], first, *step_.after[j]);
    double* at = store_.at[j].get(size_);
    for (int k = 0; k < size_; ++k) at[k] = (before_[j][k] + after_[j][k]) / 2;
    at_[j] = at;
  }
}

void CellStages::add_rest(int i, double* f) {
  add_variable(i, f);
  if (is_linear(b_.material)) return;
  double *all = store_.all.get(size_), *missed = store_.missed.get(W_), *length = store_.length.get(W_);
  find_energy_change(missed, length);
  for (int l = 0; l < W_; ++l) length[l] *= rounding;
  for (int j = 0; j < n; ++j) {
    std::fill_n(all, size_, 0.0);
    add(KernelCall{call_.X, at_[j], at_[j], 1, 0, call_.law, nullptr, nullptr, nullptr, nullptr, nullptr, 0, nullptr, 0, b_.area}, all);
    add_variable(j, all);
    add_product(-step_.b[j], all, j, missed);
    std::fill_n(all, size_, 0.0);
    add(along(j, 1), all);
    add_product(step_.b[j], all, j, length);
  }
  std::fill_n(all, size_, 0.0);
  add(along(i, 1), all);
  for (int k = 0; k < size_; ++k)
    if (length[k % W_] > 1e-280) f[k] += missed[k % W_] / length[k % W_] * all[k];
}

void CellStages::add_slope(int i, int k, double* K) {
  const Eigen::Map<const Eigen::Matrix<double, n, n, Eigen::RowMajor>> A(step_.a[0]);
  const Eigen::Matrix3d W = A.inverse();
  double *to = store_.to.get(size_), *from = store_.from.get(size_);
  for (int x = 0; x < size_; ++x) {
    to[x] = A(i, k) * (after_[k][x] - before_[k][x]);
    for (int j = 0; j < n; ++j) to[x] += A(i, j) * W(j, k) * at_[j][x];
  }
  if (i == k) {  // calls have half of what is geometric, and B(after_i) to the right
    for (const KernelCall& c : variable(i)) add_tangent(2, c, K);
    for (int x = 0; x < size_; ++x) to[x] -= at_[i][x] + 2 * A(i, i) * after_[i][x];
  }
  for (int x = 0; x < size_; ++x) from[x] = 2 * at_[i][x] - to[x];
  KernelCall c = call_;  // without stress: e(to) - e(from) is recalled
  c.x0 = from, c.x1 = to, c.viscous = 1, c.past[0] = to, c.past[1] = from, c.recall[1] = 1;
  add_tangent(1, c, K);
}

const double* CellStages::put(Scratch& to, int first, const Config& from) {
  gather(b_, first, W_, from.x, to.get(size_));
  return to.get(size_);
}

KernelCall CellStages::along(int i, double v, double share, const double* from, const double* to) const {
  KernelCall c = call_;
  c.x0 = before_[i], c.x1 = after_[i], c.viscous = v;
  if (from) c.past[0] = from, c.past[1] = to, c.recall[1] = share;
  return c;
}

void CellStages::add(KernelCall c, double* f) {
  c.f = store_.f.get(size_);
  b_.kernel.call(c);
  for (int k = 0; k < size_; ++k) f[k] += c.f[k];
}

std::array<KernelCall, Collocation::n> CellStages::variable(int i) const {
  const double v = step_.a[i][i] / 3;
  std::array<KernelCall, n> calls;
  for (int j = 0; j < n; ++j)
    calls[j] = j == i ? along(i, v, 1 / v, at_[i], start_) : along(i, v, step_.a[i][j] / v, before_[j], after_[j]);
  return calls;
}

void CellStages::add_variable(int i, double* f) {
  for (const KernelCall& c : variable(i)) add(c, f);
}

void CellStages::add_tangent(double factor, KernelCall c, double* K) {
  const int size = size_ * (size_ / W_);
  c.K = store_.K.get(size);
  b_.kernel.call(c);
  for (int k = 0; k < size; ++k) K[k] += factor * c.K[k];
}

void CellStages::add_product(double factor, const double* f, int j, double* sum) const {
  for (int k = 0; k < size_; ++k) sum[k % W_] += factor * f[k] * (after_[j][k] - before_[j][k]);
}

void CellStages::find_energy_change(double* change, double* size) {
  double *end = store_.end.get(size_), *energy = store_.energy.get(W_);
  for (int k = 0; k < size_; ++k) {
    end[k] = start_[k];
    for (int j = 0; j < n; ++j) end[k] += step_.b[j] * (after_[j][k] - before_[j][k]);
  }
  std::fill_n(change, W_, 0.0), std::fill_n(size, W_, 0.0);
  for (const double* x : {static_cast<const double*>(end), start_}) {
    b_.kernel.call({call_.X, x, x, 0, 0, call_.law, nullptr, nullptr, energy, nullptr, nullptr, 0, nullptr, 0, b_.area});
    for (int l = 0; l < W_; ++l) change[l] += x == start_ ? -energy[l] : energy[l], size[l] += std::abs(energy[l]);
  }
}

}  // namespace hilo
