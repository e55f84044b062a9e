// SPDX-License-Identifier: GPL-3.0-or-later
// What the cell shapes do where shapes differ: compliance (mean displacement under a load) over that of a fine mesh, small strains.
// The matrices are those of the solver's kernels.  elements-bench prints the table of docs/elements.md.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

#include "model/mesh.hpp"
#include "physics/solid_kernel.hpp"
#include "verify/block_mesh.hpp"

namespace hilo {
namespace {

using test::block_mesh;
using test::BlockOptions;
using test::scatter;

constexpr double E = 1e7;

/// A mesh, what is held of it, and a load.
struct Problem {
  Mesh mesh;
  std::vector<char> held;  // (3 n_nodes)
  Eigen::VectorXd force;   // [N]

  explicit Problem(Mesh m)
      : mesh(std::move(m)), held(3 * mesh.n_nodes(), 0), force(Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(mesh.n_nodes()))) {}
  void hold(const std::string& set, const std::string& components) {
    for (const auto a : mesh.nodes_of(set, ""))
      for (const char c : components) held[3 * a + (c - 'x')] = 1;
  }
  /// A force of 1 N in direction i on the nodes of a facet set by the areas of the facets: consistent on plane facets of each shape.
  void pull(const std::string& set, int i) {
    double area = 0;
    std::vector<double> share(mesh.n_nodes(), 0.0);
    for (const Facet& f : mesh.facet_sets.at(set)) {
      const double a = facet_area(mesh, f).norm();
      const auto nodes = mesh.facet_nodes(f);
      const size_t n = nodes.size();
      for (size_t k = 0; k < n; ++k)
        share[nodes[k]] += a * (n == 3 ? 1. / 3 : n == 4 ? 1. / 4 : n == 6 ? (k < 3 ? 0 : 1. / 3) : k < 4 ? -1. / 12 : 1. / 3);
      area += a;
    }
    for (size_t a = 0; a < share.size(); ++a) force[3 * static_cast<Eigen::Index>(a) + i] += share[a] / area;
  }
  /// Work of the load on its displacement: the compliance for a force of 1 N [m].
  double compliance(double nu) const {
    std::vector<Eigen::Triplet<double>> entries;
    std::vector<int> row(held.size(), -1);
    int n = 0;
    for (size_t i = 0; i < held.size(); ++i)
      if (!held[i]) row[i] = n++;
    const StVenantKirchhoff law{lame(E, nu)};
    alignas(64) static double X[60 * 8], f[60 * 8], K[3600 * 8], det[8];
    for (std::int64_t e = 0; e < mesh.n_cells(); ++e) {
      const auto nodes = mesh.cell(e);
      const SolidKernel kernel = solid_kernel(static_cast<Shape>(mesh.shape[e]), place_of<StVenantKirchhoff>);
      const int n3 = 3 * static_cast<int>(nodes.size()), W = kernel.width;
      for (int i = 0; i < n3; ++i)
        for (int l = 0; l < W; ++l) X[i * W + l] = mesh.X[nodes[i / 3]][i % 3];
      kernel.call({X, X, X, 1, 0, &law, f, K, nullptr, nullptr, det, 0, nullptr, 0, 0, 1});
      for (int i = 0; i < n3; ++i)
        for (int j = 0; j < n3; ++j) {
          const int r = row[3 * nodes[i / 3] + i % 3], c = row[3 * nodes[j / 3] + j % 3];
          if (r >= 0 && c >= 0 && c <= r) entries.emplace_back(r, c, K[(i * n3 + j) * W]);
        }
    }
    Eigen::SparseMatrix<double> A(n, n);
    A.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(A);
    Eigen::VectorXd b(n);
    for (size_t i = 0; i < held.size(); ++i)
      if (row[i] >= 0) b[row[i]] = force[static_cast<Eigen::Index>(i)];
    return b.dot(factors.solve(b));
  }
};

BlockOptions options(Shape shape, int nx, int ny, int nz, const Vec3& high) {
  const BlockOptions o{.shape = shape, .n = {nx, ny, nz}, .high = high};
  return o;
}

/// Cantilever 10 x 1 x 1; `lean`: trapezoids, `moved`: inner corners moved by that share of a cell.
double beam(Shape shape, int n, double nu, double lean = 0, double moved = 0) {
  const Vec3 size(10, 1, 1);
  BlockOptions o = options(shape, (n > 1 && moved > 0 ? 5 : 10) * n, n, n, size);
  const int nx = o.n[0];
  o.map = [=](const Vec3& x) {
    const int at[3] = {static_cast<int>(std::lround(x[0] / size[0] * nx)), static_cast<int>(std::lround(x[1] * n)),
                       static_cast<int>(std::lround(x[2] * n))};
    const int count[3] = {nx, n, n};
    Vec3 y = x;
    if (at[0] > 0 && at[0] < nx) y[0] += (at[0] % 2 ? 1 : -1) * lean * (x[2] - 0.5);
    for (int i = 0; i < 3; ++i)
      if (at[i] > 0 && at[i] < count[i]) y[i] += moved * size[i] / count[i] * scatter(3 * (at[0] + 31 * (at[1] + 17 * at[2])) + i);
    return y;
  };
  Problem p(block_mesh(o));
  p.hold("xmin", "xyz");
  p.pull("xmax", 2);
  return p.compliance(nu);
}

/// Half a pipe of radius 1 and wall 1/20, bent by 90 degrees about a radius of 3, one cell through the wall.
double pipe(Shape shape, int around, int along) {
  BlockOptions o = options(shape, along, around, 1, Vec3::Ones());
  Mesh m = block_mesh(o);
  for (Vec3& x : m.X) {
    const double bend = M_PI / 2 * x[0], turn = M_PI * x[1], r = 1 + 0.05 * (x[2] - 0.5), R = 3 + r * std::cos(turn);
    x = Vec3(R * std::sin(bend), R * std::cos(bend), -r * std::sin(turn));
  }
  Problem p(std::move(m));
  p.hold("xmin", "xyz"), p.hold("ymin", "z"), p.hold("ymax", "z");
  p.pull("xmax", 1);
  return p.compliance(0.3);
}

/// Cook's membrane in plane strain.
double cook(Shape shape, int n, double nu) {
  BlockOptions o = options(shape, n, n, 1, Vec3(1, 1, 8));
  o.map = [](const Vec3& s) { return Vec3(48 * s[0], 44 * s[0] + s[1] * (44 - 28 * s[0]), s[2]); };
  Problem p(block_mesh(o));
  p.hold("xmin", "xyz");
  for (std::int64_t a = 0; a < p.mesh.n_nodes(); ++a) p.held[3 * a + 2] = 1;
  p.pull("xmax", 1);
  return p.compliance(nu);
}

/// A quarter of a block glued between two plates, 2 x 2 x 0.5.
double glued(Shape shape, int n, double nu) {
  Problem p(block_mesh(options(shape, n, n, n, Vec3(1, 1, 0.5))));
  p.hold("zmin", "xyz"), p.hold("zmax", "xy"), p.hold("xmin", "x"), p.hold("ymin", "y");
  p.pull("zmax", 2);
  return p.compliance(nu);
}

}  // namespace
}  // namespace hilo

