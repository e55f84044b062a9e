// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/solid_kernel_lanes.hpp"

namespace hilo {
KernelFunction kernel_lanes8(Shape shape, size_t law) {
  typedef double Lanes __attribute__((vector_size(8 * 8)));
  return kernel_of<Lanes>(shape, law);
}
}  // namespace hilo
