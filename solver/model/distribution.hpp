// SPDX-License-Identifier: GPL-3.0-or-later
// How a mesh is divided: every rank reads a slice of the rows; cells travel to the rank that computes them, and nodes, sets and names
// follow.
#pragma once
#include <algorithm>
#include <optional>

#include "base/error.hpp"
#include "model/local_mesh.hpp"
#include "model/mesh_source.hpp"

namespace hilo::division {

using Rows = std::vector<std::int64_t>;

/// Rows cut into one contiguous slice per rank.
struct Slices {
  std::int64_t n = 0;
  int size = 1;
  std::int64_t first(int rank) const { return n * rank / size; }
  int holder(std::int64_t row) const { return static_cast<int>((size * (row + 1) - 1) / n); }
};

inline void sort_unique(Rows& rows) {
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
}

class Distribution {
 public:
  Distribution(const std::string& path, const Comm& comm) : comm_(comm), file_(Store::open(path)) { out_.file = path; }
  LocalMesh run();

 private:
  enum Kind { node, cell, facet };
  struct Set {
    Kind kind;
    std::string name, array;
    std::int64_t rows;
  };

  const Store& mesh_file() const { return other_ ? *other_ : file_; }
  Error damaged(const std::string& what) const { return Error(mesh_file().path(), "damaged: " + what); }

  // distribute.cpp
  /// Everything that is small and the same on all ranks; its errors are the same too.
  void open();
  void refuse_changed(const std::string& what, const std::string& target) const;
  void read_tags();
  /// This rank's slices of the cells and of the node coordinates.
  void read_cells();
  std::vector<int> choose_ranks() const;
  // distribute_cells.cpp
  void send_cells(const std::vector<int>& part);
  /// The nodes of the local cells and the lone nodes of sets; every holder of a slice learns who has which of its nodes.
  void collect_nodes();
  void find_owners();
  // distribute_sets.cpp
  /// Every rank reads a slice of each set and hands the entries to the holders of their rows, who know which ranks want them.
  void share_sets();
  /// A shared node may belong to a name through a cell of another rank: all ranks that have the node learn it.
  void complete_names();

  /// Ask the holders of sorted rows; the answers come in the order of the rows, `width` values each.
  template <class T>
  std::vector<T> fetch(const Rows& rows, const std::vector<T>& slice, int width) const {
    std::vector<Rows> ask(comm_.size);
    for (const auto row : rows) ask[nodes_.holder(row)].push_back(row);
    const auto asked = comm_.exchange(ask);
    std::vector<std::vector<T>> answer(comm_.size);
    for (int r = 0; r < comm_.size; ++r)
      for (const auto row : asked[r]) {
        const auto at = (row - nodes_.first(comm_.rank)) * width;
        answer[r].insert(answer[r].end(), slice.begin() + at, slice.begin() + at + width);
      }
    std::vector<T> values;
    for (const auto& list : comm_.exchange(answer)) values.insert(values.end(), list.begin(), list.end());
    return values;
  }

  std::int64_t local_node(std::int64_t row) const {
    const auto at = std::lower_bound(out_.node_global.begin(), out_.node_global.end(), row);
    return at != out_.node_global.end() && *at == row ? at - out_.node_global.begin() : -1;
  }
  std::int64_t local_cell(std::int64_t row) const {
    return std::lower_bound(out_.cell_global.begin(), out_.cell_global.end(), row) - out_.cell_global.begin();
  }

  const Comm& comm_;
  LocalMesh out_;
  Store file_;
  std::optional<Store> other_;  // the mesh, where file_ links to it
  std::vector<Set> sets_;
  Rows lone_nodes_;  // of sets of one node
  Slices nodes_, cells_;
  int n_parts_ = 0;  // of a parts file
  // this rank's slice of the file
  std::vector<std::uint8_t> shape_;
  std::vector<std::int32_t> region_, part_;
  Rows cell_id_, offset_, cell_nodes_, node_id_, block_;
  std::vector<double> X_;
  std::vector<int> rank_of_cell_;          // where each cell of the slice went
  std::vector<std::vector<int>> holders_;  // ranks that have each node of the slice, ascending
  std::vector<int> owner_;                 // the one among them that owns it
  std::vector<char> shared_;               // of local nodes: other ranks have it too
};

}  // namespace hilo::division
