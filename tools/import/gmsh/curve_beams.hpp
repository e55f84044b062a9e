// SPDX-License-Identifier: GPL-3.0-or-later
// Curve groups as beams of the scene: --beams rail=tube:diameter=60,thickness=3.
#pragma once
#include <array>
#include <map>
#include <string>
#include <vector>

#include "import/imported.hpp"

namespace hilo {

/// Curve groups that become beams, and what section each has.
class CurveBeams {
 public:
  /// Errors: no section by these words.
  explicit CurveBeams(const ImportOptions& options);
  bool wants(const std::string& group) const { return sections_.contains(group); }
  /// A line of a group between two nodes, by their rows.
  void add(const std::string& group, std::int64_t a, std::int64_t b) { lines_[group].push_back({a, b}); }
  /// The sections and beams as lines of a scene, a beam for each way between ends, forks and borders of groups; the groups of points are
  /// named by the sections that stand on them.  Notes nodes that cells have too.  Errors: a group without lines.
  SceneWriter scene(Imported& in, const std::map<std::int64_t, std::vector<std::string>>& points) const;
  size_t n_lines() const;

 private:
  const ImportOptions& options_;
  std::map<std::string, std::string> sections_;                            // the words, by group
  std::map<std::string, std::vector<std::array<std::int64_t, 2>>> lines_;  // by group
};

}  // namespace hilo
