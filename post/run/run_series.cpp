// SPDX-License-Identifier: GPL-3.0-or-later
// Histories of a run: which there are, what their columns are called, and their values.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
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
      {"contact", {"Fx", "Fy", "Fz", "depth", "share_of_cell", "slip", "friction_work"}, {"N", "N", "N", "m", "1", "m", "J"}},
      {"path", {"load", "rise", "negative_eigenvalues"}, {"1", "1", "1"}},
      {"mode_stiffness", {"omega2"}, {"1/s^2"}},
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

}  // namespace

std::vector<std::string> RunFile::series_names() const {
  std::vector<std::string> names;
  for (const std::string& item : store_->list("/history")) {
    if (item == "t") continue;
    const auto members = store_->list("/history/" + item);  // of an array: none
    for (const std::string& member : members) names.push_back(item + "." + from_link_name(member));
    if (members.empty() && !store_->shape("/history/" + item).empty()) names.push_back(item);
  }
  return names;
}

Series RunFile::describe(const std::string& name) const {
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
  if (s.column.empty()) {
    const std::string unit = store_->text_attribute(array_of(name), "unit").value_or("");
    for (size_t c = 0; c < columns; ++c) s.column.push_back(columns == 1 ? "value" : std::to_string(c)), s.unit.push_back(unit);
  }
  return s;
}

Series RunFile::series(const std::string& name) const {
  Series s = describe(name);
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
