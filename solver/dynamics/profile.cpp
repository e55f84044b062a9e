// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>

#include "base/table.hpp"

namespace hilo {
namespace {

Traffic operator-(const Traffic& a, const Traffic& b) {
  return {a.messages - b.messages, a.collectives - b.collectives, a.bytes - b.bytes};
}
Traffic operator+(const Traffic& a, const Traffic& b) {
  return {a.messages + b.messages, a.collectives + b.collectives, a.bytes + b.bytes};
}

}  // namespace

double wall_clock() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

double processor_clock() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

Phases& phases() {
  static Phases p;
  return p;
}

Timed::~Timed() {
  const Traffic sent = traffic() - sent_;
  phase_.seconds += wall_clock() - start_;
  phase_.sent.messages += sent.messages, phase_.sent.collectives += sent.collectives, phase_.sent.bytes += sent.bytes;
}

Profile::Profile(const Comm& comm, const KktSolver& solver, double began, double processor_began, const std::string& results) {
  const Phases& p = phases();
  const double all = p.earlier.wall + wall_clock() - began, set_up = p.earlier.set_up + solver.set_up_seconds();
  const Traffic everything = p.earlier.sent + traffic();
  Phase rest{all - p.assembly.seconds - p.solve.seconds - p.output.seconds,
             everything - Traffic{p.assembly.sent.messages + p.solve.sent.messages + p.output.sent.messages,
                                  p.assembly.sent.collectives + p.solve.sent.collectives + p.output.sent.collectives,
                                  p.assembly.sent.bytes + p.solve.sent.bytes + p.output.sent.bytes}};
  const auto row = [&](const char* name, const Phase& phase, std::string count) {
    Row r{name,
          comm.sum(phase.seconds) / comm.size,
          1,
          comm.max(static_cast<double>(phase.sent.messages)),
          comm.max(static_cast<double>(phase.sent.collectives)),
          comm.max(phase.sent.bytes),
          std::move(count)};
    if (const double most = comm.max(phase.seconds); r.seconds > 0) r.imbalance = most / r.seconds;
    return r;
  };
  rows[0] = row("assembly", p.assembly, fmt::format("{} evaluations, {} tangents", p.evaluations, p.tangents));
  rows[1] = row("set-up", {set_up, {}}, "");
  rows[2] = row("solve", {p.solve.seconds - set_up, p.solve.sent}, fmt::format("{} solves, {} iterations", p.solves, p.linear_iterations));
  rows[3] = row("output", p.output, fmt::format("{} records", p.records));
  rows[4] = row("rest", rest, "");
  rows[5] = row("all", {all, everything}, "");
  processor_seconds = comm.sum(p.earlier.processor + processor_clock() - processor_began);
  undivided_seconds = comm.max(p.earlier.undivided + solver.undivided_seconds());
  solver_bytes = comm.max(solver.bytes());
  std::error_code ignored;
  const auto size = std::filesystem::file_size(results, ignored);
  result_bytes = ignored ? 0 : static_cast<double>(size);
}

void Profile::tell(Json& run) const {
  Json phases = Json::object(Json::In::lines);
  for (const Row& r : rows)
    phases.add(r.name, {{"seconds", {r.seconds, 6}},
                        {"imbalance", {r.imbalance, 4}},
                        {"messages", {r.messages, 15}},
                        {"collectives", {r.collectives, 15}},
                        {"bytes_sent", {r.bytes, 15}}});
  run.add("profile", std::move(phases));
  run.add("processor_seconds", {processor_seconds, 6});
  run.add("undivided_seconds", {undivided_seconds, 6});
  run.add("solver_bytes", {solver_bytes, 15});
  run.add("result_bytes", {result_bytes, 15});
}

std::string Profile::text() const {
  Table t{{"phase", "seconds", "share", "imbalance", "messages", "sums", "MB sent", "what"}, {}, 1};
  for (const Row& r : rows)
    t.rows.push_back({r.name, fmt::format("{:.3f}", r.seconds),
                      fmt::format("{:.1f}%", 100 * r.seconds / std::max(rows.back().seconds, 1e-300)), fmt::format("{:.3f}", r.imbalance),
                      fmt::format("{:.0f}", r.messages), fmt::format("{:.0f}", r.collectives), fmt::format("{:.3f}", r.bytes / 1e6),
                      r.count});
  return t.text() + fmt::format(
                        "matrix and factors {:.1f} MB, results {:.1f} MB; seconds: mean of the ranks, imbalance: largest divided by mean; "
                        "messages, sums and MB: of the rank with most\n",
                        solver_bytes / 1e6, result_bytes / 1e6);
}

}  // namespace hilo
