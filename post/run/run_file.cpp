// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/run/run_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "base/error.hpp"
#include "model/inputs.hpp"
#include "model/mesh_source.hpp"
#include "model/scene_sets.hpp"
#include "post/run/swept_beams.hpp"
#include "post/run/times.hpp"

namespace hilo {
namespace {

namespace fs = std::filesystem;

}  // namespace

bool matches(const std::string& glob, const std::string& name) { return fnmatch(glob.c_str(), name.c_str(), 0) == 0; }

RunFile::RunFile(const std::string& path) : path(path), store_(Store::open(path)) {
  const std::string format = store_->text_attribute("/", "format").value_or("");
  if (format != "hilo run")
    throw Error(path, format.empty() ? "is no file of hilo" : fmt::format("is a \"{}\", not a run", format),
                "give the run.h5 of hilo-solve");
  complete = store_->number_attribute("/", "complete").value_or(0) != 0;
  title = store_->text_attribute("/", "title").value_or("");
  if (title.empty()) title = fs::path(path).stem().string();
  for (const std::string& key : store_->list("/field"))
    if (const auto t = store_->number_attribute("/field/" + key, "t")) steps.push_back({key, *t});
  buckles = store_->has("/history/buckling");
  if (buckles || store_->has("/history/mode")) {
    const Series all = series(buckles ? "buckling" : "mode");
    for (size_t row = 0; row < all.rows(); ++row) shapes.push_back(all.at(row, 0));
  }
}

const MeshFile& RunFile::mesh_file() {
  if (mesh_) return *mesh_;
  if (!has_mesh())
    throw Error(path, "holds no mesh: a scene of bodies alone has no surfaces to draw or export",
                "its histories are there: hilo-post series --list");
  const auto link = store_->linked("/mesh");
  const std::string target = link ? resolved_from(path, link->first) : path;
  if (!fs::exists(target))
    throw Error(path, fmt::format("the mesh it was run on, {}, is missing", target), "keep it where it was, or move both together");
  refuse_if_changed(*store_, "mesh", target);
  mesh_ = read_mesh_file(target);
  if (store_->has("/scene")) add_scene_sets(scene_of(*this), mesh_->mesh);
  if (store_->has("/tags/fidelity")) {  // as run, which may differ from the tags there are now
    const auto words = store_->read_strings("/tags/fidelity");
    if (words.size() != mesh_->mesh.region_name.size())
      throw Error(path, fmt::format("{} tags, but {} has {} regions", words.size(), target, mesh_->mesh.region_name.size()),
                  "the mesh was changed after the run");
    mesh_->fidelity.clear();
    for (const auto& w : words) mesh_->fidelity.push_back(fidelity_of(w, path));
    mesh_->tagged = true;
  }
  mesh_->rank.clear();
  if (store_->has("/parts/rank")) mesh_->rank = store_->read<std::int32_t>("/parts/rank");
  if (!mesh_->rank.empty() && mesh_->rank.size() != mesh_->mesh.shape.size())
    throw Error(path, fmt::format("ranks of {} cells, but {} has {}", mesh_->rank.size(), target, mesh_->mesh.shape.size()),
                "the mesh was changed after the run");
  mesh_->n_parts = 1;
  for (const std::int32_t r : mesh_->rank) mesh_->n_parts = std::max(mesh_->n_parts, r + 1);
  if (is_skin()) read_skin();
  read_borders();
  return *mesh_;
}

void RunFile::read_borders() {
  if (!store_->has("/border/row")) return;
  std::map<std::int64_t, std::int64_t> node;  // of each row
  for (size_t n = 0; n < held_.size(); ++n)
    if (held_[n]) node[row_[n]] = static_cast<std::int64_t>(n);
  const auto row = store_->read<std::int64_t>("/border/row"), region = store_->read<std::int64_t>("/border/region");
  borders_.resize(mesh_->mesh.region_name.size());
  for (size_t k = 0; k < row.size(); ++k) {
    const std::int64_t n = held_.empty() ? row[k] : node.at(row[k]);
    Border& border = borders_.at(static_cast<size_t>(region[k]));
    border.entry.push_back(static_cast<std::int64_t>(k)), border.node.push_back(n);
  }
}

const std::vector<std::int64_t>& RunFile::own_nodes(int region) const {
  static const std::vector<std::int64_t> none;
  return region < 0 || static_cast<size_t>(region) >= borders_.size() ? none : borders_[static_cast<size_t>(region)].node;
}

RunFile::Field RunFile::field_in(int region, const Step& step, const std::string& name) const {
  Field f = field(step, name);
  const std::string array = fmt::format("/border/{}/{}", step.key, name);
  if (own_nodes(region).empty() || !store_->has(array)) return f;
  const auto own = store_->read<double>(array);
  const Border& border = borders_[static_cast<size_t>(region)];
  const auto width = static_cast<size_t>(f.columns);
  for (size_t k = 0; k < border.node.size(); ++k)
    std::copy_n(own.begin() + static_cast<std::ptrdiff_t>(static_cast<size_t>(border.entry[k]) * width), width,
                f.value.begin() + static_cast<std::ptrdiff_t>(static_cast<size_t>(border.node[k]) * width));
  return f;
}

void RunFile::read_skin() {
  const Mesh& mesh = mesh_->mesh;
  row_.assign(mesh.X.size(), -1);
  held_.assign(mesh.X.size(), false);
  const auto nodes = store_->read<std::int64_t>("/skin/node");
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i] < 0 || nodes[i] >= mesh.n_nodes())
      throw Error(path, fmt::format("holds fields of node {}, but the mesh has {}", nodes[i], mesh.n_nodes()),
                  "the mesh was changed after the run");
    row_[static_cast<size_t>(nodes[i])] = static_cast<std::int64_t>(i), held_[static_cast<size_t>(nodes[i])] = true;
  }
  for (bool more = true; more;) {  // inwards, a layer of cells at a time
    more = false;
    std::vector<std::pair<std::int64_t, std::int64_t>> reached;
    for (std::int64_t c = 0; c < mesh.n_cells(); ++c) {
      std::int64_t from = -1;
      for (const std::int64_t n : mesh.cell(c)) from = std::max(from, row_[static_cast<size_t>(n)]);
      if (from < 0) continue;
      for (const std::int64_t n : mesh.cell(c))
        if (row_[static_cast<size_t>(n)] < 0) reached.emplace_back(n, from);
    }
    for (const auto& [n, from] : reached) row_[static_cast<size_t>(n)] = from, more = true;
  }
}

