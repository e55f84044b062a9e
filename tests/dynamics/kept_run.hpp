// SPDX-License-Identifier: GPL-3.0-or-later
// Runs that are kept in the middle, and others that go on from there.
#pragma once
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <set>
#include <sstream>

#include "base/comm.hpp"
#include "dynamics/run.hpp"
#include "folder.hpp"
#include "model/local_mesh.hpp"
#include "model/store.hpp"

namespace hilo::test {

/// Paths of the arrays of numbers of a results file.
inline void arrays_of(const Store& file, const std::string& group, std::set<std::string>& out) {
  for (const std::string& name : file.list(group)) {
    const std::string path = (group == "/" ? "" : group) + "/" + name;
    if (file.linked(path)) continue;
    if (!file.is_array(path))
      arrays_of(file, path, out);
    else if (file.type(path) != "string")
      out.insert(path);
  }
}

/// Bytes of an array.
inline std::string bytes_of(const Store& file, const std::string& array) {
  const auto bytes = [&]<class T>(T) {
    const std::vector<T> values = file.read<T>(array);
    return std::string(reinterpret_cast<const char*>(values.data()), sizeof(T) * values.size());
  };
  const std::string type = file.type(array);
  return type == "f8" ? bytes(double{}) : type == "f4" ? bytes(float{}) : type == "i8" ? bytes(std::int64_t{}) : bytes(std::int32_t{});
}

/// Arrays in which the file of a run that was gone on with differs from that of the run that was not left.
inline std::string differences(const std::string& whole, const std::string& later) {
  const Store a = Store::open(whole), b = Store::open(later);
  std::set<std::string> in_a, in_b;
  arrays_of(a, "/", in_a), arrays_of(b, "/", in_b);
  std::string out;
  for (const std::string& array : in_a)
    if (!in_b.contains(array))
      out += array + " is missing; ";
    else if (bytes_of(a, array) != bytes_of(b, array))
      out += array + "; ";
  for (const std::string& array : in_b)
    if (!in_a.contains(array)) out += array + " is new; ";
  return out;
}

/// run.json without what seconds and bytes it took.
inline std::string told(const std::string& results) {
  std::istringstream file(text_of(results.substr(0, results.size() - 2) + "json"));
  std::string out;
  for (std::string line; std::getline(file, line);)
    if (line.find("seconds") == line.npos && line.find("bytes") == line.npos) out += line + "\n";
  return out;
}

/// A scene, with its mesh if it has one, run in this process.
class KeptRun {
 public:
  KeptRun(std::filesystem::path folder, const std::string& scene, std::string mesh, const std::vector<std::string>& overrides)
      : folder_(std::move(folder)), scene_(Scene::parse(scene, "scene.toml", overrides)), mesh_(std::move(mesh)) {}

  /// Run from the start, or from what was kept, and keep after these numbers of steps.
  RunReport run(const std::string& output, const std::set<long>& steps, const Kept& from = {}) {
    Comm& comm = Comm::world();
    std::unique_ptr<LocalMesh> mesh;
    if (!mesh_.empty()) mesh = std::make_unique<LocalMesh>(read_local_mesh((folder_ / mesh_).string(), comm));
    const auto system = build_system(scene_, mesh.get(), comm);
    RunOptions options;
    options.output = (folder_ / output).string(), options.quiet = true, options.from = from;
    kept_.clear();
    options.between_steps = [&](const StepsSoFar& so_far, const std::function<Kept()>& keep) {
      if (steps.contains(so_far.steps)) kept_[so_far.steps] = keep();
      return std::string();
    };
    return hilo::run(scene_, *system, options);
  }
  const std::map<long, Kept>& kept() const { return kept_; }

 private:
  std::filesystem::path folder_;
  Scene scene_;
  std::string mesh_;
  std::map<long, Kept> kept_;
};

/// What a run kept after each of `steps` takes another one to the same end, bit by bit.  Returns the report of the whole run.
inline RunReport expect_goes_on(const std::filesystem::path& folder, const std::string& scene, const std::string& mesh,
                                const std::set<long>& steps, const std::vector<std::string>& overrides = {}) {
  KeptRun whole(folder, scene, mesh, overrides);
  const std::string all = (folder / "whole.h5").string(), rest = (folder / "later.h5").string();
  const RunReport report = whole.run("whole.h5", steps);
  EXPECT_TRUE(report.complete) << report.reason;
  EXPECT_EQ(whole.kept().size(), steps.size()) << "of " << report.steps << " steps";
  for (const auto& [step, kept] : whole.kept()) {
    KeptRun later(folder, scene, mesh, overrides);
    if (Comm::world().rank == 0)  // all of it: what is behind the kept step has to go
      std::filesystem::copy_file(all, rest, std::filesystem::copy_options::overwrite_existing);
    Comm::world().barrier();
    later.run("later.h5", steps, kept);
    if (Comm::world().rank == 0) {
      EXPECT_EQ(differences(all, rest), "") << "from step " << step;
      EXPECT_EQ(told(all), told(rest)) << "from step " << step;
    }
    for (auto again = later.kept().begin(); again != later.kept().end(); ++again)
      EXPECT_GT(again->first, step) << "steps before are not taken again";
    Comm::world().barrier();
  }
  return report;
}

}  // namespace hilo::test
