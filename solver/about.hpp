// SPDX-License-Identifier: GPL-3.0-or-later
// What this build was made from.
#pragma once
#include <string>
#include <vector>

namespace hilo {

/// Lines of --version below the first: the commit, with a + where the tree had changes of its own, and the libraries with the versions that
/// it was built with; `own` are those that this tool uses and not all do.
std::string about(const std::vector<std::string>& own = {});

/// "METIS 5.1.0"
std::string metis();

}  // namespace hilo
