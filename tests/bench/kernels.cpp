// SPDX-License-Identifier: GPL-3.0-or-later
// The kernels of solids, shells and beams and their assembly against what one core can do.  By shape and material, microseconds per cell:
// force alone, tangent and force, the same with its insertion into the light solver's matrix; flops of the tangent and force, counted by
// running the kernel on numbers that count; fractions of the peak of fused multiply-adds in the same vectors and of the memory bandwidth,
// both measured here. HILO_LANES=2|4 asks for narrower vectors; an argument names the only shape.
#include <fmt/format.h>

#include "base/shell_shape.hpp"
#include "block.hpp"
#include "physics/beam_cell.hpp"
#include "physics/solid_kernel_lanes.hpp"
#include "system/beams.hpp"

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
    const auto nodes = reference_nodes(shape);
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

void print_row(std::string_view name, std::string_view law, double force, double both, double flops, const System& system, double cells,
               double bytes, const Machine& machine) {
  const auto solver = make_light_solver();
  solver->structure(system.layout.cliques, system.layout.map);
  AtRest r(system);
  const double assembled = microseconds(3, [&] { system.evaluate(r.stage, r.lambda, r.residual, solver.get()); }) / cells;
  const double residual = microseconds(1, [&] { system.evaluate(r.stage, r.lambda, r.residual, nullptr); }) / cells;
  fmt::print("{:8} {:12} {:7.2f} {:7.2f} {:8.1f} {:8.1f} {:5.0f}%  {:8.2f} {:8.2f} {:7.1f} {:7.1f} {:5.0f}%\n", name, law, force, both,
             flops / 1e3, flops / both / 1e3, 100 * flops / both / machine.peak, residual, assembled, bytes / 1e3, bytes / assembled / 1e3,
             100 * bytes / assembled / machine.triad);
}

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
  // read and written: blocks of the matrix; read: their places, four vectors of each node and its number; twice: nodal forces
  const double nodes = info(shape).n_nodes, bytes = nodes * nodes * (2 * 72 + 4) + nodes * (4 * 24 + 4 + 2 * 24);
  print_row(info(shape).name, kind_of(law).name, force, both, flops, block.system, cells, bytes, machine);
}

/// Straight beams along a helix of bodies, of which the first is fixed.
struct Frame {
  System system;
  explicit Frame(int n) {
    system.comm = &Comm::world();
    for (int k = 0; k <= n; ++k) {
      Body section;
      section.ground = k == 0, section.size = 0.1;
      system.bodies.push_back(section);
      const double turn = 0.05 * k;
      Mat3 R;
      R.col(2) = Vec3(-std::sin(turn), std::cos(turn), 0.2).normalized();
      R.col(0) = Vec3(std::cos(turn), std::sin(turn), 0), R.col(1) = R.col(2).cross(R.col(0));
      system.start.c.push_back(Vec3(2 * std::cos(turn), 2 * std::sin(turn), 0.4 * turn)), system.start.R.push_back(R);
      system.bodies.back().Xc = system.start.c.back();
    }
    BeamSection tube;
    tube.C.setZero();
    tube.C.diagonal() << 2e7, 2e7, 1e8, 5e4, 5e4, 4e4;
    tube.mass = 4, tube.J11 = tube.J22 = 2e-3;
    Beams& beams = system.add<Beams>(system);
    SectionsAlong along;
    along.fill(tube);
    for (int k = 0; k < n; ++k)
      beams.add_cell({system.start.c[k], system.start.R[k], k}, {system.start.c[k + 1], system.start.R[k + 1], k + 1}, along, 0, 0);
    system.prepare();
  }
};

void measure_beams(int n, const Machine& machine) {
  const auto call_of = [](const auto& cells, const auto& q0, const auto& q1, auto& out) {
    ArcCall call{};
    call.cells = cells.data(), call.left = q0.data(), call.end = q1.data(), call.a = q1.data();
    call.slope = 0.5, call.mass_slope = 1e6, call.n_pairs = 1;
    call.pairs[0].q0 = q0.data(), call.pairs[0].q1 = q1.data(), call.pairs[0].elastic = 1;
    call.f = out.data(), call.scale2 = out.data() + 16 * 8, call.K = out.data() + 32 * 8;
    return call;
  };
  const Frame frame(n);
  const Beams& beams = frame.system.part<Beams>();
  struct alignas(64) Line {
    double v[8];
  };
  const ArcKernel kernel = arc_kernel();
  constexpr size_t n_cell = sizeof(arc::ArcCell<double>) / sizeof(double);
  const auto W = static_cast<size_t>(kernel.width);
  std::vector<Line> cells(n_cell), q0(24), q1(24), out(200);
  double* const lanes[] = {cells.front().v, q0.front().v, q1.front().v};
  for (size_t l = 0; l < W; ++l)
    for (size_t i = 0; i < n_cell; ++i) lanes[0][i * W + l] = reinterpret_cast<const double*>(&beams.cells[l].arc)[i];
  for (size_t l = 0; l < W; ++l)
    for (int e = 0; e < 2; ++e)
      for (size_t i = 0; i < 12; ++i) {
        const double x = i < 3 ? frame.system.start.c[l + e][i] : frame.system.start.R[l + e].data()[i - 3];
        lanes[1][(12 * e + i) * W + l] = x, lanes[2][(12 * e + i) * W + l] = x * (i < 3 ? 1 + 1e-3 * e : 1);
      }
  std::vector<double> one(n_cell), p0(24), p1(24), f(2000);
  for (size_t i = 0; i < n_cell; ++i) one[i] = lanes[0][i * W];
  for (size_t i = 0; i < 24; ++i) p0[i] = lanes[1][i * W], p1[i] = lanes[2][i * W];
  Counted::flops = 0;
  arc::run<Counted>(call_of(one, p0, p1, f));
  const auto flops = static_cast<double>(Counted::flops);
  struct View {
    double* at;
    double* data() const { return at; }
  };
  View result{out.front().v};
  ArcCall call = call_of(View{lanes[0]}, View{lanes[1]}, View{lanes[2]}, result);
  const double both = microseconds(20000, [&] { kernel.call(call); }) / kernel.width;
  call.K = nullptr;
  const double force = microseconds(50000, [&] { kernel.call(call); }) / kernel.width;
  // as above, with four configurations of two bodies and what a cell has
  print_row("beam", "", force, both, flops, frame.system, n, 16 * (2 * 72 + 4) + 4 * 192 + n_cell * 8 + 2 * 96, machine);
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
                                 {Shape::hex20r, 14},
                                 {shell8, 32}})
    for (const Material& law : bench::laws)
      if ((argc < 2 || argv[1] == info(shape).name) && solid_kernel(shape, law.index()).n_state == 0) measure(shape, law, n, machine);
  if (argc < 2 || argv[1] == std::string_view("beam")) measure_beams(20000, machine);
}
