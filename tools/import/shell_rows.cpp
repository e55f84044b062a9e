// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/shell_rows.hpp"

#include <map>
#include <set>

#include "import/imported.hpp"
#include "import/sheets.hpp"

namespace hilo {
namespace {

class Rows {
 public:
  Rows(const Imported& in, const Sheets& sheets, const std::vector<std::int64_t>& cells) : in_(in), sheets_(sheets), cells_(cells) {
    for (const auto c : cells)
      for (int k = 0; k < 4; ++k) beside_[edge(c, k)].emplace_back(c, k);
  }

  ShortRows run() const {
    ShortRows out;
    std::set<std::int64_t> in_short;
    for (const auto& [nodes, sides] : beside_) {
      if (!is_end(nodes)) continue;
      for (const auto& [cell, k] : sides) {
        std::vector<std::int64_t> row;
        if (!walk(cell, k, row)) continue;
        in_short.insert(row.begin(), row.end());
        if (const int n = static_cast<int>(row.size()); out.cell < 0 || n < out.fewest) out.fewest = n, out.cell = row.front();
      }
    }
    out.n_shells = static_cast<std::int64_t>(in_short.size());
    return out;
  }

 private:
  using Edge = std::pair<std::int64_t, std::int64_t>;
  Edge edge(std::int64_t c, int k) const {
    const auto n = in_.mesh.cell(c);
    return std::minmax(n[k], n[(k + 1) % 4]);
  }
  /// A fold, an edge of several shells or a clamp.  A step of thickness is none: the plate turns there.
  bool is_end(const Edge& e) const {
    const auto is_clamped = [&](std::int64_t a) {
      const auto held = in_.held.find(a);
      return held != in_.held.end() && held->second == 63;
    };
    return (is_clamped(e.first) && is_clamped(e.second)) ||
           (beside_.at(e).size() > 1 && !goes_on(e) && !(is_flat(sheets_.at(e.first)) && is_flat(sheets_.at(e.second))));
  }
  /// Whether the two shells at an edge are of one sheet at both of its nodes.
  bool goes_on(const Edge& e) const {
    const auto& sides = beside_.at(e);
    if (sides.size() != 2) return false;
    const auto together = [&](std::int64_t a) {
      for (const auto& part : sheets_.at(a)) {
        bool has[2] = {};
        for (const auto c : part.cells)
          for (int i = 0; i < 2; ++i) has[i] = has[i] || c == sides[static_cast<size_t>(i)].first;
        if (has[0] && has[1]) return true;
      }
      return false;
    };
    return together(e.first) && together(e.second);
  }
  /// The shells from an edge to the opposite end, fewer than enough; whether there is such an end.
  bool walk(std::int64_t cell, int k, std::vector<std::int64_t>& row) const {
    for (;;) {
      row.push_back(cell);
      const Edge far = edge(cell, (k + 2) % 4);
      if (is_end(far)) return row.size() < static_cast<size_t>(enough_in_a_row);
      if (!goes_on(far) || row.size() + 1 >= static_cast<size_t>(enough_in_a_row)) return false;
      const auto& sides = beside_.at(far);
      const auto& next = sides[sides[0].first == cell ? 1 : 0];
      cell = next.first, k = next.second;
    }
  }

  const Imported& in_;
  const Sheets& sheets_;
  const std::vector<std::int64_t>& cells_;
  std::map<Edge, std::vector<std::pair<std::int64_t, int>>> beside_;
};

}  // namespace

ShortRows short_rows(const Imported& in, const Sheets& sheets, const std::vector<std::int64_t>& cells) {
  return Rows(in, sheets, cells).run();
}

}  // namespace hilo