RunFile judged_run(const std::string& path) {
  RunFile run(path);
  for (const char* beside : {".json", ".xdmf"}) note_input(fs::path(path).replace_extension(beside).string());  // they are of the run
  if (run.complete) return run;
  const auto t = run.store().has("/history/t") ? run.store().read<double>("/history/t") : std::vector<double>{};
  warn(path, "the run is not complete: in progress or stopped" + (t.empty() ? "" : fmt::format(", it has come to t = {:.6g} s", t.back())));
  return run;
}

void RunFile::close() { store_.reset(); }
void RunFile::open() { store_ = Store::open(path); }

namespace {

/// von_mises_envelope is /envelope/von_mises at every step, von_mises_envelope_time is /envelope/von_mises_time.
std::string array_of(const Step& step, const std::string& name) {
  constexpr std::string_view word = "_envelope";
  const auto at = name.find(word);
  if (at == name.npos) return fmt::format("/field/{}/{}", step.key, name);
  return "/envelope/" + name.substr(0, at) + name.substr(at + word.size());
}

}  // namespace

std::vector<std::string> RunFile::fields(const Step& step) const {
  std::vector<std::string> names = has_mesh() ? store_->list("/field/" + step.key) : std::vector<std::string>{"displacement"};
  if (swept_ && swept_->stressed())
    for (const char* of : {"von_mises", "axial_stress"})
      if (std::find(names.begin(), names.end(), of) == names.end()) names.emplace_back(of);
  if (!has_mesh()) return names;
  for (const std::string& of : store_->list("/envelope"))
    names.push_back(of.ends_with("_time") ? of.substr(0, of.size() - 5) + "_envelope_time" : of + "_envelope");
  return names;
}

