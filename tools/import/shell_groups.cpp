// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/shell_groups.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"

namespace hilo {

ShellGroups::ShellGroups(const ImportOptions& options, const std::string& path, bool has_solids) : options_(options) {
  if (has_solids && options.thickness.contains(""))
    throw Error("", fmt::format("--thickness makes shells of surfaces, and {} has volumes", path),
                "name the groups of surfaces: --thickness NAME=T", Exit::usage);
}

std::optional<double> ShellGroups::thickness_of(const std::string& group) {
  names_.push_back(group);
  for (const std::string& key : {group, std::string()})
    if (const auto found = options_.thickness.find(key); found != options_.thickness.end()) return found->second;
  return {};
}

void ShellGroups::require_all_names() const {
  for (const auto& [name, thickness] : options_.thickness)
    if (!name.empty() && std::ranges::find(names_, name) == names_.end())
      throw Error("", fmt::format("--thickness {}={:g}: no group of surfaces has this name", name, thickness), suggest(name, names_),
                  Exit::usage);
}

void ShellGroups::refuse_twice(std::int64_t surface, const std::string& group) {
  throw Error("", fmt::format("--thickness: surface {} is in two groups that become shells, \"{}\" the second", surface, group),
              "name one of them: --thickness NAME=T", Exit::usage);
}

}  // namespace hilo
