// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/checkpoint.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

#include "base/interrupt.hpp"
#include "dynamics/profile.hpp"
#include "dynamics/record/run_output.hpp"
#include "model/inputs.hpp"

namespace hilo {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t version = 4;  // of the format

std::string newest(const std::string& results) { return stem(results) + ".checkpoint.h5"; }
std::string former(const std::string& results) { return stem(results) + ".checkpoint-1.h5"; }

/// "mesh DIGEST" and "tags DIGEST" of what a mesh, tags or parts file leads to.
std::vector<std::string> digests_behind(const std::string& path) {
  std::vector<std::string> out;
  if (path.empty()) return out;
  const Store file = Store::open(path);
  for (const char* what : {"/mesh", "/tags"})
    if (const auto link = file.linked(what))
      out.push_back(fmt::format("{} {}", what + 1, digest(resolved_from(path, link->first))));
    else if (file.has(what))
      out.push_back(fmt::format("{} {}", what + 1, digest(path)));
  return out;
}

std::string absolute(const std::string& path) { return path.empty() || path == "-" ? path : fs::absolute(path).string(); }

}  // namespace

Checkpoints::Checkpoints(const Comm& comm, const Scene& scene, RunCommand command, std::string output, CheckpointPolicy policy,
                         const std::string& from)
    : comm_(comm),
      scene_(scene),
      command_(std::move(command)),
      output_(std::move(output)),
      stop_file_((fs::path(output_).parent_path() / "STOP").string()),
      policy_(policy),
      last_(wall_clock()),
      looked_(last_),
      step_began_(last_),
      newest_is_good_(from == newest(output_)),
      former_is_ours_(!from.empty()) {
  command_.scene = absolute(command_.scene), command_.mesh = absolute(command_.mesh), command_.modes = absolute(command_.modes);
  if (fs::exists(stop_file_))
    throw Error(stop_file_, "this file ends a run, and it is there before the run begins", "remove it", Exit::usage);
}

std::string Checkpoints::reason_to_stop() {
  if (const std::string signal = noted_signal(); !signal.empty()) return "stopped by " + signal;
  if (comm_.rank != 0) return "";
  const double now = wall_clock();
  longest_step_ = std::max(longest_step_, now - step_began_), step_began_ = now;
  const double reserve = std::min(1.0, policy_.time_limit / 10);  // to close the results [s]
  if (policy_.time_limit > 0 && now - policy_.began + longest_step_ + 2 * took_ + reserve > policy_.time_limit)
    return "stopped by --time-limit";
  if (now - looked_ < 1) return "";
  looked_ = now;
  return ::access(stop_file_.c_str(), F_OK) == 0 ? "stopped by the file STOP" : "";
}

std::string Checkpoints::between_steps(const StepsSoFar& so_far, const std::function<Kept()>& keep) {
  std::string why = reason_to_stop();
  double now[2] = {why.empty() ? 0.0 : 1.0, comm_.rank == 0 && wall_clock() - last_ > policy_.seconds ? 1.0 : 0.0};
  if (comm_.size > 1) comm_.max(now);
  const bool by_number = policy_.steps > 0 && so_far.steps % policy_.steps == 0;
  if (now[0] == 0 && now[1] == 0 && !by_number) return "";
  if (comm_.size > 1 && now[0] > 0) {
    const std::vector<char> mine(why.begin(), why.end());
    for (const auto& said : comm_.exchange(std::vector<std::vector<char>>(comm_.size, mine)))
      if (!said.empty()) why.assign(said.begin(), said.end());
  }
  write(so_far, keep);
  if (!why.empty() && comm_.rank == 0) ::unlink(stop_file_.c_str());
  return why;
}

