// SPDX-License-Identifier: GPL-3.0-or-later
// Values of things that ranks have parts of (nodes, cells), in an order that no rank makes: by the number of each thing in its file.
#pragma once
#include "base/comm.hpp"

namespace hilo {

class Spread {
 public:
  /// `number`: of each local thing, the same on every rank that holds it.
  Spread(const Comm& comm, std::vector<std::int64_t> number) : comm_(&comm), number_(std::move(number)) {}
  size_t size() const { return number_.size(); }
  /// Whether it holds on some rank.  Collective.
  bool any(bool here) const { return comm_->max(here ? 1.0 : 0.0) > 0; }
  /// Values (n x width) of all things by number, on rank 0; NaN where no rank has the thing.  Collective.
  std::vector<double> gather(const std::vector<double>& local, int width) const;
  /// And back: `all` as rank 0 has it.  Collective.
  std::vector<double> pick(const std::vector<double>& all, int width) const;

 private:
  const Comm* comm_;
  std::vector<std::int64_t> number_;
};

}  // namespace hilo
