// SPDX-License-Identifier: GPL-3.0-or-later
// Entries [beam.NAME] and [section.NAME] to sections and cells.
#include "system/beams.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "base/values_between.hpp"
#include "model/section_file.hpp"
#include "model/store.hpp"
#include "system/build/builder.hpp"
#include "system/section_meshes.hpp"

namespace hilo {
namespace {

/// The entry of a section of the scene that a key names.
const Entry& named(const Scene& scene, std::string_view section, const Entry& e, std::string_view key) {
  std::vector<std::string> names;
  for (const Entry& found : scene.entries(section)) {
    if (found.name == e.text(key)) return found;
    names.push_back(found.name);
  }
  const std::string near = suggest(e.text(key), names);
  e.refuse(key, fmt::format("no {} \"{}\"", section, e.text(key)),
           !near.empty()   ? near
           : names.empty() ? fmt::format("write [{}.{}]", section, e.text(key))
                           : fmt::format("there are: {}", fmt::join(names, ", ")));
}

/// The mesh of a section, read on one rank for all.
SectionMesh mesh_of(const Scene& scene, const Entry& section, const Comm& comm) {
  if (!section.has("file")) section.refuse("", "no file of its mesh", "file = \"face.msh\", as hilo-import --face writes it");
  const std::filesystem::path file = section.text("file");
  const std::string path = (scene.folder == "." ? file : scene.folder / file).string();
  if (std::error_code error; !std::filesystem::exists(path, error) && !error)
    section.refuse("file", fmt::format("no file {}", path), "paths in a scene are relative to the scene's folder");
  std::vector<char> text;
  comm.on_first([&] {
    const std::string read = read_text_file(path, section.where("file"));
    text.assign(read.begin(), read.end());
  });
  text = comm.of_first(std::move(text));
  SectionMesh mesh = section_mesh_of({text.begin(), text.end()}, path);
  for (Eigen::Vector2d& x : mesh.X) x *= section.number("scale") * to_si("m", scene.units);
  return mesh;
}

/// Faces of meshed sections, by name and Poisson's ratio.
class Faces {
 public:
  Faces(const Scene& scene, const Comm& comm, std::vector<NamedSection>& meshes) : scene_(scene), comm_(comm), meshes_(meshes) {}
  const SectionArea& area(const Entry& section, double nu) {
    const auto known = areas_.find({section.name, nu});
    if (known != areas_.end()) return known->second;
    auto mesh = std::find_if(meshes_.begin(), meshes_.end(), [&](const NamedSection& s) { return s.name == section.name; });
    if (mesh == meshes_.end()) mesh = meshes_.insert(meshes_.end(), {section.name, mesh_of(scene_, section, comm_)});
    const SectionFace face = meshed_face(mesh->mesh, nu);
    for (size_t i = 0; i < face.points.size(); ++i) mesh->mesh.X[i] = face.points[i].at;
    return areas_.emplace(std::pair{section.name, nu}, face.area).first->second;
  }

 private:
  const Scene& scene_;
  const Comm& comm_;
  std::vector<NamedSection>& meshes_;
  std::map<std::pair<std::string, double>, SectionArea> areas_;
};

/// What varies along a beam has the same keys at both ends.
void check_taper(const Entry& beam, const SectionKind& kind, const Entry& first, const Entry& last) {
  const std::string both = fmt::format("sections \"{}\" and \"{}\"", first.name, last.name);
  if (first.kind != last.kind)
    beam.refuse("section_end", fmt::format("{} are of the kinds {} and {}", both, first.kind, last.kind),
                "a beam tapers between two of one kind");
  if (kind.meshed) beam.refuse("section_end", "meshed sections have no sizes to taper by", "several beams, each with a section of its own");
  std::vector<Param> keys = kind.keys;
  keys.push_back({"shear", Type::numbers, "", "", ""});
  for (const auto& [key, type, unit, fallback, meaning, range, counts] : keys) {
    if (first.given(key) != last.given(key))
      last.refuse(last.given(key) ? key : "", fmt::format("{} are the ends of beam \"{}\", and one alone has {}", both, beam.name, key));
    if (type == Type::numbers && first.given(key) && first.numbers(key).size() != last.numbers(key).size())
      last.refuse(key, fmt::format("{} are the ends of beam \"{}\", and have {} of different lengths", both, beam.name, key));
  }
}

/// Sections along a beam.
class Sections {
 public:
  Sections(const Scene& scene, const Entry& beam, bool is_static, Faces& faces)
      : first_(named(scene, "section", beam, "section")), kind_(section_kinds().at(first_.kind, first_.place.text())) {
    if (beam.given("section_end")) {
      last_ = &named(scene, "section", beam, "section_end");
      check_taper(beam, kind_, first_, *last_);
    }
    if (!kind_.area && !kind_.meshed) {
      if (beam.given("material"))
        beam.refuse("material", fmt::format("section \"{}\" is given by its stiffness, without a material", first_.name));
      return;
    }
    if (!beam.given("material")) beam.refuse("", "no material", "material = \"a name of [material.NAME]\"");
    const Entry& material = named(scene, "material", beam, "material");
    if (material.kind != "stvk")
      beam.refuse("material", fmt::format("a beam is linear elastic, and material \"{}\" is of kind \"{}\"", material.name, material.kind),
                  "kind = \"stvk\", or a section of kind \"matrix\"");
    for (const char* key : {"E", "nu"})
      if (!material.has(key)) beam.refuse("material", fmt::format("material \"{}\" has no {}", material.name, key));
    if (!material.has("density") && !is_static) beam.refuse("material", fmt::format("material \"{}\" has no density", material.name));
    E_ = material.number("E"), nu_ = material.number("nu"), density_ = material.has("density") ? material.number("density") : 0;
    if (kind_.meshed) meshed_ = &faces.area(first_, nu_);
  }
  /// At a share of the length.
  BeamSection at(double share) const {
    if (last_) return of(ValuesBetween(first_, *last_, share));
    if (!same_) same_ = of(first_);
    return *same_;
  }

