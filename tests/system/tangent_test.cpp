// SPDX-License-Identifier: GPL-3.0-or-later
// The assembled tangent is the derivative of the assembled residual, for a scene with everything in it and both integrators' stages.
#include "dynamics/integrator/make.hpp"
#include "model/local_mesh.hpp"
#include "system/dense_kkt.hpp"
#include "system/somewhere_off.hpp"
#include "verify/verify.hpp"

namespace hilo::test::tangent_test {
namespace {

const char* const everything = R"(
gravity = [1, -2, -9.81]
material.soft = {kind = "neo-hookean", E = 2e5, nu = 0.3, density = 1000}
region."*" = {material = "soft", damping = 0.02, mass_damping = 0.7}
body = [{name = "top", mass = 3, com = [0.2, 0.1, 2], inertia = [0.2, 0.3, 0.4, 0.02, -0.01, 0.03]},
  {name = "side", mass = 2, com = [0.2, 1.5, 1], inertia = [0.1, 0.1, 0.1]},
  {name = "slider", mass = 1, com = [0.2, 1.9, 1.1], inertia = [0.02, 0.03, 0.04]},
  {name = "coin", mass = 1, com = [0.3, 0.2, 2.3], inertia = [0.02, 0.04, 0.03]}]
point_mass = [{name = "lump", on = "ymax", mass = 5}]
joint = [{kind = "revolute", name = "hinge", a = "zmax", b = "top", at = [0.2, 0.15, 1.2], axis = [1, 0.3, 0]},
  {kind = "universal", name = "cross", a = "top", b = "side", at = [0.2, 0.8, 1.5], axis = [0, 1, 0], x = [1, 0, 0]},
  {kind = "distance", name = "rod", a = "ground", b = "side", at_a = [2, 1.5, 1], at_b = [0.2, 1.6, 1]},
  {kind = "planar", name = "table", b = "top", at = [0.1, 0.1, 2], axis = [0, 0.2, 1]},
  {kind = "in-plane", name = "foot", a = "zmax", b = "side", at = [0.3, 1, 1], axis = [1, 0.2, 1]},
  {kind = "in-line", name = "pin", a = "top", b = "side", at = [0.3, 1, 1], axis = [1, 0.2, 1]},
  {kind = "constant-velocity", name = "bent", a = "top", b = "side", at = [0.3, 1, 1.2], axis = [1, 0.2, 1], axis_b = [1, 0.5, 0.5]},
  {kind = "screw", name = "spindle", a = "side", b = "top", at = [0.3, 1, 1.2], axis = [1, 0.2, 1], pitch = 0.4, angle = 0.3, history = {t = [0, 1], value = [
    0, 1], interpolation = "smooth"}},
  {kind = "cylindrical", name = "ram", a = "zmax", b = "side", at = [0.3, 1, 1.2], axis = [1, 0.2, 1], velocity = 0.2},
  {kind = "gear", name = "mesh", a = "top", b = "side", at = [0.3, 1, 1.2], axis = [1, 0.2, 1], axis_b = [0, 0.2, 1], ratio = -1.7, carrier = "zmax"},
  {kind = "rack", name = "teeth", a = "side", b = "top", at = [0.1, 1, 2.2], axis = [0, 0.2, 1], direction = [0, 1, 0.1], radius = 0.3},
  {kind = "weighted-sum", name = "rope", a = "zmax", b = "top", carrier = "side", at_a = [0.3, 0.1, 2], at_b = [0.1, 0.2, 2.2], at_carrier = [
    0.3, 1, 1.2], axis_a = [1, 0.2, 0], axis_carrier = [0, 1, 1], factors = [2, -1.5], factor_carrier = 0.7},
  {kind = "point-on-curve", name = "cam", a = "top", b = "side", at = [0.3, 1, 1.2], points = [[0, 0.8, 1], [0.2, 0.9, 1.2], [0.4, 1.1, 1.1], [0.5, 1.5, 1.3], [
    0.2, 1.7, 1.2]]},
  {kind = "distance", name = "long", a = "top", b = "side", at_a = [2, 1.5, 1], at_b = [0.2, 1.6, 1], length = 1.7},
  {kind = "cylindrical", name = "sleeve", a = "side", b = "slider", at = [0.2, 1.9, 1.1], axis = [0.2, 1, 0.3]},
  {kind = "rolling", name = "coin", a = "top", b = "coin", at = [0.3, 0.25, 2.3], axis = [0.1, 0, 1], radius = 0.3, axle = [0.2, 1, 0.3]},
  {kind = "knife-edge", name = "blade", a = "side", b = "coin", at = [0.1, 0.4, 1.2], axis = [0.1, 0, 1], edge = [0.2, 1, 0.3]}]
spring = [{kind = "axial", name = "strut", a = "heavy", b = "side", at_a = [0.1, 0.1, 0.2], at_b = [0.2, 1.5, 0.9], stiffness = 4000, damping = 50, length = 1},
  {kind = "torsion", name = "coil", a = "zmax", b = "top", axis = [1, 0.3, 0], stiffness = 300, damping = 4},
  {kind = "bushing", name = "mount", b = "heavy", at = [0.2, 0.15, 0], stiffness = [3000, 4000, 5000], damping = [10, 20, 30], angular_stiffness = [
    100, 200, 300], angular_damping = [1, 2, 3]}]
friction = [{name = "hinge", joint = "hinge", coefficient = 0.3, radius = 0.05, preload = 4, slip_velocity = 0.4},
  {name = "sleeve", joint = "sleeve", coefficient = 0.2, radius = 0.04, slip_velocity = 0.7}]
stop = [{kind = "angle", name = "hinge", joint = "hinge", upper = -0.02, stiffness = 500, restitution = 0.4},
  {kind = "slide", name = "sleeve", joint = "sleeve", lower = 0.04, stiffness = 900, restitution = 0.6, rest_speed = 0.5}]
motor = [{kind = "rotary", name = "sleeve", joint = "sleeve", rate = [-3, 5], torque = [7, -2], history = {t = [0, 1], value = [1, 2]}}]
load = [{kind = "pressure", name = "air", on = "xmax", pressure = 3000}, {kind = "pressure", name = "below", on = "zmin", pressure = 2000},
  {kind = "torque", name = "follower", on = "top", torque = [5, -7, 3], follower = true},
  {kind = "force", name = "push", on = "side", force = [50, 20, -30], at = [0.3, 1.7, 1.2]}]
motion = [{kind = "fixed", name = "held", on = "corner", components = ["x", "z"]},
  {kind = "rotation", name = "turned", on = "line", at = [0, 0, 0.6], axis = [0, 0, 1], angle = 0.5, history = {t = [0, 1], value = [0, 1]}}]
time = {end = 1, step = 0.02}
)";

std::unique_ptr<StageIntegrator> made(const std::string& name) {
  const double rho[3] = {0.9, 0.7, 0.5};
  if (name == "energy-momentum") return make_energy_momentum(0.1);
  if (name == "mid-point") return make_mid_point();
  if (name == "generalized-alpha") return make_generalized_alpha(generalized_alpha(0.8));
  if (name == "bathe") return make_bathe();
  if (name == "bdf2") return make_bdf2();
  return make_zhou_tamma(name.ends_with("V0"), rho, name.starts_with("averaged"));
}

/// Integrator, and what the uppermost region is: "stiffening" is linear with strains of the second degree.
class Tangent : public testing::TestWithParam<std::tuple<const char*, const char*>> {
 protected:
  Tangent() {
    Mesh m = block_mesh({.n = {1, 1, 4},
                         .high = {0.4, 0.3, 1.6},
                         .map = [](const Vec3& x) { return Vec3(x + 0.02 * Vec3(std::sin(7 * x[2]), 0, 0)); },
                         .regions = {"heavy", "soft", "upper"},
                         .region_of = [](const Vec3& x) { return x[2] < 0.4   ? 0
                                                                 : x[2] < 1.2 ? 1
                                                                              : 2; }});
    for (auto& [name, list] : m.facet_sets)
      if (name == "zmax") m.node_sets["unused"] = {};
    m.node_sets.erase("unused");
    add_node_set(m, "corner", [](const Vec3& x) { return std::abs(x[2] - 0.8) < 1e-9 && x[0] < 0.2 && x[1] < 0.1; });
    add_node_set(m, "line", [](const Vec3& x) { return std::abs(x[2] - 0.8) < 1e-9 && x[0] > 0.2; });
    write_mesh(place / "mesh.h5", m, {"test"});
    const std::string upper = std::get<1>(GetParam());
    write_tags(place / "tags.h5", place / "mesh.h5",
               {Fidelity::rigid, Fidelity::nonlinear, upper == "nonlinear" ? Fidelity::nonlinear : Fidelity::linear}, {"test"});
    local = read_local_mesh(place / "tags.h5", Comm::world());
    scene = Scene::parse(
        everything + std::string(upper == "stiffening" ? "region.upper = {material = \"soft\", modes = 4, stiffening = true}\n" : ""),
        "scene.toml");
    system = build_system(scene, &local, Comm::world());
  }
  Workplace place;
  LocalMesh local;
  Scene scene;
  std::unique_ptr<System> system;
};

TEST_P(Tangent, OfTheWholeSystemIsTheDerivativeOfItsResidual) {
  const auto integrator = made(std::get<0>(GetParam()));
  const int n = 3 * system->n_blocks(), first = 3 * system->first_joint_block();
  const State s = state_of(*system);
  std::vector<double> kick(n);
  integrator->begin(*system, s, 0.02);
  Config q1 = s.q;
  for (int i = 0; i < n; ++i) kick[i] = 0.02 * small(*system, i) * scatter(5000 + i);
  system->move(q1, kick);
  system->prescribe(q1, s.t + 0.02);
  system->commit(s.q);
  Config past[2] = {s.q, s.q};
  Dissipation recalled{0, &past[0], &past[1], 0.9, 0.7, 0.8};
  for (int k = 0; k < 2; ++k) {
    for (int i = 0; i < n; ++i) kick[i] = 0.02 * small(*system, i) * scatter(6000 + 100 * k + i);
    system->move(past[k], kick);
  }
  const auto stage_to = [&](const Unknown& u) {
    Stage stage = integrator->stage(0, u);
    if (stage.dissipation) recalled.kappa = stage.dissipation->kappa, stage.dissipation = &recalled;
    return stage;
  };

  DenseKkt K;
  K.structure(system->layout.cliques, system->layout.map);
  Residual at;
  system->evaluate(stage_to(Unknown(*system, s.q, q1)), s.lambda, at, &K);
  const double scale = K.A.topLeftCorner(first, first).cwiseAbs().maxCoeff();
  const auto residual = [&](const Config& q, const std::vector<double>& lambda) {
    Residual r;
    system->evaluate(stage_to(Unknown(*system, s.q, q)), lambda, r, nullptr);
    system->mask_fixed(r.r);
    return Eigen::Map<const Eigen::VectorXd>(r.r.data(), n).eval();
  };
  const double step = 1e-6;  // central differences: truncation 1e-12 of the third derivative, round-off 1e-10 of the scale
  Eigen::MatrixXd difference(n, n);
  for (int j = 0; j < n; ++j) {
    Eigen::VectorXd side[2];
    for (int k = 0; k < 2; ++k) {
      const double d = k ? step : -step;
      if (j < first) {
        std::vector<double> z(n, 0.0);
        z[j] = d;
        Config q = q1;
        system->move(q, z);
        side[k] = residual(q, s.lambda);
      } else {
        auto lambda = s.lambda;
        lambda[j - first] += at.sigma * d / 10;  // friction is curved in what presses it
        side[k] = residual(q1, lambda);
      }
    }
    difference.col(j) = (side[1] - side[0]) / (2 * step) * (j < first ? 1 : 10);
  }
  std::vector<char> idle(n, 0);  // held components and unused multipliers
  for (size_t i = 0; i < system->X.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (system->node_block[i] >= 0 && system->fixed[i][k]) idle[3 * system->node_block[i] + k] = 1;
  for (int i = first; i < n; ++i) idle[i] = difference.row(i).cwiseAbs().maxCoeff() == 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      // a row or column that stands for nothing has only a diagonal entry, of scale sigma
      if (idle[i] || idle[j]) {
        if (i == j) {
          EXPECT_GT(K.A(i, i), 0) << i;
        } else {
          EXPECT_EQ(K.A(i, j), 0) << i << "," << j;
        }
        continue;
      }
      ASSERT_NEAR(K.A(i, j), difference(i, j), 2e-7 * scale)
          << "row " << i << " column " << j << " of " << n << ", multipliers from " << first;
    }
}

INSTANTIATE_TEST_SUITE_P(Integrators, Tangent,
                         testing::Combine(testing::Values("energy-momentum", "mid-point", "generalized-alpha", "U0", "averaged U0", "V0",
                                                          "averaged V0", "bathe", "bdf2"),
                                          testing::Values("nonlinear", "linear", "stiffening")),
                         [](const auto& p) { return as_name(std::string(std::get<0>(p.param)) + "_" + std::get<1>(p.param)); });

}  // namespace
}  // namespace hilo::test::tangent_test
