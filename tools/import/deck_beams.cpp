// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/deck_beams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.hpp"
#include "model/scene.hpp"
#include "physics/section_mesh.hpp"

namespace hilo {
namespace {

constexpr double stiff_in_shear = 1e4;  // of E A: the share of shear in a tip's bend is 1.2e-3 (radius of gyration / length)^2 and less

double shear_modulus(const DeckMaterial& m) { return std::isnan(m.G) ? m.data.E / (2 * (1 + m.data.nu)) : m.G; }

}  // namespace

SectionArea DeckSection::area(double nu, const std::string& place) const {
  for (const auto& [key, value] : sizes)
    if (!(value > 0) && kind != "general") throw Error(place, fmt::format("a section of beams: {} {:g}", key, value), "above 0");
  Entry values("a section of beams", "", {place});
  for (const auto& [key, value] : sizes) {
    Value& v = values.values[key];
    v.place.file = place, v.numbers = {value};
  }
  SectionArea out = section_kinds().at(kind, place).area(values, std::isnan(nu) ? 0.3 : nu);
  if (shear) out.shear_1 = (*shear)[0], out.shear_2 = (*shear)[1];
  return out;
}

DeckSection circle_section(double diameter) { return {"circle", {{"diameter", diameter}}}; }
DeckSection tube_section(double diameter, double thickness) { return {"tube", {{"diameter", diameter}, {"thickness", thickness}}}; }
DeckSection rectangle_section(double width, double height) { return {"rectangle", {{"width", width}, {"height", height}}}; }
DeckSection box_section(double width, double height, double thickness) {
  return {"box", {{"width", width}, {"height", height}, {"thickness", thickness}}};
}
DeckSection I_section(double width, double height, double flange, double web) {
  return {"I", {{"width", width}, {"height", height}, {"flange", flange}, {"web", web}}};
}
DeckSection general_section(double A, double I1, double I2, double J) {
  return {"general", {{"area", A}, {"I1", I1}, {"I2", I2}, {"J", J}}};
}

DeckSection section_of_rectangles(const std::vector<DeckRectangle>& parts, const std::string& place) {
  constexpr int most = 12;  // cells between two edges
  std::vector<double> edges[2];
  for (const DeckRectangle& r : parts) {
    if (!(r.to_1 > r.from_1 && r.to_2 > r.from_2)) return {};
    edges[0].insert(edges[0].end(), {r.from_1, r.to_1}), edges[1].insert(edges[1].end(), {r.from_2, r.to_2});
  }
  std::vector<double> lines[2];  // of cells
  double thin = 1e300;
  for (auto& e : edges) {
    std::ranges::sort(e);
    const double size = e.back() - e.front();
    e.erase(std::unique(e.begin(), e.end(), [&](double a, double b) { return b - a < 1e-9 * size; }), e.end());
    for (size_t i = 1; i < e.size(); ++i) thin = std::min(thin, e[i] - e[i - 1]);
  }
  for (int k = 0; k < 2; ++k)
    for (size_t i = 1; i < edges[k].size(); ++i) {
      const double length = edges[k][i] - edges[k][i - 1];
      const int n = static_cast<int>(std::clamp(std::ceil(2 * length / thin), 2., static_cast<double>(most)));
      for (int j = 0; j < n; ++j) lines[k].push_back(edges[k][i - 1] + length * j / n);
      if (i + 1 == edges[k].size()) lines[k].push_back(edges[k][i]);
    }
  SectionMesh mesh;
  std::map<std::pair<size_t, size_t>, int> number;  // by half lines
  const auto node = [&](size_t i, size_t j) {
    const auto at = [](const std::vector<double>& l, size_t h) { return h % 2 ? (l[h / 2] + l[h / 2 + 1]) / 2 : l[h / 2]; };
    const auto [it, fresh] = number.try_emplace({i, j}, static_cast<int>(mesh.X.size()));
    if (fresh) mesh.X.emplace_back(at(lines[0], i), at(lines[1], j));
    return it->second;
  };
  for (size_t i = 0; i + 1 < lines[0].size(); ++i)
    for (size_t j = 0; j + 1 < lines[1].size(); ++j) {
      const double x = (lines[0][i] + lines[0][i + 1]) / 2, y = (lines[1][j] + lines[1][j + 1]) / 2;
      if (std::ranges::none_of(parts, [&](const auto& r) { return x > r.from_1 && x < r.to_1 && y > r.from_2 && y < r.to_2; })) continue;
      const auto at = [&](size_t a, size_t b) { return node(2 * i + a, 2 * j + b); };
      mesh.cells.push_back({at(0, 0), at(2, 0), at(2, 2), at(0, 2), at(1, 0), at(2, 1), at(1, 2), at(0, 1), at(1, 1)});
    }
  try {
    const SectionArea a = meshed_face(mesh, 0.3).area;
    DeckSection out = general_section(a.A, a.I1, a.I2, a.J);
    const bool askew = std::abs(a.I12) > 1e-9 * (a.I1 + a.I2);
    out.I12 = askew ? a.I12 : 0;
    out.shear = {a.shear_1, a.shear_2};
    const auto clean = [&](double x) { return std::abs(x) < 1e-9 * std::sqrt(a.A) ? 0 : x; };
    out.shear_centre = {clean(a.s1), clean(a.s2)};
    return out;
  } catch (const Error& e) {
    throw Error(place, std::string("a section of beams: ") + e.what());
  }
}

bool has_scene_material(const DeckSection& s, const DeckMaterial& m) {
  const bool isotropic = m.elastic() && m.data.E > 0 && m.data.nu > -1 && m.data.density > 0 &&
                         std::abs(shear_modulus(m) * 2 * (1 + m.data.nu) / m.data.E - 1) < 1e-3;
  return isotropic && s.I12 == 0 && s.line_mass == 0 && s.shear_centre == std::array{0., 0.} &&
         std::ranges::all_of(s.sizes, [](const auto& size) { return size.second > 0; });
}

void write_section(SceneWriter& scene, const std::string& name, DeckSection s, const DeckSection& beside, const DeckMaterial& m,
                   const ImportOptions& o, const std::string& place) {
  const auto power = [](const std::string& key) { return key == "area" ? 2 : key[0] == 'I' || key[0] == 'J' ? 4 : 1; };  // of a length
  for (auto& [key, value] : s.sizes) value *= std::pow(o.scale, power(key));
  s.I12 *= std::pow(o.scale, 4);
  for (double& x : s.shear_centre) x *= o.scale;
  const double E = m.data.E, G = shear_modulus(m);
  if (!(E > 0) || !(G > 0)) throw Error(place, fmt::format("material {} has no Young's or shear modulus, which a beam needs", m.name));
  const SectionArea area = s.area(m.data.nu, place);
  const double k[2] = {s.no_shear_strain[0] ? stiff_in_shear * E / G : area.shear_1,
                       s.no_shear_strain[1] ? stiff_in_shear * E / G : area.shear_2};
  if (has_scene_material(s, m) && has_scene_material(beside, m)) {
    SceneTable& out = scene.add({"section", s.kind}, name, place);
    for (const auto& [key, value] : s.sizes) out.set(key, value * std::pow(o.si("m"), power(key)));
    out.set_if(s.shear || s.no_shear_strain[0] || s.no_shear_strain[1], "shear", {k[0], k[1]});
    return;
  }
  const double J = area.J > 0 ? area.J : 1e-6 * (area.I1 + area.I2);  // a beam resists every strain
  if (!(area.A > 0 && area.I1 > 0 && area.I2 > 0))
    throw Error(place,
                fmt::format("section {}: area {:g}, second moments {:g} and {:g}; a beam has all of them", name, area.A, area.I1, area.I2),
                "a rod where only the area is given");
  const double N = o.si("Pa") * o.si("m^2"), Nm2 = o.si("Pa") * o.si("m^4"), rho = m.data.density > 0 ? m.data.density : 0;
  const double inertia = o.si("kg/m^3") * o.si("m^4");
  const double A1 = k[0] * G * area.A * N, A2 = k[1] * G * area.A * N;
  const double s1 = s.shear_centre[0] * o.si("m"), s2 = s.shear_centre[1] * o.si("m");
  const double b = -E * s.I12 * Nm2, twist = G * J * Nm2 + A1 * s2 * s2 + A2 * s1 * s1;
  const auto is_apart = [](const DeckSection& section) { return section.shear_centre != std::array{0., 0.}; };
  scene.add({"section", "matrix"}, name, place, {{"stiffness", {A1, A2, E * area.A * N}}})
      .set_if(is_apart(s) || is_apart(beside), "coupling", {0, 0, -A1 * s2, 0, 0, A2 * s1, 0, 0, 0})
      .set("bending", s.I12 == 0 && beside.I12 == 0 ? SceneValue{E * area.I1 * Nm2, E * area.I2 * Nm2, twist}
                                                    : SceneValue{E * area.I1 * Nm2, b, 0, b, E * area.I2 * Nm2, 0, 0, 0, twist})
      .set("line_mass", rho * area.A * o.si("kg/m^3") * o.si("m^2") + s.line_mass * o.si("kg") / o.si("m"))
      .set("inertia", {rho * area.I2 * inertia, rho * area.I1 * inertia, rho * s.I12 * inertia});
}

}  // namespace hilo
