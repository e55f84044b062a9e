// What a flexible cell costs by shape and material, microseconds on one core, best of five: residual and tangent into the matrix, the
// residual alone, and its share of a factorisation and a solve, in blocks of about 6600 unknowns.  hilo-part's weights come from here:
//   cmake --build build --target costs-bench && build/bin/costs-bench
#include <fmt/format.h>

#include <array>
#include <chrono>
#include <map>
#include <tuple>

#include "../model/block.hpp"
#include "physics/solid_kernel.hpp"
#include "system/system.hpp"

namespace hilo {
namespace {

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Best of five timings of `body`, in microseconds.
template <class F>
double microseconds(F body) {
  double best = 1e300;
  for (int k = 0; k < 5; ++k) {
    const double start = seconds();
    body();
    best = std::min(best, seconds() - start);
  }
  return best * 1e6;
}

/// The first corners of the cells of a shape that fill a cube: an affine map of the reference cell each.
std::vector<std::array<Vec3, 4>> cells_of_cube(int n_corners) {
  const Vec3 o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  if (n_corners == 8 || n_corners == 2) return {{o, x, y, z}};
  if (n_corners == 6) return {{o, x, y, z}, {Vec3(x + y), y, x, Vec3(x + y + z)}};
  std::vector<std::array<Vec3, 4>> out;  // one tetrahedron for each way from corner to opposite corner
  for (const auto& [a, b] : {std::pair{x, y}, {y, z}, {z, x}}) out.push_back({o, a, Vec3(a + b), Vec3(x + y + z)});
  for (const auto& [a, b] : {std::pair{y, x}, {z, y}, {x, z}}) out.push_back({o, Vec3(a + b), a, Vec3(x + y + z)});
  return out;
}

/// n x n x n cubes filled with cells of one shape and law, as a system.
struct Block {
  LocalMesh local;
  System system;
  Block(Shape shape, Law law, int n) {
    SolidBatch b{};
    b.shape = shape, b.law = law, b.c = lame(1e9, 0.3), b.density = 1000, b.area = 0.1, b.kernel = solid_kernel(shape, law);
    const auto reference = test::reference_nodes(shape);
    std::map<std::tuple<int, int, int>, int> node;  // by twice the position
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
          for (const auto& c : cells_of_cube(info(shape).n_corners)) {
            for (const Vec3& r : reference) {
              const Vec3 x = Vec3(i, j, k) + c[0] + r[0] * (c[1] - c[0]) + r[1] * (c[2] - c[0]) + r[2] * (c[3] - c[0]);
              const std::tuple key(static_cast<int>(std::lround(2 * x[0])), static_cast<int>(std::lround(2 * x[1])),
                                   static_cast<int>(std::lround(2 * x[2])));
              const auto [it, is_new] = node.try_emplace(key, static_cast<int>(system.X.size()));
              if (is_new) system.X.push_back(x);
              b.nodes.push_back(it->second);
            }
            b.cells.push_back(static_cast<int>(b.cells.size()));
          }
    local.mesh.region_name = {"block"};
    system.comm = &Comm::world();
    system.mesh = &local;
    system.follower.assign(system.X.size(), -1);
    system.fixed.assign(system.X.size(), {false, false, false});
    system.node_owned.assign(system.X.size(), 1);
    Body ground;
    ground.ground = true;
    system.bodies.push_back(ground);
    system.start.x = system.X, system.start.c = {Vec3::Zero()}, system.start.R = {Mat3::Identity()};
    system.batches.push_back(std::move(b));
    system.number();
  }
};

/// Tangent and force, force alone, and solve of a system, microseconds each.
struct Cost {
  double tangent, force, solve;
};
Cost cost(const System& system) {
  Config a = system.start, mid = system.start;
  for (auto* list : {&a.x, &a.c})
    for (Vec3& x : *list) x.setZero();
  for (Mat3& R : a.R) R.setZero();
  Stage s{};
  s.e0 = s.w0 = s.e1 = s.w1 = s.end = &system.start, s.left = &mid, s.a = &a, s.h = 1e-3, s.mass_slope = 2e6;
  Residual r;
  const std::vector<double> lambda(3 * static_cast<size_t>(system.n_joint_blocks()), 0.0);
  std::vector<double> b(3 * static_cast<size_t>(system.n_blocks()), 1.0), x(b.size());
  Cost out{0, 0, 1e300};
  const auto solver = make_light_solver();
  solver->structure(system.cliques, system.map);
  out.force = microseconds([&] { system.evaluate(s, lambda, r, nullptr); });
  out.tangent = microseconds([&] { system.evaluate(s, lambda, r, solver.get()); });
  for (int k = 0; k < 3; ++k) {  // a solver anew each time: one that has factors may go on with them
    const auto fresh = make_light_solver();
    fresh->structure(system.cliques, system.map);
    system.evaluate(s, lambda, r, fresh.get());
    const double start = seconds();
    if (!fresh->solve(b, x).ok) fmt::print(stderr, "the solve failed\n");
    out.solve = std::min(out.solve, (seconds() - start) * 1e6);
  }
  return out;
}

void print(std::string_view what, std::string_view law, double number, const System& system, const Cost& c, double hex8) {
  fmt::print("{:8} {:12} {:6} {:8} {:9.2f} {:9.2f} {:9.1f} {:9.3f}\n", what, law, number, 3 * system.n_blocks(), c.tangent / number,
             c.force / number, c.solve / number, (c.tangent + c.solve) / number / hex8);
}

/// A chain of bodies on revolutes, each axis at a right angle to the one before: the share of a joint with its body.
void measure_joints(int n, double hex8) {
  std::string text = "gravity = [0, 0, -9.81]\n[time]\nend = 1\nstep = 1e-3\n";
  for (int i = 0; i < n; ++i)
    text += fmt::format(
        "[[body]]\nname = \"b{0}\"\nmass = 1\ncom = [{0}.5, 0, 0]\ninertia = [0.01, 0.09, 0.09]\n"
        "[[joint]]\nkind = \"revolute\"\nname = \"j{0}\"\na = \"{1}\"\nb = \"b{0}\"\nat = [{0}, 0, 0]\naxis = {2}\n",
        i, i > 0 ? fmt::format("b{}", i - 1) : "ground", i % 2 ? "[0, 1, 0]" : "[0, 0, 1]");
  const auto system = build_system(Scene::parse(text, "chain"), nullptr, Comm::world());
  print("joint", "revolute", n, *system, cost(*system), hex8);
}

void measure(Shape shape, Law law, int n, double& hex8) {
  const Block block(shape, law, n);
  const Cost c = cost(block.system);
  const auto cells = static_cast<double>(block.system.batches[0].cells.size());
  if (shape == Shape::hex8 && law == Law::stvk) hex8 = (c.tangent + c.solve) / cells;
  print(info(shape).name, law == Law::stvk ? "stvk" : "neo-hookean", cells, block.system, c, hex8);
}

}  // namespace
}  // namespace hilo

int main() {
  using namespace hilo;
  fmt::print("shape    law           cells unknowns   tangent     force     solve      work\n");
  double hex8 = 1;
  for (const auto& [shape, n] : {std::pair{Shape::hex8, 12},
                                 {Shape::bar2, 12},
                                 {Shape::tet4, 12},
                                 {Shape::tet10, 6},
                                 {Shape::wedge6, 12},
                                 {Shape::wedge15, 7},
                                 {Shape::hex20, 7}})
    for (const Law law : {Law::stvk, Law::neo_hookean}) measure(shape, law, n, hex8);
  measure_joints(100, hex8);
}
