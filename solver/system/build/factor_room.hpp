// SPDX-License-Identifier: GPL-3.0-or-later
// Room for the factors of linear regions while their modes are found.
#pragma once
#include <memory>

#include "system/system.hpp"

namespace hilo {

struct FactorRoom {
  double memory = -1;   // that the factor of a region may take; negative: what is free   [byte]
  std::string scratch;  // folder of a file for one that does not fit
};
/// As the other, with this room.
std::unique_ptr<System> build_system(const Scene& scene, LocalMesh* mesh, const Comm& comm, const ReducedFiles& files,
                                     const FactorRoom& room);

}  // namespace hilo
