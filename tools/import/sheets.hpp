// SPDX-License-Identifier: GPL-3.0-or-later
// Shells as sheets: where they go on smoothly, and the lines at which they fold, meet or change their thickness.
#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "base/math.hpp"

namespace hilo {

struct Imported;

/// Two shells are of one sheet where they share an edge with no third one, are as thick as each other there, lie on the same side of it,
/// and their normals are at most 40 degrees apart.  A node has one pair of nodes for each sheet that it is in.
class Sheets {
 public:
  /// A sheet at a node.
  struct Part {
    std::vector<std::int64_t> cells;
    Vec3 normal = Vec3::Zero();  // the mean of theirs; where the surface ends, of theirs as turned there
    double thickness = 0, offset = 0;
  };
  explicit Sheets(const Imported& in);

  /// The sheets at a node; none where no shell has it.
  const std::vector<Part>& at(std::int64_t node) const;
  /// Whether a shell is numbered against its neighbours in its sheet.
  bool is_turned(std::int64_t cell) const { return turned_.at(cell); }
  /// All nodes, each with its sheets.
  const std::map<std::int64_t, std::vector<Part>>& all() const { return at_; }
  /// Shells that lie on a neighbour.
  const std::vector<std::int64_t>& folded() const { return folded_; }

 private:
  std::map<std::int64_t, bool> turned_;
  std::map<std::int64_t, std::vector<Part>> at_;
  std::vector<std::int64_t> folded_;
};

/// The sheets that a row of the deck's mesh is in, where shells become pairs of nodes; none elsewhere.
const std::vector<Sheets::Part>& sheets_at(const Imported& in, std::int64_t row);

/// Whether a pair of nodes along n can stand for a support of a shell's node: it holds both nodes or none, so (turn x n)_i is held with
/// place i.  `held`: bits 0 to 5.
bool bears_support(unsigned held, const Vec3& n);

/// A support of a node of shells.
struct ShellSupport {
  unsigned held = 0;    // components, bits 0 to 5
  bool turned = false;  // by an angle that is not zero
  bool askew = false;   // along axes that are not the model's
};
/// Whether the node has to be a body, by joints of which it is held: pairs alone cannot be.
bool needs_body(const std::vector<Sheets::Part>& parts, const ShellSupport& s);
/// How many nodes it becomes.
size_t count_nodes(const std::vector<Sheets::Part>& parts, bool of_solid);
/// Whether the sheets have one normal, about which no turn is resisted.
bool is_flat(const std::vector<Sheets::Part>& parts);
/// Takes out of a moment what is about that normal; whether there was some.
bool drop_drilling(const std::vector<Sheets::Part>& parts, Vec3& moment);

}  // namespace hilo
