// Cost of the solid kernels and of assembly, microseconds per cell on one core: for every shape and lane width, tangent and force, force
// alone, and (hexahedra) tangent with insertion into the light solver's matrix.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <random>
#include <vector>

#include "physics/solid_kernel.hpp"
#include "system/system.hpp"

namespace hilo {
KernelFunction kernel_lanes2(Shape, Law);
KernelFunction kernel_lanes4(Shape, Law);
KernelFunction kernel_lanes8(Shape, Law);

namespace {

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Best of five timings of `body` run `n` times, in microseconds per run.
template <class F>
double microseconds(int n, F body) {
  double best = 1e300;
  for (int k = 0; k < 5; ++k) {
    const double start = seconds();
    for (int i = 0; i < n; ++i) body();
    best = std::min(best, seconds() - start);
  }
  return best / n * 1e6;
}

std::vector<double> aligned(size_t n) { return std::vector<double>(n + 8); }
double* at64(std::vector<double>& v) { return reinterpret_cast<double*>((reinterpret_cast<std::uintptr_t>(v.data()) + 63) / 64 * 64); }

/// A block of n x n x n unit hexahedra as a system of one material.
struct Block {
  Mesh mesh;
  LocalMesh local;
  System system;
  explicit Block(int n) {
    for (int k = 0; k <= n; ++k)
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) system.X.emplace_back(i, j, k);
    SolidBatch b{};
    b.shape = Shape::hex8, b.law = Law::stvk, b.c = lame(1e9, 0.3), b.density = 1000, b.kernel = solid_kernel(Shape::hex8, Law::stvk);
    const auto node = [&](int i, int j, int k) { return (k * (n + 1) + j) * (n + 1) + i; };
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          b.cells.push_back(static_cast<int>(b.cells.size()));
          for (const auto& [a, c, d] : {std::array{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}})
            b.nodes.push_back(node(i + a, j + c, k + d));
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

void run() {
  fmt::print("us per cell  shape    law          lanes  tangent + force     force\n");
  const char* names[] = {"", "tet4", "tet10", "wedge6", "wedge15", "hex8", "hex20"};
  std::mt19937 random(1);
  std::uniform_real_distribution<double> noise(-0.01, 0.01);
  for (int shape = 1; shape < n_shapes; ++shape)
    for (Law law : {Law::stvk, Law::neo_hookean})
      for (int W : {2, 4, 8}) {
        if (W > lanes()) continue;
        const auto s = static_cast<Shape>(shape);
        const KernelFunction f = W == 2 ? kernel_lanes2(s, law) : W == 4 ? kernel_lanes4(s, law) : kernel_lanes8(s, law);
        const int n3 = 3 * info(s).n_nodes;
        auto X = aligned(n3 * W), x0 = X, x1 = X, r = X, K = aligned(static_cast<size_t>(n3) * n3 * W), a = X;
        for (int i = 0; i < n3 * W; ++i) {
          // any well-shaped cell will do: the cost does not depend on it
          at64(X)[i] = std::sin(1.0 + i / W) + noise(random);
          at64(x0)[i] = at64(X)[i], at64(x1)[i] = at64(X)[i] * 1.0001, at64(a)[i] = 1;
        }
        KernelCall call{at64(X), at64(x0), at64(x1), 1, 0, lame(1e9, 0.3), at64(r), at64(K), nullptr, nullptr, nullptr, 1000, at64(a), 1e6};
        const int n = s == Shape::hex20 ? 200 : 2000;
        const double both = microseconds(n, [&] { f(call); }) / W;
        call.K = nullptr;
        const double force = microseconds(10 * n, [&] { f(call); }) / W;
        fmt::print("             {:8} {:12} {:5}  {:15.3f} {:9.3f}\n", names[shape], law == Law::stvk ? "stvk" : "neo-hookean", W, both,
                   force);
      }
  Block block(24);
  auto solver = make_light_solver();
  solver->structure(block.system.cliques, block.system.map);
  Config a = block.system.start;
  for (Vec3& x : a.x) x.setZero();
  Config mid = block.system.start;
  Stage s{};
  s.e0 = s.w0 = s.e1 = s.w1 = s.end = &block.system.start, s.left = &mid, s.a = &a, s.h = 1e-3, s.mass_slope = 2e6;
  Residual r;
  const double cells = static_cast<double>(block.system.batches[0].cells.size());
  const double tangent = microseconds(3, [&] { block.system.evaluate(s, {}, r, solver.get()); }) / cells;
  const double residual = microseconds(3, [&] { block.system.evaluate(s, {}, r, nullptr); }) / cells;
  fmt::print("assembly of {} hex8: residual and tangent into the matrix {:.2f} us per cell, residual alone {:.2f}\n", cells, tangent,
             residual);
}

}  // namespace
}  // namespace hilo

int main() { hilo::run(); }
