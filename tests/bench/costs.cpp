// SPDX-License-Identifier: GPL-3.0-or-later
// What a flexible cell costs by shape and material, microseconds on one core, best of five: residual and tangent into the matrix, the
// residual alone, and its share of a factorisation and a solve, in blocks of about 6600 unknowns.  hilo-part's weights come from here:
//   cmake --build build --target costs-bench && build/bin/costs-bench
#include <fmt/format.h>

#include "block.hpp"

namespace hilo {
namespace {

using namespace bench;

/// Tangent and force, force alone, and solve of a system, microseconds each.
struct Cost {
  double tangent, force, solve;
};
Cost cost(const System& system) {
  AtRest r(system);
  std::vector<double> b(3 * static_cast<size_t>(system.n_blocks()), 1.0), x(b.size());
  Cost out{0, 0, 1e300};
  const auto solver = make_light_solver();
  solver->structure(system.layout.cliques, system.layout.map);
  out.force = microseconds(1, [&] { system.evaluate(r.stage, r.lambda, r.residual, nullptr); });
  out.tangent = microseconds(1, [&] { system.evaluate(r.stage, r.lambda, r.residual, solver.get()); });
  for (int k = 0; k < 3; ++k) {  // a solver anew each time: one that has factors may go on with them
    const auto fresh = make_light_solver();
    fresh->structure(system.layout.cliques, system.layout.map);
    system.evaluate(r.stage, r.lambda, r.residual, fresh.get());
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

void measure(Shape shape, const Material& law, int n, double& hex8) {
  const Block block(shape, law, n);
  const Cost c = cost(block.system);
  const auto cells = static_cast<double>(block.system.part<Solids>().batches[0].cells.size());
  if (shape == Shape::hex8 && law.index() == place_of<StVenantKirchhoff>) hex8 = (c.tangent + c.solve) / cells;
  print(info(shape).name, kind_of(law).name, cells, block.system, c, hex8);
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
                                 {Shape::hex20, 7},
                                 {Shape::hex20r, 7}})
    for (const Material& law : bench::laws) measure(shape, law, n, hex8);
  measure_joints(100, hex8);
}
