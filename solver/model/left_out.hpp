// SPDX-License-Identifier: GPL-3.0-or-later
// What import left out of a model: the entries of [[left_out]], told before a run, and refused where the answer would be another model's.
#pragma once
#include <string>

#include "base/json.hpp"
#include "model/scene.hpp"

namespace hilo {

/// One warning on stderr for each entry.  --quiet does not silence them.
void tell_left_out(const Scene& scene);
/// Error (bad input) where a tie was lost, a load of an analysis of buckling, or all loads of a static one.
void refuse_left_out(const Scene& scene);
/// The entries as JSON, for run.json.
Json left_out_json(const Scene& scene);

}  // namespace hilo
