// SPDX-License-Identifier: GPL-3.0-or-later
// TOML with places: parsing, overrides and text of a scene before the schema looks at it.
#pragma once
#include <toml++/toml.h>

#include <span>
#include <string>
#include <vector>

#include "model/scene.hpp"

namespace hilo {

/// Parse, with syntax errors as Error at file:line:column.
toml::table parse_toml(std::string_view text, const std::string& file);

/// Apply "joint.trunnion.stiffness=2e6": list sections by name (or number where they have none), names with dots quoted.  The right side is
/// TOML; a bare word is a text.  The new value's place is the option itself.
void apply_override(toml::table& root, const std::string& option);

/// The table as TOML, with the entries of a section in file order (the last matching region wins).
std::string toml_text(const toml::table& root);

/// One key of a table, with its place: that of the key, or the --set option that gave it.
struct Item {
  std::string key;
  Place place;
  const toml::node* node;
};
std::vector<Item> in_file_order(const toml::table& table);
Place place_of_node(const toml::node& node);

/// "text", "a number", "a list", ... for messages.
std::string_view type_word(const toml::node& node);

}  // namespace hilo
