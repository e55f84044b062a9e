// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's method where parts touch: contacts that are soft find what meets, then ever stiffer ones the answer.
#pragma once
#include <functional>

#include "dynamics/newton.hpp"

namespace hilo {

class SoftContacts {
 public:
  explicit SoftContacts(System& system) : system_(system) {}
  /// Where a solution stands among those that lead to the answer.
  struct Turn {
    bool first, last;  // from where the step began; with contacts as asked for
  };
  /// Newton's method from a guess.
  using Solve = std::function<NewtonReport(const NewtonOptions& how, Turn turn)>;
  /// As asked for, and where that fails from soft contacts on, or the other way round: what succeeded last comes first.  `begin_again` puts
  /// guess and choices to where they were; `q` is where `solve` leaves positions.  Collective.
  NewtonReport find(const NewtonOptions& options, const std::function<void()>& begin_again, const Solve& solve, const Config& q);

  bool begins_soft = false;  // as what succeeded last did

 private:
  NewtonReport softly(const NewtonOptions& options, const std::function<void()>& begin_again, const Solve& solve, const Config& q);
  System& system_;
};

}  // namespace hilo
