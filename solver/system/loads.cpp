// Loads within an evaluation: mean of the history over the step, at the step's left configuration.
#include "system/facet.hpp"
#include "system/pass.hpp"

namespace hilo {

void System::add_loads(Pass& p) const {
  const Stage& s = p.s;
  std::vector<NodeMap> maps;
  std::vector<std::array<bool, 3>> masks;
  for (const Load& load : loads) {
    const double factor = load.factor(s.t0, s.t1, s.load_factor);
    switch (load.kind) {
      case Load::Kind::nodal:
        for (size_t i = 0; i < load.nodes.size(); ++i) {
          const Vec3 f = factor * load.weight[i] * load.value;
          p.node[load.nodes[i]] -= f;
          p.scale(f.norm());
        }
        break;
      case Load::Kind::body_force:
      case Load::Kind::body_torque: {
        if (comm->rank != load.body % comm->size) break;
        const int b = load.body;
        const bool force = load.kind == Load::Kind::body_force;
        const Vec3 f = factor * (load.follower ? Vec3(s.left->R[b] * load.value) : load.value);
        Mat3 K = Mat3::Zero();
        if (force) {
          p.body[b].head<3>() -= f;
          p.body[b].tail<3>() -= (s.left->R[b] * load.arm).cross(f);
          K = -s.slope * skew(f) * skew(s.end->R[b] * load.arm);
        } else {
          p.body[b].tail<3>() -= f;
          if (load.follower) K = s.slope * skew(s.end->R[b] * load.value * factor);
        }
        p.scale(force ? f.norm() : f.norm() / bodies[b].size);
        if (p.K && body_block[b] >= 0) {
          Eigen::Matrix<double, 6, 6, Eigen::RowMajor> K6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>::Zero();
          K6.bottomRightCorner<3, 3>() = K;
          p.K->add(body_clique(b), K6.data());
        }
        break;
      }
      case Load::Kind::pressure:
        for (size_t e = 0; e < load.facets.size(); ++e) {
          const std::vector<int>& nodes = load.facets[e];
          const int n = static_cast<int>(nodes.size());
          std::vector<Vec3> x0(n), x1(n), f(n);
          for (int a = 0; a < n; ++a) x0[a] = s.e0->x[nodes[a]], x1[a] = s.e1->x[nodes[a]];
          if (!s.conserving())
            for (int a = 0; a < n; ++a) x0[a] = x1[a] = (1 - s.weight) * x0[a] + s.weight * x1[a];
          std::vector<double> K(p.K ? 9 * n * n : 0);
          pressure_force(factor * load.pressure, x0, x1, f, p.K ? K.data() : nullptr);
          for (int a = 0; a < n; ++a) p.node[nodes[a]] -= f[a], p.scale(f[a].norm());
          if (!p.K) continue;
          for (double& k : K) k *= -s.chain * (s.conserving() ? 1 : 2 * s.weight);
          const auto blocks = cliques[load.cliques[e]];
          make_maps(nodes, blocks, s, maps, masks);
          add_reduced(*p.K, load.cliques[e], n, K.data(), maps.data(), static_cast<int>(blocks.size()), masks.data());
        }
        break;
    }
  }
}

/// Work of what acts from outside over the step from q0 to q1: loads, and the forces that prescribed motions exert.
System::Work System::work(const Stage& s, std::span<const double> lambda) const {
  const Config& from = s.work_from ? *s.work_from : *s.e0;
  double external = 0, dissipated = solid_dissipation(s);
  for (const Load& load : loads) {
    const double factor = load.factor(s.t0, s.t1, s.load_factor);
    if (load.kind == Load::Kind::nodal) {
      for (size_t i = 0; i < load.nodes.size(); ++i)
        external += factor * load.weight[i] * load.value.dot(s.end->x[load.nodes[i]] - from.x[load.nodes[i]]);
    } else if (load.kind == Load::Kind::pressure) {
      for (const auto& nodes : load.facets) {
        std::vector<Vec3> x0(nodes.size()), x1(nodes.size()), f(nodes.size());
        for (size_t a = 0; a < nodes.size(); ++a) x0[a] = from.x[nodes[a]], x1[a] = s.end->x[nodes[a]];
        pressure_force(factor * load.pressure, x0, x1, f, nullptr);
        for (size_t a = 0; a < nodes.size(); ++a) external += f[a].dot(x1[a] - x0[a]);
      }
    } else if (comm->rank == load.body % comm->size) {
      const int b = load.body;
      const Vec3 f = factor * (load.follower ? Vec3(s.left->R[b] * load.value) : load.value);
      if (load.kind == Load::Kind::body_force) {
        external += f.dot(s.end->c[b] - from.c[b] + (s.end->R[b] - from.R[b]) * load.arm);
      } else {  // R1 - R0 = skew(w) (R0 + R1)/2 defines the rotation increment w
        external += f.dot(rotation_increment(from.R[b], s.end->R[b]));
      }
    }
  }
  for (size_t j = 0; j < joints.size(); ++j)
    if (owns_joint_[j] && joints[j].drive.row >= 0 && joints[j].active[joints[j].drive.row])
      external += drive_work(joints[j], s, from, lambda[3 * (joint_block[j] - first_joint_block()) + joints[j].drive.row]);
  for (size_t i = 0; i < springs.size(); ++i) {
    if (!owns_spring_[i] || s.h <= 0) continue;
    SpringLaw::Values r0{}, r1{};
    for (size_t m = 0; m < springs[i].measures.size(); ++m) {
      r0[m] = springs[i].value(static_cast<int>(m), *s.w0);
      r1[m] = springs[i].value(static_cast<int>(m), *s.w1);
    }
    Response response;
    springs[i].law->viscous(r0, r1, interval(springs[i], s, lambda), response);
    const double share = s.span > 0 ? s.span / s.h : 1;
    dissipated += share * response.dissipated, external += share * response.supplied;
  }
  for (const SolidBatch& b : batches) {  // mass-proportional damping: alpha M v.dx
    if (b.alpha == 0 || !s.v) continue;
    const int n = info(b.shape).n_nodes, W = b.kernel.width;
    alignas(64) double X_[60 * 8], v[60 * 8], f[60 * 8];
    for (size_t e = 0; e < b.cells.size(); ++e) {
      const int* nodes = b.nodes.data() + e * n;
      for (int k = 0; k < n; ++k)
        for (int i = 0; i < 3; ++i)
          for (int l = 0; l < W; ++l) X_[(3 * k + i) * W + l] = X[nodes[k]][i], v[(3 * k + i) * W + l] = s.v->x[nodes[k]][i];
      b.kernel.call({X_, X_, X_, 0, 0, parameters(b.material), f, nullptr, nullptr, nullptr, nullptr, b.density * b.alpha, v, 0, b.area});
      for (int k = 0; k < n; ++k)
        for (int i = 0; i < 3; ++i) dissipated += f[(3 * k + i) * W] * (s.end->x[nodes[k]][i] - from.x[nodes[k]][i]);
    }
  }
  external += motion_work(s, lambda, from);
  double both[2] = {external, dissipated};
  comm->sum(both);
  return {both[0], both[1]};
}

}  // namespace hilo
