// A whole run: start, steps with cutting, results, report.
#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "model/scene.hpp"
#include "system/system.hpp"

namespace hilo {

/// What a run remembers between two steps, of this rank: bits of everything that the steps to come depend on, but for the factors of
/// matrices.  Those fill many times the memory and belong to other libraries; a run that is kept gives its own up and makes new ones, as
/// does the one that goes on from there, so that both take the same steps bit by bit.
using Kept = std::vector<std::byte>;

struct RunOptions {
  std::string output;  // run.h5
  std::vector<std::string> provenance = {};
  bool quiet = false;
  std::string mesh = {};  // file used, "" for none
  /// Called between steps, so many behind the start, on all ranks alike: it may call `keep`, which is collective.
  std::function<void(long steps, const std::function<Kept()>& keep)> between_steps = {};
  /// What was kept of a run of the same scene on as many ranks: this one goes on from there.  Its file has the rows from there on.
  Kept from = {};
};

/// What run.json tells.
struct RunReport {
  bool complete = false;
  double t = 0;        // last time reached [s]
  std::string reason;  // why it stopped early
  long steps = 0, iterations = 0, cuts = 0;
  std::string profile;  // table of seconds by phase
  std::string table;    // of the modes of an analysis of these
};

/// Run the scene; writes run.h5, run.xdmf and, last, run.json.  A run stopped by physics is a report, not an exception.
RunReport run(const Scene& scene, System& system, const RunOptions& options);

}  // namespace hilo
