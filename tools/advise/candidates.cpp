// SPDX-License-Identifier: GPL-3.0-or-later
#include "advise/candidates.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "about.hpp"
#include "base/digest.hpp"
#include "model/store.hpp"

namespace hilo {
namespace {

using Parsed = nlohmann::json;

/// hilo-solve beside this program.
std::string solver() {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto beside = self.parent_path() / "hilo-solve";
  return !error && std::filesystem::exists(beside) ? beside.string() : "hilo-solve";
}

Parsed json_of_file(const std::string& path) {
  std::ifstream file(path);
  return file ? Parsed::parse(file, nullptr, false) : Parsed();
}

bool is_complete(const std::string& name) {
  const Parsed j = json_of_file(name + ".json");
  return j.is_object() && j.contains("complete") && j["complete"] == true && std::filesystem::exists(name + ".h5");
}

/// Bodies of several regions are named by all of them, with + between; of many beams by some, and all may be among "+5 more".
bool is_of(const std::string& body, const std::string& region) {
  return ("+" + body + "+").find("+" + region + "+") != std::string::npos || body.ends_with(" more");
}

std::string last_line(const std::string& path) {
  std::ifstream file(path);
  std::string line, last;
  while (std::getline(file, line))
    if (!line.empty()) last = line;
  return last;
}

/// What a measure of a linear region says of the answers' error, as a share.  Of bend, spin and quadratic strain it grows with the square;
/// at the limits of the measures it is the few per cent these are set for.  Shortening: ten times as much was the most on chains of bars
/// (docs/advise.md).
struct Measure {
  const char* name;
  double (*error)(double value);
};
constexpr Measure measures[] = {{"bend", [](double v) { return 0.03 * std::pow(v / 0.0125, 2); }},
                                {"spin", [](double v) { return 0.05 * std::pow(v / 0.3, 2); }},
                                {"quadratic_strain", [](double v) { return v * v; }},
                                {"tension", [](double v) { return std::max(0.0, v - 1); }},
                                {"shortening", [](double v) { return 10 * v; }}};

struct Extent {
  Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
  double volume = 0;  // of bars their length
};
std::vector<Extent> extents(const Mesh& mesh) {
  std::vector<Extent> out(mesh.region_name.size());
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c) {
    Extent& e = out[static_cast<size_t>(mesh.region[static_cast<size_t>(c)])];
    for (const std::int64_t node : mesh.cell(c)) {
      e.low = e.low.cwiseMin(mesh.X[static_cast<size_t>(node)]);
      e.high = e.high.cwiseMax(mesh.X[static_cast<size_t>(node)]);
    }
    e.volume += std::abs(quality(mesh, c).volume);
  }
  return out;
}

/// Regions of the same names are the same parts where their boxes and volumes agree, but for what larger cells cut off of curved faces.
void check_extent(const Mesh& mesh, const Mesh& finer, const std::string& path, const std::string& finer_path) {
  constexpr double box = 0.1, volume = 0.25;  // shares of the diagonal and of the volume
  const std::vector<Extent> mine = extents(mesh), its = extents(finer);
  for (size_t r = 0; r < mine.size(); ++r) {
    const Extent &a = mine[r], &b = its[r];
    const double diagonal = (a.high - a.low).norm(), ratio = (b.high - b.low).norm() / diagonal;
    const double apart = std::max((b.low - a.low).norm(), (b.high - a.high).norm());
    if (apart <= box * diagonal && std::abs(b.volume - a.volume) <= volume * a.volume) continue;
    const std::string place = fmt::format("region \"{}\" of {}", mesh.region_name[r], path);
    if (std::abs(ratio - 1) > box)
      throw Error(finer_path, fmt::format("is not the same part: {:.3g} times as large as {}", ratio, place),
                  "import it with the same --units and --scale");
    throw Error(finer_path,
                fmt::format("is not the same part: its corners are up to {:.3g} m off {}, its volume is {:.3g} times as large", apart,
                            place, b.volume / a.volume),
                "the same model with smaller cells");
  }
}

}  // namespace

