// Flexible cells: gather, kernel on as many cells as there are lanes, scatter.
#include <cstring>

#include "system/pass.hpp"

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
  Scratch X, x0, x1, a, f, K, f2, K2, scalar[3];
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

}  // namespace

void System::add_solids(Pass& p) const {
  thread_local Lanes lanes;
  thread_local std::vector<double> Ke;
  thread_local std::vector<NodeMap> maps;
  thread_local std::vector<std::array<bool, 3>> masks;
  const Stage& s = p.s;
  const bool same_pair = s.w0 == s.e0 && s.w1 == s.e1;
  const Vec3 g = gravity * s.load_factor;
  for (const SolidBatch& b : batches) {
    const int W = b.kernel.width, n = info(b.shape).n_nodes, n3 = 3 * n, count = static_cast<int>(b.cells.size());
    double *X_ = lanes.X.get(n3 * W), *x0 = lanes.x0.get(n3 * W), *x1 = lanes.x1.get(n3 * W), *a = lanes.a.get(n3 * W),
           *f = lanes.f.get(n3 * W);
    double* K = p.K ? lanes.K.get(static_cast<size_t>(n3) * n3 * W) : nullptr;
    double* det = lanes.scalar[0].get(W);
    const double rate = s.h > 0 ? b.beta / s.h : 0;
    KernelCall call{X_,
                    x0,
                    x1,
                    1,
                    same_pair ? rate + s.chi / 2 : s.chi / 2,
                    parameters(b.material),
                    f,
                    K,
                    nullptr,
                    nullptr,
                    det,
                    b.density,
                    a,
                    (s.mass_slope + b.alpha * s.alpha_slope) / s.chain,
                    b.area,
                    s.weight};
    for (int first = 0; first < count; first += W) {
      gather(b, first, W, X, X_);
      gather(b, first, W, s.e0->x, x0);
      gather(b, first, W, s.e1->x, x1);
      gather(b, first, W, s.a->x, a);
      for (int k = 0; k < n; ++k)
        for (int i = 0; i < 3; ++i)
          for (int l = 0; l < W; ++l) a[(3 * k + i) * W + l] -= g[i];
      if (b.alpha > 0 && s.v) {
        double* v = lanes.f2.get(n3 * W);
        gather(b, first, W, s.v->x, v);
        for (int i = 0; i < n3 * W; ++i) a[i] += b.alpha * v[i];
      }
      b.kernel.call(call);
      if (K && s.chain != 1)
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
        p.out.least_det.take({det[l], b.region});
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
          const auto blocks = cliques[b.first_clique + e];
          make_maps({nodes, static_cast<size_t>(n)}, blocks, s, maps, masks);
          add_reduced(*p.K, b.first_clique + e, n, Ke.data(), maps.data(), static_cast<int>(blocks.size()), masks.data());
        }
      }
    }
  }
}

void System::make_maps(std::span<const int> nodes, std::span<const int> blocks, const Stage& s, std::vector<NodeMap>& maps,
                       std::vector<std::array<bool, 3>>& masks) const {
  maps.resize(nodes.size());
  masks.resize(nodes.size());
  for (size_t k = 0; k < nodes.size(); ++k) {
    const int node = nodes[k], body = follower[node], block = body < 0 ? node_block[node] : body_block[body];
    maps[k].slot = -1;
    for (size_t i = 0; i < blocks.size() && block >= 0; ++i)
      if (blocks[i] == block) maps[k].slot = static_cast<int>(i);
    maps[k].follower = body >= 0;
    if (body >= 0) maps[k].left = s.left->x[node] - s.left->c[body], maps[k].right = s.end->x[node] - s.end->c[body];
    masks[k] = fixed[node];
  }
}

