// SPDX-License-Identifier: GPL-3.0-or-later
// The words of the scene's text keys.
#include <map>

#include "model/integrators.hpp"
#include "model/scene.hpp"

namespace hilo {

Registry<Word>* words_of(std::string_view section, std::string_view key) {
  static std::map<std::pair<std::string_view, std::string_view>, Registry<Word>> lists{
      {{"beam", "path"}, {"path of a beam", {{"line"}, {"arc"}}}},
      {{"beam", "fidelity"}, {"fidelity of a beam", {{"rigid"}, {"linear"}, {"nonlinear"}}}},
      {{"motion", "components"}, {"component", {{"x"}, {"y"}, {"z"}}}},
      {{"history", "interpolation"}, {"interpolation", {{"linear"}, {"smooth"}, {"smoother"}, {"spline"}, {"monotone"}}}},
      {{"history", "ends"}, {"ends of a spline", {{"natural"}, {"clamped"}, {"periodic"}}}},
      {{"time", "start"}, {"start", {{"as given"}, {"equilibrium"}}}},
      {{"time", "error_estimate"}, {"word for the error estimate", {{"auto"}, {"always"}, {"steps"}, {"never"}}}},
      {{"time", "analysis"}, {"analysis", {{"dynamic"}, {"static"}, {"path"}, {"modes"}, {"buckling"}}}},
      {{"solver", "kind"},
       {"solver", {{"auto"}, {"light"}, {"klu"}, {"cholesky"}, {"umfpack"}, {"direct"}, {"cg"}, {"iterative"}, {"bddc"}, {"feti-dp"}}}},
      {{"output", "fields"},
       {"field",
        {{"displacement"},
         {"velocity"},
         {"acceleration"},
         {"stress"},
         {"von_mises"},
         {"stress_error"},
         {"plastic_strain"},
         {"contact_pressure"},
         {"shell"}}}},
      {{"left_out", "loss"}, {"loss", {{"load"}, {"support"}, {"tie"}, {"material"}, {"other"}}}},
      {{"output", "nodes"}, {"choice of nodes", {{"all"}, {"skin"}}}},
      {{"output", "precision"}, {"precision", {{"double"}, {"single"}}}},
  };
  const auto found = lists.find({section, key});
  return found == lists.end() ? nullptr : &found->second;
}

std::vector<std::string> choices(std::string_view section, std::string_view key) {
  if (section == "scene" && key == "units") return unit_systems();
  if (section == "time" && key == "integrator") return integrator_words().words();
  const Registry<Word>* words = words_of(section, key);
  return words ? words->words() : std::vector<std::string>{};
}

}  // namespace hilo
