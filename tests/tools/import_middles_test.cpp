// SPDX-License-Identifier: GPL-3.0-or-later
// --order 2: the nodes in the middle of edges are held where both ends are.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "import_case.hpp"

namespace hilo::test::import_middles_test {
namespace {

constexpr double E = 2e11, pull = 1e6, nu = 0.3;
Mat3 turned(double degrees) { return Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Vec3::UnitZ()).toRotationMatrix(); }

/// n x n x n cubes in a unit cube, in axes turned about z.
struct Cube {
  int n;
  Mat3 R;
  int number(int i, int j, int k) const { return 1 + i + (n + 1) * (j + (n + 1) * k); }
  template <class Use>
  void nodes(const Use& use) const {
    for (int k = 0; k <= n; ++k)
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) use(number(i, j, k), Vec3(R * Vec3(i, j, k) / n), std::array{i, j, k});
  }
  template <class Use>
  void cells(const Use& use) const {
    int e = 0;
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
          use(++e,
              std::array{number(i, j, k), number(i + 1, j, k), number(i + 1, j + 1, k), number(i, j + 1, k), number(i, j, k + 1),
                         number(i + 1, j, k + 1), number(i + 1, j + 1, k + 1), number(i, j + 1, k + 1)},
              i);
  }
  /// Grids in a system of their own where the cube is turned, held on its three planes and pulled along the first axis.
  std::string bdf() const {
    std::string s = "SOL 101\nCEND\nSPC=1\nLOAD=2\nBEGIN BULK\n", supports, loads;
    const Vec3 x = R.col(0);
    s += fmt::format("CORD2R,5,0,0.,0.,0.,0.,0.,1.\n,{:.12f},{:.12f},0.\n", x[0], x[1]);
    const char* cd = R.isIdentity() ? "" : "5";
    nodes([&](int a, const Vec3& X, const std::array<int, 3>& at) {
      s += fmt::format("GRID*,{},,{:.12f},{:.12f}\n*,{:.12f},{}\n", a, X[0], X[1], X[2], cd);
      for (size_t d = 0; d < 3; ++d)
        if (at[d] == 0) supports += fmt::format("SPC1,1,{},{}\n", d + 1, a);
    });
    cells([&](int e, const auto& c, int i) {
      s += fmt::format("CHEXA,{},1,{}\n,{},{}\n", e, fmt::join(c.begin(), c.begin() + 6, ","), c[6], c[7]);
      if (i == n - 1) loads += fmt::format("PLOAD4,2,{},{}.,,,,{},{}\n", e, -pull, c[1], c[6]);
    });
    return s + supports + loads + "PSOLID,1,1\nMAT1,1,2.+11,,.3\n";
  }
  std::string inp(bool by_set) const {
    std::string s = "*NODE\n", of_nodes, loads;
    std::array<std::string, 3> plane;
    nodes([&](int a, const Vec3& X, const std::array<int, 3>& at) {
      s += fmt::format("{}, {:.15g}, {:.15g}, {:.15g}\n", a, X[0], X[1], X[2]);
      for (size_t d = 0; d < 3; ++d)
        if (at[d] == 0) plane[d] += fmt::format("{},\n", a), of_nodes += fmt::format("{0}, {1}, {1}\n", a, d + 1);
    });
    s += "*ELEMENT, TYPE=C3D8, ELSET=A\n";
    cells([&](int e, const auto& c, int i) {
      s += fmt::format("{}, {}\n", e, fmt::join(c, ", "));
      if (i == n - 1) loads += fmt::format("{}, P4, {}\n", e, -pull);
    });
    for (size_t d = 0; d < 3; ++d) s += fmt::format("*NSET, NSET=N{}\n{}", d + 1, plane[d]);
    s += fmt::format("*NSET, NSET=ALL, GENERATE\n1, {}\n", number(n, n, n));
    if (!R.isIdentity())
      s += fmt::format("*TRANSFORM, NSET=ALL\n{:.15g}, {:.15g}, 0, {:.15g}, {:.15g}, 0\n", R(0, 0), R(1, 0), R(0, 1), R(1, 1));
    return s + "*MATERIAL, NAME=S\n*ELASTIC\n2e11, 0.3\n*SOLID SECTION, ELSET=A, MATERIAL=S\n*BOUNDARY\n" +
           (by_set ? "N1, 1, 1\nN2, 2, 2\nN3, 3, 3\n" : of_nodes) + "*STEP\n*STATIC\n*DLOAD\n" + loads + "*END STEP\n";
  }
};

