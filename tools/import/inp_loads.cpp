// The cards of an .inp deck that say materials, supports and loads.
#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

#include "base/error.hpp"
#include "import/inp_deck.hpp"

namespace hilo {
namespace {

/// The first parameter that is not among those known, as "*CLOAD, SECTOR"; "" when all are.
std::string unknown_param(const Card& card, std::initializer_list<const char*> known) {
  for (const auto& [key, p] : card.params)
    if (std::find_if(known.begin(), known.end(), [&](const char* k) { return key == k; }) == known.end())
      return fmt::format("{}, {}{}", card.name, key, p.value.empty() ? "" : "=" + p.value);
  return "";
}

/// Target of a line: a number or the name of a set.
void target_of(const DataLine& l, std::string& target, std::int64_t& id) {
  id = 0;
  target.clear();
  if (l.is_integer(0)) {
    id = l.integer(0);
    return;
  }
  std::string_view text = l.text(0);
  if (text.size() > 1 && text.front() == '"') text = text.substr(1, text.size() - 2);
  target = upper(text);
  if (target.empty()) throw Error(l.place(0), "expected a number or the name of a set");
}

/// Abaqus names for supports of solids: the held translations as first, last pairs.
std::vector<std::pair<int, int>> named_support(const std::string& word) {
  if (word == "ENCASTRE" || word == "PINNED") return {{1, 3}};
  if (word == "XSYMM") return {{1, 1}};
  if (word == "YSYMM") return {{2, 2}};
  if (word == "ZSYMM") return {{3, 3}};
  if (word == "XASYMM") return {{2, 3}};
  if (word == "YASYMM") return {{1, 1}, {3, 3}};
  if (word == "ZASYMM") return {{1, 2}};
  return {};
}

void read_supports(const Card& card, InpLines& lines, InpDeck& d, Imported& in) {
  const std::string amplitude = card.word("AMPLITUDE");
  DataLine l;
  while (lines.next_data(l)) {
    InpNodal b;
    b.amplitude = amplitude;
    b.place = l.place();
    target_of(l, b.target, b.id);
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
    if (b.first > 3) {
      if (b.first > 6) in.skip(fmt::format("*BOUNDARY on degree of freedom {}", b.first), b.place);
      continue;  // rotations: the nodes of solids have none
    }
    if (b.first < 1) {
      in.skip(fmt::format("*BOUNDARY on degree of freedom {}", b.first), b.place);
      continue;
    }
    b.last = std::min(b.last, 3);
    d.supports.push_back(b);
  }
}

/// *CLOAD and *INITIAL CONDITIONS, TYPE=VELOCITY.
void read_nodal(const Card& card, InpLines& lines, std::vector<InpNodal>& into, Imported& in) {
  DataLine l;
  while (lines.next_data(l)) {
    InpNodal f;
    f.amplitude = card.word("AMPLITUDE");
    f.place = l.place();
    target_of(l, f.target, f.id);
    f.first = f.last = static_cast<int>(l.integer(1));
    f.value = l.number(2);
    if (f.first < 1 || f.first > 3)
      in.skip(fmt::format("{} on degree of freedom {}", card.name, f.first), f.place);
    else
      into.push_back(f);
  }
}

void read_distributed(const Card& card, InpLines& lines, InpDeck& d, Imported& in) {
  const bool surface = card.key == "DSLOAD";
  DataLine l;
  while (lines.next_data(l)) {
    const std::string label = upper(l.text(1));
    InpDistributed p{"", 0, 0, l.number(2), Vec3::Zero(), card.word("AMPLITUDE"), l.place()};
    if (l.text(0).empty()) {  // Abaqus: no target means the whole model
      in.skip(fmt::format("{} without a set", card.name), p.place);
      continue;
    }
    target_of(l, p.target, p.id);
    if (surface && label == "P")
      p.face = 0;
    else if (!surface && label == "GRAV") {
      p.face = -1;
      p.direction = Vec3(l.number(3), l.number(4), l.number(5));
      if (p.direction.norm() == 0) throw Error(l.place(3), "GRAV: the direction has no length");
      p.direction.normalize();
    } else if (!surface && label.size() == 2 && label[0] == 'P' && label[1] >= '1' && label[1] <= '6')
      p.face = label[1] - '0';
    else {
      in.skip(fmt::format("{} {}", card.name, label), p.place);
      continue;
    }
    d.distributed.push_back(p);
  }
}

void read_amplitude(const Card& card, InpLines& lines, InpDeck& d, Imported& in) {
  if (const auto odd = unknown_param(card, {"NAME", "TIME", "VALUE", "DEFINITION"});
      !odd.empty() || (card.has("DEFINITION") && card.word("DEFINITION") != "TABULAR")) {
    in.skip(odd.empty() ? "*AMPLITUDE, DEFINITION=" + card.word("DEFINITION") : odd, card.place());
    return;
  }
  const std::string name = card.need("NAME");
  auto& a = d.amplitudes[upper(name)];
  a.name = name;
  DataLine l;
  while (lines.next_data(l))
    for (size_t i = 0; i + 1 < l.fields.size(); i += 2) {
      if (l.empty(i)) continue;
      const double t = l.number(i);
      if (!a.t.empty() && t < a.t.back())
        throw Error(l.place(i), fmt::format("*AMPLITUDE {}: time {:g} is before the one in front of it", name, t));
      a.t.push_back(t);
      a.value.push_back(l.number(i + 1));
    }
}

}  // namespace

bool parse_material_card(const Card& card, InpLines& lines, InpDeck& d, Imported& in) {
  DataLine l;
  const auto one = [&](const char* what) {
    if (!lines.next_data(l)) throw Error(card.place() + ":1", fmt::format("{} lacks its data line", card.name), what);
    if (d.material.empty()) throw Error(card.place() + ":1", fmt::format("{} stands before any *MATERIAL", card.name));
  };
  if (card.key == "MATERIAL") {
    const std::string name = card.need("NAME");
    d.material = upper(name);
    d.materials[d.material].name = name;
  } else if (card.key == "ELASTIC") {
    const std::string type = card.has("TYPE") ? card.word("TYPE") : "ISO";
    if (type.substr(0, 3) != "ISO") {
      in.skip("*ELASTIC, TYPE=" + type, card.place());
      return true;
    }
    one("Young's modulus, Poisson's ratio");
    auto& m = d.materials[d.material];
    m.data.E = l.number(0);
    m.data.nu = l.number(1);
    if (!(m.data.E > 0)) throw Error(l.place(0), fmt::format("material {}: Young's modulus {:g} is not positive", m.name, m.data.E));
    if (!(m.data.nu > -1 && m.data.nu < 0.5))
      throw Error(l.place(1), fmt::format("material {}: Poisson's ratio {:g} is not in (-1, 0.5)", m.name, m.data.nu));
    while (lines.next_data(l)) in.skip("*ELASTIC at further temperatures", l.place());
  } else if (card.key == "DENSITY") {
    one("mass per volume");
    auto& m = d.materials[d.material];
    m.data.density = l.number(0);
    if (!(m.data.density > 0)) throw Error(l.place(0), fmt::format("material {}: density {:g} is not positive", m.name, m.data.density));
    while (lines.next_data(l)) in.skip("*DENSITY at further temperatures", l.place());
  } else if (card.key == "SOLIDSECTION") {
    InpSection s{upper(card.need("ELSET")), upper(card.need("MATERIAL")), card.need("ELSET"),
                 card.need("MATERIAL"),     card.place("ELSET"),          card.place("MATERIAL")};
    if (card.has("ORIENTATION")) in.skip("*SOLID SECTION, ORIENTATION", card.place());
    if (lines.next_data(l)) s.area = l.number(0);
    d.sections.push_back(s);
  } else
    return false;
  return true;
}

bool parse_load_card(const Card& card, InpLines& lines, InpDeck& d, Imported& in, bool in_step) {
  const auto skip = [&](const std::string& what) {
    in.skip(what, card.place());
    return true;
  };
  // OP=NEW forgets what was said before the step
  const bool afresh = in_step && card.word("OP") == "NEW";
  if (card.key == "BOUNDARY") {
    if (const auto odd = unknown_param(card, {"OP", "AMPLITUDE", "TYPE", "FIXED", "LOADCASE"}); !odd.empty()) return skip(odd);
    if (card.has("TYPE") && card.word("TYPE") != "DISPLACEMENT") return skip("*BOUNDARY, TYPE=" + card.word("TYPE"));
    if (card.has("LOADCASE") && card.word("LOADCASE") != "1") return skip("*BOUNDARY, LOADCASE=" + card.word("LOADCASE"));
    if (afresh) d.supports.clear();
    read_supports(card, lines, d, in);
  } else if (card.key == "CLOAD") {
    if (const auto odd = unknown_param(card, {"OP", "AMPLITUDE", "LOADCASE"}); !odd.empty()) return skip(odd);
    if (card.has("LOADCASE") && card.word("LOADCASE") != "1") return skip("*CLOAD, LOADCASE=" + card.word("LOADCASE"));
    read_nodal(card, lines, d.forces, in);
  } else if (card.key == "DLOAD" || card.key == "DSLOAD") {
    if (const auto odd = unknown_param(card, {"OP", "AMPLITUDE", "LOADCASE"}); !odd.empty()) return skip(odd);
    if (card.has("LOADCASE") && card.word("LOADCASE") != "1") return skip("*DLOAD, LOADCASE=" + card.word("LOADCASE"));
    read_distributed(card, lines, d, in);
  } else if (card.key == "INITIALCONDITIONS" && card.word("TYPE") == "VELOCITY")
    read_nodal(card, lines, d.velocities, in);
  else if (card.key == "INITIALCONDITIONS")
    return skip("*INITIAL CONDITIONS, TYPE=" + card.word("TYPE"));
  else if (card.key == "AMPLITUDE")
    read_amplitude(card, lines, d, in);
  else if (card.key == "TRANSFORM")
    d.transformed.push_back(card.has("NSET") ? card.word("NSET") : "");
  else
    return false;
  return true;
}

}  // namespace hilo