void Checkpoints::write(const StepsSoFar& so_far, const std::function<Kept()>& keep) {
  const double began = wall_clock();
  const Kept kept = keep();
  comm_.on_first([&] {
    if (digests_.empty()) digests_ = digests_behind(command_.mesh);
    const std::string path = newest(output_);
    Store f = Store::create(path);
    f.set("/", "format", std::string("hilo checkpoint"));
    f.set("/", "version", version);
    f.set("/", "complete", std::int64_t{1});
    f.set("/", "t", so_far.t);
    f.set("/", "steps", static_cast<std::int64_t>(so_far.steps));
    f.write_text("/scene", scene_.text);
    f.write_strings("/values", scene_.values());
    f.write_strings("/digests", digests_);
    f.write_text("/command/scene", command_.scene);
    f.write_text("/command/mesh", command_.mesh);
    f.write_text("/command/modes", command_.modes);
    f.write_strings("/command/overrides", command_.overrides);
    f.write_text("/command/checkpoint", command_.checkpoint);
    f.write_strings("/provenance", command_.provenance);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(kept.bytes.data());
    f.write<std::uint8_t>("/kept/alike", std::span(bytes, kept.bytes.size()), {static_cast<std::int64_t>(kept.bytes.size())});
    for (size_t k = 0; k < kept.arrays.size(); ++k)
      f.write<double>(fmt::format("/kept/spread/{:06}", k), kept.arrays[k], {static_cast<std::int64_t>(kept.arrays[k].size())});
    const bool moved = newest_is_good_ && ::rename(path.c_str(), former(output_).c_str()) == 0;
    if (newest_is_good_ && !moved && errno != ENOENT)  // another pass of the run begins without
      throw Error(path, fmt::format("cannot rename: {}", std::strerror(errno)), "", Exit::resources);
    f.publish();
    if (!former_is_ours_) ::unlink(former(output_).c_str());
  });
  newest_is_good_ = former_is_ours_ = true;
  last_ = step_began_ = wall_clock(), took_ = last_ - began;
}

void Checkpoints::finish() {
  if (comm_.rank != 0 || policy_.at_end) return;
  ::unlink(newest(output_).c_str()), ::unlink(former(output_).c_str());
}

namespace {

Checkpoint read_one(const std::string& path, const Comm& comm) {
  const Store f = Store::open(path);
  if (f.text_attribute("/", "format") != "hilo checkpoint") throw Error(path, "is no checkpoint");
  if (f.number_attribute("/", "version") != static_cast<double>(version))
    throw Error(path, "was made by another version of hilo", "run the scene again from its start");
  Checkpoint c;
  c.path = path;
  c.t = f.number_attribute("/", "t").value_or(0);
  c.steps = static_cast<long>(f.number_attribute("/", "steps").value_or(0));
  c.scene = f.read_text("/scene");
  c.values = f.read_strings("/values"), c.digests = f.read_strings("/digests");
  c.command = {f.read_text("/command/scene"),
               f.read_text("/command/mesh"),
               f.read_text("/command/modes"),
               f.read_strings("/command/overrides"),
               f.has("/command/checkpoint") ? f.read_text("/command/checkpoint") : "",
               f.read_strings("/provenance")};
  const auto bytes = f.read<std::uint8_t>("/kept/alike");
  const auto* begin = reinterpret_cast<const std::byte*>(bytes.data());
  c.kept.bytes.assign(begin, begin + bytes.size());
  for (const std::string& name : f.list("/kept/spread")) c.kept.arrays.push_back(f.read<double>("/kept/spread/" + name));
  if (comm.rank != 0) c.kept.arrays.clear();
  return c;
}

}  // namespace

Checkpoint read_checkpoint(const std::string& results, const Comm& comm) {
  if (!results.ends_with(".h5")) throw Error(results, "the results file must end in .h5", "--restart run.h5", Exit::usage);
  try {
    Checkpoint c = read_one(newest(results), comm);
    release_input(newest(results));
    return c;
  } catch (const Error& first) {
    std::error_code ignored;
    const bool is_there = fs::exists(newest(results), ignored);
    if (!fs::exists(former(results), ignored)) {
      if (is_there) throw;
      throw Error(results, "no checkpoint lies beside it", fmt::format("{} is not there; see --checkpoint", newest(results)));
    }
    if (is_there) warn(first.where, first.message + ": the one before it is taken");
    Checkpoint c = read_one(former(results), comm);
    release_input(former(results));
    return c;
  }
}

std::optional<Scene> complete_without_checkpoint(const std::string& results) {
  std::error_code ignored;
  for (const std::string& path : {newest(results), former(results)})
    if (fs::exists(path, ignored)) return {};
  if (!results.ends_with(".h5") || !fs::exists(results, ignored)) return {};
  const Store f = Store::open(results);
  if (f.text_attribute("/", "format") != "hilo run" || f.number_attribute("/", "complete") != 1.0) return {};
  release_input(results);
  return Scene::parse(f.read_text("/scene"), results);
}

