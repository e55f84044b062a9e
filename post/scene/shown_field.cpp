// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/scene/shown_field.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "post/scene/names.hpp"

namespace hilo {

namespace {

struct Known {
  const char *array, *label, *unit;
  std::vector<std::string> components;
};
const std::vector<Known>& known_fields() {
  static const std::vector<std::string> xyz{"x", "y", "z"};
  static const std::vector<Known> table = {{"von_mises", "von Mises stress", "Pa", {}},
                                           {"axial_stress", "axial stress of beams", "Pa", {}},
                                           {"stress_error", "error of stress", "Pa", {}},
                                           {"plastic_strain", "plastic strain", "1", {}},
                                           {"contact_pressure", "contact pressure", "Pa", {}},
                                           {"stress", "stress", "Pa", {"xx", "yy", "zz", "yz", "xz", "xy"}},
                                           {"shell_force", "force of shells", "N/m", {"n11", "n22", "n12", "q1", "q2"}},
                                           {"shell_moment", "moment of shells", "N", {"m11", "m22", "m12"}},
                                           {"shell_stress", "stress of shells", "Pa", {"s11", "s22", "s12", "mean11", "mean22", "mean12"}},
                                           {"shell_axis", "axis of shells", "1", xyz},
                                           {"displacement", "displacement", "m", xyz},
                                           {"velocity", "velocity", "m/s", xyz},
                                           {"acceleration", "acceleration", "m/s^2", xyz},
                                           {"von_mises_envelope", "largest von Mises stress", "Pa", {}},
                                           {"displacement_envelope", "largest displacement", "m", {}},
                                           {"acceleration_envelope", "largest acceleration", "m/s^2", {}},
                                           {"von_mises_envelope_time", "time of largest von Mises stress", "s", {}},
                                           {"displacement_envelope_time", "time of largest displacement", "s", {}},
                                           {"acceleration_envelope_time", "time of largest acceleration", "s", {}}};
  return table;
}

bool is_vector(const Known& k) { return k.components.size() == 3 && k.components.front() == "x"; }

}  // namespace

std::vector<std::string> components_of(const std::string& array) {
  for (const Known& k : known_fields())
    if (array == k.array && !is_vector(k)) return k.components;
  return {};
}

ShownField shown_field(const std::string& name, const std::vector<std::string>& known) {
  const auto dot = name.find('.');
  const std::string array = name.substr(0, dot);
  for (const Known& k : known_fields()) {
    if (array != k.array) continue;
    ShownField f{array, -1, k.label, k.unit};
    f.flexible_only = f.unit == "Pa" || f.unit == "1" || array.starts_with("von_mises") || array.starts_with("shell_");
    f.from_zero = array != "axial_stress";
    const std::string component = dot == std::string::npos ? "" : name.substr(dot + 1);
    const auto at = std::find(k.components.begin(), k.components.end(), component);
    if (component.empty() && k.components.size() < 4 && array != "shell_moment") return f;
    if (at == k.components.end())
      throw Error("--field",
                  k.components.empty() ? fmt::format("{} has no components", array) : fmt::format("which component of {}?", array),
                  k.components.empty() ? "" : fmt::format("{0}.{1}", array, fmt::join(k.components, ", " + array + ".")));
    f.component = static_cast<int>(at - k.components.begin());
    f.label = fmt::format("{} {}", f.label, component);
    f.from_zero = false;
    return f;
  }
  std::vector<std::string> names;
  for (const auto& k : known)
    if (!k.starts_with("cell_")) names.push_back(k);
  names.insert(names.end(), {"region", "fidelity", "partition", "von_mises", "stress_error", "plastic_strain", "contact_pressure",
                             "acceleration", "displacement", "velocity"});
  std::string hint = suggest(name, names);
  throw Error(
      "--field", fmt::format("no field \"{}\"", name),
      hint.empty()
          ? "von_mises, stress_error, plastic_strain, contact_pressure, acceleration, displacement, velocity, stress.xx, shell_moment.m11, "
            "region, fidelity or "
            "partition"
          : hint);
}

std::vector<double> reduced(RunFile::Field raw, const ShownField& field, const std::string& path) {
  const auto columns = static_cast<size_t>(raw.columns);
  if (field.component >= raw.columns)
    throw Error(path, fmt::format("field \"{}\" has {} columns", field.array, raw.columns), "the file was not written by hilo-solve");
  if (columns == 1) return std::move(raw.value);
  std::vector<double> value(raw.value.size() / columns);
  for (size_t i = 0; i < value.size(); ++i) {
    const double* x = raw.value.data() + i * columns;
    if (field.component >= 0) {
      value[i] = x[field.component];
    } else {
      double sum = 0;
      for (size_t c = 0; c < columns; ++c) sum += x[c] * x[c];
      value[i] = std::sqrt(sum);
    }
  }
  return value;
}

bool is_named_field(const std::string& name) { return name == "region" || name == "fidelity" || name == "partition"; }

Rgb fidelity_colour(Fidelity f) {
  switch (f) {
    case Fidelity::rigid:
      return neutral;
    case Fidelity::linear:
      return {0.40, 0.70, 0.90};
    default:
      return {0.93, 0.58, 0.20};
  }
}

NamedCells named_cells(const MeshFile& file, const std::string& field, const std::vector<bool>& shown, const std::string& path) {
  if (field == "partition" && file.rank.empty()) throw Error(path, "was not partitioned", "run hilo-part, or mpirun -n 4 hilo-solve");
  const Mesh& mesh = file.mesh;
  NamedCells named;
  std::vector<int> group_of(shown.size(), 0);  // of the regions
  if (field == "region") {
    std::vector<std::string> names;
    std::vector<size_t> which;
    for (size_t r = 0; r < shown.size(); ++r)
      if (shown[r]) names.push_back(mesh.region_name[r]), which.push_back(r);
    for (const NameGroup& g : grouped(names)) {
      for (const size_t m : g.members) group_of[which[m]] = static_cast<int>(named.names.size());
      named.colours.push_back(category_colour(static_cast<int>(named.names.size())));
      named.names.push_back(g.label);
    }
  } else if (field == "fidelity") {
    for (const Fidelity f : {Fidelity::nonlinear, Fidelity::linear, Fidelity::rigid}) {
      bool used = false;
      for (size_t r = 0; r < shown.size(); ++r)
        if (shown[r] && file.fidelity[r] == f) used = true, group_of[r] = static_cast<int>(named.names.size());
      if (used) named.names.emplace_back(word(f)), named.colours.push_back(fidelity_colour(f));
    }
  } else {
    for (int k = 0; k < file.n_parts; ++k) named.names.push_back(fmt::format("rank {}", k)), named.colours.push_back(category_colour(k));
  }
  named.name_of.resize(static_cast<size_t>(mesh.n_cells()));
  for (size_t c = 0; c < named.name_of.size(); ++c)
    named.name_of[c] = field == "partition" ? file.rank[c] : group_of[static_cast<size_t>(mesh.region[c])];
  named.title = field == "region" ? "Regions" : field == "fidelity" ? "Fidelity" : "Partition";
  return named;
}

std::vector<bool> shown_regions(const Mesh& mesh, const std::vector<std::string>& show, const std::vector<std::string>& hide) {
  std::vector<bool> shown(mesh.region_name.size(), show.empty());
  const auto apply = [&](const std::vector<std::string>& globs, bool value, const char* option) {
    for (const std::string& glob : globs) {
      bool any = false;
      for (size_t r = 0; r < shown.size(); ++r)
        if (matches(glob, mesh.region_name[r])) shown[r] = value, any = true;
      if (!any) throw Error(option, fmt::format("no region \"{}\"", glob), suggest(glob, mesh.region_name));
    }
  };
  apply(show, true, "--show");
  apply(hide, false, "--hide");
  if (std::none_of(shown.begin(), shown.end(), [](bool b) { return b; })) throw Error("--hide", "nothing is left to show");
  return shown;
}

}  // namespace hilo
