// SPDX-License-Identifier: GPL-3.0-or-later
// A material: soft tissue after Fung, whose stiffness grows with strain without end.  A struct as solver/physics/material/material.hpp
// says, and one call.
#include "outside.hpp"
#include "physics/add_material.hpp"
#include "physics/lane_functions.hpp"

namespace outside {
namespace {

using namespace hilo;

/// exp(x) of each lane.
template <class T>
T exp_of(T x) {
  for (unsigned l = 0; l < sizeof(T) / sizeof(double); ++l) lane(x, l) = std::exp(lane(x, l));
  return x;
}
/// (exp(d) - 1)/d and its derivative, by series where |d| < 1e-3.
template <class T>
void quotient_of_exp(const T& d, T& q, T& slope) {
  for (unsigned l = 0; l < sizeof(T) / sizeof(double); ++l) {
    const double x = lane(d, l);
    const bool small = std::abs(x) < 1e-3;
    lane(q, l) = small ? 1 + x * (1. / 2 + x * (1. / 6 + x * (1. / 24 + x / 120))) : std::expm1(x) / x;
    lane(slope, l) = small ? 1. / 2 + x * (1. / 3 + x * (1. / 8 + x * (1. / 30 + x / 144))) : (std::exp(x) - lane(q, l)) / x;
  }
}

/// W = Y/(2 a) (exp(a e:C:e/Y) - 1), C of Young's modulus Y and Poisson's ratio; S = exp(a e:C:e/Y) C e.  Over a step e:C:e changes by
/// (e0 + e1):C:(e1 - e0), so with d = a (e1:C:e1 - e0:C:e0)/Y and q = (exp(d) - 1)/d the stress S = exp(a e0:C:e0/Y) q C (e0 + e1)/2 has
/// S.(e1 - e0) = W1 - W0 exactly.
struct Fung {
  static constexpr std::string_view name = "fung", meaning = "soft tissue: the exponential law of Fung, isotropic";
  static std::vector<Param> keys() {
    return {young, poisson, {"stiffening", Type::number, "1", "!", "a: the modulus of a bar grows as exp(a e^2) (1 + 2 a e^2)", above(0)}};
  }
  static Fung make(const MaterialValues& v) { return {lame(v.number("E"), v.number("nu")), v.number("E"), v.number("stiffening")}; }
  using Bulk = NoBulk;
  static constexpr double soft_below = 0;
  static constexpr std::string_view soft_because = "";
  Lame c;
  double Y, a;

  Lame linear() const { return c; }
  template <class T>
  T energy(const T e[6]) const {
    T s[6];
    linear_stress(c, e, s);
    return Y / (2 * a) * (exp_of(T(a / Y * dot(e, s))) - 1);
  }
  template <class T>
  void stress(const T e0[6], const T e1[6], T s[6], T (*D)[6]) const {
    T s0[6], s1[6];
    linear_stress(c, e0, s0);
    linear_stress(c, e1, s1);
    const T x0 = a / Y * dot(e0, s0), before = exp_of(x0);
    T q = x0, slope = x0;
    quotient_of_exp(T(a / Y * dot(e1, s1) - x0), q, slope);
    for (int i = 0; i < 6; ++i) s[i] = before * q * (s0[i] + s1[i]) / 2;
    if (!D) return;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) D[i][j] += before * slope * (a / Y) * (s0[i] + s1[i]) * s1[j];
    T C[6][6];
    for (auto& row : C)
      for (T& entry : row) entry = 0 * q;
    add_linear_tangent(c, 0.5, C);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) D[i][j] += before * q * C[i][j];
  }

  /// Lateral strains are -nu e, as e:C:e alone is stretched.
  BarState bar(double e) const {
    const double grown = std::exp(a * e * e), nu = c.lambda / (2 * (c.lambda + c.mu));
    return {Y / (2 * a) * (grown - 1), Y * e * grown, Y * grown * (1 + 2 * a * e * e), std::max(1 - 2 * nu * e, 0.01)};
  }
  BarStep bar_step(double e0, double e1) const { return quotient_step(*this, e0, e1); }

 private:
  template <class T>
  static T dot(const T x[6], const T y[6]) {
    T sum = x[0] * y[0];
    for (int i = 1; i < 6; ++i) sum += x[i] * y[i];
    return sum;
  }
};

