// SPDX-License-Identifier: GPL-3.0-or-later
// The cards of an .inp deck that divide it: heading, parts, steps and what a step computes.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "base/error.hpp"
#include "import/inp/card.hpp"

namespace hilo {
namespace {

void read_heading(InpReading& r) {
  DataLine l;
  if (r.lines.next_data(l) && r.deck.title.empty())
    for (size_t i = 0; i < l.fields.size(); ++i) r.deck.title += (i ? ", " : "") + std::string(l.text(i));
  r.skipped = true;  // further lines of it say nothing of the model
}

/// Lines "name = expression"; `#` begins a comment.
void read_parameter(InpReading& r) {
  std::string_view text;
  std::string place;
  while (r.lines.next_text(text, place)) {
    text = text.substr(0, text.find('#'));
    const size_t first = text.find_first_not_of(" \t");
    if (first == text.npos) continue;
    const size_t equals = text.find('=');
    if (equals == text.npos || equals == first) throw Error(place, "*PARAMETER: \"name = expression\" is expected");
    const std::string name(text.substr(first, text.find_last_not_of(" \t", equals - 1) + 1 - first));
    if (name.find_first_of(" ,<>()\"'") != name.npos) throw Error(place, fmt::format("*PARAMETER: \"{}\" is no name", name));
    const auto value = evaluate_parameter(text.substr(equals + 1), r.deck.parameters, place);
    r.deck.parameters[name] = value;
    r.lines.set(name, value.text());
  }
}

/// Its lines move it and turn it.
void place_instance(InpReading& r) {
  DataLine l;
  if (!r.lines.next_data(l)) return;
  InpDeck::Placed& p = r.deck.placed;
  p.by = l.vector(0);
  if (l.fields.size() > 3) throw Error(l.place(3), "*INSTANCE: three numbers move it, the next line turns it");
  if (!r.lines.next_data(l)) return;
  p.at = l.vector(0);
  const Vec3 axis = l.vector(3) - p.at;
  const double angle = l.number(6) * std::numbers::pi / 180;
  if (!(axis.norm() > 0)) throw Error(l.place(3), "*INSTANCE: the two points of its axis are one");
  p.turn = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

std::vector<std::string> names_of(const std::map<std::string, InpLines::Mark>& parts) {
  std::vector<std::string> names;
  for (const auto& [name, mark] : parts) names.push_back(name);
  return names;
}

[[noreturn]] void refuse_included(const InpReading& r, const char* what) {
  throw Error(r.card.place() + ":1", fmt::format("more than one {}, in included files, is not read", what),
              "write *PART and *INSTANCE into the deck itself");
}

/// A part that stands alone is read where it is; of several, each instance reads its part once more.
void read_part(InpReading& r) {
  if (!r.several && ++r.parts > 1) refuse_included(r, "*PART");
  r.card.find("NAME");
  if (!r.several) return;
  const std::string name = upper(r.card.need("NAME")), place = r.card.place();
  r.part_at.emplace(name, r.lines.mark());
  while (r.card.key != "ENDPART")
    if (!r.lines.next_card(r.card)) throw Error(place, "*PART without *END PART");
  r.lines.take_unread();  // by its instances
}
void end_part(InpReading& r) {
  if (!r.several) return;
  if (!r.in_part) throw Error(r.card.place() + ":1", "*END PART without *PART");
  r.in_part = false;
  r.lines.go_back();
}
void read_instance(InpReading& r) {
  InpDeck& d = r.deck;
  if (++r.instances > 1 && !r.several) refuse_included(r, "*INSTANCE");
  if (r.in_part) throw Error(r.card.place() + ":1", "*INSTANCE in a *PART");
  d.instance = r.card.value("NAME");
  d.in_assembly = false;  // what stands between it and its end is the part's
  d.placed = {}, d.first_node = d.X.size(), d.first_section = d.sections.size(), d.first_transform = d.transformed.size();
  const auto part = r.part_at.find(r.card.word("PART"));
  if (r.several) {
    r.card.need("NAME");
    if (part == r.part_at.end())
      throw Error(r.card.place("PART"), fmt::format("*INSTANCE of part \"{}\", which is not there", r.card.value("PART")),
                  suggest(r.card.word("PART"), names_of(r.part_at)));
    if (r.instances >= assembly_numbers / instance_numbers) throw Error(r.card.place(), "too many *INSTANCE");
    d.shift = r.instances * instance_numbers, d.prefix = d.instance + ".";
    if (!d.shift_of.emplace(upper(d.instance), d.shift).second)
      throw Error(r.card.place("NAME"), fmt::format("*INSTANCE {} is given twice", d.instance), "give each a name of its own");
  }
  place_instance(r);
  if (r.several) r.lines.read_again(part->second), r.in_part = true;
}

/// What follows is of the assembly.
void read_assembly(InpReading& r) {
  r.deck.in_assembly = true;
  r.card.find("NAME");
  for (const auto& [key, set] : r.deck.nset) r.deck.part_nsets.insert(key);
  for (const auto& [key, set] : r.deck.elset) r.deck.part_elsets.insert(key);
}

/// The part as it stands in the assembly: moved, then turned; its directions with it.
void end_instance(InpReading& r) {
  InpDeck& d = r.deck;
  const InpDeck::Placed& p = d.placed;
  for (size_t a = r.several ? d.first_node : 0; a < d.X.size(); ++a)
    if (d.node_id[a] < assembly_numbers) d.X[a] = p.at + p.turn * (d.X[a] + p.by - p.at);
  for (auto& [name, o] : d.orientations)
    if (name.starts_with(upper(d.prefix))) o.a = p.turn * o.a, o.b = p.turn * o.b;
  for (size_t s = r.several ? d.first_section : 0; s < d.sections.size(); ++s) d.sections[s].n1 = p.turn * d.sections[s].n1;
  for (size_t t = r.several ? d.first_transform : 0; t < d.transformed.size(); ++t) {  // two directions, or two points of an axis
    InpTransform& of = d.transformed[t];
    for (Vec3* x : {&of.a, &of.b}) *x = of.cylindrical ? Vec3(p.at + p.turn * (*x + p.by - p.at)) : Vec3(p.turn * *x);
  }
  d.shift = 0, d.prefix.clear();
  read_assembly(r);
}

void read_step(InpReading& r) {
  r.supports_before_step = r.deck.supports.size();
  ++r.step;
  for (const char* of_no_effect : {"INC", "NAME", "UNSYMM", "EXTRAPOLATION", "CONVERTSDI", "SOLVER"}) r.card.find(of_no_effect);
  InpStep& s = r.deck.steps.emplace_back();
  s.place = r.card.place(), s.nlgeom = r.card.has("NLGEOM") && r.card.word("NLGEOM") != "NO", s.perturbation = r.card.has("PERTURBATION");
  if (r.card.has("AMPLITUDE")) s.ramps = r.card.word("AMPLITUDE") != "STEP", s.ramps_said = true;
}

/// *STATIC, *DYNAMIC and *FREQUENCY become scene lines.
void read_procedure(InpReading& r) {
  InpStep& s = step_of(r);
  s.procedure = r.card.name;
  if (!s.ramps_said) s.ramps = r.card.key == "STATIC";
  DataLine l;
  if (r.lines.next_data(l)) s.increment = l.number(0), s.end = l.number(1), l.ignore_rest();
  s.direct = r.card.has("DIRECT") || r.card.has("EXPLICIT");
  r.card.find("SOLVER");  // of no effect here
}
/// How many modes or shapes, the lowest ones; the accuracy of the search is ours.
void read_modes(InpReading& r) {
  const bool frequency = r.card.key == "FREQUENCY";
  step_of(r).procedure = r.card.name;
  for (const char* of_no_effect : {"SOLVER", "EIGENSOLVER"}) r.card.find(of_no_effect);
  if (frequency) r.card.find("STORAGE"), r.card.find("NORMALIZATION");
  DataLine l;
  if (!r.lines.next_data(l)) return;
  step_of(r).n_modes = static_cast<int>(std::clamp(l.number(0), 0.0, 1000.0));
  if (frequency && (l.number(1) != 0 || l.number(2) != 0))
    r.in.skip("*FREQUENCY: its limits (the lowest modes are looked for)", l.place(l.number(1) != 0 ? 1 : 2));
  if (frequency && l.number(3) != 0) r.in.skip("*FREQUENCY: its fourth number (it scales masses, or is a shift)", l.place(3));
  l.ignore_rest();
}
void other_procedure(InpReading& r) {
  step_of(r).procedure = r.card.name;
  if (r.step < 2) r.skip(r.card.name);
  r.skipped = true;
}
void end_assembly(InpReading& r) { r.deck.in_assembly = false; }
void nothing(InpReading&) {}

}  // namespace

InpStep& step_of(InpReading& r) {
  if (r.deck.steps.empty()) r.deck.steps.emplace_back();
  return r.deck.steps.back();
}

std::vector<InpCard> inp_step_cards() {
  std::vector<InpCard> cards{
      {"HEADING", read_heading},
      {"PARAMETER", read_parameter},
      {"PART", read_part},
      {"ENDPART", end_part},
      {"ASSEMBLY", read_assembly},
      {"ENDASSEMBLY", end_assembly},
      {"INSTANCE", read_instance},
      {"ENDINSTANCE", end_instance},
      {"STEP", read_step},
      {"ENDSTEP", nothing},
      {"STATIC", read_procedure, false, true},
      {"DYNAMIC", read_procedure, false, true},
      {"FREQUENCY", read_modes, false, true},
      {"BUCKLE", read_modes, false, true},
  };
  for (const char* name : {"COMPLEXFREQUENCY", "HEATTRANSFER", "VISCO", "COUPLEDTEMPERATURE-DISPLACEMENT",
                           "UNCOUPLEDTEMPERATURE-DISPLACEMENT", "CFD", "ELECTROMAGNETICS", "SENSITIVITY", "GREEN", "NOANALYSIS",
                           "SUBSTRUCTUREGENERATE", "GEOSTATIC", "RANDOMRESPONSE", "CRACKPROPAGATION", "ROBUSTDESIGN", "FEASIBLEDIRECTION"})
    cards.push_back({name, other_procedure, false, true});
  return cards;
}

}  // namespace hilo
