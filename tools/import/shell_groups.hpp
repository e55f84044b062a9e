// SPDX-License-Identifier: GPL-3.0-or-later
// Which groups of surfaces --thickness makes shells of.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "import/imported.hpp"

namespace hilo {

class ShellGroups {
 public:
  /// Throws Error where all surfaces of a mesh with solids would become shells.
  ShellGroups(const ImportOptions& options, const std::string& path, bool has_solids);
  /// Of the group of this name; nothing where it stays a set.
  std::optional<double> thickness_of(const std::string& group);
  /// The region of a mesh without groups.
  [[nodiscard]] double thickness_of_all() const { return options_.thickness.at(""); }
  /// After all groups: throws Error where an option names none of them.
  void require_all_names() const;
  /// That a surface would be a shell of two groups.
  [[noreturn]] static void refuse_twice(std::int64_t surface, const std::string& group);

 private:
  const ImportOptions& options_;
  std::vector<std::string> names_;
};

}  // namespace hilo