/// Laws of the tree under another name: what they do from outside must be what they do inside, with memory, mean dilatation and moduli that
/// differ with direction.
struct TwinOfJ2 : J2 {
  static constexpr std::string_view name = "twin of j2";
  static TwinOfJ2 make(const MaterialValues& v) { return {J2::make(v)}; }
};
struct TwinOfRubber : MooneyRivlin {
  static constexpr std::string_view name = "twin of mooney-rivlin";
  static TwinOfRubber make(const MaterialValues& v) { return {MooneyRivlin::make(v)}; }
  TwinOfRubber with_lambda(double lambda) const { return {MooneyRivlin::with_lambda(lambda)}; }
};
struct TwinOfWood : Orthotropic {
  static constexpr std::string_view name = "twin of orthotropic";
  static TwinOfWood make(const MaterialValues& v) { return {Orthotropic::make(v)}; }
};

}  // namespace

void add_materials() {
  add_material<Fung>();
  add_material<TwinOfJ2>();
  add_material<TwinOfRubber>();
  add_material<TwinOfWood>();
}

namespace {

const std::string tissue = test::solid(2e5, 0.3, 1000, "*", "kind = \"fung\"\nstiffening = 4");

Mesh block(Shape shape, std::array<int, 3> n = {1, 1, 1}, const Vec3& high = Vec3(2, 1, 1)) {
  test::BlockOptions o;
  o.shape = shape, o.high = high;
  std::copy(n.begin(), n.end(), o.n);
  return test::block_mesh(o);
}
constexpr Shape solids[] = {Shape::tet4, Shape::tet10, Shape::wedge6, Shape::wedge15, Shape::hex8, Shape::hex20, Shape::hex20r};

// Exact: of a bar of stretch l, e = (l^2 - 1)/2, the force over its first area is l Y e exp(a e^2), its width sqrt(1 - 2 nu e), and the
// stress that force over its area now.
TEST(OutsideMaterial, BlockIsPulledByTheForceOfItsLaw) {
  const double l = 1.4, e = (l * l - 1) / 2, force = l * 2e5 * e * std::exp(4 * e * e), width = std::sqrt(1 - 0.6 * e);
  for (const Shape shape : solids) {
    const test::Workplace place;
    const Mesh mesh = block(shape);
    write_mesh(place / "mesh.h5", mesh, {"test"});
    const auto r = run_scene(place,
                             tissue + held("xmin", "x") + held("ymin", "y") + held("zmin", "z") +
                                 motion("translation", "pull", "xmax", "components = [\"x\"]\ndisplacement = [0.8, 0, 0]") + in_steps(4) +
                                 "[output]\nfields = [\"displacement\", \"stress\", \"von_mises\"]\n",
                             "mesh.h5");
    EXPECT_NEAR(std::abs(r.at("motion/pull", 1)[0]), force, 1e-8 * force) << info(shape).name;
    const auto stress = r.table("/field/" + r.steps().back() + "/stress");
    EXPECT_LT((stress.col(0).array() - force / (width * width)).abs().maxCoeff(), 1e-7 * force) << info(shape).name;
    EXPECT_LT(stress.rightCols(5).cwiseAbs().maxCoeff(), 1e-7 * force) << info(shape).name;
    const auto u = r.field("displacement");
    for (std::int64_t a = 0; a < mesh.n_nodes(); ++a) EXPECT_NEAR(u[a][2], (width - 1) * mesh.X[a][2], 1e-9) << info(shape).name;
  }
}

// Energy and momenta of a free bar that bends as it tumbles.
TEST(OutsideMaterial, TumblingBarKeepsItsEnergyAndMomentum) {
  for (const Shape shape : solids) {
    const test::Workplace place;
    write_mesh(place / "mesh.h5", block(shape, {4, 1, 1}, Vec3(1, 0.1, 0.1)), {"test"});
    const auto r =
        run_scene(place, tissue + initial("block", "spin = [1, 4, 3]") + in_time(0.5, 0.01) + "[solver]\ntolerance = 1e-12\n", "mesh.h5");
    const auto energy = r.history("energy"), momentum = r.history("momentum");
    EXPECT_LT(energy.col(5).cwiseAbs().maxCoeff(), 1e-10 * energy(0, 0)) << info(shape).name;
    EXPECT_GT(energy.col(1).maxCoeff(), 1e-3 * energy(0, 0)) << info(shape).name;
    const Vec3 before = momentum.row(0).tail<3>(), after = momentum.bottomRows(1).rightCols(3).transpose();
    EXPECT_LT((after - before).norm(), 1e-11 * before.norm()) << info(shape).name;
  }
}

// Exact: the force of the law, of a rod of A = 1e-3 m^2 and stretch l, gives it that stretch.
TEST(OutsideMaterial, BarCarriesTheForceOfItsLaw) {
  const test::Workplace place;
  Mesh rod;
  for (const double x : {0., 1.}) rod.X.emplace_back(x, 0, 0), rod.node_id.push_back(rod.n_nodes());
  rod.add_cell(Shape::bar2, std::array<std::int64_t, 2>{0, 1}, 0, 1);
  rod.region_name = {"rod"}, rod.region_data.resize(1);
  rod.node_sets["foot"] = {0}, rod.node_sets["head"] = {1};
  write_mesh(place / "mesh.h5", rod, {"test"});
  const double l = 1.3, e = (l * l - 1) / 2, force = 1e-3 * l * 2e5 * e * std::exp(4 * e * e);
  const auto r = run_scene(place,
                           tissue + R"(
area = 1e-3
[[motion]]
kind = "fixed"
name = "foot"
on = "foot"
[[motion]]
kind = "fixed"
name = "guide"
on = "head"
components = ["y", "z"]
[[load]]
kind = "force"
name = "pull"
on = "head"
)" + fmt::format("force = [{:.17g}, 0, 0]", force) +
                               R"(
[time]
analysis = "static"
[output]
fields = ["displacement", "stress"]
)",
                           "mesh.h5");
  EXPECT_NEAR(r.field("displacement").back()[0], l - 1, 1e-9);
  const auto stress = r.table("/field/" + r.steps().back() + "/stress");
  EXPECT_NEAR(stress(0, 0), force / (1e-3 * (1 - 0.6 * e)), 1e-9 * stress(0, 0));
}