Candidates::Candidates(Options options)
    : o_(std::move(options)),
      scene_(Scene::load(o_.scene, o_.overrides)),
      mesh_(o_.mesh.empty() ? MeshFile() : read_mesh_file(o_.mesh)),
      mesh_digest_(o_.mesh.empty() ? "" : digest(o_.mesh)),
      names_(mesh().region_name) {
  check_quantity_regions(scene_, names());
  for (const std::string& name : names()) nodes_.push_back(static_cast<double>(mesh().nodes_of(name, o_.mesh).size()));
  for (const Entry& e : scene_.entries("beam")) {
    double sections = 1;
    for (const double cells : e.numbers("cells")) sections += cells;
    names_.push_back(e.name), nodes_.push_back(2 * sections);
  }
  if (names().empty()) throw Error(scene_.path, "has neither a mesh nor beams to advise on", "hilo-advise scene.toml tags.h5", Exit::usage);
  if (!o_.finer.empty()) {
    const MeshFile finer = read_mesh_file(o_.finer);
    if (finer.mesh.region_name != mesh().region_name)
      throw Error(o_.finer, "has other regions than " + o_.mesh, "the same model with smaller cells");
    check_extent(mesh(), finer.mesh, o_.mesh, o_.finer);
    refinement_ = std::cbrt(static_cast<double>(finer.mesh.n_cells()) / static_cast<double>(mesh().n_cells()));
    if (refinement_ < 1.2)
      throw Error(o_.finer, fmt::format("its cells are {:.3g} times as small: too near to estimate the error of the mesh", refinement_),
                  "half as large is right");
    finer_digest_ = digest(o_.finer);
  }
  std::error_code failed;
  std::filesystem::create_directories(o_.folder + "/modes", failed);
  if (failed) throw Error(o_.folder, "cannot make the folder: " + failed.message(), "--work FOLDER", Exit::resources);
  std::vector<std::vector<std::int64_t>> nodes;
  for (const std::string& name : mesh().region_name) nodes.push_back(mesh().nodes_of(name, o_.mesh));
  neighbours_.resize(names().size());
  std::vector<std::int64_t> shared;
  for (size_t r = 0; r < nodes.size(); ++r)
    for (size_t s = 0; s < nodes.size(); ++s) {
      shared.clear();
      if (r != s) std::set_intersection(nodes[r].begin(), nodes[r].end(), nodes[s].begin(), nodes[s].end(), std::back_inserter(shared));
      if (!shared.empty()) neighbours_[r].push_back(s);
    }
}

std::string Candidates::table(size_t r) const { return fmt::format("{}.\"{}\"", is_beam(r) ? "beam" : "region", names()[r]); }

Assignment Candidates::consistent(Assignment levels) const {
  for (size_t r = 0; r < levels.size(); ++r)
    if (is_beam(r) && levels[r] == Level::stiffening) levels[r] = Level::linear;
  for (bool more = true; more;) {
    more = false;
    for (size_t r = 0; r < levels.size(); ++r)
      for (const size_t s : neighbours_[r])
        if (levels[r] == Level::stiffening && levels[s] == Level::linear) levels[s] = Level::stiffening, more = true;
  }
  return levels;
}