bool RunFile::has_field(const Step& step, const std::string& name) const {
  if (swept_ && swept_->stressed() && (name == "von_mises" || name == "axial_stress")) return true;
  return has_mesh() ? store_->has(array_of(step, name)) : name == "displacement";
}

RunFile::Field RunFile::field(const Step& step, const std::string& name) const {
  const auto names = fields(step);
  if (!has_field(step, name)) {
    std::string hint = suggest(name, names);
    if (hint.empty()) hint = fmt::format("there are {}", fmt::join(names, ", "));
    throw Error(path, fmt::format("no field \"{}\" in step {}", name, step.key), hint);
  }
  Field f = own_field(step, name);
  if (swept_) swept_->append(step, name, f);
  return f;
}

RunFile::Field RunFile::own_field(const Step& step, const std::string& name) const {
  if (!has_mesh()) return name == "displacement" ? bodies_displacement(step) : Field{std::vector<double>(swept_->first_node()), 1};
  const std::string array = array_of(step, name);
  if (!store_->has(array)) return {std::vector<double>(swept_->first_node()), 1};  // of beams alone
  const auto shape = store_->shape(array);
  Field f{store_->read<double>(array), shape.size() > 1 ? static_cast<int>(shape[1]) : 1};
  if (row_.empty() || name.starts_with("cell_")) return f;
  const auto width = static_cast<size_t>(f.columns);
  std::vector<double> all(row_.size() * width);
  for (size_t n = 0; n < row_.size(); ++n)
    std::copy_n(f.value.begin() + static_cast<std::ptrdiff_t>(static_cast<size_t>(std::max<std::int64_t>(0, row_[n])) * width), width,
                all.begin() + static_cast<std::ptrdiff_t>(n * width));
  return {std::move(all), f.columns};
}

bool RunFile::gives(size_t region, const std::string& field) const {
  if (!swept_ || region < swept_->first_region()) return field != "axial_stress";
  return field == "displacement" || ((field == "axial_stress" || field == "von_mises") && swept_->has_face(region));
}

void RunFile::draw_beams() {
  if (swept_ || beams().empty()) return;
  swept_ = std::make_shared<SweptBeams>(*this, const_cast<MeshFile&>(mesh_file()));
}

std::vector<Step> RunFile::select_steps(const std::string& numbers, const std::string& times) const {
  if (steps.empty())
    throw Error(path, "holds no field output yet", complete ? "see output.interval of the scene" : "the run is in progress");
  std::vector<double> t;
  for (const Step& s : steps) t.push_back(s.t);
  std::vector<Step> chosen;
  for (const size_t k : choose_instants(t, numbers, times, path, "output")) chosen.push_back(steps[k]);
  return chosen;
}

std::vector<std::string> sensor_names(const RunFile& run, const std::vector<std::string>& globs) {
  std::vector<std::string> all;
  for (const auto& link : run.store().list("/history/sensor")) all.push_back(from_link_name(link));
  if (all.empty()) throw Error(run.path, "has no sensors", "add [[sensor]] name, on to the scene");
  std::vector<std::string> names;
  for (const auto& name : all)
    for (const auto& glob : globs)
      if (matches(glob, name) && (names.empty() || names.back() != name)) names.push_back(name);
  if (names.empty()) {
    std::string hint = suggest(globs.front(), all);
    throw Error(run.path, fmt::format("no sensor \"{}\"", globs.front()), hint.empty() ? fmt::format("there is {}", all.front()) : hint);
  }
  return names;
}

}  // namespace hilo
