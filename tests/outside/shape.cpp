// SPDX-License-Identifier: GPL-3.0-or-later
// A solid shape: the pyramid of five nodes, what lies between hexahedra and tetrahedra.  A struct as solver/physics/shape/shape.hpp says,
// and one call.
#include <fmt/format.h>

#include "outside.hpp"
#include "physics/shape/hex8.hpp"
#include "system/add_shape.hpp"

namespace outside {
namespace {

using namespace hilo;

/// The hexahedron of eight nodes whose upper face is one point.  Nodes 0 to 3 are the base, 4 the apex (VTK's order); eight points.
struct Pyramid5 {
  static constexpr Shape shape{128};
  static constexpr int n = 5, n_points = 8;
  static constexpr void values(const double* xi, double* N) {
    for (int a = 0; a < 4; ++a) N[a] = (1 + hex_corner[a][0] * xi[0]) * (1 + hex_corner[a][1] * xi[1]) * (1 - xi[2]) / 8;
    N[4] = (1 + xi[2]) / 2;
  }
  static constexpr void gradients(const double* xi, double (*dN)[3]) {
    for (int a = 0; a < 4; ++a) {
      const double *c = hex_corner[a], u = 1 + c[0] * xi[0], v = 1 + c[1] * xi[1], w = 1 - xi[2];
      dN[a][0] = c[0] * v * w / 8, dN[a][1] = u * c[1] * w / 8, dN[a][2] = -u * v / 8;
    }
    dN[4][0] = dN[4][1] = 0, dN[4][2] = 0.5;
  }
  static constexpr Quadrature<8> rule() { return hex_rule<2>(); }
  static constexpr int n_mass_points = 27;  // det dX/dxi is of the second degree in xi_3
  static constexpr Quadrature<27> mass_rule() { return hex_rule<3>(); }
  static constexpr Quadrature<5> nodes() {
    Quadrature<5> r;
    for (int a = 0; a < 4; ++a)
      for (int i = 0; i < 3; ++i) r.xi[a][i] = hex_corner[a][i];
    r.xi[4][2] = 1;
    return r;
  }
  static ShapeRow row() {
    return {"pyramid5",
            5,
            3,
            14,
            7,
            40,
            {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}},
            {{1, 3, 4}, {2, 0, 4}, {3, 1, 4}, {0, 2, 4}, {2, 1, 0}},
            {}};
  }
};

/// A law from outside too, which the shape must be added with.
struct Twin : StVenantKirchhoff {
  static constexpr std::string_view name = "twin of stvk";
  static Twin make(const MaterialValues& v) { return {StVenantKirchhoff::make(v)}; }
  Twin with_lambda(double lambda) const { return {StVenantKirchhoff::with_lambda(lambda)}; }
};

}  // namespace

void add_pyramid() {
  add_material<Twin>();
  add_shape<Pyramid5, Twin>();
}

