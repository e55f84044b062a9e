// SPDX-License-Identifier: GPL-3.0-or-later
// The expressions of *PARAMETER.
#pragma once
#include <map>
#include <string>
#include <string_view>

namespace hilo {

/// A number of *PARAMETER; whole ones stay whole, as numbers of nodes have to.
struct InpParameter {
  double value = 0;
  bool whole = false;
  std::string text() const;
};
/// The value of "2.*(a + 1)**2/sqrt(b)" with the parameters so far, by the rules of Python.  Error at `place` where it is none, where a
/// name is not known, and for a division of whole numbers that leaves a rest, of which Abaqus keeps the whole part in some versions.
InpParameter evaluate_parameter(std::string_view expression, const std::map<std::string, InpParameter>& known, const std::string& place);

}  // namespace hilo