Candidates::Job Candidates::job(const Request& request) const {
  const Entry& time = scene_.table("time");
  std::vector<std::string> more;
  if (request.step != 1) more.push_back(fmt::format("time.step={:.17g}", written("s", time.number("step") * request.step)));
  if (!request.is_estimated && !time.given("error_estimate") && !time.given("tolerance"))
    more.push_back("time.error_estimate=\"never\"");  // a third of the time
  bool stress = false;
  for (const Entry& q : scene_.entries("quantity")) stress = stress || q.has("stress");
  const double end = time.number("end");
  if (request.end > 0) more.push_back(fmt::format("time.end={:.17g}", written("s", request.end)));
  if (!stress)  // no quantity is one of fields
    more.push_back(fmt::format("output.interval={:.17g}", written("s", end)));
  else if (request.end > 0 && !scene_.table("output").given("interval"))
    more.push_back(fmt::format("output.interval={:.17g}", written("s", end / 50)));
  for (size_t r = 0; r < request.levels.size(); ++r)
    if (is_beam(r))
      more.push_back(fmt::format("{}.fidelity=\"{}\"", table(r), word(request.levels[r])));
    else if (request.levels[r] == Level::stiffening)
      more.push_back(table(r) + ".stiffening=true");
  for (size_t r = 0; r < request.levels.size() && (request.modes != 1 || request.step != 1); ++r) {
    if (fidelity(request.levels[r]) != Fidelity::linear) continue;
    if (request.step == 1 && request.modes_in(r) == 1) continue;
    const Modes m = modes_of(r, request.modes_in(r));  // with half the step the same modes
    more.push_back(fmt::format("{}.up_to={:.17g}", table(r), written("Hz", m.up_to)));
    if (request.modes_in(r) != 1) more.push_back(fmt::format("{}.modes={}", table(r), m.most));
  }
  Digest key;
  key.add(about()).add(request.finer ? finer_digest_ : mesh_digest_);  // another hilo may compute otherwise
  for (const std::string& value : scene_.values())
    if (!value.starts_with("quantity.") && !value.starts_with("scene.title")) key.add(value);
  for (const Level l : request.levels) key.add(word(l));
  for (const std::string& m : more) key.add(m);
  Job job{fmt::format("{}/{:016x}", o_.folder, key.value()), {}};
  job.command = {solver(), "--quiet", o_.scene};
  if (!o_.mesh.empty()) job.command.push_back(job.name + "-tags.h5");
  job.command.insert(job.command.end(), {"-o", job.name + ".h5", "--checkpoint", "none"});
  const bool has_modes = std::any_of(request.levels.begin(), request.levels.end(), [](Level l) { return fidelity(l) == Fidelity::linear; });
  if (has_modes) job.command.insert(job.command.end(), {"--modes", o_.folder + "/modes"});
  for (const std::vector<std::string>* list : {&o_.overrides, static_cast<const std::vector<std::string>*>(&more)})
    for (const std::string& text : *list) job.command.insert(job.command.end(), {"--set", text});
  return job;
}

std::set<size_t> Candidates::named_in(const std::string& message) const {
  std::set<size_t> out;
  const std::vector<std::string> sets = mesh().all_names();
  const size_t n_regions = mesh().region_name.size();
  for (size_t begin = message.find('"'), end = 0; begin != std::string::npos; begin = message.find('"', end + 1)) {
    end = message.find('"', begin + 1);
    if (end == std::string::npos) break;
    const std::string name = message.substr(begin + 1, end - begin - 1);
    const size_t before = out.size();
    for (size_t r = 0; r < names().size(); ++r)
      if (is_of(name, names()[r])) out.insert(r);
    if (out.size() > before) continue;
    std::vector<std::int64_t> its, folded;
    if (std::find(sets.begin(), sets.end(), name) != sets.end()) its = mesh().nodes_of(name, o_.mesh);
    const auto block = std::find(mesh().block_name.begin(), mesh().block_name.end(), name) - mesh().block_name.begin();
    for (size_t i = 0; its.empty() && i < mesh().block.size(); ++i)
      if (mesh().block[i] == block) folded.push_back(static_cast<std::int64_t>(i));
    if (its.empty()) its = std::move(folded);
    std::vector<std::int64_t> shared;
    for (size_t r = 0; r < n_regions; ++r) {
      const std::vector<std::int64_t> mine = mesh().nodes_of(names()[r], o_.mesh);
      shared.clear();
      std::set_intersection(mine.begin(), mine.end(), its.begin(), its.end(), std::back_inserter(shared));
      if (!shared.empty()) out.insert(r);
    }
  }
  return out;
}

