// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/bar.hpp"

#include "physics/bar_of_law.hpp"

namespace hilo {
namespace {

template <class... M>
KernelFunction kernel_in(size_t law, LawList<M...>) {
  constexpr KernelFunction of_law[] = {bar_of<M>()...};
  return of_law[law];
}

}  // namespace

KernelFunction bar_kernel(size_t law) {
  const LawFunctions* other = material_kinds()[law].functions;
  return other ? other->bar_kernel : kernel_in(law, Laws{});
}

}  // namespace hilo
