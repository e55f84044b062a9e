// SPDX-License-Identifier: GPL-3.0-or-later
// Motions of a whole scene as one rigid body, and the shares that modes have in them.
#pragma once
#include "dynamics/modes/linearized.hpp"

namespace hilo {

/// Along x, y, z and about axes through the origin: the forces of inertia (n x 6) of everything that moves along.
struct RigidMotions {
  using Vector = Eigen::VectorXd;
  Eigen::MatrixXd force;
  Vec3 centre = Vec3::Zero();                     // of all mass, what is held too
  Eigen::Matrix<double, Eigen::Dynamic, 6> drag;  // of dampers along x, y, z where what stands still swings along, and where it does not
  RigidMotions(const System& system, const Linearized& at, const Config& q) : force(at.n(), 6), drag(at.n(), 6) {
    drag.setZero();
    Config v;
    for (int k = 0; k < 6; ++k) {
      const Vec3 e = Vec3::Unit(k % 3);
      const auto moved = [&](const Vec3& p) { return k < 3 ? e : Vec3(e.cross(p)); };
      const Mat3 spin = k < 3 ? Mat3(Mat3::Zero()) : skew(e);
      combine(v, {{0, &q}});
      for (size_t i = 0; i < q.x.size(); ++i) v.x[i] = moved(q.x[i]);
      for (size_t b = 0; b < q.c.size(); ++b) v.c[b] = moved(q.c[b]), v.R[b] = spin * q.R[b];
      for (size_t j = 0; j < q.Y.size(); ++j) v.Y[j] = spin * q.Y[j];
      force.col(k) = at.mass_of(v);
      if (const Energy all = system.energy(q, v); k < 2 && all.momentum[k] > 0) {  // angular momentum m centre x e
        const Vec3 lever = all.angular / all.momentum[k];
        if (k == 0) centre[1] = -lever[2], centre[2] = lever[1];
        if (k == 1) centre[0] = lever[2];
      }
      if (k < 3 && system.traits().has_rates) {
        drag.col(k) = at.damping_of(v, false);
        v.c[0].setZero();
        drag.col(3 + k) = at.damping_of(v);
      }
    }
  }
  /// Share of a mode of unit mass in these motions, those about axes through the centre of mass.
  Vec6 part_of(const Vector& mode) const {
    Vec6 p = force.transpose() * mode;
    for (int k = 0; k < 3; ++k) p[3 + k] -= Vec3(Vec3::Unit(k)).cross(centre).dot(p.head<3>());
    return p;
  }
};

}  // namespace hilo
