// SPDX-License-Identifier: GPL-3.0-or-later
// Load steps by Newton's method; where parts touch, contacts that are soft find what meets, then ever stiffer ones the answer.
#pragma once
#include "dynamics/run_parts.hpp"
#include "dynamics/start/start.hpp"

namespace hilo {

class SoftContacts {
 public:
  explicit SoftContacts(RunParts& run) : run_(run) {}
  /// From the state of the run, at rest under the loads of `step`, to q and lambda at rest under those at time t [s] times `ramp`: with
  /// contacts as they are, and where that fails from soft ones on, or the other way round.  What succeeded last comes first.  Where none
  /// does, q and lambda are where the last attempt ended.  Collective.
  NewtonReport find(LoadStep& step, double t, double ramp, const NewtonOptions& options, Config& q, std::vector<double>& lambda);

  bool begins_soft = false;  // as what succeeded last did

 private:
  RunParts& run_;
};

}  // namespace hilo
