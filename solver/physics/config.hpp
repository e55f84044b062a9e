// SPDX-License-Identifier: GPL-3.0-or-later
// What every unknown is made of: positions of nodes, of bodies as a centre and three directors, and of linear regions their amplitudes
// beside these.
#pragma once
#include <string>
#include <type_traits>
#include <vector>

#include "base/archive.hpp"
#include "base/math.hpp"

namespace hilo {

/// Positions, or their velocities or accelerations.  A body's material point X sits at c + R (X - Xc): linear in (c, R), the natural
/// coordinates of the rigid super-element; its four points are c and c + L_i d_i, with d_i the columns of R.  A node of a linear region
/// sits at c + R (X - Xc) + sum_j Y_j phi_j, Y_j = eta_j R: linear in (c, R, Y).
struct Config {
  std::vector<Vec3> x;    // nodes, followers included   (n_nodes x 3)      [m]
  std::vector<Vec3> c;    // centres of the bodies       (n_bodies x 3)     [m]
  std::vector<Mat3> R;    // directors, columns          (n_bodies x 3 x 3) [1]
  std::vector<Vec3> eta;  // amplitudes of modes, three to a block (n_mode_blocks x 3)   [1]
  std::vector<Mat3> Y;    // their products with R       (3 n_mode_blocks x 3 x 3)       [1]

  /// Visit each of the arrays.
  template <class Visit>
  static void each_array(Visit&& visit) {
    visit(&Config::x), visit(&Config::c), visit(&Config::R), visit(&Config::eta), visit(&Config::Y);
  }
  void archive(Archive& a) {
    a.nodes(x);
    a("configuration", c, R, eta, Y);
  }
  /// As many of everything as another has, what is new zero.
  void resize_like(const Config& other) {
    each_array([&](auto array) {
      using T = typename std::remove_reference_t<decltype(this->*array)>::value_type;
      (this->*array).resize((other.*array).size(), T::Zero());
    });
  }
};

/// A rigid super-element: rigid regions joined by shared nodes, a massless patch, a body without mesh, or one whose motion is prescribed.
struct Body {
  std::string name;
  Vec3 Xc = Vec3::Zero();    // reference position of its centre of mass      [m]
  double mass = 0;           //                                               [kg]
  Mat3 J = Mat3::Zero();     // Euler tensor int rho (X - Xc)(X - Xc)^T dV    [kg m^2]
  double size = 1;           // a length of the body, for scaling             [m]
  std::string motion;        // that prescribes it
  bool held = false;         // by that motion
  bool moving = false;       // by the law of that motion
  bool ground = false;       // fixed for ever; body 0
  bool patch = false;        // massless, made for a joint on a flexible region
  bool block = false;        // massless, of nodes that the mesh says move as one
  bool has_cells = false;    // on the nodes of such a block, be it of a body of the scene: they hold it
  Vec3 line = Vec3::Zero();  // along which all of these nodes lie: nothing resists a turn about it
  bool linear = false;       // the mean axes of a linear region, whose inertia is not that of a rigid body
  bool free() const { return !held && !ground; }
  /// v.M w of velocities of its centre and directors [J].
  double inertia(const Vec3& v, const Mat3& V, const Vec3& w, const Mat3& W) const {
    return mass * v.dot(w) + (V * J).cwiseProduct(W).sum();
  }
};

}  // namespace hilo
