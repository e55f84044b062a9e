// SPDX-License-Identifier: GPL-3.0-or-later
// What hilo-show says of a file: facts, then tables; for people or as JSON.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "base/table.hpp"
#include "model/mesh.hpp"
#include "model/store.hpp"

namespace hilo {

struct Summary {
  struct Fact {
    std::string key, value;
    bool is_number = false;
  };
  std::vector<Fact> facts;
  std::vector<std::pair<std::string, Table>> tables;

  void say(const std::string& key, const std::string& value);
  void count(const std::string& key, std::int64_t n);
  void measure(const std::string& key, double value);
  /// An empty table is not shown, but is [] in JSON.
  void list(const std::string& key, Table table) { tables.emplace_back(key, std::move(table)); }
  std::string text() const;
  std::string json() const;
};

/// Any of our HDF5 files.
Summary summary_of_file(const std::string& path);
/// A scene, from a file or "-".
Summary summary_of_scene(const std::string& path);

/// Sets, regions, tags and parts; whatever the file has of them.
void add_mesh(Summary& s, const MeshFile& file, const std::string& path);
/// Bodies, fields and histories of a results file.
void add_run(Summary& s, const Store& store);
/// Linear regions, their modes, and the mass that vibrations of held regions carry.
void add_reduced(Summary& s, const Store& store);

/// Open every array of a file and of those it links to: whole and of consistent sizes, or an Error.  Returns what it is: "ok, 16
/// arrays", or of a run on its way how far it is sound.
std::string check_file(const std::string& path);

/// docs/format.md, from the schemas.
std::string format_page();

}  // namespace hilo
