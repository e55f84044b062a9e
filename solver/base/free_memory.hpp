// SPDX-License-Identifier: GPL-3.0-or-later
// Memory that a process may still take.
#pragma once

#include <istream>
#include <string>
#include <vector>

namespace hilo {

/// What the machine, the limits of the process (ulimit -v) and its control groups leave [bytes].
double free_memory();

/// Folders of the groups that limit a process's memory, from its own to the root of the hierarchy; `membership`: as /proc/self/cgroup says
/// it (cgroups(7)): lines "number:controllers:path", without controllers for version 2.
std::vector<std::string> memory_groups(std::istream& membership);

}  // namespace hilo
