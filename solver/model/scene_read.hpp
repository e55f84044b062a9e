// SPDX-License-Identifier: GPL-3.0-or-later
// Steps of Scene::load between the TOML tree and the checked entries.
#pragma once
#include <array>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "model/scene_toml.hpp"

namespace hilo {

using Entries = std::map<std::string, std::vector<Entry>, std::less<>>;

/// What reading a value needs to know of the scene around it.
struct Surroundings {
  std::string file, folder, units = "m-kg-s";
  std::map<std::string, History, std::less<>> histories;  // of the [history.NAME] tables
  /// What a parameter of the schema is found to say, once for all entries.
  struct Known {
    std::optional<double> factor;  // to SI
    std::vector<std::string> choices;
    std::optional<Value> fallback;
  };
  mutable std::unordered_map<const Param*, Known> known;
  mutable std::map<std::string, std::string> value_units;  // in SI, of histories whose file says it: by name, and by where they are used
};

/// Check a TOML value against its parameter and convert it to SI; `label` says whose value it is.
Value read_value(std::string_view section, const Param& param, const Item& item, const std::string& label, const Surroundings& around);

/// Check all keys of a table and complete them with defaults.  Messages begin with `owner`, the entry's label when empty.
Entry read_entry(std::string_view section, const toml::table& table, const std::string& name, const Place& place,
                 const Surroundings& around, const std::string& owner = "");
/// All sections of the scene.
Entries read_sections(const toml::table& root, Surroundings& around);

/// The history a [history.NAME] or inline table describes: its points, or those of its CSV file.
History history_of(const Entry& entry, const std::string& label, const Surroundings& around);
/// Error where the file of an entry's history says values of another unit than the key has that it scales.
void check_history_unit(const Entry& entry, const Surroundings& around);
/// Two columns of a CSV file: times and values, as written, and the units in their headings ("" without one) with their places.
struct HistoryTable {
  std::vector<double> t, value;
  std::array<std::string, 2> unit, place;
};
HistoryTable read_history_csv(const std::string& path, const std::string& where);

/// Mistakes that need more than one key to see: Error.
void check_entries(const Entries& entries);
/// Quantities: one source each, names that the scene has, tolerances that can be.
void check_quantities(const Entries& entries);
/// Values that are possible but not plausible, one line each.
std::vector<std::string> find_implausible(const Entries& entries);

}  // namespace hilo
