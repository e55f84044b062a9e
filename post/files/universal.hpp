// SPDX-License-Identifier: GPL-3.0-or-later
// Universal files: histories as datasets 58, "Function at Nodal DOF", which programs of test departments read.
#pragma once
#include <string>
#include <vector>

namespace hilo {

struct UniversalColumn {
  std::string label, unit;  // "sensor.seat.az", "g"
  std::vector<double> value;
};

/// Dataset 164 with SI units, then a dataset 58 for each column, in double precision.  Numbers of units of the SI get its data type or its
/// exponents of length and force, accelerations in g become m/s^2, and others are "unknown" with their unit as the label.  The record of
/// the abscissa has six digits: Error (exit 2), at `path`, where they tell two rows not apart, where the abscissa does not rise, and where
/// a value is not finite.
std::string universal_text(const std::string& title, const UniversalColumn& x, const std::vector<UniversalColumn>& columns,
                           const std::string& path);

}  // namespace hilo
