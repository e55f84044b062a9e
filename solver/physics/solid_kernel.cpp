#include "physics/solid_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace hilo {

namespace {

/// Two-node bar of area A:  E = (l^2 - L^2)/(2 L^2), W = Y A L E^2/2, consistent mass; one cell at a time.  Y is Young's modulus.
void run_bar(const KernelCall& k) {
  const double w = k.weight;
  double d0[3], d1[3], dm[3], L2 = 0, l0 = 0, l1 = 0;
  for (int i = 0; i < 3; ++i) {
    const double D = k.X[3 + i] - k.X[i];
    d0[i] = k.x0[3 + i] - k.x0[i], d1[i] = k.x1[3 + i] - k.x1[i], dm[i] = (1 - w) * d0[i] + w * d1[i];
    L2 += D * D, l0 += d0[i] * d0[i], l1 += d1[i] * d1[i];
  }
  const double L = std::sqrt(L2), Y = k.c.mu * (3 * k.c.lambda + 2 * k.c.mu) / (k.c.lambda + k.c.mu), EA = Y * k.area;
  const double e0 = (l0 / L2 - 1) / 2, e1 = (l1 / L2 - 1) / 2;
  const double S = EA * (k.elastic * ((1 - w) * e0 + w * e1) + k.viscous * (e1 - e0)), D = EA * (k.elastic * w + k.viscous);
  if (k.energy) *k.energy = EA * L * e1 * e1 / 2;
  if (k.dissipated) *k.dissipated = EA * L * k.viscous * (e1 - e0) * (e1 - e0);
  if (k.least_det) *k.least_det = 1;
  const double m = k.density * k.area * L / 6;
  for (int a = 0; a < 2; ++a)
    for (int i = 0; i < 3; ++i) {
      if (k.f) k.f[3 * a + i] = (a ? 1 : -1) * S * dm[i] / L + (k.a ? m * (k.a[i] + k.a[3 + i] + k.a[3 * a + i]) : 0);
      for (int b = 0; b < 2 && k.K; ++b)
        for (int j = 0; j < 3; ++j)
          k.K[(3 * a + i) * 6 + 3 * b + j] = (a == b ? 1 : -1) * (D * dm[i] * d1[j] / (L * L2) + (i == j ? w * S / L : 0)) +
                                             (k.a && i == j ? k.mass_slope * m * (a == b ? 2 : 1) : 0);
    }
}

}  // namespace

KernelFunction kernel_lanes2(Shape, Law);
KernelFunction kernel_lanes4(Shape, Law);
KernelFunction kernel_lanes8(Shape, Law);

int lanes() {
  static const int width = [] {
    int w = 2;
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) w = 4;
    if (w == 4 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) w = 8;
#endif
    if (const char* wish = std::getenv("HILO_LANES")) w = std::min(w, std::max(2, std::atoi(wish)));
    return w >= 8 ? 8 : w >= 4 ? 4 : 2;
  }();
  return width;
}

SolidKernel solid_kernel(Shape shape, Law law) {
  if (shape == Shape::bar2) return {run_bar, 1};
  const int w = lanes();
  return {w == 8 ? kernel_lanes8(shape, law) : w == 4 ? kernel_lanes4(shape, law) : kernel_lanes2(shape, law), w};
}

}  // namespace hilo
