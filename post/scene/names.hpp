// SPDX-License-Identifier: GPL-3.0-or-later
// Regions that belong together by name: wheel_1, wheel_2, ... share a colour and a line of the legend when there are many.
#pragma once
#include <string>
#include <vector>

namespace hilo {

struct NameGroup {
  std::string label;            // "wheel_1 ... wheel_8"
  std::vector<size_t> members;  // positions in the list of names
};
/// Names grouped by what is left without digits and without the words l, r, left, right; one group each for lists of at most `few`.
std::vector<NameGroup> grouped(const std::vector<std::string>& names, size_t few = 12);

}  // namespace hilo