 private:
  BeamSection of(const EntryValues& section) const {
    if (!kind_.area && !kind_.meshed) return section_of_stiffness(section);
    return section_of_area(section, meshed_ ? *meshed_ : kind_.area(section, nu_), E_, nu_, density_);
  }
  const Entry &first_, *last_ = nullptr;
  const SectionKind& kind_;
  double E_ = 0, nu_ = 0, density_ = 0;
  const SectionArea* meshed_ = nullptr;
  mutable std::optional<BeamSection> same_;  // all along
};

}  // namespace

/// The sections of all beams that do not ride on something else, as bodies named NAME.0, NAME.1 ... NAME.end.
void Builder::add_sections() {
  for (const Entry& e : scene_.entries("beam")) {
    BeamPlan plan{&e, beam_line(e), {}};
    const BeamLine& line = plan.line;
    const size_t last = line.at.size() - 1;
    for (const char* key : {"a", "b", "section_end"})
      if (line.closed && e.given(key)) e.refuse(key, "the beam is closed: it has no ends");
    plan.body.assign(last + 1, -1);
    for (const auto& [name, k] : section_names(e, line)) {
      if (body_by_name_.contains(name) || (mesh_ && mesh_->mesh.find_region(name) >= 0))
        throw Error(e.place.text(), fmt::format("{}: a body or region is called \"{}\", as one of its sections", e.label(), name));
      if (plan.body[k] < 0) {
        plan.body[k] = new_body(name, line.at[k]);
        section_at_[plan.body[k]] = line.at[k];
        out_->bodies.back().size = line.cells[std::min(k, last - 1)].length;
      }
      body_by_name_[name] = plan.body[k];
    }
    if (line.closed) plan.body[last] = plan.body[0];
    beam_plans_.push_back(std::move(plan));
  }
}

void Builder::add_beams() {
  Beams& beams = out_->part<Beams>();
  Faces faces(scene_, comm_, beams.meshes);
  for (BeamPlan& plan : beam_plans_) {
    const Entry& e = *plan.entry;
    plan.fidelity = fidelity_of(e.text("fidelity"), e.where("fidelity"));
    for (const char* key : {"a", "b"})
      if (e.given(key)) {
        const int known = plan.by_modes() ? find(e.text(key), e.where(key), Asks::looks).body : -1;
        (key[0] == 'a' ? plan.body.front() : plan.body.back()) = known >= 0 ? known : carrier(e, key, true).body;
      }
    const Sections sections(scene_, e, is_static(), faces);
    const std::vector<double>& s = plan.line.s;
    plan.sections.resize(s.size() - 1);
    for (size_t k = 0; k + 1 < s.size(); ++k)
      for (size_t i = 0; i < along_arc.size(); ++i) plan.sections[k][i] = sections.at(std::lerp(s[k], s[k + 1], along_arc[i].t) / s.back());
    check_carriers(plan);
    if (plan.by_modes()) continue;
    beams.beams.push_back({e.name, static_cast<int>(beams.cells.size()), static_cast<int>(plan.line.cells.size())});
    for (size_t k = 0; k < plan.line.cells.size(); ++k) {
      const BeamLine::Cell& cell = plan.line.cells[k];
      beams.add_cell({plan.line.at[k], cell.frame_a, plan.body[k]}, {plan.line.at[k + 1], cell.frame_b, plan.body[k + 1]}, plan.sections[k],
                     e.number("damping"), e.number("mass_damping"));
      count_cell(plan.sections[k], beams.cells.back());
    }
  }
  add_linear_beams();
}

void Builder::count_cell(const SectionsAlong& sections, const BeamCell& cell) const {
  const BeamSection section = mean_section(sections);
  out_->mass += section.mass * cell.arc.law.length;
  out_->stiffness = std::max(out_->stiffness, section.C(2, 2) / cell.arc.law.length);
}

void Builder::check_carriers(const BeamPlan& plan) const {
  const Entry& e = *plan.entry;
  for (size_t k = 0; k + 1 < plan.body.size(); ++k) {
    const Body &a = out_->bodies[plan.body[k]], &b = out_->bodies[plan.body[k + 1]];
    if (plan.body[k] == plan.body[k + 1]) e.refuse("cells", "both ends of a cell are on one body: it could not deform");
    if (a.linear || b.linear)
      e.refuse(a.linear ? "a" : "b", fmt::format("\"{}\" is a linear region: it has no single position", (a.linear ? a : b).name),
               "a set of its nodes");
  }
}

const std::vector<NamedSection>& section_meshes(const System& system) { return system.part<Beams>().meshes; }

}  // namespace hilo