TEST(OutsideMaterial, LawsOfTheTreeDoTheSameFromOutside) {
  struct Twin {
    const char *inside, *outside, *keys;
  };
  for (const Twin& t : {Twin{"j2", "twin of j2", "E = 1e7\nnu = 0.3\nyield = 1e4\nhardening = 1e5"},
                        Twin{"mooney-rivlin", "twin of mooney-rivlin", "c10 = 1.2e6\nc01 = 0.5e6\nbulk = 5e9"},
                        Twin{"orthotropic", "twin of orthotropic",
                             "E1 = 11e6\nE2 = 3e6\nE3 = 2e6\nnu12 = 0.37\nnu13 = 0.42\nnu23 = 0.47\nG12 = 0.9e6\nG13 = 0.8e6\nG23 = "
                             "0.5e6\naxis_1 = [3, 1, 0.5]\naxis_2 = [-1, 3, 0]"}})
    for (const Shape shape : {Shape::hex8, Shape::tet10, Shape::hex20r}) {
      const test::Workplace place;
      write_mesh(place / "mesh.h5", block(shape, {4, 1, 1}, Vec3(1, 0.1, 0.1)), {"test"});
      const auto run = [&](const std::string& law) {
        return run_scene(place, "[material.m]\nkind = \"" + law + "\"\n" + t.keys + R"(
density = 1000
[region."*"]
material = "m"
damping = 1e-4
[[initial]]
on = ["block"]
spin = [3, 15, 10]
[time]
end = 0.05
step = 0.005
[output]
fields = ["displacement", "stress", "plastic_strain"]
)",
                         "mesh.h5");
      };
      const auto a = run(t.inside), b = run(t.outside);
      const std::string last = "/field/" + a.steps().back() + "/";
      for (const char* field : {"displacement", "stress", "plastic_strain"}) {
        if (!a.file().has(last + field)) continue;
        const auto x = a.table(last + field), y = b.table(last + field);
        EXPECT_LT((x - y).cwiseAbs().maxCoeff(), 1e-7 * x.cwiseAbs().maxCoeff()) << t.outside << " " << info(shape).name << " " << field;
      }
      EXPECT_EQ(a.file().has(last + "plastic_strain"), b.file().has(last + "plastic_strain"));
    }
}

TEST(OutsideMaterial, IsSuggestedForAMistypedWordAndItsKeysAreChecked) {
  const auto refused = [](const std::string& from, const std::string& to) -> std::string {
    std::string text = tissue;
    text.replace(text.find(from), from.size(), to);
    try {
      Scene::parse(text, "scene.toml");
    } catch (const Error& e) {
      return e.what();
    }
    return "not refused";
  };
  EXPECT_NE(refused("\"fung\"", "\"fnug\"").find("did you mean \"fung\"?"), std::string::npos) << refused("\"fung\"", "\"fnug\"");
  EXPECT_NE(refused("stiffening", "stifening").find("did you mean \"stiffening\"?"), std::string::npos);
  EXPECT_NE(refused("stiffening = 4\n", "").find("stiffening"), std::string::npos);
  EXPECT_NE(refused("stiffening = 4", "stiffening = -4").find("scene.toml:6"), std::string::npos) << refused("= 4", "= -4");
  EXPECT_THROW(add_material<Fung>(), Error) << "too late, and the word stands already";
}

}  // namespace
}  // namespace outside
