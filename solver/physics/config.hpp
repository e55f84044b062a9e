// What every unknown is made of: positions of nodes, and of rigid bodies as a centre and three directors.
#pragma once
#include <string>
#include <vector>

#include "base/math.hpp"

namespace hilo {

/// Positions, or their velocities or accelerations.  A body's material point X sits at c + R (X - Xc): linear in (c, R), the natural
/// coordinates of the rigid super-element; its four points are c and c + L_i d_i, with d_i the columns of R.
struct Config {
  std::vector<Vec3> x;  // nodes, followers included   (n_nodes x 3)      [m]
  std::vector<Vec3> c;  // centres of the bodies       (n_bodies x 3)     [m]
  std::vector<Mat3> R;  // directors, columns          (n_bodies x 3 x 3) [1]

  void resize(size_t n_nodes, size_t n_bodies) {
    x.resize(n_nodes, Vec3::Zero()), c.resize(n_bodies, Vec3::Zero()), R.resize(n_bodies, Mat3::Zero());
  }
};

/// A rigid super-element: rigid regions joined by shared nodes, a massless patch, a body without mesh, or one whose motion is prescribed.
struct Body {
  std::string name;
  Vec3 Xc = Vec3::Zero();  // reference position of its centre of mass      [m]
  double mass = 0;         //                                               [kg]
  Mat3 J = Mat3::Zero();   // Euler tensor int rho (X - Xc)(X - Xc)^T dV    [kg m^2]
  double size = 1;         // a length of the body, for scaling             [m]
  std::string motion;      // that prescribes it
  bool held = false;       // by that motion
  bool moving = false;     // by the law of that motion
  bool ground = false;     // fixed for ever; body 0
  bool patch = false;      // massless, made for a joint on a flexible region
  bool free() const { return !held && !ground; }
  /// v.M w of velocities of its centre and directors [J].
  double inertia(const Vec3& v, const Mat3& V, const Vec3& w, const Mat3& W) const {
    return mass * v.dot(w) + (V * J).cwiseProduct(W).sum();
  }
};

}  // namespace hilo
