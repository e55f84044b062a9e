// SPDX-License-Identifier: GPL-3.0-or-later
// Solid-shells at rest against published values of thin shells, in the small and in the large.
#include "physics/shape/hex8.hpp"
#include "verify/shells/shell_scene.hpp"

namespace hilo::test::shells_statics_test {
namespace {

class ShellStatics : public ShellPlace {
 protected:
  double scordelis_lo(int n) {
    use([&] {
      Mesh m = shell_mesh(cylinder(25, M_PI * 40 / 180, 25), n, n, 0.25);
      add_stack(m, "tip", n, 0, n, n);
      return m;
    }());
    const double small = 1e-3;
    const Results r = solved(fmt::format("gravity = [0, 0, {}]\n", -small) + shell_of(4.32e8, 0, "density = 360") + held("ymin", "y") +
                             held("ymax", "xz") + held("xmin", "x") + probe("tip") + in_steps(1));
    return -way(r, "tip")[2] / small / 0.3024;
  }
  double pinched_cylinder(int n) {
    use([&] {
      Mesh m = shell_mesh(cylinder(300, M_PI / 2, 300), n, n, 3);
      add_stack(m, "tip", 0, 0, n, n);
      return m;
    }());
    const Results r = solved(shell_of(3e6, 0.3) + held("ymin", "y") + held("ymax", "xz") + held("xmin", "x") + held("xmax", "z") +
                             push("tip", Vec3(0, 0, -0.25)) + probe("tip") + in_steps(1));
    return -way(r, "tip")[2] / 1.8249e-5;
  }
  /// Hemisphere with a hole, quarter: way out under one force and in under the other.
  std::pair<double, double> hemisphere(int n, double P, int steps, int layers = 1) {
    use([&] {
      Mesh m = shell_mesh(sphere(10), n, n, 0.04, layers);
      add_stack(m, "A", 0, 0, n, n, layers), add_stack(m, "B", n, 0, n, n, layers);
      m.node_sets["inside"] = {0};
      return m;
    }());
    const Results r = solved(shell_of(6.825e7, 0.3) + held("xmin", "y") + held("xmax", "x") + held("inside", "z") +
                             push("A", Vec3(P, 0, 0)) + push("B", Vec3(0, -P, 0)) + probe("A") + probe("B") + in_steps(steps));
    iterations = work_iterations();
    return {way(r, "A")[0], -way(r, "B")[1]};
  }
  double work_iterations() const {
    const std::string text = text_of(work / "run.json"), key = "\"newton_iterations\": ";
    const auto at = text.find(key);
    return at == std::string::npos ? std::nan("") : std::stod(text.substr(at + key.size()));
  }
  double iterations = 0;
};

TEST_F(ShellStatics, TheRoofOfScordelisAndLo) {
  const double coarse = scordelis_lo(8), fine = scordelis_lo(16);
  std::printf("8: %.4f, 16: %.4f of 0.3024\n", coarse, fine);
  EXPECT_NEAR(coarse, 1, 0.01);
  EXPECT_NEAR(fine, 1, 0.003);
}

// Half of its answer lies in a dimple at the load, which a uniform mesh resolves slowly.
TEST_F(ShellStatics, ThePinchedCylinder) {
  const double coarse = pinched_cylinder(16), fine = pinched_cylinder(32);
  std::printf("16: %.4f, 32: %.4f of 1.8249e-5\n", coarse, fine);
  EXPECT_NEAR(coarse, 1, 0.08);
  EXPECT_NEAR(fine, 1, 0.025);
}

TEST_F(ShellStatics, TheHemisphereWithAHole) {
  const double small = hemisphere(16, 1e-3, 1).first / 1e-3;
  std::printf("in the small %.5f of 0.0935\n", small);
  EXPECT_NEAR(small / 0.0935, 1, 0.015);
  const auto [in, out] = hemisphere(16, 200, 5);
  std::printf("under 400: %.4f and %.4f of 4.067 and 8.178, %.0f iterations\n", in, out, iterations);
  EXPECT_NEAR(in / 4.067, 1, 0.01);
  EXPECT_NEAR(out / 8.178, 1, 0.01);
  EXPECT_LT(iterations, 120);
  const double two = hemisphere(16, 1e-3, 1, 2).first / 1e-3;
  EXPECT_NEAR(two / small, 1, 0.002) << "in two layers";
}

TEST_F(ShellStatics, TheTwistedBeam) {
  for (const auto& [h, P, in_plane, across] : {std::array{0.32, 1., 5.424e-3, 1.754e-3}, std::array{0.0032, 1e-6, 5.256e-3, 1.294e-3}}) {
    const Surface twisted = [](double u, double v) {
      const double a = M_PI / 2 * u, w = 1.1 * (v - 0.5);
      const Vec3 e(0, std::cos(a), std::sin(a)), n = Vec3(Vec3(12, 0, 0) + w * M_PI / 2 * Vec3(0, -std::sin(a), std::cos(a))).cross(e);
      return std::pair(Vec3(Vec3(12 * u, 0, 0) + w * e), Vec3(n.normalized()));
    };
    use([&, h = h] {
      Mesh m = shell_mesh(twisted, 24, 4, h);
      add_stack(m, "tip", 24, 2, 24, 4);
      return m;
    }());
    const auto bent = [&](int axis) {
      const double small = 1e-3;
      return way(solved(shell_of(29e6, 0.22) + held("xmin") + push("xmax", P * small * Vec3::Unit(axis)) + probe("tip") + in_steps(1)),
                 "tip")[axis] /
             small;
    };
    const double z = bent(2) / in_plane, y = bent(1) / across;
    std::printf("h %g: in plane %.4f, across %.4f\n", h, z, y);
    EXPECT_NEAR(z, 1, 0.01);
    EXPECT_NEAR(y, 1, 0.015);
  }
}

// [sze-2004] 3.1: end force 4 on a strip; the whole load in one step, however thin.
TEST_F(ShellStatics, ACantileverUnderAnEndForce) {
  for (const double thin : {1., 0.1}) {
    use([&] {
      Mesh m = shell_mesh(plate(10, 1), 16, 1, 0.1 * thin);
      add_stack(m, "tip", 16, 0, 16, 1);
      return m;
    }());
    const Results r =
        solved(shell_of(1.2e6, 0) + held("xmin") + push("xmax", Vec3(0, 0, 4 * std::pow(thin, 3))) + probe("tip") + in_steps(1));
    const Vec3 u = way(r, "tip");
    std::printf("L/h %.0f: %.4f %.4f of 3.286 and 6.698, %.0f iterations\n", 100 / thin, -u[0], u[2], work_iterations());
    EXPECT_NEAR(-u[0] / 3.286, 1, 0.003);
    EXPECT_NEAR(u[2] / 6.698, 1, 0.002);
    EXPECT_LT(work_iterations(), 10);
  }
}

// [sze-2004] 3.5: an open cylinder pulled, to a quarter and to half of the load, shortly before it snaps.
TEST_F(ShellStatics, AnOpenCylinderPulled) {
  const int n = 16, m_ = 24;
  use([&] {
    Mesh m = shell_mesh(cylinder(4.953, M_PI / 2, 10.35 / 2), n, m_, 0.094);
    add_stack(m, "A", 0, 0, n, m_), add_stack(m, "B", n, 0, n, m_), add_stack(m, "C", n, m_, n, m_);
    return m;
  }());
  const Results r = solved(shell_of(10.5e6, 0.3125) + held("ymin", "y") + held("xmin", "x") + held("xmax", "z") +
                           push("A", Vec3(0, 0, 10000. / 2)) + probe("A") + probe("B") + probe("C") + in_steps(10));
  for (const auto& [at, a, b, c, limit] : {std::tuple{0.5, 2.180, 3.087, 3.310, 0.005}, std::tuple{1., 2.473, 3.653, 3.718, 0.021}}) {
    const auto gone = [&, at = at](const char* probe, int axis) {
      return r.at(fmt::format("probe/{}", probe), at)[axis] - r.at(fmt::format("probe/{}", probe), 0)[axis];
    };
    std::printf("%.3f %.3f %.3f of %.3f %.3f %.3f\n", gone("A", 2), -gone("B", 0), -gone("C", 0), a, b, c);
    EXPECT_NEAR(gone("A", 2) / a, 1, limit);
    EXPECT_NEAR(-gone("B", 0) / b, 1, limit);
    EXPECT_NEAR(-gone("C", 0) / c, 1, limit);
  }
}

// A strip under an end force, one cell thick: stress at both faces is M z/I.
TEST_F(ShellStatics, StressesOfBothFacesAreThoseOfBending) {
  const Mesh m = shell_mesh(plate(10, 1), 20, 2, 0.1);
  use(m);
  const double P = 1e-3, I = 1 * std::pow(0.1, 3) / 12;
  const Results r = solved(shell_of(1e7, 0) + held("xmin") + push("xmax", Vec3(0, 0, P)) +
                           "[output]\nfields = [\"stress\", \"von_mises\"]\n" + in_steps(1));
  const Eigen::MatrixXd s = r.table("/field/" + r.steps().back() + "/stress");
  const Eigen::MatrixXd vm = r.table("/field/" + r.steps().back() + "/von_mises");
  const double root = P * 10 * 0.05 / I;
  for (std::int64_t i = 0; i < m.n_nodes(); ++i) {
    const double truth = -P * (10 - m.X[i][0]) * m.X[i][2] / I;
    if (m.X[i][0] < 0.6 || m.X[i][0] > 9.4) continue;
    EXPECT_NEAR(s(i, 0), truth, 0.002 * root) << m.X[i].transpose();
    EXPECT_NEAR(vm(i, 0), std::abs(truth), 0.01 * root) << m.X[i].transpose();
  }
}

// A strip whose end is pushed far: the moment at its root is yield b h^2/4, with four points across 4 % more; the root may narrow.
TEST_F(ShellStatics, APlasticHingeBearsItsLimit) {
  Mesh m = shell_mesh(plate(1, 0.1), 20, 1, 0.02);
  m.node_sets["side"] = {0};
  use(m);
  const double yield = 2.5e8, limit = yield * 0.1 * 0.02 * 0.02 / 4;
  const auto tip = [&](double share) {
    const Results r = solved(
        "[material.m]\nkind = \"j2\"\nE = 2e11\nnu = 0.3\nyield = 2.5e8\nhardening = 1e7\ndensity = 7800\n"
        "[region.shell]\nmaterial = \"m\"\nshell = true\n" +
        held("xmin", "xz") + held("side", "y") + push("xmax", Vec3(0, 0, share * limit)) + probe("xmax") + in_steps(10));
    return way(r, "xmax")[2] / (share * limit / (3 * 2e11 * 0.1 * std::pow(0.02, 3) / 12));  // over that of the elastic beam
  };
  const double below = tip(0.6), above = tip(1.0), beyond = tip(1.15);
  std::printf("tip over the elastic one: %.3f %.3f %.3f\n", below, above, beyond);
  EXPECT_NEAR(below, 1, 0.02);
  EXPECT_LT(above, 1.5);
  EXPECT_GT(beyond, 2);
}

/// A plate along x from the set "root" ends at x = 1, set "joint", in the middle of a wall along z, with its upper edge the set "top"; both
/// 0.2 wide and 0.02 thick, regions of their own that share the facets of the joint.
Mesh tee() {
  Mesh m;
  std::map<std::array<std::int64_t, 3>, std::int64_t> node;
  const auto cell = [&](const Vec3& low, const Vec3& size, int region) {
    std::int64_t nodes[8];
    for (int a = 0; a < 8; ++a) {
      const Vec3 unit = (Vec3(hex_corner[a]) + Vec3::Ones()) / 2, X = low + unit.cwiseProduct(size);
      const auto [it, fresh] = node.try_emplace({std::lround(1e4 * X[0]), std::lround(1e4 * X[1]), std::lround(1e4 * X[2])}, m.n_nodes());
      nodes[a] = it->second;
      if (!fresh) continue;
      if (it->first[0] == 0) m.node_sets["root"].push_back(nodes[a]);
      if (it->first[0] == 10000 && (it->first[2] == 2000 || it->first[2] == 2200)) m.node_sets["joint"].push_back(nodes[a]);
      if (it->first[2] == 4200) m.node_sets["top"].push_back(nodes[a]);
      m.X.push_back(X), m.node_id.push_back(nodes[a]);
    }
    m.add_cell(Shape::hex8, nodes, region, m.n_cells());
  };
  for (const double y : {0., 0.1}) {
    for (int i = 0; i < 20; ++i) cell({0.05 * i, y, 0.2}, {0.05, 0.1, 0.02}, 0);
    for (const double z : {0., 0.1, 0.22, 0.32}) cell({1, y, z}, {0.02, 0.1, 0.1}, 1);
    cell({1, y, 0.2}, {0.02, 0.1, 0.02}, 1);
  }
  m.region_name = {"shell", "wall"}, m.region_data.resize(2);
  return m;
}

// The force on the wall's edge bends both as beams: the plate by its moment, the wall by itself.
TEST_F(ShellStatics, PlatesThatMeetAreRegionsOfTheirOwn) {
  use(tee());
  const double E = 2e11, EI = E * 0.2 * std::pow(0.02, 3) / 12, P = 1, lever = 0.21, turn = P * lever / EI;
  const std::string scene = shell_of(E, 0) + "[region.wall]\nmaterial = \"m\"\nshell = true\n" + held("root") + push("top", Vec3(P, 0, 0)) +
                            probe("joint") + probe("top") + in_steps(1);
  const Results r = solved(scene);
  const double down = -way(r, "joint")[2] / (turn / 2), over = way(r, "top")[0] / (turn * lever + P * std::pow(0.2, 3) / (3 * EI));
  std::printf("the joint goes down %.4f, the edge over %.4f of beams\n", down, over);
  EXPECT_NEAR(down, 1, 0.01);
  EXPECT_NEAR(over, 1, 0.02);
}

// Clamped square under a pressure, one cell thick: Kirchhoff's 0.00126532 p L^4/D,
// by a Ritz series of 49 polynomials; a thick plate bends further by shear.
TEST_F(ShellStatics, AClampedPlateInOneLayer) {
  const double E = 2.1e11, nu = 0.3;
  struct Row {
    const char* name;
    Shape shape;
    bool shell;
    double off[3][2];  // by L/h 20, 100, 500 and 8, 16 cells along a side
  } rows[] = {{"shell8", Shape::hex8, true, {}}, {"hex20r", Shape::hex20r, false, {}}, {"tet10", Shape::tet10, false, {}}};
  const double thickness[] = {0.05, 0.01, 0.002};
  for (Row& row : rows)
    for (int k = 0; k < 3; ++k)
      for (const int n : {8, 16}) {
        const double h = thickness[k], p = 1e8 * h * h * h, w = 0.00126532 * p * 12 * (1 - nu * nu) / (E * h * h * h);
        BlockOptions o;
        o.shape = row.shape, o.n[0] = o.n[1] = n, o.regions = {"shell"}, o.low[2] = -h / 2, o.high[2] = h / 2;
        Mesh m = block_mesh(o);
        for (int i = 0; i < m.n_nodes(); ++i)
          if (const Vec3 x = m.X[i]; x[0] * (1 - x[0]) * x[1] * (1 - x[1]) < 1e-9) m.node_sets["edge"].push_back(i);
        use(m);
        std::string scene = shell_of(E, nu) + held("edge");
        if (!row.shell) scene.replace(scene.find("shell = true\n"), 13, "");
        scene += fmt::format(
            "[set.middle]\nkind = \"ball\"\nat = [0.5, 0.5, 0]\nradius = {}\n[[load]]\nkind = \"pressure\"\nname = \"p\"\n"
            "on = \"zmax\"\npressure = {}\n",
            0.51 * h, p);
        row.off[k][n / 16] = -way(solved(scene + probe("middle") + in_steps(1)), "middle")[2] / w - 1;
        std::printf("%s, L/h %3.0f, %2d cells: %+.4f\n", row.name, 1 / h, n, row.off[k][n / 16]);
      }
  for (int k = 1; k < 3; ++k) {
    EXPECT_NEAR(rows[0].off[k][0], 0, 0.016);
    EXPECT_NEAR(rows[0].off[k][1], 0, 0.005);
    EXPECT_LT(rows[1].off[k][0], 2 * rows[0].off[k][0]) << "a solid of one layer is stiffer";
    EXPECT_LT(rows[2].off[k][0], rows[1].off[k][0]);
  }
  EXPECT_GT(rows[0].off[0][1], rows[0].off[1][1] + 0.02) << "shear of a thick plate";
}

// A cell that is thick along the plate where its neighbours are across: refused in one region, whichever ranks the two are on.
TEST_F(ShellStatics, AThicknessThatTurnsIsRefusedAcrossACutToo) {
  use(shell_mesh([](double u, double v) { return std::pair(Vec3(u < 0.97 ? u : 0.96, 0.1 * v, 1), Vec3(0, 0, 1)); }, 20, 1, 0.02));
  std::vector<std::int32_t> rank(20, 0);
  rank.back() = 1;
  write_parts(work / "parts.h5", work / "mesh.h5", 2, rank, {"test"});
  work.write("scene.toml", shell_of(2e11, 0) + held("xmin") + in_steps(1));
  const std::string why =
      "hilo-solve: scene.toml:7:1: region \"shell\": the thickness turns between the neighbouring cells at (0.925, 0.05, 1) and "
      "(0.955, 0.05, 1) (regions of their own for plates that meet)\n";
  const Ran one = work.run("hilo-solve --quiet scene.toml mesh.h5 -o no.h5");
  EXPECT_EQ(one.exit, 2);
  EXPECT_EQ(one.err, why);
  expect_end(mpirun(2, "hilo-solve --quiet scene.toml parts.h5 -o no.h5", work.path()), 2,
             why);  // mpirun puts its own words before or behind
}

}  // namespace
}  // namespace hilo::test::shells_statics_test
