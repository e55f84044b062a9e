// SPDX-License-Identifier: GPL-3.0-or-later
// The solid kernels and their assembly against what one core can do.  By shape and material, microseconds per cell: force alone, tangent
// and force, the same with its insertion into the light solver's matrix; flops of the tangent and force, counted by running the kernel on
// numbers that count; fractions of the peak of fused multiply-adds in the same vectors and of the memory bandwidth, both measured here.
// HILO_LANES=2|4 asks for narrower vectors; an argument names the only shape.
#include <fmt/format.h>

#include "block.hpp"
#include "physics/solid_kernel_lanes.hpp"

namespace hilo {

/// A double that counts the operations done with it and its likes.
struct Counted {
  double v;
  static inline long flops = 0;
  Counted() = default;
  Counted(double value) : v(value) {}
  static Counted of(double value) { return ++flops, Counted(value); }
  friend Counted operator+(Counted a, Counted b) { return of(a.v + b.v); }
  friend Counted operator-(Counted a, Counted b) { return of(a.v - b.v); }
  friend Counted operator*(Counted a, Counted b) { return of(a.v * b.v); }
  friend Counted operator/(Counted a, Counted b) { return of(a.v / b.v); }
  Counted operator-() const { return Counted(-v); }
  Counted& operator+=(Counted b) { return *this = *this + b; }
  Counted& operator-=(Counted b) { return *this = *this - b; }
  Counted& operator*=(Counted b) { return *this = *this * b; }
  friend bool operator<(Counted a, Counted b) { return a.v < b.v; }
};
inline Counted log_of(Counted x) { return Counted::of(std::log(x.v)); }
inline Counted log_of_1_and(Counted x) { return Counted::of(std::log1p(x.v)); }
inline Counted exp_less_1(Counted x) { return Counted::of(std::expm1(x.v)); }
inline Counted root(Counted x) { return Counted::of(std::sqrt(x.v)); }
inline Counted cube_root(Counted x) { return Counted::of(std::cbrt(x.v)); }
inline void log_ratio(Counted r, Counted& L, Counted& dL) {
  log_ratio(r.v, L.v, dL.v);
  Counted::flops += 20;  // the series
}

namespace {

using namespace bench;

/// Twelve independent chains of fused multiply-adds: more than two units of latency five need, fewer than there are registers.
template <class V>
[[gnu::always_inline]] inline double chains(long n) {
  const V a = V{} + 0.999999, b = V{} + 1e-6;
  V x0{}, x1 = x0 + 1, x2 = x1 + 1, x3 = x2 + 1, x4 = x3 + 1, x5 = x4 + 1, x6 = x5 + 1, x7 = x6 + 1, x8 = x7 + 1, x9 = x8 + 1, y = x9 + 1,
          z = y + 1;  // an array would stay in memory
  for (long i = 0; i < n; ++i) {
    x0 = x0 * a + b, x1 = x1 * a + b, x2 = x2 * a + b, x3 = x3 * a + b, x4 = x4 * a + b, x5 = x5 * a + b;
    x6 = x6 * a + b, x7 = x7 * a + b, x8 = x8 * a + b, x9 = x9 * a + b, y = y * a + b, z = z * a + b;
  }
  return (x0 + x1 + x2 + x3 + x4 + x5 + x6 + x7 + x8 + x9 + y + z)[0];
}
typedef double V2 __attribute__((vector_size(16)));
typedef double V4 __attribute__((vector_size(32)));
typedef double V8 __attribute__((vector_size(64)));
double chains2(long n) { return chains<V2>(n); }
#ifdef __x86_64__
[[gnu::target("avx2,fma")]] double chains4(long n) { return chains<V4>(n); }
[[gnu::target("avx512f,avx512dq,avx512vl,fma,prefer-vector-width=512")]] double chains8(long n) { return chains<V8>(n); }
#else
double chains4(long n) { return chains<V4>(n); }
double chains8(long n) { return chains<V8>(n); }
#endif

/// Flops per microsecond of multiply-adds in registers.
double peak() {
  constexpr long n = 1000000;
  volatile double sink = 0;
  const int W = lanes();
  const double t = microseconds(20, [&] { sink = sink + (W == 8 ? chains8(n) : W == 4 ? chains4(n) : chains2(n)); });
  return 2. * 12 * W * n / t;
}

/// Bytes per microsecond of a := b + s c on arrays far larger than any cache, 24 bytes an entry.
double triad() {
  constexpr size_t n = size_t{1} << 25;
  std::vector<double> a(n, 0), b(n, 1), c(n, 2);
  double s = 3;
  const double t = microseconds(1, [&] {
    for (size_t i = 0; i < n; ++i) a[i] = b[i] + s * c[i];
    s += a[n / 2];
  });
  return 24. * n / t;
}

/// Arrays of a call on one good cell in every lane.
struct Cell {
  std::vector<double> X, x1, f, K, a, least;
  KernelCall call;
  static double* at64(std::vector<double>& v) {
    return reinterpret_cast<double*>((reinterpret_cast<std::uintptr_t>(v.data()) + 63) / 64 * 64);
  }
  Cell(Shape shape, const Material& law, int W) {
    const auto nodes = test::reference_nodes(shape);
    const size_t n3 = 3 * nodes.size();
    for (auto* v : {&X, &x1, &f, &a}) v->assign(n3 * W + 8, 1);
    K.resize(n3 * n3 * W + 8), least.resize(W + 8);
    for (size_t i = 0; i < n3; ++i)
      for (int l = 0; l < W; ++l) at64(X)[i * W + l] = nodes[i / 3][i % 3], at64(x1)[i * W + l] = nodes[i / 3][i % 3] * (1 + 1e-3 * l);
    call = {at64(X), at64(X), at64(x1), 1, 0, parameters(law), at64(f), at64(K), nullptr, nullptr, at64(least), 1000, at64(a), 1e6};
  }
};

struct Machine {
  double peak, triad;
};

void measure(Shape shape, const Material& law, int n, const Machine& machine) {
  Cell one(shape, law, 1), cell(shape, law, lanes());
  Counted::flops = 0;
  kernel_of<Counted>(shape, law.index())(one.call);
  const auto flops = static_cast<double>(Counted::flops);
  const SolidKernel kernel = solid_kernel(shape, law.index());
  const int repeats = 200 + 20000000 / static_cast<int>(flops);
  const double both = microseconds(repeats, [&] { kernel.call(cell.call); }) / kernel.width;
  cell.call.K = nullptr;
  const double force = microseconds(10 * repeats, [&] { kernel.call(cell.call); }) / kernel.width;

  const Block block(shape, law, n);
  const auto cells = static_cast<double>(block.system.part<Solids>().batches[0].cells.size());
  const auto solver = make_light_solver();
  solver->structure(block.system.layout.cliques, block.system.layout.map);
  AtRest r(block.system);
  const double assembled = microseconds(3, [&] { block.system.evaluate(r.stage, r.lambda, r.residual, solver.get()); }) / cells;
  const double residual = microseconds(1, [&] { block.system.evaluate(r.stage, r.lambda, r.residual, nullptr); }) / cells;
  // read and written: blocks of the matrix; read: their places, four vectors of each node and its number; twice: nodal forces
  const double nodes = info(shape).n_nodes, bytes = nodes * nodes * (2 * 72 + 4) + nodes * (4 * 24 + 4 + 2 * 24);
  fmt::print("{:8} {:12} {:7.2f} {:7.2f} {:8.1f} {:8.1f} {:5.0f}%  {:8.2f} {:8.2f} {:7.1f} {:7.1f} {:5.0f}%\n", info(shape).name,
             kind_of(law).name, force, both, flops / 1e3, flops / both / 1e3, 100 * flops / both / machine.peak, residual, assembled,
             bytes / 1e3, bytes / assembled / 1e3, 100 * bytes / assembled / machine.triad);
}

}  // namespace
}  // namespace hilo

int main(int argc, char** argv) {
  using namespace hilo;
  const Machine machine{peak(), triad()};
  fmt::print("one core, {} lanes: peak {:.1f} GFLOP/s, triad {:.1f} GB/s\n\n", lanes(), machine.peak / 1e3, machine.triad / 1e3);
  fmt::print("                      kernel, us per cell                          assembled, us per cell\n");
  fmt::print("shape    law            force    both    kflop  GFLOP/s   peak     force     both      kB    GB/s  triad\n");
  for (const auto& [shape, n] : {std::pair{Shape::hex8, 32},
                                 {Shape::tet4, 32},
                                 {Shape::tet10, 15},
                                 {Shape::wedge6, 32},
                                 {Shape::wedge15, 13},
                                 {Shape::hex20, 14},
                                 {Shape::hex20r, 14}})
    for (const Material& law : bench::laws)
      if (argc < 2 || argv[1] == info(shape).name) measure(shape, law, n, machine);
}
