// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/blas_room.hpp"

#include <fmt/format.h>
#include <sys/mman.h>

#include "base/error.hpp"
#include "linear/lapack.hpp"

namespace hilo {

void require_address_space(int megabytes, const char* what) {
  const size_t bytes = static_cast<size_t>(megabytes) << 20;
  void* room = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room == MAP_FAILED)
    throw Error("", fmt::format("out of memory: no room for the {} MB of addresses that {}", megabytes, what),
                "raise the limit, ulimit -v or that of the batch system", Exit::resources);
  munmap(room, bytes);
}

void make_room_for_blas() {
  static const bool once = [] {
    require_address_space(136, "OpenBLAS reserves");  // 128 MB, its alignment, and a little for what is asked for meanwhile
    const double a[1] = {1};
    double product[1];
    lapack::gram(1, 1, a, product);  // takes the buffer
    return true;
  }();
  static_cast<void>(once);
}

}  // namespace hilo
