// SPDX-License-Identifier: GPL-3.0-or-later
// The cards of an .inp deck that tie nodes together: *COUPLING, *RIGID BODY, *MPC, *TIE, and the values of elements of points: *MASS,
// *SPRING, *DASHPOT.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "base/error.hpp"
#include "import/inp/card.hpp"

namespace hilo {
namespace {

/// A node by its number or by the name of a set, which must hold one.
InpTarget target_in(const InpReading& r, const std::string& key) {
  const Card& card = r.card;
  const std::string value = card.need(key);
  InpTarget t{upper(value), 0, card.place(key)};
  if (!t.target.empty() && t.target.size() < 18 && t.target.find_first_not_of("0123456789") == std::string::npos)
    t.id = std::stoll(t.target) + r.deck.node_shift(), t.target.clear();
  return t;
}

/// A node or set of a field.
InpTarget target_of_field(const InpReading& r, const DataLine& l, size_t i) {
  const bool number = l.is_integer(i);
  return {number ? "" : upper(r.deck.prefix) + upper(l.text(i)), number ? l.integer(i) + r.deck.node_shift() : 0, l.place(i)};
}

/// Kinematic or distributing, as the card behind it says.
void read_coupling(InpReading& r) {
  InpTie t;
  t.name = r.card.name, t.place = r.card.place();
  t.of = upper(r.card.need("SURFACE")), t.kind = InpTie::Of::surface;
  t.reference = target_in(r, "REFNODE");
  t.undecided = true;
  if (const auto odd = unknown_param(r.card, {"CONSTRAINTNAME", "REFNODE", "SURFACE", "ORIENTATION"}); !odd.empty())
    r.skip(odd), t.left_out = true;
  t.own_axes = r.card.has("ORIENTATION");
  r.deck.ties.push_back(t);
}
void read_coupling_kind(InpReading& r) {
  if (r.deck.ties.empty() || !r.deck.ties.back().undecided)
    throw Error(r.card.place() + ":1", fmt::format("{} follows no *COUPLING", r.card.name));
  InpTie& t = r.deck.ties.back();
  t.undecided = false, t.mean = r.card.key == "DISTRIBUTING";
  bool any = false;
  for (DataLine l; r.lines.next_data(l);) {
    const auto first = l.integer(0), last = l.integer(1, first);
    if (first < 1 || last < first || last > 6)
      throw Error(l.place(0), fmt::format("{}: no degrees of freedom {} to {}", r.card.name, first, last));
    for (auto k = first; k <= last; ++k) t.components |= 1u << (k - 1);
    any = true;
  }
  if (!any) t.components = 63;
}

void read_rigid_body(InpReading& r) {
  InpTie t;
  t.name = r.card.name, t.place = r.card.place(), t.components = 63;
  for (const auto& [key, kind] : {std::pair{"NSET", InpTie::Of::nodes}, {"TIENSET", InpTie::Of::nodes}, {"ELSET", InpTie::Of::cells}})
    if (r.card.has(key)) {
      if (!t.of.empty()) return r.skip("*RIGID BODY of several sets");
      t.of = upper(r.card.need(key)), t.kind = kind;
    }
  if (const auto odd = unknown_param(r.card, {"NSET", "TIENSET", "ELSET", "REFNODE", "ROTNODE"}); !odd.empty() || t.of.empty())
    return r.skip(odd.empty() ? "*RIGID BODY without a set" : odd);
  if (r.card.has("REFNODE"))
    t.reference = target_in(r, "REFNODE");
  else if (r.card.has("ROTNODE"))
    return r.skip("*RIGID BODY with ROT NODE and without REF NODE");
  else
    t.no_node = true;
  if (r.card.has("ROTNODE")) t.turns = target_in(r, "ROTNODE");
  r.deck.ties.push_back(t);
}

/// A DCOUP3D is the mean of nodes, with weights.
void read_distributing(InpReading& r) {
  if (const auto odd = unknown_param(r.card, {"ELSET"}); !odd.empty()) return r.skip(odd);
  InpTie t;
  t.name = r.card.name, t.place = r.card.place(), t.kind = InpTie::Of::weighted, t.mean = true, t.components = 63;
  t.reference = {upper(r.card.need("ELSET")), 0, r.card.place("ELSET")};
  for (DataLine l; r.lines.next_data(l);) {
    const InpTarget of = target_of_field(r, l, 0);
    const double w = l.number(1, 1);
    if (!(w > 0)) throw Error(l.place(1), fmt::format("{}: a weight of {:g}", t.name, w), "one above zero");
    t.weights.emplace_back(of, w);
  }
  if (t.weights.empty()) return r.skip(t.name + " of no node");
  r.deck.ties.push_back(t);
}

/// Rows of the model stand before its steps and have no parameters; others are told.
bool tell_odd_rows(InpReading& r) {
  const auto odd = unknown_param(r.card, {});
  if (odd.empty() && r.step == 0) return false;
  const std::string what = odd.empty() ? r.card.name : odd;
  r.skip(r.step > 0 ? what + " in a step" : what);
  if (r.step > 0) r.deck.steps.back().not_read = what;
  return true;
}

/// How many terms; and then node or set, component and factor of each, on as many lines as they need.
void read_equation(InpReading& r) {
  if (tell_odd_rows(r)) return;
  for (DataLine l; r.lines.next_data(l);) {
    InpEquation e{{}, l.place()};
    const auto n = l.integer(0);
    if (n < 1 || n > 1'000'000) throw Error(l.place(0), fmt::format("*EQUATION of {} terms", n));
    while (e.terms.size() < static_cast<size_t>(n)) {
      if (!r.lines.next_data(l)) throw Error(e.place, fmt::format("*EQUATION has {} of its {} terms", e.terms.size(), n));
      for (size_t i = 0; i < l.fields.size() && e.terms.size() < static_cast<size_t>(n); i += 3) {
        e.terms.push_back({target_of_field(r, l, i), static_cast<int>(l.integer(i + 1)), l.number(i + 2)});
      }
    }
    r.deck.equations.push_back(std::move(e));
  }
}

/// A kind, and then nodes or sets, on as many lines as they need: a line that begins with a number goes on with the last kind.
void read_mpc(InpReading& r) {
  if (tell_odd_rows(r)) return;
  InpMpc* last = nullptr;  // the one at hand, where it is read
  bool any = false;
  for (DataLine l; r.lines.next_data(l);) {
    size_t first = 0;
    if (!l.is_integer(0)) {
      InpMpc mpc{upper(l.text(0)), {}, l.place()};
      any = true, first = 1;
      if (mpc.kind == "BEAM" || mpc.kind == "LINK" || mpc.kind == "PLANE" || mpc.kind == "STRAIGHT")
        last = &r.deck.mpcs.emplace_back(std::move(mpc));
      else
        last = nullptr, r.skip("*MPC, " + mpc.kind.substr(0, 20));
    } else if (!any) {
      throw Error(l.place(0), fmt::format("*MPC: a kind is expected, found \"{}\"", l.text(0)), "PLANE, STRAIGHT or BEAM, and then nodes");
    }
    for (size_t i = first; i < l.fields.size() && last; ++i)
      if (!l.empty(i) && !(l.is_integer(i) && l.integer(i) == 0)) last->nodes.push_back(target_of_field(r, l, i));
  }
  if (!any) r.skip("*MPC of nothing");
}

/// Pairs of surfaces that stay together, the one whose nodes follow first.
void read_tie(InpReading& r) {
  if (const auto odd = unknown_param(r.card, {"NAME", "POSITIONTOLERANCE", "ADJUST", "TYPE"}); !odd.empty()) return r.skip(odd);
  double tolerance = -1;
  if (r.card.has("POSITIONTOLERANCE")) {
    const std::string text = r.card.need("POSITIONTOLERANCE");
    char* end = nullptr;
    tolerance = std::strtod(text.c_str(), &end);
    if (*end != 0 || !(tolerance >= 0)) throw Error(r.card.place("POSITIONTOLERANCE"), fmt::format("*TIE: \"{}\" is no tolerance", text));
  }
  bool any = false;
  for (DataLine l; r.lines.next_data(l);) {
    InpPair t;
    t.name = r.card.has("NAME") ? r.card.need("NAME") : "tie", t.place = l.place();
    t.slave = upper(l.text(0)), t.master = upper(l.text(1)), t.adjust = r.card.word("ADJUST") != "NO";
    t.tolerance = tolerance;
    if (t.slave.empty() || t.master.empty()) throw Error(l.place(0), "*TIE: two surfaces are expected", "SLAVE, MASTER");
    r.deck.tied.push_back(std::move(t));
    any = true;
  }
  if (!any) r.skip("*TIE of nothing");
}

/// The first number of a line; in front of it, for springs and dampers, a line with the degrees of freedom of SPRING1 and SPRING2.
void read_value(InpReading& r) {
  if (const auto odd = r.card.key == "MASS" ? unknown_param(r.card, {"ELSET"}) : unknown_param(r.card, {"ELSET", "NONLINEAR"});
      !odd.empty())
    return r.skip(odd);
  InpPointValue v{upper(r.card.need("ELSET")), r.card.name, r.card.place(), {}};
  for (DataLine l; r.lines.next_data(l);) {
    if (l.fields.empty()) continue;
    v.first.push_back(l.number(0)), v.second.push_back(l.number(1));
    v.more = false;  // of the last line
    v.table = r.card.has("NONLINEAR");
    for (size_t i = v.table ? 2 : 1; i < l.fields.size(); ++i) v.more = v.more || !l.empty(i);
  }
  r.deck.point_values.push_back(std::move(v));
}

}  // namespace

bool read_points(InpReading& r, const std::string& type) {
  static const std::map<std::string, size_t> kinds{{"MASS", 1},     {"SPRINGA", 2},  {"SPRING1", 1},  {"SPRING2", 2},
                                                   {"DASHPOTA", 2}, {"DASHPOT1", 1}, {"DASHPOT2", 2}, {"DCOUP3D", 1}};
  const auto kind = kinds.find(type);
  if (kind == kinds.end()) return false;
  InpSet* set = r.card.has("ELSET") ? &set_of_cells(r.card.need("ELSET"), r.deck) : nullptr;
  for (DataLine l; r.lines.next_data(l);) {
    InpPoint p{type, l.integer(0) + r.deck.shift, {}, l.place()};
    for (size_t i = 0; i < kind->second; ++i) p.nodes.push_back(l.integer(1 + i) + r.deck.node_shift());
    if (r.deck.cell.contains(p.id) || !r.deck.points.try_emplace(p.id, p).second)
      throw Error(l.place(0), fmt::format("element {} is given twice", p.id), "number each element once");
    if (set) set->members.push_back(p.id);
  }
  return true;
}

std::vector<InpCard> inp_tie_cards() {
  return {
      {"COUPLING", read_coupling},
      {"KINEMATIC", read_coupling_kind},
      {"DISTRIBUTING", read_coupling_kind},
      {"DISTRIBUTINGCOUPLING", read_distributing},
      {"EQUATION", read_equation},
      {"MPC", read_mpc},
      {"RIGIDBODY", read_rigid_body},
      {"TIE", read_tie},
      {"MASS", read_value},
      {"SPRING", read_value},
      {"DASHPOT", read_value},
  };
}

}  // namespace hilo