namespace {

/// "key = value" of each.
std::map<std::string, std::string> by_key(const std::vector<std::string>& lines) {
  std::map<std::string, std::string> out;
  for (const std::string& line : lines) {
    const size_t at = line.find(" = ");
    out[line.substr(0, at)] = at == line.npos ? "" : line.substr(at + 3);
  }
  return out;
}

/// Whether a run may go on with another value.
bool may_differ(const std::string& key, const std::string& was, const std::string& is, double t, bool in_time) {
  const auto number = [](const std::string& text) { return text.empty() ? 0.0 : std::strtod(text.c_str(), nullptr); };
  if (key == "time.end") return in_time && number(is) >= t;
  if (key == "solver.tolerance" || key == "time.tolerance") return !was.empty() && !is.empty() && number(is) >= number(was);
  return key == "output.interval" || key == "output.fields" || key == "title" || key == "solver.kind" || key == "solver.cuts" ||
         key == "solver.iterations";
}

/// Whether another value makes what was kept that of another system or file.
bool shapes_what_is_kept(const std::string& key) {
  for (const char* start : {"tie.", "time.integrator", "time.error_estimate", "output.nodes", "output.precision"})
    if (key.starts_with(start)) return true;
  return false;
}

/// Entries of things that have a state or a history, as "body.arm".
std::set<std::string> things(const std::map<std::string, std::string>& values) {
  std::set<std::string> out;
  for (const auto& [key, value] : values)
    for (const char* section : {"body.", "point_mass.", "beam.", "joint.", "spring.", "stop.", "motor.", "friction.", "contact.", "tie.",
                                "motion.", "region.", "probe.", "sensor."})
      if (key.starts_with(section)) out.insert(key.substr(0, key.rfind('.')));
  return out;
}

}  // namespace

void require_same(const Checkpoint& from, const Scene& scene, const std::string& mesh, bool accept) {
  const auto was = by_key(from.values), is = by_key(scene.values());
  const auto value = [](const auto& list, const std::string& key) {
    const auto found = list.find(key);
    return found == list.end() ? std::string() : found->second;
  };
  const auto shown = [](const std::string& text) {
    return text.empty() ? std::string("not there") : text.size() > 60 ? fmt::format("{:.57}...", text) : text;
  };
  const auto differs = [&](const std::string& what) {
    const std::string hint = "--accept goes on all the same";
    if (!accept) throw Error(scene.path, what, hint);
    warn(scene.path, what);
  };
  const auto had = things(was), has = things(is);
  for (const auto& [one, other, what] : {std::tuple(&had, &has, "is not there, and was"), std::tuple(&has, &had, "is there, and was not")})
    for (const std::string& thing : *one)
      if (!other->contains(thing))
        throw Error(scene.path, fmt::format("{} {} when the run was kept: what belongs to it cannot be taken over", thing, what),
                    "run the scene from its start");
  const bool in_time = value(is, "time.analysis") == "\"dynamic\"";
  std::map<std::string, std::string> keys = was;
  keys.insert(is.begin(), is.end());
  for (const auto& [key, ignored] : keys) {
    const std::string a = value(was, key), b = value(is, key);
    if (a != b && shapes_what_is_kept(key))
      throw Error(scene.path, fmt::format("{} is {}, and was {} when the run was kept, which does not fit it", key, shown(b), shown(a)),
                  "run the scene from its start");
    if (a == b || may_differ(key, a, b, from.t, in_time)) continue;
    if (key == "time.end" && in_time)
      differs(fmt::format("time.end is {}, before the checkpoint at t = {:.6g} s", shown(b), from.t));
    else
      differs(fmt::format("{} is {}, and was {} when the run was kept", key, shown(b), shown(a)));
  }
  const std::vector<std::string> digests = digests_behind(mesh);
  for (const std::string& d : from.digests)
    if (std::find(digests.begin(), digests.end(), d) == digests.end())
      differs(fmt::format("{} is another {} than the run that was kept had", mesh.empty() ? "none" : mesh, d.substr(0, d.find(' '))));
}

}  // namespace hilo