void Candidates::run(const std::vector<Request>& list, const Beyond& beyond) {
  std::vector<Process> processes;
  std::vector<std::pair<std::string, Request>> of;  // the names of their files
  for (const Request& request : list) {
    const Job j = job(request);
    if (done_.contains(j.name) || std::any_of(of.begin(), of.end(), [&](const auto& other) { return other.first == j.name; })) continue;
    if (take(j.name, request, beyond)) {
      ++known;
      continue;
    }
    of.emplace_back(j.name, request);
    std::vector<Fidelity> tags;
    for (size_t r = 0; r < mesh().region_name.size(); ++r) tags.push_back(fidelity(request.levels[r]));
    if (!tags.empty()) write_tags(j.name + "-tags.h5", request.finer ? o_.finer : o_.mesh, tags, {"hilo-advise"});
    processes.push_back({.command = j.command, .log = j.name + ".log"});
    if (beyond) processes.back().is_enough = [this, name = j.name, &beyond] { return is_beyond(name, beyond); };
    ++runs;
    if (!is_quiet())
      fmt::print(stderr, "run {}: {}{}{}, about {:.2g} s\n", runs, label(request.levels, names()),
                 (request.step != 1 ? fmt::format(", {:g} of the step", request.step) : "") +
                     (request.modes != 1 ? fmt::format(", {} times the modes", request.modes) : "") + (request.finer ? ", finer mesh" : ""),
                 request.end > 0 ? fmt::format(", to {:.4g} s", request.end) : "", price(request));
  }
  run_processes(processes, o_.at_once);
  for (const auto& [name, request] : of)
    if (!take(name, request, beyond)) fail(request, name, processes);
}

/// Takes what a run says that has ended; false where there is none, or where its files are damaged.
bool Candidates::take(const std::string& name, const Request& request, const Beyond& beyond) {
  if (!is_complete(name) && !is_beyond(name, beyond)) return false;
  Candidate c;
  static_cast<Request&>(c) = request;
  c.run = name + ".h5";
  try {
    read(c, name);
  } catch (const Error&) {
    return false;
  } catch (const Parsed::exception&) {
    return false;
  }
  done_[name] = std::move(c);
  return true;
}

/// The last line that a run wrote, without the name of its program, and the exit with which it ended.
void Candidates::fail(const Request& request, const std::string& name, const std::vector<Process>& processes) {
  Candidate& c = done_[name];
  static_cast<Request&>(c) = request;
  c.failure = last_line(name + ".log");
  if (const std::string program = "hilo-solve: "; c.failure.starts_with(program)) c.failure.erase(0, program.size());
  for (const Process& p : processes) {
    if (p.log != name + ".log") continue;
    c.seconds = p.seconds;
    if (p.status > 0 && p.status <= static_cast<int>(Exit::stopped)) c.exit = static_cast<Exit>(p.status);
    if (p.status > 128 || c.failure.empty())  // it could not say why
      c.failure =
          fmt::format("it ended with {}", p.status > 128 ? fmt::format("signal {}", p.status - 128) : fmt::format("status {}", p.status));
  }
}

const Candidate& Candidates::of(const Request& request, const Beyond& beyond) {
  run({request}, beyond);
  return done_.at(job(request).name);
}

std::vector<QuantityValue> Candidates::values_of(RunFile& run) const {
  std::vector<QuantityValue> out;
  for (QuantityValue& v : quantities(scene_, run)) {
    if (is_of_shapes(v.kind)) continue;
    if (v.tolerance.empty()) v.allowed = o_.tolerance * std::abs(v.value);
    out.push_back(std::move(v));
  }
  return out;
}

bool Candidates::is_beyond(const std::string& name, const Beyond& beyond) const {
  if (!beyond || is_complete(name) || !std::filesystem::exists(name + ".h5")) return false;
  try {
    RunFile run(name + ".h5");
    return beyond(values_of(run));
  } catch (const Error&) {
    return false;  // it has no rows yet
  }
}

