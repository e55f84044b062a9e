// SPDX-License-Identifier: GPL-3.0-or-later
// Flexible cells: gather, kernel on as many cells as there are lanes, scatter.
#include "system/solids.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "base/shell_shape.hpp"
#include "system/collocation.hpp"

namespace hilo {
namespace {

/// Cache-line aligned scratch that grows.
class Scratch {
 public:
  double* get(size_t n) {
    if (n + 8 > store_.size()) store_.resize(n + 8);
    const auto at = reinterpret_cast<std::uintptr_t>(store_.data());
    return reinterpret_cast<double*>((at + 63) / 64 * 64);
  }

 private:
  std::vector<double> store_;
};

/// Arrays of one call, (entry x lanes).
struct Lanes {
  Scratch X, x0, x1, a, f, K, f2, K2, h0, h1, before, along, one, two, scalar[3];
};

void gather(const SolidBatch& b, int first, int W, const std::vector<Vec3>& from, double* to) {
  const int n = info(b.shape).n_nodes, count = static_cast<int>(b.cells.size());
  for (int l = 0; l < W; ++l) {
    const int* nodes = b.nodes.data() + static_cast<size_t>(std::min(first + l, count - 1)) * n;
    for (int k = 0; k < n; ++k) {
      const Vec3& v = from[nodes[k]];
      for (int i = 0; i < 3; ++i) to[(3 * k + i) * W + l] = v[i];
    }
  }
}

/// States of W cells, (entry x lanes).
void gather_state(const SolidBatch& b, int first, int W, const std::vector<double>& from, double* to) {
  const int n = b.kernel.n_state, last = static_cast<int>(b.cells.size()) - 1;
  for (int l = 0; l < W; ++l) {
    const double* cell = from.data() + static_cast<size_t>(std::min(first + l, last)) * n;
    for (int k = 0; k < n; ++k) to[k * W + l] = cell[k];
  }
}

bool is_linear(const Material& m) { return std::holds_alternative<StVenantKirchhoff>(m) || std::holds_alternative<Orthotropic>(m); }

/// W cells at the stages of a step that these share (system/collocation): the strain is a variable of its own, and stress
///   S_i = dW(e(Q_i)) + C (E_i - e(Q_i)) + c C way_i,   E_i = e(q0) + sum a_ij way_j,   way_j = h G(Q_j) V_j = e(after_j) - e(before_j)
/// with the law's moduli C at small strain.  Where stress is linear in strain the first two are C E_i, and c is none; elsewhere
///   c = (W1 - W0 - sum b_j S_j.way_j)/(sum b_j way_j.C way_j)
/// of the cell makes the work of the step the change of W; c way_i is of order h^6.
class CellStages {
 public:
  CellStages(const SolidBatch& b, const Collocation& step) : b_(b), step_(step), W_(b.kernel.width), size_(3 * info(b.shape).n_nodes * W_) {
    call_.law = parameters(b.material), call_.area = b.area;
  }
  void gather_cells(int first, const double* X) {
    call_.X = X;
    start_ = put(store_.start, first, *step_.start);
    for (int j = 0; j < n; ++j) {
      before_[j] = put(store_.before[j], first, *step_.before[j]), after_[j] = put(store_.after[j], first, *step_.after[j]);
      double* at = store_.at[j].get(size_);
      for (int k = 0; k < size_; ++k) at[k] = (before_[j][k] + after_[j][k]) / 2;
      at_[j] = at;
    }
  }
  /// What is not dW(e(Q_i)), to the forces f of stage i.
  void add_rest(int i, double* f) {
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
  /// The derivative of C (E_i - e(Q_i)) at Q_i by Q_k, but for the factor c:  B(Q_i)^T C B(Y) with Y = sum a_ij W_jk Q_j + a_ik h V_k, as
  /// B is linear, W = a^-1.
  void add_slope(int i, int k, double* K) {
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

 private:
  static constexpr int n = Collocation::n;
  static constexpr double rounding = 1e-9;  // of the energy: ways below its root are too short to do work that was missed
  struct Store {
    Scratch start, before[n], after[n], at[n], end, f, all, missed, length, energy, to, from, K;
  };
  const double* put(Scratch& to, int first, const Config& from) {
    gather(b_, first, W_, from.x, to.get(size_));
    return to.get(size_);
  }
  /// v C (way_i + share (e(to) - e(from))) at Q_i.
  KernelCall along(int i, double v, double share = 0, const double* from = nullptr, const double* to = nullptr) const {
    KernelCall c = call_;
    c.x0 = before_[i], c.x1 = after_[i], c.viscous = v;
    if (from) c.past[0] = from, c.past[1] = to, c.recall[1] = share;
    return c;
  }
  void add(KernelCall c, double* f) {
    c.f = store_.f.get(size_);
    b_.kernel.call(c);
    for (int k = 0; k < size_; ++k) f[k] += c.f[k];
  }
  /// C (E_i - e(Q_i)), in three calls that each take a third of a_ii way_i.
  std::array<KernelCall, n> variable(int i) const {
    const double v = step_.a[i][i] / 3;
    std::array<KernelCall, n> calls;
    for (int j = 0; j < n; ++j)
      calls[j] = j == i ? along(i, v, 1 / v, at_[i], start_) : along(i, v, step_.a[i][j] / v, before_[j], after_[j]);
    return calls;
  }
  void add_variable(int i, double* f) {
    for (const KernelCall& c : variable(i)) add(c, f);
  }
  /// factor times the K of a call.
  void add_tangent(double factor, KernelCall c, double* K) {
    const int size = size_ * (size_ / W_);
    c.K = store_.K.get(size);
    b_.kernel.call(c);
    for (int k = 0; k < size; ++k) K[k] += factor * c.K[k];
  }
  /// factor f.h V_j of each cell to `sum`.
  void add_product(double factor, const double* f, int j, double* sum) const {
    for (int k = 0; k < size_; ++k) sum[k % W_] += factor * f[k] * (after_[j][k] - before_[j][k]);
  }
  /// W1 - W0 and |W1| + |W0| of each cell.
  void find_energy_change(double* change, double* size) {
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
  const SolidBatch& b_;
  const Collocation& step_;
  int W_, size_;
  KernelCall call_{};
  const double *start_ = nullptr, *before_[n]{}, *after_[n]{}, *at_[n]{};
  static thread_local Store store_;
};
thread_local CellStages::Store CellStages::store_;

/// Stage whose positions the derivatives are by: that of the pair of the rate terms.
int columns_of(const Stage& s) {
  for (int k = 0; k < Collocation::n; ++k)
    if (s.w1 == s.step->after[k]) return k;
  return s.member;
}

}  // namespace

void Solids::evaluate(Pass& p) const {
  thread_local Lanes lanes;
  thread_local std::vector<double> Ke;
  thread_local std::vector<NodeMap> maps;
  thread_local std::vector<std::array<bool, 3>> masks;
  const Stage& s = p.s;
  const bool same_pair = s.w0 == s.e0 && s.w1 == s.e1, is_strained = s.chain != 0;  // else it is inertia and rates that matter
  const Vec3 g = points_.gravity * s.load_factor;
  const auto& X = points_.X;
  const auto& follower = points_.follower;
  const auto& fixed = points_.fixed;
  for (const SolidBatch& b : batches) {
    const int W = b.kernel.width, n = info(b.shape).n_nodes, n3 = 3 * n, count = static_cast<int>(b.cells.size());
    double *X_ = lanes.X.get(n3 * W), *x0 = lanes.x0.get(n3 * W), *x1 = lanes.x1.get(n3 * W), *a = lanes.a.get(n3 * W),
           *f = lanes.f.get(n3 * W);
    double* K = p.K ? lanes.K.get(static_cast<size_t>(n3) * n3 * W) : nullptr;
    double* det = lanes.scalar[0].get(W);
    const double rate = s.h > 0 ? b.beta / s.h : 0, viscous = (s.dissipation ? s.dissipation->kappa : 0) + (same_pair ? rate : 0);
    KernelCall call{X_,      x0,
                    x1,      is_strained ? 1. : 0.,
                    viscous, parameters(b.material),
                    f,       K,
                    nullptr, nullptr,
                    det,     b.density,
                    a,       (s.mass_slope + b.alpha * s.alpha_slope) / (is_strained ? s.chain : 1),
                    b.area,  s.weight};
    double* h0 = lanes.h0.get(static_cast<size_t>(b.kernel.n_state) * W);
    call.h0 = h0, call.elapsed = s.elapsed;
    double *before = lanes.before.get(n3 * W), *along = lanes.along.get(n3 * W);
    double *one = lanes.one.get(n3 * W), *two = lanes.two.get(n3 * W);
    if (const Dissipation* d = s.dissipation) {
      const double share = d->kappa / viscous;
      call.past[0] = one, call.past[1] = two, call.recall[0] = share * d->last(), call.recall[1] = share * d->before();
    }
    if (K && s.before) call.before = before, call.along = along;
    std::optional<CellStages> stages;
    const int by = s.step ? columns_of(s) : 0;
    const bool crossed = K && s.step && by != s.member;
    if (s.step && (crossed || !s.rates_alone)) stages.emplace(b, *s.step);
    for (int first = 0; first < count; first += W) {
      gather(b, first, W, X, X_);
      gather(b, first, W, s.e0->x, x0);
      gather(b, first, W, s.e1->x, x1);
      gather(b, first, W, s.a->x, a);
      if (call.past[0]) gather(b, first, W, s.dissipation->one->x, one), gather(b, first, W, s.dissipation->two->x, two);
      if (call.before) gather(b, first, W, s.before->x, before), gather(b, first, W, s.along->x, along);
      if (b.kernel.n_state > 0) gather_state(b, first, W, b.h0, h0);
      for (int k = 0; k < n; ++k)
        for (int i = 0; i < 3; ++i)
          for (int l = 0; l < W; ++l) a[(3 * k + i) * W + l] -= g[i];
      if (b.alpha > 0 && s.v) {
        double* v = lanes.f2.get(n3 * W);
        gather(b, first, W, s.v->x, v);
        for (int i = 0; i < n3 * W; ++i) a[i] += b.alpha * v[i];
      }
      if (crossed)
        std::fill_n(f, n3 * W, 0.0), std::fill_n(K, n3 * n3 * W, 0.0), std::fill_n(det, W, 1e300);
      else
        b.kernel.call(call);
      if (stages) stages->gather_cells(first, X_);
      if (stages && !crossed) stages->add_rest(s.member, f);
      if (stages && K) stages->add_slope(s.member, by, K);
      if (K && is_strained && s.chain != 1)
        for (int i = 0; i < n3 * n3 * W; ++i) K[i] *= s.chain;
      if (!same_pair && rate > 0) {  // rate terms with a pair of their own
        double *f2 = lanes.f2.get(n3 * W), *K2 = K ? lanes.K2.get(static_cast<size_t>(n3) * n3 * W) : nullptr;
        gather(b, first, W, s.w0->x, x0);
        gather(b, first, W, s.w1->x, x1);
        b.kernel.call({X_, x0, x1, 0, rate, parameters(b.material), f2, K2, nullptr, nullptr, nullptr, 0, nullptr, 0, b.area});
        for (int i = 0; i < n3 * W; ++i) f[i] += f2[i];
        for (int i = 0; K && i < n3 * n3 * W; ++i) K[i] += s.slope1() * K2[i];
        if (K && s.slope0() != 0) {  // by x0: the ends exchanged, and with them the sign of the rate
          b.kernel.call({X_, x1, x0, 0, -rate, parameters(b.material), f2, K2, nullptr, nullptr, nullptr, 0, nullptr, 0, b.area});
          for (int i = 0; i < n3 * n3 * W; ++i) K[i] += s.slope0() * K2[i];
        }
      }
      for (int l = 0; l < W && first + l < count; ++l) {
        const int e = first + l;
        const int* nodes = b.nodes.data() + static_cast<size_t>(e) * n;
        if (b.shape != shell8) p.out.least_det.take({det[l], b.region});  // a shell may fold on its way: it has its stress foreseen
        bool plain = true;
        for (int k = 0; k < n; ++k) {
          Vec3 fk(f[3 * k * W + l], f[(3 * k + 1) * W + l], f[(3 * k + 2) * W + l]);
          p.node[nodes[k]] += fk;
          p.scale(fk.cwiseAbs().maxCoeff());
          plain = plain && follower[nodes[k]] < 0 && !(fixed[nodes[k]][0] || fixed[nodes[k]][1] || fixed[nodes[k]][2]);
        }
        if (!p.K) continue;
        Ke.resize(static_cast<size_t>(n3) * n3);
        for (int i = 0; i < n3 * n3; ++i) Ke[i] = K[static_cast<size_t>(i) * W + l];
        if (plain) {
          p.K->add(b.first_clique + e, Ke.data());
        } else {
          const auto blocks = points_.layout.cliques[b.first_clique + e];
          points_.make_maps({nodes, static_cast<size_t>(n)}, blocks, s, maps, masks);
          add_reduced(*p.K, b.first_clique + e, n, Ke.data(), maps.data(), static_cast<int>(blocks.size()), masks.data());
        }
      }
    }
  }
}

/// Elastic energy at q, kinetic energy and momenta at v, of the cells.
void Solids::add_energy(const Config& q, const Config& v, Energy& out) const {
  thread_local Lanes lanes;
  const auto& X = points_.X;
  const Vec3& gravity = points_.gravity;
  for (const SolidBatch& b : batches) {
    const int W = b.kernel.width, n = info(b.shape).n_nodes, n3 = 3 * n, count = static_cast<int>(b.cells.size());
    double *X_ = lanes.X.get(n3 * W), *x = lanes.x0.get(n3 * W), *vel = lanes.a.get(n3 * W), *p = lanes.f.get(n3 * W),
           *W_ = lanes.scalar[0].get(W);
    for (int first = 0; first < count; first += W) {
      gather(b, first, W, X, X_);
      gather(b, first, W, q.x, x);
      gather(b, first, W, v.x, vel);
      KernelCall call{X_, x, x, 0, 0, parameters(b.material), p, nullptr, W_, nullptr, nullptr, b.density, vel, 0, b.area};
      if (b.kernel.n_state > 0) {
        double* state = lanes.h0.get(static_cast<size_t>(b.kernel.n_state) * W);
        gather_state(b, first, W, b.h1, state);
        call.h0 = state;
      }
      b.kernel.call(call);
      for (int l = 0; l < W && first + l < count; ++l) {
        out.elastic += W_[l];
        for (int k = 0; k < n; ++k) {
          const Vec3 pk(p[3 * k * W + l], p[(3 * k + 1) * W + l], p[(3 * k + 2) * W + l]),
              vk(vel[3 * k * W + l], vel[(3 * k + 1) * W + l], vel[(3 * k + 2) * W + l]);
          const Vec3 xk(x[3 * k * W + l], x[(3 * k + 1) * W + l], x[(3 * k + 2) * W + l]);
          out.kinetic += pk.dot(vk) / 2;
          out.momentum += pk;
          out.angular += xk.cross(pk);
        }
      }
      if (gravity.isZero(0)) continue;
      b.kernel.call({X_, x, x, 0, 0, parameters(b.material), p, nullptr, nullptr, nullptr, nullptr, b.density, x, 0, b.area});
      for (int l = 0; l < W && first + l < count; ++l)
        for (int k = 0; k < n; ++k)
          for (int i = 0; i < 3; ++i) out.gravity -= gravity[i] * p[(3 * k + i) * W + l];
    }
  }
}

void Solids::advance(const Stage& s) {
  thread_local Lanes lanes;
  for (SolidBatch& b : batches) {
    if (b.kernel.n_state == 0) continue;
    const int W = b.kernel.width, n3 = 3 * info(b.shape).n_nodes, count = static_cast<int>(b.cells.size()), m = b.kernel.n_state;
    double *X_ = lanes.X.get(n3 * W), *x0 = lanes.x0.get(n3 * W), *x1 = lanes.x1.get(n3 * W), *D = lanes.scalar[0].get(W),
           *h0 = lanes.h0.get(static_cast<size_t>(m) * W), *h1 = lanes.h1.get(static_cast<size_t>(m) * W);
    b.dissipated = 0;
    for (int first = 0; first < count; first += W) {
      gather(b, first, W, points_.X, X_);
      gather(b, first, W, s.e0->x, x0);
      gather(b, first, W, s.e1->x, x1);
      gather_state(b, first, W, b.h0, h0);
      KernelCall call{X_, x0, x1, 1, 0, parameters(b.material), nullptr, nullptr, nullptr, D, nullptr, 0, nullptr, 0, b.area, s.weight};
      call.h0 = h0, call.h1 = h1, call.elapsed = s.elapsed;
      b.kernel.call(call);
      for (int l = 0; l < W && first + l < count; ++l) {  // what fills the lanes up has no state of its own
        b.dissipated += D[l];
        for (int k = 0; k < m; ++k) b.h1[static_cast<size_t>(first + l) * m + k] = h1[k * W + l];
      }
    }
  }
}

void Solids::settle(bool accepted) {
  for (SolidBatch& b : batches) (accepted ? b.h0 : b.h1) = accepted ? b.h1 : b.h0;
}

CellMemory Solids::memory() const {
  CellMemory out;
  for (const SolidBatch& b : batches) out.batch.push_back(b.h1);
  return out;
}

void Solids::archive(Archive& a) {
  CellMemory accepted;
  for (const SolidBatch& b : batches) accepted.batch.push_back(b.h0);
  a("solids", strain_told_, accepted);
  for (size_t k = 0; k < batches.size(); ++k) batches[k].h1 = batches[k].h0 = accepted.batch[k];
}

/// Dissipation by flow, and work of the rate terms and of the stress dissipation of the cells over a step, this rank's share.
void Solids::add_dissipation(const Stage& s, Work& sum) const {
  thread_local Lanes lanes;
  const auto& X = points_.X;
  const auto work = [&](const SolidBatch& b, const Config& q0, const Config& q1, double viscous, double last = 0, double before = 0) {
    double total = 0;
    if (viscous == 0) return total;
    const int W = b.kernel.width, n = info(b.shape).n_nodes, n3 = 3 * n, count = static_cast<int>(b.cells.size());
    double *X_ = lanes.X.get(n3 * W), *x0 = lanes.x0.get(n3 * W), *x1 = lanes.x1.get(n3 * W), *D = lanes.scalar[0].get(W);
    for (int first = 0; first < count; first += W) {
      gather(b, first, W, X, X_);
      gather(b, first, W, q0.x, x0);
      gather(b, first, W, q1.x, x1);
      KernelCall call{X_, x0, x1, 0, viscous, parameters(b.material), nullptr, nullptr, nullptr, D, nullptr, 0, nullptr, 0, b.area};
      if (last != 0 || before != 0) {
        double *one = lanes.one.get(n3 * W), *two = lanes.two.get(n3 * W);
        gather(b, first, W, s.dissipation->one->x, one), gather(b, first, W, s.dissipation->two->x, two);
        call.past[0] = one, call.past[1] = two, call.recall[0] = last, call.recall[1] = before;
      }
      b.kernel.call(call);
      for (int l = 0; l < W && first + l < count; ++l) total += D[l];
    }
    return total;
  };
  for (const SolidBatch& b : batches) {
    if (s.elapsed > 0) sum.dissipated += b.dissipated;
    sum.add(s, [&](const Config& from, const Config& to, double last, double before) { return work(b, from, to, 1, last, before); });
    if (s.h > 0) sum.dissipated += work(b, *s.w0, *s.w1, b.beta / s.h * s.share());
  }
}

/// Mass-proportional damping: alpha M v.dx.
double Solids::mass_damping(const Stage& s) const {
  double total = 0;
  for (const SolidBatch& b : batches) {
    if (b.alpha == 0 || !s.v) continue;
    const int n = info(b.shape).n_nodes, W = b.kernel.width;
    Lanes lanes;
    const size_t size = 3 * static_cast<size_t>(n) * W;
    double *X_ = lanes.X.get(size), *v = lanes.x0.get(size), *f = lanes.f.get(size);
    for (size_t e = 0; e < b.cells.size(); ++e) {
      const int* nodes = b.nodes.data() + e * n;
      for (int k = 0; k < n; ++k)
        for (int i = 0; i < 3; ++i)
          for (int l = 0; l < W; ++l) X_[(3 * k + i) * W + l] = points_.X[nodes[k]][i], v[(3 * k + i) * W + l] = s.v->x[nodes[k]][i];
      b.kernel.call({X_, X_, X_, 0, 0, parameters(b.material), f, nullptr, nullptr, nullptr, nullptr, b.density * b.alpha, v, 0, b.area});
      for (int k = 0; k < n; ++k)
        for (int i = 0; i < 3; ++i) total += f[(3 * k + i) * W] * (s.end->x[nodes[k]][i] - s.from().x[nodes[k]][i]);
    }
  }
  return total;
}

void Solids::add_work(const Moment& m, Work& sum) const {
  add_dissipation(m.s, sum);
  sum.dissipated += mass_damping(m.s);
}

}  // namespace hilo
