// SPDX-License-Identifier: GPL-3.0-or-later
// Histories of a run: which there are, what their columns are called, and their values.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "post/run/run_beams.hpp"
#include "post/run/run_file.hpp"

namespace hilo {
namespace {

/// Columns of the histories in a group, as docs/format.md has them.
struct Layout {
  std::string_view group;
  std::vector<std::string> column, unit;
};

const std::vector<Layout>& layouts() {
  static const std::vector<std::string> wrench{"Fx", "Fy", "Fz", "Mx", "My", "Mz"}, newtons{"N", "N", "N", "N m", "N m", "N m"};
  static const std::vector<Layout> table = {
      {"joint", wrench, newtons},
      {"coordinate", {"slide", "angle"}, {"m", "rad"}},
      {"spring", wrench, newtons},
      {"stop", wrench, newtons},
      {"motor", wrench, newtons},
      {"friction", wrench, newtons},
      {"motion", wrench, newtons},
      {"tie", wrench, newtons},
      {"energy", {"kinetic", "elastic", "gravity", "external_work", "dissipated", "balance"}, {"J", "J", "J", "J", "J", "J"}},
      {"momentum", {"px", "py", "pz", "Lx", "Ly", "Lz"}, {"kg m/s", "kg m/s", "kg m/s", "kg m^2/s", "kg m^2/s", "kg m^2/s"}},
      {"sensor", {"x", "y", "z"}, {"g", "g", "g"}},
      {"probe", {"x", "y", "z", "vx", "vy", "vz", "ax", "ay", "az"}, {"m", "m", "m", "m/s", "m/s", "m/s", "m/s^2", "m/s^2", "m/s^2"}},
      {"body",
       {"x0", "y0", "z0", "x1", "y1", "z1", "x2", "y2", "z2", "x3", "y3", "z3"},
       {"m", "m", "m", "m", "m", "m", "m", "m", "m", "m", "m", "m"}},
      {"mode",
       {"frequency", "damping", "mass_x", "mass_y", "mass_z", "inertia_x", "inertia_y", "inertia_z", "error", "amplitude"},
       {"Hz", "1", "kg", "kg", "kg", "kg m^2", "kg m^2", "kg m^2", "1", "m kg^0.5"}},
      {"participation",
       {"x", "y", "z", "about_x", "about_y", "about_z"},
       {"kg^0.5", "kg^0.5", "kg^0.5", "kg^0.5 m", "kg^0.5 m", "kg^0.5 m"}},
      {"contact",
       {"Fx", "Fy", "Fz", "depth", "share_of_cell", "slip", "friction_work", "pressing"},
       {"N", "N", "N", "m", "1", "m", "J", "N"}},
      {"heap", {"pairs", "depth", "share_of_radius", "slip", "friction_work", "force"}, {"1", "m", "1", "m", "J", "N"}},
      {"buckling", {"factor", "error"}, {"1", "1"}},
      {"path", {"load", "rise", "negative_eigenvalues"}, {"1", "1", "1"}},
      {"mode_stiffness", {"omega2"}, {"1/s^2"}},
      {"mode_load", {"force"}, {"N kg^-0.5"}},
      {"left_out", {"strain", "left_out"}, {"J", "J"}},
      {"second_order", {"quadratic", "buckling", "growth"}, {"J", "1", "1"}},
      {"constraint", {"violation"}, {"m"}},
      {"newton", {"iterations"}, {"1"}},
  };
  return table;
}

/// "joint.trunnion" is stored at /history/joint/trunnion; the first dot alone divides.
std::string array_of(const std::string& name) {
  const auto dot = name.find('.');
  return "/history/" + (dot == std::string::npos ? name : name.substr(0, dot) + "/" + to_link_name(name.substr(dot + 1)));
}

/// At both ends of each cell, forces and moments.
void name_beam_columns(Series& s, size_t columns) {
  constexpr std::pair<const char*, const char*> of[] = {{"V1", "N"}, {"V2", "N"}, {"N", "N"}, {"M1", "N m"}, {"M2", "N m"}, {"T", "N m"}};
  for (size_t c = 0; c < columns; ++c)
    s.column.push_back(fmt::format("cell{}.{}.{}", c / 12, c % 12 < 6 ? "a" : "b", of[c % 6].first)), s.unit.emplace_back(of[c % 6].second);
}

}  // namespace

const std::vector<RunBeam>& RunFile::beams() const {
  if (beams_) return *beams_;
  std::vector<RunBeam> found;
  try {
    found = beams_of(*this);
  } catch (const Error&) {  // kinds of a program outside this tree: its histories are there all the same
  }
  beams_ = std::make_shared<const std::vector<RunBeam>>(std::move(found));
  return *beams_;
}

const RunBeam* RunFile::stressed_beam(const std::string& series) const {
  constexpr std::string_view group = "beam_stress.";
  if (!series.starts_with(group)) return nullptr;
  for (const RunBeam& b : beams())
    if (b.has_stress() && b.name == series.substr(group.size())) return &b;
  return nullptr;
}

std::vector<std::string> RunFile::series_names() const {
  std::vector<std::string> names;
  for (const std::string& item : store_->list("/history")) {
    if (item == "t") continue;
    const auto members = store_->list("/history/" + item);  // of an array: none
    for (const std::string& member : members) names.push_back(item + "." + from_link_name(member));
    if (members.empty() && !store_->shape("/history/" + item).empty()) names.push_back(item);
    if (item == "beam")
      for (const RunBeam& b : beams())
        if (b.has_stress()) names.push_back("beam_stress." + b.name);
  }
  return names;
}

Series RunFile::describe(const std::string& name) const {
  if (const RunBeam* beam = stressed_beam(name)) return described_beam_stress(*beam);
  const auto dot = name.find('.');  // with one, no list of thousands is asked
  if (dot == std::string::npos || dot + 1 == name.size() || !store_->has(array_of(name))) {
    const auto names = series_names();
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw Error(path, fmt::format("no history \"{}\"", name), suggest(name, names));
  }
  Series s;
  s.name = name;
  const auto shape = store_->shape(array_of(name));
  const size_t columns = shape.size() > 1 ? static_cast<size_t>(shape[1]) : 1;
  const std::string group = name.substr(0, name.find('.'));
  for (const Layout& layout : layouts())
    if (layout.group == group && layout.column.size() == columns) s.column = layout.column, s.unit = layout.unit;
  if (group == "beam" && columns % 12 == 0) name_beam_columns(s, columns);
  if (s.column.empty()) {
    const std::string unit = store_->text_attribute(array_of(name), "unit").value_or("");
    for (size_t c = 0; c < columns; ++c) s.column.push_back(columns == 1 ? "value" : std::to_string(c)), s.unit.push_back(unit);
  }
  return s;
}

Series RunFile::series(const std::string& name) const {
  Series s = describe(name);
  if (const RunBeam* beam = stressed_beam(name)) {
    const Series forces = series("beam." + beam->name);
    s.t = forces.t, s.value = beam_stress(*beam, forces);
    return s;
  }
  const std::string array = array_of(name);
  s.value = store_->read<double>(array);
  s.t = store_->read<double>(store_->text_attribute(array, "time").value_or("/history/t"));
  // The arrays of a run in progress may differ by the row being written.
  const size_t rows = std::min(s.t.size(), s.value.size() / s.column.size());
  s.t.resize(rows);
  s.value.resize(rows * s.column.size());
  return s;
}

}  // namespace hilo
