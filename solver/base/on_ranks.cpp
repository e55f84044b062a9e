// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/on_ranks.hpp"

#include <unistd.h>

#include "base/error.hpp"
#include "base/interrupt.hpp"

namespace hilo {

int on_ranks(std::string_view tool, const std::function<void(Comm&)>& body) {
  Comm* comm = nullptr;
  const int code = guarded(tool, [&] {
    comm = &Comm::world();
    if (comm->size == 1) return body(*comm);
    try {
      body(*comm);
    } catch (...) {
      obey_signals();                 // rank 0 takes the job down by one
      if (comm->rank != 0) sleep(2);  // an error all ranks share is told once, by rank 0, which ends the job
      throw;
    }
  });
  if (comm && comm->size > 1) {
    if (code != 0) comm->abort(code);
    comm->finish();
  }
  return code;
}

}  // namespace hilo