class ImportMiddles : public test::Import {
 protected:
  std::vector<Vec3> displacements() const {
    const auto u = Store::open(place / "run.h5").read<double>("/field/000001/displacement");
    std::vector<Vec3> out;
    for (size_t a = 0; a < u.size(); a += 3) out.emplace_back(u[a], u[a + 1], u[a + 2]);
    return out;
  }
  /// Pure tension, node by node: u = sigma/E (x, -nu y, -nu z) in the axes of the cube.
  void expect_tension(const Mat3& R) {
    const Mesh m = read_mesh_file(place / "out.h5").mesh;
    const auto u = displacements();
    for (size_t a = 0; a < u.size(); ++a) {
      const Vec3 x = R.transpose() * m.X[a];
      EXPECT_LT((R.transpose() * u[a] - pull / E * Vec3(x[0], -nu * x[1], -nu * x[2])).norm(), 1e-4 * pull / E) << x.transpose();
    }
  }
};

TEST_F(ImportMiddles, PlanesOfSymmetryStayPlanesWhichsoeverCardHoldsThem) {
  for (const double turn : {0., 30.})
    for (const int n : {1, 2}) {
      const Cube cube{n, turned(turn)};
      SCOPED_TRACE(fmt::format("{} cubes, turned by {} deg", n, turn));
      solve(cube.bdf(), "a.bdf", "--order 2");
      expect_tension(cube.R);
      for (const bool by_set : {true, false}) {
        solve(cube.inp(by_set), "a.inp", "--order 2");
        expect_tension(cube.R);
      }
    }
}

// A face whose nodes are moved by what varies along it, as a bend moves it: the middle goes the mean way.
TEST_F(ImportMiddles, BetweenTwoThatAreMovedTheMiddleGoesTheMeanWay) {
  const Cube cube{1, Mat3::Identity()};
  std::string bdf = cube.bdf(), inp = cube.inp(false);
  bdf = bdf.substr(0, bdf.find("PLOAD4")) + "SPC,1,2,1,1.-3\nSPC,1,4,1,2.-3\nSPC,1,6,1,3.-3\nSPC,1,8,1,4.-3\n" +
        bdf.substr(bdf.find("PSOLID"));
  inp = inp.substr(0, inp.find("*STEP")) + "2, 1, 1, 1e-3\n4, 1, 1, 2e-3\n6, 1, 1, 3e-3\n8, 1, 1, 4e-3\n*STEP\n*STATIC\n*END STEP\n";
  for (const auto& [file, text] : {std::pair("a.bdf", bdf), std::pair("a.inp", inp)}) {
    SCOPED_TRACE(file);
    solve(text, file, "--order 2");
    const Mesh m = read_mesh_file(place / "out.h5").mesh;
    const auto u = displacements();
    for (size_t a = 0; a < u.size(); ++a) {
      if (m.X[a].x() < 1 - 1e-9) continue;
      EXPECT_NEAR(u[a].x(), 1e-3 * (1 + m.X[a].y() + 2 * m.X[a].z()), 1e-9);
    }
    // of the cube, 4 edges lead from the foot to this face and 4 lie in it
    expect_said(
        "warning: order 2: 8 nodes in the middle of edges from nodes that are held to nodes that are moved, one cell apart, go the mean "
        "way");
  }
}

