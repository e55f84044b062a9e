// SPDX-License-Identifier: GPL-3.0-or-later
// A whole run: start, steps with cutting, results, report.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "base/archive.hpp"
#include "base/json.hpp"
#include "model/scene.hpp"
#include "system/system.hpp"

namespace hilo {

/// How far a run is.
struct StepsSoFar {
  long steps;
  double t;  // [s]
};

struct RunOptions {
  std::string output;  // run.h5
  std::vector<std::string> provenance = {};
  bool quiet = false;
  std::string mesh = {};  // file used, "" for none
  /// Called between two steps, on all ranks alike.  It may call `keep`, which is collective: what the run remembers, bits of everything
  /// that the steps to come depend on, but for the factors of matrices.  Those fill many times the memory and belong to other libraries; a
  /// run that is kept gives its own up and makes new ones, as does the one that goes on from there, so that both take the same steps bit by
  /// bit. Why the run is to end here, or "".
  std::function<std::string(const StepsSoFar& so_far, const std::function<Kept()>& keep)> between_steps = {};
  /// What was kept of a run: this one goes on from there, on any number of ranks, and its file with it.
  Kept from = {};
  /// Adds what else run.json is to tell of the finished results; called on rank 0.
  std::function<void(Json& run)> more = {};
};

/// What run.json tells.
struct RunReport {
  bool complete = false;
  double t = 0;          // last time reached [s]
  std::string reason;    // why it stopped early,
  bool stopped = false;  // because something outside of it wanted that
  long steps = 0, iterations = 0, cuts = 0;
  std::string profile;  // table of seconds by phase
  std::string table;    // of the modes of an analysis of these, or of the turns of a path
};

/// Run the scene; writes run.h5, run.xdmf and, last, run.json.  A run stopped by physics is a report, not an exception.
RunReport run(const Scene& scene, System& system, const RunOptions& options);

}  // namespace hilo
