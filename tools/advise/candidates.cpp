// SPDX-License-Identifier: GPL-3.0-or-later
#include "advise/candidates.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "about.hpp"
#include "base/digest.hpp"
#include "base/error.hpp"
#include "model/store.hpp"

namespace hilo {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string text_of_file(const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// hilo-solve beside this program.
std::string solver() {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto beside = self.parent_path() / "hilo-solve";
  return !error && std::filesystem::exists(beside) ? beside.string() : "hilo-solve";
}

/// The text of a run.json between `key` and the next quote that is none of it, from `at` on, which moves behind it; "" where there is none.
std::string text_behind(const std::string& json, const std::string& key, size_t& at) {
  const size_t begin = json.find(key, at);
  if (begin == json.npos) return at = json.npos, "";
  std::string text;
  for (at = begin + key.size(); at < json.size() && json[at] != '"'; ++at) {
    if (json[at] == '\\') ++at;
    text += json[at];
  }
  return text;
}

/// What run.json says of linear regions that left their range; bodies of several regions are named by all of them, with + between.
std::map<size_t, std::string> beyond_linear(const std::string& json, const Mesh& mesh) {
  std::map<size_t, std::string> out;
  const size_t begin = json.find("\"beyond_linear\": [");
  const std::string line = begin == json.npos ? "" : json.substr(begin, json.find('\n', begin) - begin);
  for (size_t at = 0; at != line.npos;) {
    const std::string body = "+" + text_behind(line, "{\"region\": \"", at) + "+";
    if (at == line.npos) break;
    const std::string said = text_behind(line, "\"said\": \"", at);
    for (size_t r = 0; r < mesh.region_name.size(); ++r)
      if (body.find("+" + mesh.region_name[r] + "+") != body.npos) out.emplace(r, said);
  }
  return out;
}

}  // namespace

Candidates::Candidates(std::string scene, std::string mesh, std::vector<std::string> overrides, std::string folder, double tolerance)
    : scene_path_(std::move(scene)),
      mesh_path_(std::move(mesh)),
      overrides_(std::move(overrides)),
      folder_(std::move(folder)),
      tolerance_(tolerance),
      scene_(Scene::load(scene_path_, overrides_)),
      mesh_(read_mesh_file(mesh_path_)) {
  check_quantity_regions(scene_, mesh_.mesh.region_name);
  std::filesystem::create_directories(folder_);
}

std::string Candidates::label(const Assignment& fidelity) const {
  std::string flexible;
  for (size_t r = 0; r < fidelity.size(); ++r)
    if (fidelity[r] != Fidelity::rigid) flexible += (flexible.empty() ? "" : ", ") + mesh_.mesh.region_name[r];
  return flexible.empty() ? "all rigid" : flexible;
}

std::string Candidates::solve(const Assignment& fidelity, const std::vector<std::string>& more) {
  Digest key;
  key.add(about());  // another hilo may compute otherwise
  for (const std::string& value : scene_.values()) key.add(value);
  key.add(text_of_file(mesh_path_));
  for (const Fidelity f : fidelity) key.add(word(f));
  for (const std::string& m : more) key.add(m);
  const std::string name = fmt::format("{}/{:016x}", folder_, key.value()), json = name + ".json";
  if (text_of_file(json).find("\"complete\": true") != std::string::npos && std::filesystem::exists(name + ".h5")) return name;
  const std::string tags = name + "-tags.h5";
  write_tags(tags, mesh_path_, fidelity, {"hilo-advise"});
  std::string command = quoted(solver()) + " --quiet " + quoted(scene_path_) + " " + quoted(tags) + " -o " + quoted(name + ".h5");
  for (const auto* list : {&overrides_, &more})
    for (const std::string& o : *list) command += " --set " + quoted(o);
  if (!is_quiet()) fmt::print(stderr, "run {}: {}{}\n", ++runs, label(fidelity), more.empty() ? "" : " (" + more.front() + ")");
  const int status = std::system((command + " > " + quoted(name + ".log") + " 2>&1").c_str());
  if (status != 0) {
    std::string line = text_of_file(name + ".log");
    if (line.ends_with('\n')) line.pop_back();
    throw Error(scene_path_, fmt::format("the model with {} does not run: {}", label(fidelity), line.substr(line.rfind('\n') + 1)), "",
                WIFEXITED(status) && WEXITSTATUS(status) == 3 ? Exit::not_converged : Exit::input);
  }
  return name;
}

const Candidate& Candidates::of(const Assignment& fidelity, double step) {
  std::vector<std::string> more;
  const Entry& time = scene_.table("time");
  if (step != 1) more.push_back(fmt::format("time.step={:.17g}", time.number("step") * step));
  const std::string name = solve(fidelity, more);
  const auto [found, added] = done_.try_emplace(name);
  Candidate& c = found->second;
  if (!added) return c;
  c.fidelity = fidelity, c.run = name + ".h5";
  RunFile run(c.run);
  for (QuantityValue& v : quantities(scene_, run)) {
    if (v.kind == "frequency") continue;
    if (v.tolerance.empty()) v.allowed = tolerance_ * std::abs(v.value);
    c.values.push_back(std::move(v));
  }
  const std::string json = text_of_file(name + ".json");
  for (const auto& [word, value] : {std::pair{"\"processor_seconds\": ", &c.seconds}, {"\"unknowns\": ", &c.unknowns}})
    if (const auto at = json.find(word); at != json.npos) *value = std::strtod(json.c_str() + at + std::string(word).size(), nullptr);
  c.beyond = beyond_linear(json, mesh_.mesh);
  return c;
}

std::vector<double> Candidates::frequencies(const Assignment& fidelity) {
  const std::string name = solve(fidelity, {"time.analysis=\"modes\"", "time.start=\"as given\"", "time.modes=20", "gravity=[0,0,0]"});
  return RunFile(name + ".h5").frequencies;
}

std::vector<LoadHistory> Candidates::loads(const Candidate& c) const {
  const RunFile run(c.run);
  std::vector<LoadHistory> out;
  for (const std::string& name : run.series_names()) {
    if (!name.starts_with("joint.")) continue;
    const Series s = run.series(name);
    LoadHistory h{s.t, {}};
    for (size_t row = 0; row < s.rows(); ++row) h.F.push_back({s.at(row, 0), s.at(row, 1), s.at(row, 2)});
    out.push_back(std::move(h));
  }
  return out;
}

double Candidates::difference(const Candidate& c, const Candidate& base, std::string* worst) const {
  double largest = -1;
  for (size_t k = 0; k < base.values.size(); ++k) {
    const QuantityValue &a = c.values[k], &b = base.values[k];
    if (!b.why.empty()) continue;
    const double d = a.why.empty() ? std::abs(a.value - b.value) / std::max(b.allowed, 1e-300) : HUGE_VAL;
    if (d <= largest) continue;
    largest = d;
    if (worst) *worst = b.name;
  }
  return std::max(largest, 0.0);
}

}  // namespace hilo
