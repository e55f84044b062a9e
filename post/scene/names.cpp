// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/scene/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace hilo {
namespace {

std::string stem(const std::string& name) {
  std::string out, word;
  const auto close = [&] {
    if (word != "l" && word != "r" && word != "left" && word != "right") out += word + " ";
    word.clear();
  };
  for (const char c : name) {
    if (c == '_' || c == '-' || c == ' ')
      close();
    else if (!std::isdigit(static_cast<unsigned char>(c)))
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  close();
  return out;
}

}  // namespace

std::vector<NameGroup> grouped(const std::vector<std::string>& names, size_t few) {
  std::vector<NameGroup> groups;
  std::vector<std::string> stems;
  for (size_t i = 0; i < names.size(); ++i) {
    const std::string s = names.size() <= few ? names[i] : stem(names[i]);
    const auto found = std::find(stems.begin(), stems.end(), s);
    if (found == stems.end())
      stems.push_back(s), groups.push_back({names[i], {i}});
    else
      groups[static_cast<size_t>(found - stems.begin())].members.push_back(i);
  }
  for (auto& g : groups)
    if (g.members.size() > 1) g.label = fmt::format("{} \u2026 {}", names[g.members.front()], names[g.members.back()]);
  return groups;
}

}  // namespace hilo
