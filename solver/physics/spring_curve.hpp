// SPDX-License-Identifier: GPL-3.0-or-later
// Springs whose force is a table over their extension.
#pragma once
#include <memory>
#include <vector>

#include "physics/force_law.hpp"

namespace hilo {

/// On one coordinate: forces [N] at ascending values [m] of it less `free`, linear between and constant beyond; a damper [N s/m] beside.
std::unique_ptr<SpringLaw> make_curve(double free, double damping, std::vector<double> extension, std::vector<double> force);

}  // namespace hilo
