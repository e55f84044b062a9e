#include "physics/solid_kernel.hpp"

#include <algorithm>
#include <cstdlib>

#include "physics/bar.hpp"

namespace hilo {

KernelFunction kernel_lanes2(Shape, size_t);
KernelFunction kernel_lanes4(Shape, size_t);
KernelFunction kernel_lanes8(Shape, size_t);

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

SolidKernel solid_kernel(Shape shape, size_t law) {
  if (shape == Shape::bar2) return {bar_kernel(law), 1};
  const int w = lanes();
  return {w == 8 ? kernel_lanes8(shape, law) : w == 4 ? kernel_lanes4(shape, law) : kernel_lanes2(shape, law), w};
}

}  // namespace hilo
