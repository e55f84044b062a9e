// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/deck_material.hpp"

#include <algorithm>

namespace hilo {

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

void DeckMaterial::write(SceneWriter& scene, const ImportOptions& o) const {
  SceneTable& out = scene.add({"material", kind}, clean_name(name), "");
  out.set_if(!std::isnan(data.E), "E", data.E * o.si("Pa")).set_if(!std::isnan(data.nu), "nu", data.nu);
  for (const DeckKey& k : keys) {
    std::vector<double> v = k.values;
    for (double& x : v) x *= o.si(k.unit);
    out.set(k.key, k.list ? SceneValue(v) : SceneValue(v.front()));
  }
  out.set_if(!std::isnan(data.density), "density", data.density * o.si("kg/m^3"));
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
