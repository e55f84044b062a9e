// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/deck_material.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/param.hpp"

namespace hilo {

std::string toml_text(const std::string& s) {
  std::string q(1, '"');
  for (const char c : s) {
    if (c == '"' || c == '\\') q += '\\';
    q += static_cast<unsigned char>(c) < 32 ? ' ' : c;
  }
  q += '"';
  return q;
}
std::string toml_number(double x) {
  std::string s = fmt::format("{}", x == 0 ? 0.0 : x);
  return s.find_first_of(".en") == std::string::npos ? s + ".0" : s;
}
std::string toml_list(const std::vector<double>& v) {
  std::string s = "[";
  for (size_t i = 0; i < v.size(); ++i) s += (i ? ", " : "") + toml_number(v[i]);
  return s + "]";
}

void DeckMaterial::become(const std::string& other) {
  if (kind != "stvk" && kind != other && no_law.empty()) no_law = kind + " and " + other + " at once";
  kind = other;
}
void DeckMaterial::set(DeckKey k) {
  std::erase_if(keys, [&](const DeckKey& old) { return old.key == k.key; });
  keys.push_back(std::move(k));
}

RegionData DeckMaterial::carried() const {
  RegionData out = data;
  if (!elastic()) out.E = out.nu = RegionData{}.E;
  return out;
}

std::string DeckMaterial::table(const std::string& as, const std::string& units) const {
  std::string s = fmt::format("\n[material.{}]\nkind = \"{}\"\n", toml_text(clean_name(as)), kind);
  if (!std::isnan(data.E)) s += fmt::format("E = {}\n", toml_number(data.E * to_si("Pa", units)));
  if (!std::isnan(data.nu)) s += fmt::format("nu = {}\n", toml_number(data.nu));
  for (const DeckKey& k : keys) {
    std::vector<double> v = k.values;
    for (double& x : v) x *= to_si(k.unit, units);
    s += fmt::format("{} = {}\n", k.key, k.list ? toml_list(v) : toml_number(v.front()));
  }
  if (!std::isnan(data.density)) s += fmt::format("density = {}\n", toml_number(data.density * to_si("kg/m^3", units)));
  return s;
}

std::string set_hardening(DeckMaterial& m, const std::vector<double>& strain, const std::vector<double>& stress, double kinematic) {
  for (size_t i = 1; i < stress.size(); ++i)
    if (stress[i] < stress[i - 1]) return "that softens";
  m.become("j2");
  m.set({"yield", {stress.front()}, "Pa"});
  if (stress.size() == 1) return "";
  const double slope = (stress[1] - stress[0]) / (strain[1] - strain[0]);
  const bool straight = [&] {
    for (size_t i = 2; i < stress.size(); ++i)
      if (std::abs(stress[i] - stress[0] - slope * (strain[i] - strain[0])) > 1e-6 * stress[i]) return false;
    return true;
  }();
  if (kinematic > 0) {
    if (!straight) return "with kinematic hardening of more than one slope";
    m.set({"kinematic", {kinematic * slope}, "Pa"});
    if (kinematic < 1) m.set({"hardening", {(1 - kinematic) * slope}, "Pa"});
    return "";
  }
  m.set({"hardening_strain", strain, "1", true});
  m.set({"hardening_stress", stress, "Pa", true});
  return "";
}

}  // namespace hilo