void Candidates::read(Candidate& c, const std::string& name) const {
  RunFile run(c.run);
  c.values = values_of(run);
  const Parsed j = json_of_file(name + ".json");
  if (!is_complete(name)) c.ended = run.series("energy").t.back();
  c.seconds = j.value("processor_seconds", 0.0), c.unknowns = j.value("unknowns", 0.0);
  if (const Parsed estimate = j.value("error_estimate", Parsed::object()); estimate.contains("largest_share"))
    c.positions_off = estimate["largest_share"].is_number() ? estimate["largest_share"].get<double>() : c.positions_off;
  const double end = c.ended > 0 ? c.ended : c.end;
  c.cost = c.seconds * (end > 0 ? scene_.table("time").number("end") / end : 1);
  for (size_t r = 0; r < names().size(); ++r) {
    for (const Parsed& b : j.value("beyond_linear", Parsed::array()))
      if (is_of(b.at("region"), names()[r])) c.beyond.emplace(r, b.at("said"));
    if (c.levels[r] != Level::linear && c.levels[r] != Level::stiffening) continue;
    const auto each = [&](const char* measure, auto&& take) {
      const Parsed by_body = j.value(measure, Parsed::object());
      for (const auto& [body, value] : by_body.items())
        if (is_of(body, names()[r])) take(value.template get<double>());
    };
    each("modes_left_out", [&](double v) { c.lack[r] = std::max(c.lack[r], v); });
    for (const Measure& m : measures)
      if (c.levels[r] == Level::linear) each(m.name, [&](double v) { c.doubt[r] = std::max(c.doubt[r], m.error(v)); });
    for (const std::string& series : run.series_names())
      if (series.starts_with("left_out.") && is_of(series.substr(9), names()[r])) {
        const Series s = run.series(series);
        for (size_t row = 0; row < s.rows(); ++row) c.energy[r] = std::max(c.energy[r], s.at(row, 0));
      }
  }
}

Candidates::Modes Candidates::modes_of(size_t region, int scale) const {
  Modes out{40, 0.1 / scene_.table("time").number("step")};
  for (const Entry& e : scene_.entries(is_beam(region) ? "beam" : "region")) {
    if (is_beam(region) ? e.name != names()[region] : fnmatch(e.name.c_str(), names()[region].c_str(), 0) != 0) continue;
    if (e.given("modes")) out.most = static_cast<int>(e.number("modes"));
    if (e.given("up_to")) out.up_to = e.number("up_to");
  }
  out.most = std::max(out.most, 1) * scale;
  if (scale > 1) out.up_to *= 4.0 * scale * scale;
  return out;
}

double Candidates::unknowns(const Request& request) const {
  double n = 30;
  for (size_t r = 0; r < request.levels.size(); ++r) {
    const Level level = request.levels[r];
    n += level == Level::rigid        ? 6
         : level == Level::linear     ? 50 * request.modes_in(r)
         : level == Level::stiffening ? 1000
                                      : 3 * nodes_[r] * (request.finer ? std::pow(refinement_, 3) : 1);
  }
  return n;
}

/// Microseconds a step, 4600 (N/1000)^0.76: two thirds of a fit to 237 runs with flexible regions, which had a second solution to estimate
/// their error.
double Candidates::work(const Request& r) const {
  const Entry& time = scene_.table("time");
  const double end = r.end > 0 ? r.end : time.number("end");
  return 4.6e-3 * std::pow(unknowns(r) / 1000, 0.76) * end / (time.number("step") * r.step);
}

/// By the nearest run of its kind, with the same step if there is one.  Modes are dearer or cheaper than as many cells: without a run of
/// cells these cost what the fit says, or more by as much as the other runs do.
double Candidates::price(const Request& request) const {
  const auto has_cells = [](const Request& r) { return std::ranges::find(r.levels, Level::nonlinear) != r.levels.end(); };
  const double wanted = work(request);
  double nearest[2] = {HUGE_VAL, HUGE_VAL}, factor[2] = {1, 1};  // of other runs and of its kind
  for (const auto& [name, c] : done_) {
    if (!c.failure.empty() || c.seconds <= 0) continue;
    const double its = work(c), far = std::abs(std::log(wanted / its)) + (c.step == request.step ? 0 : 3);  // starts count as well
    const int kind = has_cells(c) == has_cells(request) ? 1 : 0;
    if (far < nearest[kind]) nearest[kind] = far, factor[kind] = c.seconds / its;
  }
  return wanted * (std::isfinite(nearest[1]) ? factor[1] : has_cells(request) ? std::max(1.0, factor[0]) : factor[0]);
}

double Candidates::spent() const {
  double sum = 0;
  for (const auto& [name, c] : done_) sum += c.seconds;
  return sum;
}

}  // namespace hilo
