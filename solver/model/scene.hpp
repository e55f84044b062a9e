// SPDX-License-Identifier: GPL-3.0-or-later
// The scene: one TOML file, kept as entries with their places.  What the keys mean is in scene_schema; nothing is interpreted here.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/entry_values.hpp"
#include "base/param.hpp"
#include "base/registry.hpp"

namespace hilo {

class Comm;

/// file:line:column
struct Place {
  std::string file;
  int line = 0, column = 0;
  std::string text() const;
};

/// One value of an entry, in SI units, with its place.
struct Value {
  Place place;
  std::vector<double> numbers;     // a number is a list of one
  std::vector<std::string> texts;  // a text is a list of one
  std::optional<bool> boolean;
  std::optional<History> history;
  bool given = true;                                           // false: the default is in force
  std::shared_ptr<bool> read = std::make_shared<bool>(false);  // whether its value was asked for, of a copy too
};

/// A table of the scene: [material.steel] has section "material" and name "steel"; [[joint]] has its kind and name as keys.
struct Entry final : EntryValues {
  Entry() = default;
  Entry(std::string_view section, std::string name, Place place) : section(section), name(std::move(name)), place(std::move(place)) {}
  std::string section, kind, name;
  Place place;
  std::map<std::string, Value, std::less<>> values;  // checked and completed with defaults by the schema

  bool has(std::string_view key) const override;
  bool given(std::string_view key) const override;
  double number(std::string_view key) const override;
  Vec3 vector3(std::string_view key) const override;
  const std::vector<double>& numbers(std::string_view key) const override;
  const std::string& text(std::string_view key) const override;
  const std::vector<std::string>& texts(std::string_view key) const override;
  bool boolean(std::string_view key) const override;
  const History& history(std::string_view key) const override;
  std::string where(std::string_view key) const override;
  std::string label() const override;
  /// Every value in force in one line, to tell entries apart.
  std::string all_values() const;
};

/// The whole scene, every key known and every value in range.
class Scene {
 public:
  /// Read `path` ("-": standard input), apply overrides "joint.trunnion.stiffness=2e6", check against the schema.
  /// Unknown sections, keys and kinds, wrong types, values out of range, duplicate names: Error with file:line:column and a suggestion.
  static Scene load(const std::string& path, std::span<const std::string> overrides = {});
  /// The same on all ranks, of which the first alone has standard input ("-").
  static Scene load(const std::string& path, std::span<const std::string> overrides, const Comm& comm);
  /// The same for a text that is already there (from another rank, or of a results file); `path` says where it came from.
  static Scene parse(const std::string& text, const std::string& path, std::span<const std::string> overrides = {});
  /// Entries of a section in file order: material, region, set, body, point_mass, joint, spring, load, motion, initial, sensor, probe,
  /// history.
  std::span<const Entry> entries(std::string_view section) const;
  /// The one table of a section (time, solver, output, scene); defaults where it is absent.
  const Entry& table(std::string_view section) const;
  /// The mesh file that the scene names (relative to the scene), or "".  Error where it is not there.
  std::string mesh_path() const;
  std::string path;    // as given
  std::string folder;  // relative paths in the scene start here
  std::string text;    // the TOML text after overrides, for provenance
  std::string units;
  /// Every value in force as lines "section.name.key = value [unit]  # default|given", for --explain.
  std::string explain() const;
  /// The same as "section.name.key = value", values in full, of tables and files that they name their digests.
  std::vector<std::string> values() const;
  /// Of entries that something has asked for values: keys that stand in the scene and that nothing has asked for, one line each, with
  /// place.
  std::vector<std::string> unread() const;
  /// Entries of each section in the order in which such lines name them, those they do not name last: what is kept goes by this order.
  void put_in_order(std::span<const std::string> values);
  std::vector<std::string> warnings;  // implausible values, one line each, with place

 private:
  std::map<std::string, std::vector<Entry>, std::less<>> entries_;
};

/// How many columns a table of numbers has, in words and by rule, and what its header line may be.
struct RowRule {
  std::string expected, header;
  std::function<bool(size_t)> fits;
};
/// Rows of a CSV file with a header line, all of as many columns, in the numbers of the file.  Errors with the place in the file.
std::vector<std::vector<double>> read_rows_csv(const std::string& path, const std::string& where, const RowRule& rule);
/// Points of a CSV file with a header line and three columns, in the numbers of the file.
std::vector<Vec3> read_points_csv(const std::string& path, const std::string& where);

/// The schema of scenes: every section, kind and key, with unit, default and meaning.
struct KindSchema {
  std::string_view section;  // "joint"
  std::string_view kind;     // "revolute"; "" where the section has no kinds
  std::string_view meaning;
  std::vector<Param> params;
};
const std::vector<KindSchema>& scene_schema();
/// Sections of their own that a program outside this tree brings: entries [[name]] with these keys.
struct OwnSection {
  std::string_view name, meaning;
  std::vector<Param> keys;
};
Registry<OwnSection>& own_sections();
/// A word that a key of the scene may be.
struct Word {
  std::string_view name, meaning = {};
};
/// The words of a text key; null where any text will do (a `kind` is checked against the schema's kinds).  What the floors above know by
/// words (solver.kind, output.fields) is theirs; a program outside the tree adds its own words here.
Registry<Word>* words_of(std::string_view section, std::string_view key);
/// These words as a list; empty where any text will do.
std::vector<std::string> choices(std::string_view section, std::string_view key);
/// The default of a key that has one; defaults are in SI units.
Value default_value(const Param& param);
/// Sections written as [[section]] (lists of tables with a key `name`); the others are [section.NAME] or a single [section].
bool is_list_section(std::string_view section);
bool is_single_section(std::string_view section);

}  // namespace hilo
