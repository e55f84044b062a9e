// SPDX-License-Identifier: GPL-3.0-or-later
// hilo as a library: a material of one's own.  A cube of a solid that stiffens with strain is pulled, and the force is compared with the
// closed form.
#include <cmath>
#include <cstdio>

#include "dynamics/run.hpp"
#include "model/local_mesh.hpp"
#include "model/store.hpp"
#include "physics/add_material.hpp"

using namespace hilo;

/// W = Q/2 + a Q^2/(4 Y) with Q = E:C:E, C of Young's modulus Y and Poisson's ratio, E the Green-Lagrange strain [J/m^3].
struct Stiffening {
  static constexpr std::string_view name = "stiffening", meaning = "a solid whose stiffness grows with the square of the strain";
  static std::vector<Param> keys() {
    return {young, poisson, {"a", Type::number, "1", "!", "a bar of strain e carries Y e (1 + a e^2)", above(0)}};
  }
  static Stiffening make(const MaterialValues& v) { return {lame(v.number("E"), v.number("nu")), v.number("E"), v.number("a")}; }
  using Bulk = NoBulk;
  static constexpr double soft_below = 0.58;
  static constexpr std::string_view soft_because = "it softens when it is pressed so far";
  Lame c;
  double Y, a;

  Lame linear() const { return c; }
  template <class T>
  T energy(const T e[6]) const {
    T Ce[6];
    linear_stress(c, e, Ce);
    const T Q = dot(e, Ce);
    return Q / 2 + a / (4 * Y) * Q * Q;
  }
  /// Q1 - Q0 = (E0 + E1):C:(E1 - E0), so S = (1 + a (Q0 + Q1)/(2 Y)) C (E0 + E1)/2 has S:(E1 - E0) = W1 - W0 exactly.
  template <class T>
  void stress(const T e0[6], const T e1[6], T s[6], T (*D)[6]) const {
    T s0[6], s1[6];
    linear_stress(c, e0, s0);
    linear_stress(c, e1, s1);
    const T factor = 1 + a / (2 * Y) * (dot(e0, s0) + dot(e1, s1));
    for (int i = 0; i < 6; ++i) s[i] = factor * (s0[i] + s1[i]) / 2;
    if (!D) return;
    T C[6][6];
    for (auto& row : C)
      for (T& entry : row) entry = 0 * factor;
    add_linear_tangent(c, 0.5, C);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) D[i][j] += factor * C[i][j] + a / (2 * Y) * (s0[i] + s1[i]) * s1[j];
  }

 private:
  template <class T>
  static T dot(const T x[6], const T y[6]) {
    T sum = x[0] * y[0];
    for (int i = 1; i < 6; ++i) sum += x[i] * y[i];
    return sum;
  }
};

/// The unit cube as one hexahedron, with sets of its nodes on x = 0, y = 0, z = 0 and x = 1.
static Mesh cube() {
  Mesh mesh;
  const int corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  std::array<std::int64_t, 8> nodes;
  for (int n = 0; n < 8; ++n) {
    mesh.X.emplace_back(corner[n][0], corner[n][1], corner[n][2]);
    mesh.node_id.push_back(n);
    nodes[n] = n;
    mesh.node_sets[corner[n][0] ? "x1" : "x0"].push_back(n);
    if (!corner[n][1]) mesh.node_sets["y0"].push_back(n);
    if (!corner[n][2]) mesh.node_sets["z0"].push_back(n);
  }
  mesh.add_cell(Shape::hex8, nodes, 0, 0);
  mesh.region_name = {"cube"};
  mesh.region_data.resize(1);
  return mesh;
}

int main() {
  return guarded("own_material", [] {
    add_material<Stiffening>();
    write_mesh("cube.h5", cube(), {"own_material"});
    LocalMesh mesh = read_local_mesh("cube.h5", Comm::world());
    const Scene scene = Scene::parse(R"(
      material.own = {kind = "stiffening", E = 1e6, nu = 0.3, a = 5, density = 1000}
      region.cube = {material = "own"}
      motion = [{kind = "fixed", name = "x", on = "x0", components = ["x"]}, {kind = "fixed", name = "y", on = "y0", components = ["y"]},
                {kind = "fixed", name = "z", on = "z0", components = ["z"]},
                {kind = "translation", name = "pull", on = "x1", components = ["x"], displacement = [0.2, 0, 0]}]
      time = {analysis = "static", steps = 2})",
                                     "own_material");
    const auto system = build_system(scene, &mesh, Comm::world());
    if (!run(scene, *system, {.output = "cube-run.h5", .quiet = true}).complete) throw Error("", "the run stopped");
    const Store file = Store::open("cube-run.h5");
    const auto pull = file.read<double>("/history/motion/pull");  // n_t x 6: force [N], moment [N m]
    const double force = std::abs(pull[pull.size() - 6]);
    // a bar of stretch l under uniaxial stress: E = (l^2 - 1)/2, S = Y E (1 + a E^2), and the force over the first area is l S
    const double l = 1.2, e = (l * l - 1) / 2, exact = l * 1e6 * e * (1 + 5 * e * e);
    std::printf("the cube is pulled by %.6e N, exact %.6e N\n", force, exact);
    if (std::abs(force / exact - 1) > 1e-7) throw Error("", "is wrong");
  });
}
