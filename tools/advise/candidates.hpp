// SPDX-License-Identifier: GPL-3.0-or-later
// Models of a scene that differ in the fidelity of its regions, each run by hilo-solve and kept by content.
#pragma once
#include <map>

#include "advise/gate.hpp"
#include "model/mesh.hpp"
#include "post/quantity/quantity.hpp"

namespace hilo {

using Assignment = std::vector<Fidelity>;  // (n_regions)

struct Candidate {
  Assignment fidelity;
  std::string run;                       // run.h5
  std::vector<QuantityValue> values;     // of the quantities with a tolerance
  double seconds = 0, unknowns = 0;      // of one processor
  std::map<size_t, std::string> beyond;  // linear regions that left their range, and what the run said of it
};

class Candidates {
 public:
  Candidates(std::string scene, std::string mesh, std::vector<std::string> overrides, std::string folder, double tolerance);

  const Scene& scene() const { return scene_; }
  const MeshFile& mesh() const { return mesh_; }
  /// A run, or the one that is there already of the same scene, mesh and fidelity.  `step` scales the time step.  Error with the line of
  /// hilo-solve where it fails.
  const Candidate& of(const Assignment& fidelity, double step = 1);
  /// Natural frequencies at the start without gravity, lowest first; empty where there are none.
  std::vector<double> frequencies(const Assignment& fidelity);
  /// Forces of all joints of a run.
  std::vector<LoadHistory> loads(const Candidate& c) const;
  /// Largest |difference| of the quantities over what is allowed of `base`; a quantity that either lacks counts where `base` has it.
  double difference(const Candidate& c, const Candidate& base, std::string* worst = nullptr) const;
  std::string label(const Assignment& fidelity) const;
  int runs = 0;

 private:
  std::string solve(const Assignment& fidelity, const std::vector<std::string>& more);
  const std::string scene_path_, mesh_path_;
  const std::vector<std::string> overrides_;
  const std::string folder_;
  const double tolerance_;  // of quantities that say none
  const Scene scene_;
  const MeshFile mesh_;
  std::map<std::string, Candidate> done_;
};

}  // namespace hilo
