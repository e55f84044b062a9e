// SPDX-License-Identifier: GPL-3.0-or-later
// Peaks of stress on three meshes of hex20r each, against published values, closed forms and reference.py: near from the first mesh on,
// and nearer on each finer one.
#include <array>

#include "verify/surface_stress/le10.hpp"

namespace hilo::test::benchmarks_test {
namespace {

using std::numbers::pi;
using Map = std::function<Vec3(double, double)>;

/// A face of n cells along s and m along t.
struct Face {
  int n, m;
  Map map;
};

/// From the arc of 90 degrees about the centre, beginning at the angle `first`, out to a square of that half width.
Map corner(double x, double y, double radius, double half, double first) {
  return [=](double s, double t) {
    const double c = std::cos(first + t * pi / 2), d = std::sin(first + t * pi / 2);
    const double r = radius + s * (half / std::max(std::abs(c), std::abs(d)) - radius);
    return Vec3(x + r * c, y + r * d, 0);
  };
}
Map box(double x0, double x1, double y0, double y1) {
  return [=](double s, double t) { return Vec3(x0 + (x1 - x0) * s, y0 + (y1 - y0) * t, 0); };
}

/// Faces of `thickness` one cell thick, joined where their nodes meet.
Mesh plate(const std::vector<Face>& faces, double thickness) {
  Mesh all;
  std::map<std::array<long, 3>, std::int64_t> known;
  for (const Face& face : faces) {
    const Mesh m = curved(Shape::hex20r, {face.n, face.m, 1},
                          [&](const Vec3& s) { return Vec3(face.map(s[0], s[1]) + Vec3(0, 0, thickness * s[2])); });
    if (all.region_name.empty()) all.region_name = m.region_name, all.region_data = m.region_data;
    for (std::int64_t e = 0; e < m.n_cells(); ++e) {
      std::vector<std::int64_t> nodes;
      for (const std::int64_t a : m.cell(e)) {
        const Vec3& X = m.X[a];
        const auto [it, fresh] =
            known.try_emplace({std::lround(1e7 * X[0]), std::lround(1e7 * X[1]), std::lround(1e7 * X[2])}, all.n_nodes());
        if (fresh) all.X.push_back(X), all.node_id.push_back(it->second);
        nodes.push_back(it->second);
      }
      all.add_cell(Shape::hex20r, nodes, 0, all.n_cells() + 1);
    }
  }
  return all;
}

void add_facets(Mesh& m, const std::string& name, const std::function<bool(const Vec3&)>& in) {
  const int n = static_cast<int>(info(Shape::hex20r).facets.size());
  for (std::int64_t c = 0; c < m.n_cells(); ++c)
    for (int f = 0; f < n; ++f) {
      const auto nodes = m.facet_nodes({c, f});
      if (std::all_of(nodes.begin(), nodes.end(), [&](std::int64_t a) { return in(m.X[a]); })) m.facet_sets[name].push_back({c, f});
    }
}

/// The worst of a component of stress over the nodes with these x and y, as its distance from the truth.
double off(const Mesh& m, const Eigen::MatrixXd& stress, const Vec3& at, int component, double truth) {
  double worst = 0;
  for (std::int64_t a = 0; a < m.n_nodes(); ++a)
    if ((m.X[a] - at).head<2>().norm() < 1e-6) worst = std::max(worst, std::abs(stress(a, component) / truth - 1));
  EXPECT_GT(worst, 0) << "no node there";
  return worst;
}

/// Stress under `more` of a plate held on its planes of symmetry and at the nodes at which z is held.
Eigen::MatrixXd stress_of(Mesh& m, const std::string& more, const std::function<bool(const Vec3&)>& x,
                          const std::function<bool(const Vec3&)>& y, const std::function<bool(const Vec3&)>& z) {
  add_node_set(m, "held x", x), add_node_set(m, "held y", y), add_node_set(m, "held z", z);
  SceneCase c(steel_block(210e9, held("held x", "x") + held("held y", "y") + held("held z", "z") + more, "\"displacement\", \"stress\""));
  c.use(m);
  const Results r = c.solved();
  return r.table("/field/" + r.steps().back() + "/stress");
}

constexpr double tiny = 1e-9;
const auto everywhere = [](const Vec3&) { return true; };
const auto at_x = [](double x) { return [x](const Vec3& X) { return std::abs(X[0] - x) < tiny; }; };
const auto at_y = [](double y) { return [y](const Vec3& X) { return std::abs(X[1] - y) < tiny; }; };
const std::string pull = load("traction", "pull", "end", "traction = [1e6, 0, 0]");

/// NAFEMS LE10: sigma_yy = -5.38 MPa; polynomials of degree 6 give -5.397.
double le10_off(int k) {
  const std::array<std::array<int, 3>, 3> cells{{{8, 6, 2}, {12, 8, 4}, {24, 16, 4}}};
  return off_le10(Shape::hex20r, cells[k]);
}

/// NAFEMS LE1, 0.1 m thick: sigma_yy = 92.7 MPa at the hole's end.
double le1_off(int k) {
  Mesh m =
      plate({{4 << k, 6 << k,
              [](double s, double t) { return Vec3((2 + 1.25 * s) * std::cos(t * pi / 2), (1 + 1.75 * s) * std::sin(t * pi / 2), 0); }}},
            0.05);
  add_facets(m, "end", [](const Vec3& X) { return std::abs(std::pow(X[0] / 3.25, 2) + std::pow(X[1] / 2.75, 2) - 1) < 1e-6; });
  const auto stress =
      stress_of(m, load("pressure", "pull", "end", "pressure = -10e6"), at_x(0), at_y(0), [](const Vec3& X) { return X[2] < tiny; });
  return off(m, stress, {2, 0, 0}, 1, 92.7e6);
}

/// Lame: the hoop stress inside a tube of 1 and 2 m is 5/3 of the pressure.
double lame_off(int k) {
  Mesh m = plate(
      {{3 << k, 3 << k, [](double s, double t) { return Vec3((1 + s) * std::cos(t * pi / 2), (1 + s) * std::sin(t * pi / 2), 0); }}}, 0.2);
  add_facets(m, "end", [](const Vec3& X) { return std::abs(X.head<2>().norm() - 1) < 1e-6; });
  const auto stress = stress_of(m, load("pressure", "inside", "end", "pressure = 1e4"), at_x(0), at_y(0), everywhere);
  return off(m, stress, {1, 0, 0}, 1, 5e4 / 3);
}

/// Kirsch: 3 times the tension beside a hole in a wide plate, plane strain; the plate ends at four radii, where nodes go as they would.
double kirsch_off(int k) {
  Mesh m =
      plate({{3 << k, 4 << k,
              [](double s, double t) { return Vec3(std::pow(4, s) * std::cos(t * pi / 2), std::pow(4, s) * std::sin(t * pi / 2), 0); }}},
            0.2);
  const double mu = 210e9 / 2.6, kappa = 3 - 4 * 0.3;
  std::string more;
  const auto outer = [](const Vec3& X) { return X.head<2>().norm() > 4 - 1e-6; };
  for (std::int64_t a = 0; a < m.n_nodes(); ++a) {
    if (!outer(m.X[a])) continue;
    const double r = 4, t = std::atan2(m.X[a][1], m.X[a][0]), scale = 1e6 / (8 * mu);
    const double ux =
        r * (kappa + 1) * std::cos(t) + 2 / r * ((1 + kappa) * std::cos(t) + std::cos(3 * t)) - 2 / (r * r * r) * std::cos(3 * t);
    const double uy =
        r * (kappa - 3) * std::sin(t) + 2 / r * ((1 - kappa) * std::sin(t) + std::sin(3 * t)) - 2 / (r * r * r) * std::sin(3 * t);
    const std::string name = fmt::format("n{}", a);
    m.node_sets[name] = {a};
    more += motion("translation", name, name, "displacement = " + list({scale * ux, scale * uy, 0}) + "\ncomponents = [\"x\", \"y\"]");
  }
  const auto stress = stress_of(
      m, more, [&](const Vec3& X) { return std::abs(X[0]) < tiny && !outer(X); },
      [&](const Vec3& X) { return std::abs(X[1]) < tiny && !outer(X); }, everywhere);
  return off(m, stress, {0, 1, 0}, 0, 3e6);
}

/// reference.py: a bar 4 m wide and long with notches of radius 1 m, 3.49835 times the tension at their roots.
double notch_off(int k) {
  Mesh m = plate({{3 << k, 4 << k, corner(0, 2, 1, 2, -pi / 2)}}, 0.2);
  add_facets(m, "end", at_x(2));
  return off(m, stress_of(m, pull, at_x(0), at_y(0), everywhere), {0, 1, 0}, 0, 3.49835e6);
}

/// reference.py: the width of a bar falls from 4 to 2 m by a fillet of .5 m; sigma_xx = 1.39816 of the tension at 22.5 degrees from its
/// end.
double fillet_off(int k) {
  const int n = 3 << k, around = 4 << k;
  Mesh m = plate({{n, around, corner(0.5, 1.5, 0.5, 1.5, pi)}, {n, n, box(0.5, 3, 0, 1)}, {n, 1 << k, box(-1, 0, 1.5, 2)}}, 0.2);
  add_facets(m, "end", at_x(3));
  const double angle = 1.375 * pi;
  return off(m, stress_of(m, pull, at_x(-1), at_y(0), everywhere), {0.5 + 0.5 * std::cos(angle), 1.5 + 0.5 * std::sin(angle), 0}, 0,
             1.39816e6);
}

struct Benchmark {
  const char* name;
  double (*off)(int mesh);
  std::array<double, 3> most;  // of the truth
  double rate;                 // of the error from the first mesh to the last, by a halving of the cells
};
void PrintTo(const Benchmark& b, std::ostream* out) { *out << b.name; }

class Peak : public testing::TestWithParam<Benchmark> {};

// Truth: what each benchmark says above.
TEST_P(Peak, OfStressConvergesFromTheFirstMeshOn) {
  const Benchmark& b = GetParam();
  std::array<double, 3> error;
  for (int k = 0; k < 3; ++k) {
    error[k] = b.off(k);
    EXPECT_LT(error[k], b.most[k]) << "mesh " << k;
    EXPECT_TRUE(k == 0 || std::string(b.name) == "fillet" || error[k] < error[k - 1]) << "mesh " << k;
  }
  const double halvings = std::string(b.name) == "LE10" ? std::log2(16.) / 3 : 2, rate = std::log2(error[0] / error[2]) / halvings;
  std::printf("%s: errors %.2f, %.2f, %.2f %%, rate %.1f\n", b.name, 100 * error[0], 100 * error[1], 100 * error[2], rate);
  EXPECT_GT(rate, b.rate);
}

INSTANTIATE_TEST_SUITE_P(
    SurfaceStress, Peak,
    testing::Values(Benchmark{"LE10", le10_off, {0.04, 0.03, 0.016}, 0.9}, Benchmark{"LE1", le1_off, {0.05, 0.01, 0.005}, 1.5},
                    Benchmark{"Lame", lame_off, {0.03, 0.004, 0.001}, 3}, Benchmark{"Kirsch", kirsch_off, {0.05, 0.003, 0.001}, 2.5},
                    Benchmark{"notch", notch_off, {0.03, 0.005, 0.001}, 3}, Benchmark{"fillet", fillet_off, {0.07, 0.004, 0.004}, 2}),
    [](const auto& of) { return std::string(of.param.name); });

}  // namespace
}  // namespace hilo::test::benchmarks_test