int main() {
  using namespace hilo;
  const Shape shapes[] = {Shape::hex8, Shape::hex20r, Shape::hex20, Shape::tet10, Shape::wedge15, Shape::wedge6, Shape::tet4};
  fmt::print("{:44}", "compliance over that of a fine mesh");
  for (const Shape s : shapes) fmt::print("{:>9}", info(s).name);
  fmt::print("\n");
  const auto row = [&](const std::string& what, double truth, auto&& value) {
    fmt::print("{:44}", what);
    for (const Shape s : shapes) fmt::print("{:9.3f}", value(s) / truth);
    fmt::print("\n");
  };
  const auto linear = [](Shape s) { return info(s).n_nodes == info(s).n_corners; };
  for (const double nu : {0.3, 0.4999}) {
    const double fine = beam(Shape::hex20r, 3, nu);
    row(fmt::format("cantilever 10x1x1, nu {}", nu), fine, [&](Shape s) { return beam(s, 1, nu); });
    row(fmt::format("cantilever 20x2x2, nu {}", nu), fine, [&](Shape s) { return beam(s, 2, nu); });
  }
  const double fine = beam(Shape::hex20r, 3, 0.3);
  row("cantilever 10x1x1, trapezoids (0.25)", fine, [&](Shape s) { return beam(s, 1, 0.3, 0.25); });
  row("cantilever 10x2x2, corners moved by 20 %", fine, [&](Shape s) { return beam(s, 2, 0.3, 0, 0.2); });
  row("cantilever 20x4x4, corners moved by 20 %", fine, [&](Shape s) { return beam(s, 4, 0.3, 0, 0.2); });
  const double bend = pipe(Shape::hex20r, 24, 24);
  row("pipe bend, 4 around x 3 along", bend, [&](Shape s) { return pipe(s, 4, 3); });
  row("pipe bend, 8 x 8", bend, [&](Shape s) { return pipe(s, 8, 8); });
  row("pipe bend, 16 x 16", bend, [&](Shape s) { return pipe(s, 16, 16); });
  const double membrane = cook(Shape::hex20r, 24, 0.4999);
  row("Cook's membrane, nu 0.4999, 8x8 (linear 16)", membrane, [&](Shape s) { return cook(s, linear(s) ? 16 : 8, 0.4999); });
  const double block = glued(Shape::hex20r, 8, 0.4999);
  row("glued block, nu 0.4999, 4x4x4 (linear 8)", block, [&](Shape s) { return glued(s, linear(s) ? 8 : 4, 0.4999); });
}
