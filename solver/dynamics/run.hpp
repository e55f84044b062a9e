// A whole run: start, steps with cutting, results, report.
#pragma once
#include <string>
#include <vector>

#include "model/scene.hpp"
#include "system/system.hpp"

namespace hilo {

struct RunOptions {
  std::string output;  // run.h5
  std::vector<std::string> provenance;
  bool quiet = false;
  std::string mesh;  // file used, "" for none
};

/// What run.json tells.
struct RunReport {
  bool complete = false;
  double t = 0;        // last time reached [s]
  std::string reason;  // why it stopped early
  long steps = 0, iterations = 0, cuts = 0;
  std::string profile;  // table of seconds by phase
};

/// Run the scene; writes run.h5, run.xdmf and, last, run.json.  A run stopped by physics is a report, not an exception.
RunReport run(const Scene& scene, System& system, const RunOptions& options);

}  // namespace hilo
