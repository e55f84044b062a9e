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
}

// Abaqus parts: one of them is read as if flat, more would need their numbers told apart.
[[noreturn]] void refuse_step(const InpReading& r, const std::string& what) {
  throw Error(r.card.place() + ":1", what + " is not read",
              "write a flat deck: in Abaqus/CAE \"Do not use parts and assemblies in input files\"");
}
void read_part(InpReading& r) {
  if (++r.parts > 1) refuse_step(r, "more than one *PART");
}
void read_instance(InpReading& r) {
  if (++r.instances > 1) refuse_step(r, "more than one *INSTANCE");
  r.deck.instance = r.card.value("NAME");
  r.deck.in_assembly = false;  // what stands between it and its end is the part's
  DataLine l;
  if (!r.lines.next_data(l)) return;
  InpDeck::Placed& p = r.deck.placed;
  p.by = Vec3(l.number(0), l.number(1), l.number(2));
  if (l.fields.size() > 3 || !r.lines.next_data(l)) {
    if (l.fields.size() > 3) throw Error(l.place(3), "*INSTANCE: three numbers move it, the next line turns it");
    return;
  }
  p.at = Vec3(l.number(0), l.number(1), l.number(2));
  const Vec3 axis = Vec3(l.number(3), l.number(4), l.number(5)) - p.at;
  const double angle = l.number(6) * std::numbers::pi / 180;
  if (!(axis.norm() > 0)) throw Error(l.place(3), "*INSTANCE: the two points of its axis are one");
  p.turn = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

/// What follows is of the assembly.
void read_assembly(InpReading& r) {
  r.deck.in_assembly = true;
  for (const auto& [key, set] : r.deck.nset) r.deck.part_nsets.insert(key);
  for (const auto& [key, set] : r.deck.elset) r.deck.part_elsets.insert(key);
}

/// The part as it stands in the assembly: moved, then turned; its directions with it.
void end_instance(InpReading& r) {
  InpDeck& d = r.deck;
  const InpDeck::Placed& p = d.placed;
  for (size_t a = 0; a < d.X.size(); ++a)
    if (d.node_id[a] < assembly_numbers) d.X[a] = p.at + p.turn * (d.X[a] + p.by - p.at);
  for (auto& [name, o] : d.orientations) o.a = p.turn * o.a, o.b = p.turn * o.b;
  for (InpSection& s : d.sections) s.n1 = p.turn * s.n1;
  read_assembly(r);
}

void read_step(InpReading& r) {
  r.supports_before_step = r.deck.supports.size();
  if (++r.step == 2) r.in.notes.push_back(fmt::format("{}: only the first step becomes scene lines", r.card.place()));
}

/// *STATIC, *DYNAMIC and *FREQUENCY become scene lines.
void read_procedure(InpReading& r) {
  r.deck.procedure = r.card.name;
  DataLine l;
  if (r.lines.next_data(l)) r.deck.step_increment = l.number(0), r.deck.step_end = l.number(1);
  r.deck.direct = r.card.has("DIRECT") || r.card.has("EXPLICIT");
  for (const auto& [key, p] : r.card.params)
    if (key != "DIRECT" && key != "EXPLICIT" && key != "SOLVER") r.skip(fmt::format("{}, {}", r.card.name, key));
}
/// How many modes; a band of frequencies is not asked for.
void read_frequency(InpReading& r) {
  r.deck.procedure = r.card.name;
  DataLine l;
  if (r.lines.next_data(l)) r.deck.n_modes = static_cast<int>(std::clamp(l.number(0), 0.0, 1000.0));
}
void other_procedure(InpReading& r) {
  r.deck.procedure = r.card.name;
  r.skip(r.card.name);
}
void end_assembly(InpReading& r) { r.deck.in_assembly = false; }
void nothing(InpReading&) {}

}  // namespace

std::span<const InpCard> inp_step_cards() {
  static constexpr InpCard cards[] = {
      {"HEADING", read_heading},
      {"PART", read_part},
      {"ENDPART", nothing},
      {"ASSEMBLY", read_assembly},
      {"ENDASSEMBLY", end_assembly},
      {"INSTANCE", read_instance},
      {"ENDINSTANCE", end_instance},
      {"STEP", read_step},
      {"ENDSTEP", nothing},
      {"STATIC", read_procedure, true},
      {"DYNAMIC", read_procedure, true},
      {"FREQUENCY", read_frequency, true},
      {"COMPLEXFREQUENCY", other_procedure, true},
      {"BUCKLE", other_procedure, true},
      {"HEATTRANSFER", other_procedure, true},
      {"MODALDYNAMIC", other_procedure, true},
      {"STEADYSTATEDYNAMICS", other_procedure, true},
      {"VISCO", other_procedure, true},
      {"COUPLEDTEMPERATURE-DISPLACEMENT", other_procedure, true},
      {"UNCOUPLEDTEMPERATURE-DISPLACEMENT", other_procedure, true},
      {"CFD", other_procedure, true},
      {"ELECTROMAGNETICS", other_procedure, true},
      {"SENSITIVITY", other_procedure, true},
      {"GREEN", other_procedure, true},
      {"NOANALYSIS", other_procedure, true},
      {"SUBSTRUCTUREGENERATE", other_procedure, true},
      {"GEOSTATIC", other_procedure, true},
      {"RANDOMRESPONSE", other_procedure, true},
      {"CRACKPROPAGATION", other_procedure, true},
      {"ROBUSTDESIGN", other_procedure, true},
      {"FEASIBLEDIRECTION", other_procedure, true},
  };
  return cards;
}

}  // namespace hilo