// A sector of 40 deg of a tube, held along z and, on its two planes or everywhere, around the axis: Lame.
TEST_F(ImportMiddles, PlanesThroughAnAxisStayPlanes) {
  const double a = 1, b = 2, p = 1e6;
  const int around = 4, out = 6;
  for (const bool everywhere : {false, true}) {
    SCOPED_TRACE(everywhere);
    std::string s = "SOL 101\nCEND\nSPC=1\nLOAD=2\nBEGIN BULK\nCORD2C,7,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n";
    const auto number = [&](int i, int j, int k) { return 1 + i + (out + 1) * (j + (around + 1) * k); };
    for (int k = 0; k < 2; ++k)
      for (int j = 0; j <= around; ++j)
        for (int i = 0; i <= out; ++i) {
          s += fmt::format("GRID,{},7,{:.5f},{:.3f},{}.,7\nSPC1,1,3,{}\n", number(i, j, k), a + (b - a) * i / out, 15 + 40. * j / around, k,
                           number(i, j, k));
          if (everywhere || j == 0 || j == around) s += fmt::format("SPC1,1,2,{}\n", number(i, j, k));
        }
    int e = 0;
    for (int j = 0; j < around; ++j)
      for (int i = 0; i < out; ++i) {
        s += fmt::format("CHEXA,{},1,{},{},{},{},{},{}\n,{},{}\n", ++e, number(i, j, 0), number(i + 1, j, 0), number(i + 1, j + 1, 0),
                         number(i, j + 1, 0), number(i, j, 1), number(i + 1, j, 1), number(i + 1, j + 1, 1), number(i, j + 1, 1));
        if (i == 0) s += fmt::format("PLOAD4,2,{},1.+6,,,,{},{}\n", e, number(0, j, 0), number(0, j + 1, 1));
      }
    solve(s + "PSOLID,1,1\nMAT1,1,2.+11,,.3\n", "a.bdf", "--order 2");
    const Mesh m = read_mesh_file(place / "out.h5").mesh;
    const auto u = displacements();
    for (size_t n = 0; n < u.size(); ++n) {
      const double r = std::hypot(m.X[n].x(), m.X[n].y()), angle = std::atan2(m.X[n].y(), m.X[n].x()) * 180 / std::numbers::pi;
      if (std::abs(angle - 15) > 0.01 && std::abs(angle - 55) > 0.01) continue;
      const Vec3 out_way = Vec3(m.X[n].x(), m.X[n].y(), 0) / r, round_way(-out_way[1], out_way[0], 0);
      const double lame = (1 + nu) / E * p * a * a / (b * b - a * a) * ((1 - 2 * nu) * r + b * b / r);
      EXPECT_NEAR(u[n].dot(out_way), lame, 0.01 * lame) << r;
      EXPECT_NEAR(u[n].dot(round_way), 0, 1e-4 * lame);
      EXPECT_NEAR(u[n].z(), 0, 1e-4 * lame);
    }
    EXPECT_EQ(err.find("supports whose axes are up to 10 deg apart are held along the mean axis") != std::string::npos, everywhere) << err;
  }
}

// Opposite faces that move as one, node by node, as a deck without nodes in the middle says it.
TEST_F(ImportMiddles, JointsOfSingleNodesAreToldToTieNoneBetweenThem) {
  const Cube cube{1, Mat3::Identity()};
  std::string text = cube.bdf(), equal;
  for (int a = 1; a <= 7; a += 2) equal += fmt::format("MPC,4,{},1,1.,{},1,-1.\n", a + 1, a);
  solve(text.replace(text.find("SPC=1\n"), 0, "MPC=4\n") + equal, "a.bdf", "--order 2");
  expect_said("warning: order 2: joints tie single nodes, and none of the 12 nodes in the middle of edges between them");
  solve(cube.bdf(), "a.bdf", "--order 2");
  EXPECT_EQ(err.find("warning: order 2"), std::string::npos) << err;
}

}  // namespace
}  // namespace hilo::test::import_middles_test
