// SPDX-License-Identifier: GPL-3.0-or-later
// time.dissipation of energy-momentum: a stress of second order.  What it changes falls with h^2, the energy that is left and what it
// stores never rises, and both momenta stay, for every kind of flexible part.
#include "verify/verify.hpp"

namespace hilo::test::dissipation_test {
namespace {

/// A soft arm of 1 m x 0.1 m x 0.1 m along x of one kind of part.
struct Kind {
  const char* name;
  Shape shape = Shape::hex8;
  std::string law = {};  // and keys of the material
  std::string region = {};
  Fidelity fidelity = Fidelity::nonlinear;
};
std::ostream& operator<<(std::ostream& out, const Kind& k) { return out << k.name; }

const Kind kinds[] = {{"Hexahedra"},
                      {"Hexahedra20", Shape::hex20r, "kind = \"neo-hookean\"\n"},
                      {"Tetrahedra", Shape::tet10, "kind = \"neo-hookean\"\nnu = 0.4999\n"},
                      {"NearlyIncompressible", Shape::hex20r, "nu = 0.4999\n"},
                      {"Metal", Shape::hex8, "kind = \"j2\"\nyield = 1e12\nhardening = 0\n"},
                      {"Shells", Shape::hex8, "E = 2e6\n", "shell = true\n"},
                      {"ShellsOfRubber", Shape::hex8, "kind = \"neo-hookean\"\nE = 2e6\n", "shell = true\n"},
                      {"Linear", Shape::hex8, "", "", Fidelity::linear},
                      {"LinearStiffening", Shape::hex8, "", "stiffening = true\n", Fidelity::linear},
                      {"Bars"},
                      {"Beams"}};

class Dissipation : public testing::TestWithParam<Kind> {
 protected:
  Dissipation() {
    const Kind& k = GetParam();
    const std::string name = k.name;
    if (name == "Beams") {
      parts_ =
          "[section.s]\nkind = \"matrix\"\nstiffness = [3e3, 3e3, 1e4]\nbending = [8, 8, 6]\nline_mass = 10\ninertia = [0.01, 0.01]\n"
          "[beam.arm]\npoints = [[0, 0, 0], [1, 0, 0]]\ncells = [8]\nsection = \"s\"\n";
      root_ = "arm.0", tip_ = "arm.8", whole_ = "*";
      return;
    }
    std::string material = "density = 1000\n" + k.law;
    if (k.law.find("E =") == std::string::npos) material += "E = 1e6\n";
    if (k.law.find("nu =") == std::string::npos) material += "nu = 0.3\n";
    parts_ = "[material.m]\n" + material + "[region.block]\nmaterial = \"m\"\n" + k.region;
    if (name == "Bars") {  // a cable of six
      std::string deck = "*NODE, NSET=all\n";
      for (int i = 0; i <= 6; ++i) deck += fmt::format("{}, {}, 0, 0\n", i + 1, i / 6.0);
      deck += "*NSET, NSET=xmin\n1\n*NSET, NSET=xmax\n7\n*ELEMENT, TYPE=T3D2, ELSET=block\n";
      for (int i = 1; i <= 6; ++i) deck += fmt::format("{}, {}, {}\n", i, i, i + 1);
      place_.write("bars.inp", deck);
      EXPECT_EQ(place_.run("hilo-import --quiet bars.inp --regions block -o tags.h5").exit, 0);
      parts_ += "area = 0.01\n", mesh_ = "tags.h5";
      return;
    }
    BlockOptions o{.shape = k.shape, .n = {info(k.shape).n_nodes > 8 ? 2 : 8, 1, 1}, .high = {1, 0.1, 0.1}};
    if (!k.region.empty() && k.fidelity == Fidelity::nonlinear) o.n[0] = 4, o.high = Vec3(1, 0.2, 0.05);  // shells

    write_mesh((place_ / "mesh.h5"), block_mesh(o), {"test"});
    write_tags((place_ / "tags.h5"), (place_ / "mesh.h5"), {k.fidelity}, {"test"});
    mesh_ = "tags.h5";
  }

  Results solved(const std::string& scene, double end, double step, double chi) {
    place_.write("scene.toml", parts_ + scene + fmt::format("[time]\nend = {}\nstep = {}\ndissipation = {}\n", end, step, chi) +
                                   "[output]\ninterval = 10\n[solver]\ntolerance = 1e-12\n");
    succeeded(place_.run("hilo-solve --quiet scene.toml " + mesh_ + " -o run.h5"));
    return Results(place_ / "run.h5");
  }
  /// Hung up at its root, pulled aside at its tip and let go; damped, so that steps of 10 ms resolve what is left.
  Results swung(double step, double chi) {
    return solved("damping = 2e-3\n[[joint]]\nkind = \"spherical\"\nname = \"pin\"\na = \"ground\"\nb = \"" + root_ +
                      "\"\nat = [0, 0, 0]\n" + "[[load]]\nkind = \"force\"\nname = \"pull\"\non = \"" + tip_ +
                      "\"\nforce = [60, 20, -30]\n" +
                      "history = {t = [0, 0.5, 1], value = [0, 1, 0], interpolation = \"smooth\"}\n[[probe]]\nname = \"tip\"\non = \"" +
                      tip_ + "\"\n",
                  1, step, chi);
  }

