// SPDX-License-Identifier: GPL-3.0-or-later
// The cards of an .inp deck that say supports, loads, initial velocities and histories.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/error.hpp"
#include "import/inp/card.hpp"

namespace hilo {

InpTarget target_of(const DataLine& l) {
  if (l.is_integer(0)) return {"", l.integer(0), l.place()};
  InpTarget t{upper(unquote(l.text(0))), 0, l.place()};
  if (t.target.empty()) throw Error(l.place(0), "expected a number or the name of a set");
  return t;
}

namespace {

/// Abaqus names for supports: the held components as first, last pairs.
std::vector<std::pair<int, int>> named_support(const std::string& word) {
  if (word == "ENCASTRE") return {{1, 6}};
  if (word == "PINNED") return {{1, 3}};
  if (word == "XSYMM") return {{1, 1}, {5, 6}};
  if (word == "YSYMM") return {{2, 2}, {4, 4}, {6, 6}};
  if (word == "ZSYMM") return {{3, 5}};
  if (word == "XASYMM") return {{2, 4}};
  if (word == "YASYMM") return {{1, 1}, {3, 3}, {5, 5}};
  if (word == "ZASYMM") return {{1, 2}, {6, 6}};
  return {};
}

/// Another load case than the first is not read.
bool other_case(InpReading& r) {
  const Card& card = r.card;
  const bool other = card.has("LOADCASE") && card.word("LOADCASE") != "1";
  if (other) r.skip(fmt::format("{}, LOADCASE={}", card.name, card.word("LOADCASE")));
  return other;
}

void read_supports(InpReading& r) {
  const Card& card = r.card;
  InpDeck& d = r.deck;
  Imported& in = r.in;
  if (const auto odd = unknown_param(card, {"OP", "AMPLITUDE", "TYPE", "FIXED", "LOADCASE"}); !odd.empty()) return r.skip(odd);
  if (card.has("FIXED") && r.step > 1)
    return r.skip("*BOUNDARY, FIXED, which keeps what steps before it have moved");  // so does its absence
  const std::string type = card.word("TYPE", "DISPLACEMENT");
  const int rate = type == "VELOCITY" ? 1 : type == "ACCELERATION" ? 2 : 0;
  if (rate == 0 && type != "DISPLACEMENT") return r.skip("*BOUNDARY, TYPE=" + type);
  if (other_case(r)) return;
  if (r.step > 1 && card.word("OP") == "NEW")
    d.steps.back().new_supports = true;
  else if (r.step == 1 && card.word("OP") == "NEW")
    d.supports.erase(d.supports.begin(), d.supports.begin() + static_cast<std::ptrdiff_t>(std::exchange(r.supports_before_step, 0)));
  const std::string amplitude = card.word("AMPLITUDE");
  for (DataLine l; r.lines.next_data(l);) {
    InpNodal b{target_of(l)};
    b.amplitude = amplitude, b.step = r.step, b.rate = rate;
    if (!l.is_integer(1)) {
      const auto pairs = named_support(upper(l.text(1)));
      if (pairs.empty()) throw Error(l.place(1), fmt::format("*BOUNDARY: expected a degree of freedom, found \"{}\"", l.text(1)));
      for (const auto& [first, last] : pairs) {
        b.first = first, b.last = last, b.value = 0;
        d.supports.push_back(b);
      }
      continue;
    }
    b.first = static_cast<int>(l.integer(1));
    b.last = l.empty(2) ? b.first : static_cast<int>(l.integer(2));
    b.value = l.number(3);
    b.last = std::min(b.last, 6);
    if (b.first < 1 || b.first > 6)
      in.skip(fmt::format("*BOUNDARY on degree of freedom {}", b.first), b.place);
    else
      d.supports.push_back(b);
  }
}

/// A value on a degree of freedom of a node or set, line by line.
void read_nodal(InpReading& r, std::vector<InpNodal>& into) {
  const Card& card = r.card;
  for (DataLine l; r.lines.next_data(l);) {
    InpNodal f{target_of(l)};
    f.amplitude = card.word("AMPLITUDE"), f.step = r.step;
    f.first = f.last = static_cast<int>(l.integer(1));
    f.value = l.number(2);
    if (f.first < 1 || f.first > 6)
      r.in.skip(fmt::format("{} on degree of freedom {}", card.name, f.first), f.place);
    else
      into.push_back(f);
  }
}

void read_forces(InpReading& r) {
  if (const auto odd = unknown_param(r.card, {"OP", "AMPLITUDE", "LOADCASE"}); !odd.empty()) return r.skip(odd);
  if (other_case(r)) return;
  if (r.step > 1 && r.card.word("OP") == "NEW") r.deck.steps.back().new_forces = true;
  read_nodal(r, r.deck.forces);
}

void read_initial(InpReading& r) {
  if (r.card.word("TYPE") != "VELOCITY") return r.skip("*INITIAL CONDITIONS, TYPE=" + r.card.word("TYPE"));
  read_nodal(r, r.deck.velocities);
}

void read_distributed(InpReading& r) {
  const Card& card = r.card;
  Imported& in = r.in;
  if (const auto odd = unknown_param(card, {"OP", "AMPLITUDE", "LOADCASE"}); !odd.empty()) return r.skip(odd);
  if (other_case(r)) return;
  const bool surface = card.key == "DSLOAD";
  if (r.step > 1 && card.word("OP") == "NEW") r.deck.steps.back().new_distributed = true;
  for (DataLine l; r.lines.next_data(l);) {
    const std::string label = upper(l.text(1));
    const double value = l.number(2);
    if (l.text(0).empty()) {  // Abaqus: no target means the whole model
      in.skip(fmt::format("{} without a set", card.name), l.place());
      continue;
    }
    InpDistributed p{target_of(l), 0, value, Vec3::Zero(), card.word("AMPLITUDE"), r.step};
    if (surface && label == "P")
      p.face = 0;
    else if (!surface && label == "GRAV") {
      p.face = -1;
      p.direction = l.vector(3);
      if (p.direction.norm() == 0) throw Error(l.place(3), "GRAV: the direction has no length");
      p.direction.normalize();
    } else if (!surface && label == "CENTRIF") {
      p.face = -2;
      p.at = l.vector(3);
      p.direction = l.vector(6);
      if (p.direction.norm() == 0) throw Error(l.place(6), "CENTRIF: the axis has no length");
      if (p.value < 0) throw Error(l.place(2), "CENTRIF: the square of a speed is below zero");
      p.direction.normalize();
    } else if (!surface && label.size() == 2 && label[0] == 'P' && label[1] >= '1' && label[1] <= '6')
      p.face = label[1] - '0';
    else if (!surface && label == "P")
      p.face = -3;
    else if (!surface && (label == "PX" || label == "PY" || label == "PZ"))
      p.face = -4, p.direction = Vec3::Unit(label[1] - 'X');
    else {
      in.skip(fmt::format("{} {}", card.name, label), p.place);
      continue;
    }
    r.deck.distributed.push_back(p);
  }
}

void read_transform(InpReading& r) {
  InpTransform t{{upper(r.card.need("NSET")), 0, r.card.place()}};
  const std::string type = r.card.word("TYPE", "R");
  t.cylindrical = type == "C", t.is_read = type == "R" || type == "C";
  DataLine l;
  if (r.lines.next_data(l)) t.a = l.vector(0), t.b = l.vector(3);
  r.deck.transformed.push_back(t);
}

void read_amplitude(InpReading& r) {
  const Card& card = r.card;
  if (const auto odd = unknown_param(card, {"NAME", "TIME", "VALUE", "DEFINITION"});
      !odd.empty() || (card.has("DEFINITION") && card.word("DEFINITION") != "TABULAR")) {
    r.skip(odd.empty() ? "*AMPLITUDE, DEFINITION=" + card.word("DEFINITION") : odd);
    return;
  }
  if (card.has("VALUE") && card.word("VALUE") != "RELATIVE") return r.skip("*AMPLITUDE, VALUE=" + card.word("VALUE"));
  const std::string name = card.need("NAME");
  auto& a = r.deck.amplitudes[upper(name)];
  if (!a.name.empty()) throw Error(card.place(), fmt::format("*AMPLITUDE {} is given twice", name), "give each a name of its own");
  a.name = name, a.total = card.word("TIME").starts_with("TOTAL");
  for (DataLine l; r.lines.next_data(l);)
    for (size_t i = 0; i < l.fields.size(); i += 2) {  // a last value that is not there is 0
      if (l.empty(i)) continue;
      const double t = l.number(i);
      if (!a.t.empty() && t < a.t.back())
        throw Error(l.place(i), fmt::format("*AMPLITUDE {}: time {:g} is before the one in front of it", name, t));
      a.t.push_back(t);
      a.value.push_back(l.number(i + 1));
    }
}

}  // namespace

std::vector<InpCard> inp_load_cards() {
  return {
      {"BOUNDARY", read_supports, false, true},  {"CLOAD", read_forces, false, true},       {"DLOAD", read_distributed, false, true},
      {"DSLOAD", read_distributed, false, true}, {"INITIALCONDITIONS", read_initial, true}, {"AMPLITUDE", read_amplitude},
      {"TRANSFORM", read_transform, true},
  };
}

}  // namespace hilo
