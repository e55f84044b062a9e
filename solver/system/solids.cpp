// SPDX-License-Identifier: GPL-3.0-or-later
// Flexible cells: gather, kernel on as many cells as there are lanes, scatter.
#include "system/solids.hpp"

#include <algorithm>
#include <optional>

#include "base/shell_shape.hpp"
#include "system/cell_stages.hpp"

namespace hilo {
namespace {

/// Arrays of one call, (entry x lanes).
struct Lanes {
  Scratch X, x0, x1, a, f, K, f2, K2, h0, h1, before, along, one, two, scalar[3];
};

/// States of W cells, (entry x lanes).
void gather_state(const SolidBatch& b, int first, int W, const std::vector<double>& from, double* to) {
  const int n = b.kernel.n_state, last = static_cast<int>(b.cells.size()) - 1;
  for (int l = 0; l < W; ++l) {
    const double* cell = from.data() + static_cast<size_t>(std::min(first + l, last)) * n;
    for (int k = 0; k < n; ++k) to[k * W + l] = cell[k];
  }
}

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
    if (K && s.last) call.before = before, call.along = along;
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
      if (call.before) gather(b, first, W, s.last->before.x, before), gather(b, first, W, s.last->along.x, along);
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
