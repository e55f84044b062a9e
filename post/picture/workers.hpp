// SPDX-License-Identifier: GPL-3.0-or-later
// Work divided over processes: each starts by itself (a window, open files), all give their results to the first in order.
#pragma once
#include <functional>
#include <string>

namespace hilo {

/// Results of make(0) ... make(n - 1) go to `take` in order.  `start` runs in each process and gives `make`; with one job all happens here.
/// What a process throws is thrown here; the others are ended.
void in_processes(size_t n, int jobs, const std::function<std::function<std::string(size_t)>()>& start,
                  const std::function<void(size_t, std::string)>& take);

/// How many are used when the user does not say: one per core, at most n.
int default_jobs(size_t n);

}  // namespace hilo
