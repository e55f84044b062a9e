// SPDX-License-Identifier: GPL-3.0-or-later
// The table of contents of the Nastran reader, and lists that its families share.
#include <fmt/format.h>

#include "base/error.hpp"
#include "import/bdf/card.hpp"

namespace hilo {

std::int64_t BdfDeck::row_of(std::int64_t grid, const std::string& place, const char* who, std::int64_t id) const {
  const auto a = row.find(grid);
  if (a == row.end()) throw Error(place, fmt::format("{} {} names node {}, which does not exist", who, id, grid));
  return a->second;
}

unsigned components(const DataLine& d, size_t field) {
  unsigned bits = 0;
  for (const char c : d.text(field)) {
    if (c == ' ') continue;
    if (c < '0' || c > '6') throw Error(d.place(field), fmt::format("expected components such as 123, found \"{}\"", d.text(field)));
    if (c != '0') bits |= 1u << (c - '1');
  }
  return bits;
}

size_t grid_list(const DataLine& d, size_t field, std::vector<std::int64_t>& out, std::vector<BdfRange>& ranges) {
  for (; field < d.fields.size(); ++field) {
    if (d.empty(field)) continue;
    if (d.is_integer(field)) {
      out.push_back(d.integer(field));
      continue;
    }
    if (upper(d.text(field)) != "THRU") return field;
    if (out.empty()) throw Error(d.place(field), fmt::format("THRU without a number before it"));
    const auto first = out.back(), last = d.integer(field + 1);
    std::int64_t by = 1;
    field += 1;
    if (upper(d.text(field + 1)) == "BY") by = d.integer(field + 2), field += 2;
    if (by < 1 || first < 1 || last < first || last > 1'000'000'000'000)
      throw Error(d.place(field), fmt::format("{} THRU {} names no usable range", first, last));
    out.pop_back();
    ranges.push_back({first, last, by});
  }
  return field;
}

size_t grid_list(const DataLine& d, size_t field, std::vector<std::int64_t>& out) {
  std::vector<BdfRange> ranges;
  const size_t end = grid_list(d, field, out, ranges);
  for (const BdfRange& r : ranges) {
    if ((r.last - r.first) / r.by > 100'000'000)
      throw Error(d.place(field), fmt::format("{} THRU {} names no usable range", r.first, r.last));
    for (auto i = r.first; i <= r.last; i += r.by) out.push_back(i);
  }
  return end;
}

BdfCards& bdf_cards() {
  static BdfCards all = [] {
    BdfCards list("entry of .bdf decks", {});
    for (const auto& family :
         {bdf_mesh_cards(), bdf_thin_cards(), bdf_section_cards(), bdf_material_cards(), bdf_load_cards(), bdf_link_cards()})
      for (const BdfCard& card : family) list.add(card);
    return list;
  }();
  return all;
}

}  // namespace hilo
