// SPDX-License-Identifier: GPL-3.0-or-later
// Which region is modelled how: rules from a tags.toml or from options, applied to the regions of a mesh.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "model/mesh.hpp"

namespace hilo {

/// One rule: regions by name or glob, wholly inside a box, or whose cells all belong to a set.
struct TagRule {
  Fidelity fidelity;
  enum class By { name, box, set } by;
  std::string pattern;  // name, glob or set
  Vec3 low, high;       // box [m]
  std::string where;    // tags.toml:3:10 or the option
};

struct TagRules {
  std::vector<TagRule> rules;
  std::optional<Fidelity> rest;  // fidelity of the regions that no rule names
};

/// Read a tags.toml: rigid, linear, nonlinear = list of "name", "glob*", {box = [[x, y, z], [x, y, z]]}, {set = "name"}; rest = "rigid".
TagRules read_tag_rules(const std::string& path);
/// One word of an option: name, glob, "box:x,y,z,x,y,z" or "set:NAME".
TagRule tag_rule_of_option(Fidelity fidelity, const std::string& option, const std::string& word);

/// Fidelity per region, nothing where neither a rule nor `rest` says it.  Error where a rule matches no region or a region is tagged
/// twice, and where a level is asked for that is not built yet.
std::vector<std::optional<Fidelity>> apply_tag_rules(const Mesh& mesh, const TagRules& rules);

/// Rigid body of each region, -1 for flexible ones: rigid regions that share nodes are one body.
std::vector<int> body_of_region(const Mesh& mesh, std::span<const Fidelity> fidelity);

}  // namespace hilo