namespace {

/// Bricks of the unit cube, or of the box up to `high`; every second one stays a hexahedron where `mixed`, the others are six pyramids
/// about a point near their middle.  `bend`: how far corners inside the box are moved.
Mesh pyramids(std::array<int, 3> n, const Vec3& high, double bend, bool mixed) {
  test::BlockOptions o;
  std::copy(n.begin(), n.end(), o.n);
  o.high = high;
  Mesh bricks = test::block_mesh(o), m;
  m.X = bricks.X, m.node_id = bricks.node_id, m.region_name = bricks.region_name, m.region_data = bricks.region_data;
  const auto inside = [&](const Vec3& x) { return (x.array() > 1e-9).all() && ((high - x).array() > 1e-9).all(); };
  for (size_t a = 0; a < m.X.size(); ++a)
    for (int i = 0; i < 3 && inside(bricks.X[a]); ++i) m.X[a][i] += bend * test::scatter(static_cast<int>(3 * a) + i);
  const auto& faces = info(Shape::hex8).facets;
  for (std::int64_t c = 0; c < bricks.n_cells(); ++c) {
    const auto at = bricks.cell(c);
    if (mixed && c % 2 == 0) {
      m.add_cell(Shape::hex8, at, 0, m.n_cells() + 1);
      continue;
    }
    Vec3 middle = Vec3::Zero();
    for (const auto a : at) middle += m.X[a] / 8;
    for (int i = 0; i < 3; ++i) middle[i] += bend * test::scatter(static_cast<int>(7 * c) + i);
    m.X.push_back(middle), m.node_id.push_back(m.n_nodes());
    for (const auto& f : faces)  // outward of the brick: seen from inside the base turns the other way
      m.add_cell(Pyramid5::shape, std::array<std::int64_t, 5>{at[f[0]], at[f[3]], at[f[2]], at[f[1]], m.n_nodes() - 1}, 0, m.n_cells() + 1);
  }
  for (std::int64_t c = 0; c < m.n_cells(); ++c)
    for (std::int64_t f = 0; f < static_cast<std::int64_t>(info(m.shape[c]).facets.size()); ++f)
      for (int axis = 0; axis < 3; ++axis)
        for (const double at : {0., high[axis]}) {
          const auto nodes = m.facet_nodes({c, f});
          if (std::all_of(nodes.begin(), nodes.end(), [&](std::int64_t a) { return std::abs(m.X[a][axis] - at) < 1e-9; }))
            m.facet_sets[std::string(1, "xyz"[axis]) + (at > 0 ? "max" : "min")].push_back({c, f});
        }
  return m;
}

const std::string rollers =
    "[region.\"*\"]\nmaterial = \"m\"\n" + held("xmin", "x") + held("ymin", "y") + held("zmin", "z") + load("traction", "pull", "xmax");

TEST(OutsideShape, MeshFileKeepsItAndItsVolumeAndFacetsAreRight) {
  const test::Workplace place;
  const Mesh m = pyramids({2, 2, 2}, Vec3(1, 1, 1), 0.1, true);
  write_mesh(place / "mesh.h5", m, {"test"});
  const Mesh back = read_mesh_file(place / "mesh.h5").mesh;
  EXPECT_EQ(back.shape, m.shape);
  double volume = 0;
  for (std::int64_t c = 0; c < back.n_cells(); ++c) {
    volume += quality(back, c).volume;
    EXPECT_GT(quality(back, c).scaled_jacobian, 0) << c;
  }
  EXPECT_NEAR(volume, 1, 1e-14);
  Vec3 area = Vec3::Zero();
  for (const Facet& f : back.facet_sets.at("xmax")) area += facet_area(back, f);
  EXPECT_LT((area - Vec3::UnitX()).norm(), 1e-14);
  const auto ran = place.run("hilo-show mesh.h5");  // a program that has no such shape
  EXPECT_EQ(ran.exit, 2);
  EXPECT_EQ(ran.err,
            "hilo-show: mesh.h5: cells of shape 128, \"pyramid5\", which this program does not have (it is of a program that adds shapes "
            "of its own)\n");
}

// Exact: uniform tractions stretch a box on rollers by diag(l1, l2, l2), whatever its cells (Irons' patch test): St. Venant-Kirchhoff
// T = l1 E e1, e1 = (l1^2 - 1)/2, e2 = -nu e1; stress T/l2^2 at every node and cell.
TEST(OutsideShape, PatchOfBentCellsIsStretchedUniformly) {
  const double E = 2e11, l1 = 1.05, e1 = (l1 * l1 - 1) / 2, T = l1 * E * e1, l2 = std::sqrt(1 - 0.6 * e1);
  for (const std::string law : {"stvk", "twin of stvk"})
    for (const bool mixed : {false, true}) {
      const test::Workplace place;
      const Mesh m = pyramids({2, 2, 2}, Vec3(1, 1, 1), 0.1, mixed);
      write_mesh(place / "mesh.h5", m, {"test"});
      const auto r = run_scene(place,
                               "[material.m]\nkind = \"" + law + "\"\nE = 2e11\nnu = 0.3\ndensity = 7800\n" + rollers +
                                   fmt::format("traction = [{:.17g}, 0, 0]\n[time]\nanalysis = \"static\"\n[output]\nfields = "
                                               "[\"displacement\", \"stress\", \"von_mises\", \"stress_error\"]\n",
                                               T),
                               "mesh.h5");
      const auto u = r.field("displacement");
      for (std::int64_t a = 0; a < m.n_nodes(); ++a)
        EXPECT_LT((u[a] - Vec3((l1 - 1) * m.X[a][0], (l2 - 1) * m.X[a][1], (l2 - 1) * m.X[a][2])).norm(), 1e-10) << a;
      const std::string last = "/field/" + r.steps().back() + "/";
      const auto stress = r.table(last + "stress");
      EXPECT_LT((stress.col(0).array() - T / (l2 * l2)).abs().maxCoeff(), 1e-8 * T);
      EXPECT_LT(stress.rightCols(5).cwiseAbs().maxCoeff(), 1e-8 * T);
      EXPECT_LT((r.table(last + "cell_von_mises").array() - T / (l2 * l2)).abs().maxCoeff(), 1e-8 * T);
    }
}

// Exact: momentum and energy of a free bar that bends as it tumbles; at the start those of a rigid box, so mass is exact; with laws of the
// tree that differ in direction, keep their volume, remember.
TEST(OutsideShape, TumblingBarKeepsMomentumAndEnergy) {
  for (const char* law : {"kind = \"stvk\"\nE = 1e7\nnu = 0.3", "kind = \"neo-hookean\"\nE = 1e7\nnu = 0.4999",
                          "kind = \"j2\"\nE = 1e7\nnu = 0.3\nyield = 1e4\nhardening = 1e5"})
    for (const bool rigid : {false, true}) {
      const test::Workplace place;
      const Mesh m = pyramids({4, 1, 1}, Vec3(1, 0.1, 0.1), 0, false);
      write_mesh(place / "mesh.h5", m, {"test"});
      write_tags(place / "tags.h5", place / "mesh.h5", {rigid ? Fidelity::rigid : Fidelity::nonlinear}, {"test"});
      const auto r = run_scene(place,
                               std::string("[material.m]\n") + law + "\ndensity = 1000\n[region.\"*\"]\nmaterial = \"m\"\n" +
                                   initial("block", "spin = [3, 15, 10]") + in_time(0.2, 0.01) +
                                   "[output]\nfields = [\"displacement\", \"von_mises\"]\n[solver]\ntolerance = 1e-12\n",
                               "tags.h5");
      const Vec3 box = Vec3(0.02, 1.01, 1.01) * 10 / 12, L(3 * box[0], 15 * box[1], 10 * box[2]);
      const auto energy = r.history("energy"), momentum = r.history("momentum");
      const Vec3 first = momentum.row(0).tail<3>().transpose(), last = momentum.bottomRows(1).rightCols(3).transpose();
      EXPECT_LT((first - L).norm(), 1e-12 * L.norm()) << law;
      EXPECT_NEAR(energy(0, 0), L.dot(Vec3(3, 15, 10)) / 2, 1e-12 * energy(0, 0)) << law;
      EXPECT_LT((last - first).norm(), 1e-11 * L.norm()) << law;
      EXPECT_LT(energy.col(5).cwiseAbs().maxCoeff(), 1e-10 * energy(0, 0)) << law;
      if (!rigid) {
        EXPECT_GT(energy.col(1).maxCoeff(), 1e-3 * energy(0, 0)) << law;
      }
    }
}

TEST(OutsideShape, LawFromOutsideThatItWasNotAddedWithIsRefusedByName) {
  const test::Workplace place;
  write_mesh(place / "mesh.h5", pyramids({1, 1, 1}, Vec3(1, 1, 1), 0, false), {"test"});
  try {
    run_scene(place, "[material.m]\nkind = \"fung\"\nE = 1e5\nnu = 0.3\nstiffening = 1\ndensity = 1\n" + rollers + "traction = [1, 0, 0]\n",
              "mesh.h5");
    FAIL() << "ran";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("region \"block\" is made of pyramid5: kind = \"fung\" has none (kinds that have: stvk, "),
              std::string::npos)
        << e.what();
  }
  EXPECT_THROW(add_pyramid(), Error) << "the number is taken";
}

}  // namespace
}  // namespace outside