/// Elastic energy at q, kinetic energy and momenta at v, of the cells.
System::Energy System::energy(const Config& q, const Config& v) const {
  thread_local Lanes lanes;
  Energy out;
  double gravity_energy = 0;
  for (const SolidBatch& b : batches) {
    const int W = b.kernel.width, n = info(b.shape).n_nodes, n3 = 3 * n, count = static_cast<int>(b.cells.size());
    double *X_ = lanes.X.get(n3 * W), *x = lanes.x0.get(n3 * W), *vel = lanes.a.get(n3 * W), *p = lanes.f.get(n3 * W),
           *W_ = lanes.scalar[0].get(W);
    for (int first = 0; first < count; first += W) {
      gather(b, first, W, X, X_);
      gather(b, first, W, q.x, x);
      gather(b, first, W, v.x, vel);
      b.kernel.call({X_, x, x, 0, 0, parameters(b.material), p, nullptr, W_, nullptr, nullptr, b.density, vel, 0, b.area});
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
          for (int i = 0; i < 3; ++i) gravity_energy -= gravity[i] * p[(3 * k + i) * W + l];
    }
  }
  for (const auto& [node, m] : point_masses) {
    out.kinetic += m * v.x[node].squaredNorm() / 2;
    out.momentum += m * v.x[node];
    out.angular += m * q.x[node].cross(v.x[node]);
    gravity_energy -= m * gravity.dot(q.x[node]);
  }
  for (size_t b = 0; b < bodies.size(); ++b) {
    if (static_cast<int>(b) % comm->size != comm->rank || bodies[b].mass == 0) continue;
    const Body& body = bodies[b];
    out.kinetic += body.inertia(v.c[b], v.R[b], v.c[b], v.R[b]) / 2;
    out.momentum += body.mass * v.c[b];
    out.angular += body.mass * q.c[b].cross(v.c[b]);
    const Mat3 RJ = q.R[b] * body.J;
    for (int i = 0; i < 3; ++i) out.angular += RJ.col(i).cross(v.R[b].col(i));
    gravity_energy -= body.mass * gravity.dot(q.c[b]);
  }
  out.gravity = gravity_energy;
  for (size_t i = 0; i < springs.size(); ++i) {
    if (!owns_spring_[i]) continue;
    SpringLaw::Values e{};
    for (size_t m = 0; m < springs[i].measures.size(); ++m) e[m] = springs[i].value(static_cast<int>(m), q);
    Response r;
    springs[i].law->elastic(e, e, r);
    out.elastic += r.energy;
  }
  double all[9] = {out.kinetic,     out.elastic,    out.gravity,    out.momentum[0], out.momentum[1],
                   out.momentum[2], out.angular[0], out.angular[1], out.angular[2]};
  comm->sum(all);
  out.kinetic = all[0], out.elastic = all[1], out.gravity = all[2];
  out.momentum = Vec3(all[3], all[4], all[5]), out.angular = Vec3(all[6], all[7], all[8]);
  return out;
}

/// Work of the rate terms and of the stress dissipation of the cells over a step, this rank's share.
double System::solid_dissipation(const Stage& s) const {
  thread_local Lanes lanes;
  double total = 0;
  const auto add = [&](const SolidBatch& b, const Config& q0, const Config& q1, double viscous) {
    if (viscous == 0) return;
    const int W = b.kernel.width, n = info(b.shape).n_nodes, n3 = 3 * n, count = static_cast<int>(b.cells.size());
    double *X_ = lanes.X.get(n3 * W), *x0 = lanes.x0.get(n3 * W), *x1 = lanes.x1.get(n3 * W), *D = lanes.scalar[0].get(W);
    for (int first = 0; first < count; first += W) {
      gather(b, first, W, X, X_);
      gather(b, first, W, q0.x, x0);
      gather(b, first, W, q1.x, x1);
      b.kernel.call({X_, x0, x1, 0, viscous, parameters(b.material), nullptr, nullptr, nullptr, D, nullptr, 0, nullptr, 0, b.area});
      for (int l = 0; l < W && first + l < count; ++l) total += D[l];
    }
  };
  for (const SolidBatch& b : batches) {
    add(b, *s.e0, *s.e1, s.chi / 2);
    if (s.h > 0) add(b, *s.w0, *s.w1, b.beta / s.h);
  }
  return total;
}

}  // namespace hilo
