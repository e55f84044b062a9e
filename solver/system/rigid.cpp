// Rigid bodies and point masses within an evaluation.
#include "system/pass.hpp"

namespace hilo {

using RowMatrix6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

/// Inertia of a body in its natural coordinates: m (a_c - g) at the centre, and as moment sum_i d_i x (A J)_i with A the second derivative
/// of the directors.
void System::add_bodies(Pass& p) const {
  const Stage& s = p.s;
  for (size_t b = 0; b < bodies.size(); ++b) {
    const Body& body = bodies[b];
    if (body.mass == 0 && body.J.isZero(0)) continue;
    if (static_cast<int>(b) % comm->size != comm->rank) continue;
    const Vec3 force = body.mass * (s.a->c[b] - gravity * s.load_factor);
    const Mat3 AJ = s.a->R[b] * body.J;
    Vec3 moment = Vec3::Zero();
    for (int i = 0; i < 3; ++i) moment += s.left->R[b].col(i).cross(AJ.col(i));
    p.body[b].head<3>() += force;
    p.body[b].tail<3>() += moment;
    p.scale(std::max({body.mass * s.a->c[b].norm(), body.mass * gravity.norm(), AJ.norm() / body.size}));
    if (!p.K || body_block[b] < 0) continue;
    const double mass_slope = s.mass_slope * (s.tempo ? s.tempo[b] * s.tempo[b] : 1);
    RowMatrix6 K = RowMatrix6::Zero();
    K.topLeftCorner<3, 3>().diagonal().setConstant(mass_slope * body.mass);
    Mat3 Kr = Mat3::Zero();
    for (int i = 0; i < 3; ++i) {
      Kr += s.slope * skew(AJ.col(i)) * skew(s.end->R[b].col(i));
      const Mat3 left = skew(s.left->R[b].col(i));
      for (int j = 0; j < 3; ++j)
        if (body.J(i, j) != 0) Kr -= mass_slope * body.J(i, j) * left * skew(s.end->R[b].col(j));
    }
    K.bottomRightCorner<3, 3>() = Kr;
    p.K->add(body_clique(static_cast<int>(b)), K.data());
  }
  for (const auto& [node, m] : point_masses) {
    const Vec3 f = m * (s.a->x[node] - gravity * s.load_factor);
    p.node[node] += f;
    p.scale(f.norm());
  }
}

}  // namespace hilo
