// SPDX-License-Identifier: GPL-3.0-or-later
// Fields: what nodes and cells have at an instant.  Sources of fields, one file each, are looped over; a further one is a file, a row of
// field_kinds(), its words of output.fields (model/words.cpp) and its arrays (model/schema.cpp).
#pragma once
#include <algorithm>

#include "base/registry.hpp"
#include "dynamics/record/run_output.hpp"
#include "model/schema.hpp"
#include "system/system.hpp"

namespace hilo {

/// One array of a field: /field/<step>/NAME.
struct Field {
  std::string name;
  std::string key = name;  // of output.fields, by which it is asked for
  std::string label = {};  // in ParaView; "": not shown there
  bool of_cells = false;   // else of nodes
};

/// Positions, velocities and accelerations at an instant, and what the cells remember, by batch (Solids::memory).
struct Snapshot {
  const Config &q, &v, &a;
  const std::vector<std::vector<double>>& memory;
};

/// Where the fields of one instant go.
class FieldWriter {
 public:
  FieldWriter(RunOutput& file, const std::vector<std::string>& wanted, const Slabs& nodes, const Slabs& cells, bool all_cells)
      : file_(file), wanted_(wanted), nodes_(nodes), cells_(cells), all_cells_(all_cells) {}
  virtual ~FieldWriter() = default;
  bool wants(const std::string& key) const { return std::find(wanted_.begin(), wanted_.end(), key) != wanted_.end(); }
  /// Values of the local nodes (n x width), or of this rank's piece of the rows.  Collective, like all of these.
  void nodes(const std::string& name, const std::vector<double>& local, int width) { piece(name, nodes_.collect(local, width)); }
  virtual void piece(const std::string& name, const std::vector<double>& rows) { file_.write_piece(nodes_, group + "/" + name, rows); }
  /// Values of the local cells; left out where the file has no rows for all cells.
  void cells(const std::string& name, const std::vector<double>& local, int width) {
    if (all_cells_) file_.write_piece(cells_, group + "/" + name, cells_.collect(local, width));
  }
  /// Values at borders of regions, of items in rows of their own: /border/<step>/NAME.
  void border(const Slabs& rows, const std::string& name, const std::vector<double>& local, int width) {
    file_.write_piece(rows, "/border" + group.substr(group.rfind('/')) + "/" + name, rows.collect(local, width));
  }
  /// A list that is the same at all instants.
  void list(const std::string& path, const std::vector<std::int64_t>& whole) {
    file_.on_store([&](Store& f) { write_array(f, path, whole, {std::ssize(whole)}); });
  }
  /// Whether each instant is kept, with its borders.
  virtual bool keeps() const { return true; }
  const Slabs& node_rows() const { return nodes_; }
  std::string group;  // /field/<step>

 private:
  RunOutput& file_;
  const std::vector<std::string>& wanted_;
  const Slabs &nodes_, &cells_;
  bool all_cells_;
};

class FieldSource {
 public:
  virtual ~FieldSource() = default;
  virtual std::vector<Field> fields() const = 0;
  /// Called where one of its keys is wanted.  Collective.
  virtual void write(const Snapshot& at, FieldWriter& to) = 0;
};

/// What makes a source; node_row: row of each local node, -1 for those not written.
struct FieldKind {
  std::string_view name;
  std::unique_ptr<FieldSource> (*make)(const System& system, const std::vector<std::int64_t>& node_row);
};
Registry<FieldKind>& field_kinds();
/// One more, from outside the tree: in the list, its words of output.fields, and the arrays /field/<step>/NAME that it writes.
void add_field(const FieldKind& kind, const std::vector<std::string_view>& words, const std::vector<ArraySchema>& arrays);

/// Displacement, velocity and acceleration of nodes.
std::unique_ptr<FieldSource> motion_fields(const System& system, const std::vector<std::int64_t>& node_row);
/// Pressure of contacts on nodes.
std::unique_ptr<FieldSource> contact_fields(const System& system, const std::vector<std::int64_t>& node_row);
/// Recovered stress of nodes and stress of cells.
std::unique_ptr<FieldSource> stress_fields(const System& system, const std::vector<std::int64_t>& node_row);

}  // namespace hilo
