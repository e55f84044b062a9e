// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/run/run_beams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.hpp"
#include "base/values_between.hpp"
#include "physics/section_mesh.hpp"

namespace hilo {
namespace {

const Entry* find(const Scene& scene, std::string_view section, const std::string& name) {
  for (const Entry& e : scene.entries(section))
    if (e.name == name) return &e;
  return nullptr;
}

/// Faces of the meshed sections that a run keeps.
class KeptFaces {
 public:
  explicit KeptFaces(const Store& store) : store_(store) {}
  bool contains(const std::string& name) const { return store_.has("/section/" + name + "/cells"); }
  const SectionFace& face(const std::string& name, double nu) {
    const auto known = faces_.find({name, nu});
    if (known != faces_.end()) return known->second;
    SectionMesh mesh;
    const auto x = store_.read<double>("/section/" + name + "/points");
    const auto cells = store_.read<std::int32_t>("/section/" + name + "/cells");
    for (size_t i = 0; i + 1 < x.size(); i += 2) mesh.X.emplace_back(x[i], x[i + 1]);
    for (size_t i = 0; i + 8 < cells.size(); i += 9) std::copy_n(&cells[i], 9, mesh.cells.emplace_back().begin());
    for (const auto& cell : mesh.cells)
      for (size_t i = 0; i < cell.size(); ++i)
        if (const int node = cell[i]; node >= static_cast<int>(mesh.X.size()) || (node < 0 && (i < 6 || node != cell[6] || node != -1)))
          throw Error("/section/" + name + "/cells", fmt::format("a cell has node {} of {}", cell[i], mesh.X.size()),
                      "the file is damaged");
    return faces_.emplace(std::pair{name, nu}, meshed_face(mesh, nu)).first->second;
  }

 private:
  const Store& store_;
  std::map<std::pair<std::string, double>, SectionFace> faces_;
};

/// Poisson's ratio of its material, or 0.
double ratio_of(const Scene& scene, const Entry& beam) {
  const Entry* material = beam.has("material") ? find(scene, "material", beam.text("material")) : nullptr;
  return material && material->has("nu") ? material->number("nu") : 0;
}

RunBeam::Section section_of(const SectionKind& kind, const EntryValues& values, double nu, const SectionFace* meshed) {
  RunBeam::Section out;
  SectionArea area{.A = 1};
  if (meshed) {
    out.face = *meshed, area = meshed->area;
  } else if (!kind.area) {
    const BeamSection s = section_of_stiffness(values);
    area.I1 = s.C(3, 3) / s.C(2, 2), area.I2 = s.C(4, 4) / s.C(2, 2);
  } else {
    area = kind.area(values, nu);
  }
  if (kind.area || meshed) out.area = area;
  if (out.area && values.given("shear"))
    out.area->shear_1 = values.numbers("shear").front(), out.area->shear_2 = values.numbers("shear").back(), out.area->shear_12 = 0;
  out.radii = Vec3(std::sqrt(area.I1 / area.A), std::sqrt(area.I2 / area.A), 0);
  if (kind.face) out.face = kind.face(values, nu);
  if (out.face && out.face->points.empty()) out.face.reset();
  return out;
}

std::vector<RunBeam::Section> sections_of(const Scene& scene, const Entry& e, const BeamLine& line, KeptFaces& meshed) {
  const Entry* first = find(scene, "section", e.text("section"));
  if (!first) return {{}};
  const SectionKind& kind = section_kinds().at(first->kind, first->place.text());
  if (kind.meshed && !meshed.contains(first->name)) return {{}};
  const double nu = ratio_of(scene, e);
  const Entry* last = e.given("section_end") ? find(scene, "section", e.text("section_end")) : nullptr;
  if (!last) return {section_of(kind, *first, nu, kind.meshed ? &meshed.face(first->name, nu) : nullptr)};
  std::vector<RunBeam::Section> out;
  for (const double s : line.s) out.push_back(section_of(kind, ValuesBetween(*first, *last, s / line.s.back()), nu, nullptr));
  return out;
}

RunBeam beam_of(const Scene& scene, const Entry& e, KeptFaces& meshed) {
  RunBeam b{e.name, beam_line(e), {}, {}};
  b.sections = sections_of(scene, e, b.line, meshed);
  b.on.resize(b.line.at.size());
  for (const auto& [name, k] : section_names(e, b.line))
    if (b.on[k].empty()) b.on[k] = name;
  if (e.given("a")) b.on.front() = e.text("a");
  if (e.given("b")) b.on.back() = e.text("b");
  if (b.line.closed) b.on.back() = b.on.front();
  return b;
}

}  // namespace

std::vector<RunBeam> beams_of(const RunFile& run) {
  std::vector<RunBeam> out;
  const Scene scene = scene_of(run);
  KeptFaces meshed(run.store());
  std::map<std::string, std::string> own;  // a section by each of its names
  for (const Entry& e : scene.entries("beam")) {
    out.push_back(beam_of(scene, e, meshed));
    out.back().bears = e.text("fidelity") != "rigid";
    for (const auto& [name, k] : section_names(e, out.back().line)) own[name] = out.back().on[k];
  }
  for (RunBeam& b : out)
    for (std::string* on : {&b.on.front(), &b.on.back()})
      if (const auto found = own.find(*on); found != own.end()) *on = found->second;
  return out;
}

Vec6 beam_forces(const Series& beam, size_t row, size_t cell, int end) {
  return Eigen::Map<const Vec6>(beam.value.data() + row * beam.column.size() + 12 * cell + 6 * static_cast<size_t>(end));
}

Series described_beam_stress(const RunBeam& beam) {
  Series s;
  s.name = "beam_stress." + beam.name;
  std::vector<std::string> places{""};
  for (size_t k = 0; k < beam.line.cells.size(); ++k)
    for (const char* end : {"a", "b"}) places.push_back(fmt::format("cell{}.{}.", k, end));
  for (const std::string& place : places)
    for (const char* what : {"high", "low", "von_mises"}) s.column.push_back(place + what), s.unit.emplace_back("Pa");
  return s;
}

std::vector<double> beam_stress(const RunBeam& beam, const Series& forces) {
  std::vector<double> out;
  for (size_t row = 0; row < forces.rows(); ++row) {
    const size_t first = out.size();
    out.resize(first + 3);
    StressRange all{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(), 0};
    for (size_t k = 0; k < beam.line.cells.size(); ++k)
      for (const int end : {0, 1}) {
        const StressRange r = stress_range(*beam.section(k + static_cast<size_t>(end)).face, beam_forces(forces, row, k, end));
        all.high = std::max(all.high, r.high), all.low = std::min(all.low, r.low), all.von_mises = std::max(all.von_mises, r.von_mises);
        out.insert(out.end(), {r.high, r.low, r.von_mises});
      }
    out[first] = all.high, out[first + 1] = all.low, out[first + 2] = all.von_mises;
  }
  return out;
}

}  // namespace hilo