  Workplace place_;
  std::string parts_, mesh_, root_ = "xmin", tip_ = "xmax", whole_ = "block";
};

// Truth: the same run without dissipation.
TEST_P(Dissipation, ChangesPositionsAndPinForceBySecondOrder) {
  double force[3], position[3];
  for (int i = 0; i < 3; ++i) {
    const double h = 0.01 / (1 << i);
    const Results with = swung(h, 0.1);
    const auto f = with.history("joint/pin"), x = with.history("probe/tip"), e = with.history("energy");
    const Results without = swung(h, 0);
    const auto f0 = without.history("joint/pin"), x0 = without.history("probe/tip");
    ASSERT_EQ(f.rows(), f0.rows());
    force[i] = (f - f0).leftCols(3).rowwise().norm().maxCoeff() / f0.leftCols(3).rowwise().norm().maxCoeff();
    position[i] =
        (x - x0).leftCols(3).rowwise().norm().maxCoeff() / (x0.leftCols(3).rowwise() - x0.leftCols(3).row(0)).rowwise().norm().maxCoeff();
    EXPECT_LT(e.col(5).cwiseAbs().maxCoeff(), 1e-10 * e.col(0).maxCoeff());
  }
  std::printf("%s: pin force %.2g, order %.2f; position %.2g, order %.2f\n", GetParam().name, force[0], std::log2(force[1] / force[2]),
              position[0], std::log2(position[1] / position[2]));
  EXPECT_LT(force[0], std::string(GetParam().name) == "Bars" ? 2e-2 : 5e-3);  // a cable snaps taut
  EXPECT_LT(position[0], 5e-3);
  EXPECT_GT(std::log2(force[1] / force[2]), 1.9);
  EXPECT_GT(std::log2(position[1] / position[2]), 1.9);
}

TEST_P(Dissipation, NeverRaisesTheEnergyAndKeepsMomenta) {
  // steps that are far too long for what vibrates, up to a radian each
  const Results r =
      solved("[[initial]]\non = [\"" + whole_ + "\"]\nspin = [1, 6, 4]\nabout = [0, 0, 0]\nvelocity = [1, 0, 2]\n", 4, 0.1, 0.2);
  const auto e = r.history("energy"), p = r.history("momentum");
  const Eigen::Index n = e.rows() - 1;
  const double top = e(0, 0);
  const Eigen::VectorXd sum = e.leftCols(3).rowwise().sum();
  EXPECT_LT((sum.tail(n) - sum.head(n)).maxCoeff(), 1e-11 * top);
  EXPECT_GT((e.col(4).tail(n) - e.col(4).head(n)).minCoeff(), -1e-11 * top) << "what is lost, never comes back";
  EXPECT_GT(e(n, 4), 1e-6 * top) << "something is lost";
  EXPECT_NEAR(e(n, 4), sum[0] - sum[n], 1e-10 * top);
  for (const int k : {0, 3})
    EXPECT_LT((p.middleCols(k, 3).rowwise() - p.row(0).segment(k, 3)).rowwise().norm().maxCoeff(), 1e-11 * p.row(0).segment(k, 3).norm());
}

// Truth: a bar that strikes a wall comes to rest behind the front, which passes its middle at L/2c and again at 3L/2c.
TEST(DissipationBehindAFront, TakesTheRinging) {
  Workplace place;
  const BlockOptions o{.n = {100, 1, 1}, .high = {1, 0.01, 0.01}};
  Mesh mesh = block_mesh(o);
  add_node_set(mesh, "middle", [](const Vec3& x) { return std::abs(x[0] - 0.5) < 1e-9; });
  write_mesh(place / "mesh.h5", mesh, {"test"});
  const double c = std::sqrt(1e6 / 1000);
  const auto rings = [&](double chi) {
    place.write("scene.toml",
                "[material.m]\nE = 1e6\nnu = 0\ndensity = 1000\n[region.block]\nmaterial = \"m\"\n[[motion]]\nkind = \"fixed\"\n"
                "name = \"wall\"\non = \"xmin\"\n[[initial]]\non = [\"block\"]\nvelocity = [-0.01, 0, 0]\n[[probe]]\n"
                "name = \"middle\"\non = \"middle\"\n[output]\ninterval = 1\n" +
                    fmt::format("[time]\nend = {}\nstep = {}\ndissipation = {}\n", 1.4 / c, 0.005 / c, chi));
    succeeded(place.run("hilo-solve --quiet scene.toml mesh.h5 -o run.h5"));
    const Results r(place / "run.h5");
    const auto probe = r.history("probe/middle");
    double most = 0;
    for (Eigen::Index i = 0; i < probe.rows(); ++i)
      if (r.t()[i] > 0.6 / c && r.t()[i] < 1.3 / c) most = std::max(most, std::abs(probe(i, 3)) / 0.01);
    return most;
  };
  const double without = rings(0), with = rings(0.1);
  std::printf("velocity behind the front: %.2g of the bar's, %.2g with dissipation\n", without, with);
  EXPECT_LT(with, 2e-3);
  EXPECT_LT(with, without / 5);
}

INSTANTIATE_TEST_SUITE_P(Of, Dissipation, testing::ValuesIn(kinds), [](const auto& p) { return std::string(p.param.name); });

}  // namespace
}  // namespace hilo::test::dissipation_test
