// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-post response: what a harmonic force at a probe, or a base that swings, does to probes, by the modes of an analysis of modes,
//
//   H(omega) = sum_j phi_j(out) y_j,     (omega_j^2 - omega^2) y_j + i omega sum_k C_jk y_k = p_j,     phi of unit mass,
//
// modes phi without damping, and C what dampers and regions make of them, which couples them.
// Of a force p_j = phi_j(in), of the scene's loads p_j = phi_j.F.  A base that moves with the acceleration e exp(i omega t) pushes each
// mode with p_j = -phi_j.M s, s what it moves slowly; where all that stands still moves, s = e, and phi_j.M s = -F_j/omega_j^2, F_j the
// force on a held set, where it alone does. What brakes s, mass-proportional damping, pushes too: -phi_j.C s/(i omega).  To what moves
// against the base s(out) comes, -s/omega^2 as displacement.
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <complex>
#include <memory>
#include <numbers>
#include <optional>

#include "base/args.hpp"
#include "base/error.hpp"
#include "base/math.hpp"
#include "post/charts/figure.hpp"
#include "post/commands/commands.hpp"
#include "post/files/csv.hpp"
#include "post/files/output.hpp"
#include "post/picture/picture.hpp"
#include "post/run/run_file.hpp"

namespace hilo {
namespace {

struct ResponseOptions {
  std::string run, force, of = "displacement", csv, png, title, size = "1280x720";
  std::vector<std::string> at, base;
  bool relative = false, loads = false;
  double from = 0, to = 0, damping = 0;
  int points = 1000;
};

struct Modes {
  std::vector<double> omega2, amplitude;
  Eigen::MatrixXd C;  // [1/s]
  bool is_damped = false, is_diagonal = true;
  /// Amplitudes under the forces p.
  Eigen::VectorXcd answer(double omega, const Eigen::VectorXcd& p) const {
    const std::complex<double> i_omega(0, omega);
    const auto n = static_cast<Eigen::Index>(omega2.size());
    Eigen::MatrixXcd A;
    if (!is_diagonal) A = i_omega * C;
    Eigen::VectorXcd out(n);
    for (Eigen::Index j = 0; j < n; ++j) {
      const double spring = omega2[static_cast<size_t>(j)] - omega * omega;
      if (is_diagonal)
        out[j] = p[j] / (spring + i_omega * C(j, j));
      else
        A(j, j) += spring;
    }
    return is_diagonal ? out : Eigen::VectorXcd(A.partialPivLu().solve(p));
  }
};
Modes modes_of(const RunFile& file, double more_damping) {
  const Series table = file.series("mode"), stiffness = file.series("mode_stiffness"), damping = file.series("mode_damping");
  Modes out;
  const auto n = static_cast<Eigen::Index>(table.rows()) - 1;
  out.C = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto row = static_cast<size_t>(j) + 1;
    out.omega2.push_back(stiffness.at(row, 0)), out.amplitude.push_back(table.at(row, 9));
    if (out.amplitude.back() == 0) throw Error(file.path, "its modes turn with the spin of bodies: they have no response of this kind");
    for (Eigen::Index k = 0; k < n; ++k) out.C(j, k) = damping.at(row, static_cast<size_t>(k));
    out.C(j, j) += 2 * more_damping * std::sqrt(std::abs(out.omega2.back()));
  }
  const Eigen::MatrixXd off = out.C - Eigen::MatrixXd(out.C.diagonal().asDiagonal());
  const double largest = n > 0 ? out.C.cwiseAbs().maxCoeff() : 0;
  out.is_damped = largest > 0, out.is_diagonal = n < 2 || off.cwiseAbs().maxCoeff() <= 1e-12 * largest;
  return out;
}

/// "tip.z": a name and the number of an axis; of "z" the name is empty.
std::pair<std::string, size_t> name_and_axis(const std::string& text, const char* what, const char* hint) {
  const auto dot = text.rfind('.');
  const std::string axes = "xyz", axis = dot == text.npos ? text : text.substr(dot + 1);
  if (axis.size() != 1 || axes.find(axis) == axes.npos)
    throw Error("response", fmt::format("\"{}\" is no direction of a {}", text, what), hint, Exit::usage);
  return {dot == text.npos ? "" : text.substr(0, dot), axes.find(axis)};
}

/// How much each mode of unit mass changes a column of a history.
std::vector<double> change_of(const Series& history, size_t column, const Modes& modes) {
  std::vector<double> out;
  for (size_t k = 1; k < history.rows(); ++k) out.push_back((history.at(k, column) - history.at(0, column)) / modes.amplitude[k - 1]);
  return out;
}

/// "tip.z": how much each mode of unit mass moves a probe along an axis.
struct Place {
  std::vector<double> shape;
  size_t axis;
};
Place place_of(const RunFile& run, const std::string& text, const Modes& modes) {
  const auto [name, axis] = name_and_axis(text, "probe", "write the probe and its axis: tip.z");
  if (name.empty()) throw Error("response", fmt::format("\"{}\" names no probe", text), "write the probe and its axis: tip.z", Exit::usage);
  return {change_of(run.series("probe." + name), axis, modes), axis};
}

/// phi_j.M s and phi_j.C s of each mode, and s as a whole: along these axes where everything that stands still moves, or else unknown.
struct Base {
  std::vector<double> part, drag;
  std::optional<Vec3> slow;
  Base(const RunFile& run, const std::vector<std::string>& bases, const Modes& modes);
  /// What the base moves a place by slowly; where it is one support of several, by all modes that there are.
  double slow_at(const Place& at) const {
    if (slow) return (*slow)[static_cast<Eigen::Index>(at.axis)];
    double sum = 0;
    for (size_t j = 0; j < part.size(); ++j) sum += at.shape[j] * part[j];
    return sum;
  }
};
Base::Base(const RunFile& run, const std::vector<std::string>& bases, const Modes& modes)
    : part(modes.omega2.size(), 0.0), drag(part.size(), 0.0) {
  const Series whole = run.series("participation"), brakes = run.series("mode_drag");
  Vec3 along = Vec3::Zero();
  std::vector<double> of_all(part.size(), 0.0);
  bool is_all = false, is_some = false;
  for (const std::string& text : bases) {
    const auto [name, axis] = name_and_axis(text, "base", "write an axis, z, or the name of a motion and an axis: wall.z");
    along[static_cast<Eigen::Index>(axis)] += 1;
    for (size_t j = 0; j < part.size(); ++j)  // of one motion what is damped to the ground is braked by it
      of_all[j] += whole.at(j + 1, axis), drag[j] += brakes.at(j + 1, name.empty() ? axis : 3 + axis);
    (name.empty() ? is_all : is_some) = true;
    if (name.empty()) continue;
    const std::vector<double> force = change_of(run.series("motion." + name), axis, modes);
    const double highest = *std::max_element(modes.omega2.begin(), modes.omega2.end());
    for (size_t j = 0; j < part.size(); ++j)  // of a motion without strain no support feels anything
      if (modes.omega2[j] > 1e-9 * highest) part[j] -= force[j] / modes.omega2[j];
  }
  if (is_all && is_some)
    throw Error("--base", "an axis alone moves every support, so it cannot stand beside named ones", "all axes alone, or all NAME.AXIS",
                Exit::usage);
  double off = 0, size = 0;
  for (size_t j = 0; j < part.size() && is_some; ++j)
    off = std::max(off, std::abs(part[j] - of_all[j])), size = std::max(size, std::abs(of_all[j]));
  if (is_all || off < 1e-4 * size) {  // or there is no other support; forces on it are of strains that are not quite small
    part = of_all, slow = along;
  } else {
    std::fill(drag.begin(), drag.end(), 0.0);
    if (modes.is_damped)
      warn("--base",
           "one of several supports moves: the damping of the slow motion between them is left out (an error of about twice the damping "
           "ratio)");
  }
}

void run(const ResponseOptions& o) {
  const RunFile file = judged_run(o.run);
  if (file.buckles || file.shapes.size() < 2) throw Error(o.run, "holds no modes", "run the scene with time.analysis = \"modes\"");
  const Modes modes = modes_of(file, o.damping);
  const double highest = std::sqrt(std::max(0.0, *std::max_element(modes.omega2.begin(), modes.omega2.end()))) / (2 * std::numbers::pi);
  const double from = o.from > 0 ? o.from : highest / 1000, to = o.to > 0 ? o.to : highest;
  if (!(to > from)) throw Error("--to", fmt::format("{:g} Hz is not above {:g} Hz", to, from), "", Exit::usage);
  if (const int n = !o.force.empty() + !o.base.empty() + o.loads; n != 1)
    throw Error("response", n == 0 ? "nothing excites the structure" : "several of --force, --base and --loads are given",
                "give --force, --base or --loads", Exit::usage);
  if (o.relative && o.base.empty())
    throw Error("--relative", "works with --base alone", "give --base, or leave --relative out", Exit::usage);
  if (o.at.empty() && o.force.empty()) throw Error("--at", "no probe is named", "--at tip.z", Exit::usage);
  std::optional<Base> base;
  std::vector<double> push;
  if (!o.base.empty()) {
    base.emplace(file, o.base, modes);
  } else if (o.loads) {
    const Series loads = file.series("mode_load");
    for (size_t j = 0; j < modes.omega2.size(); ++j) push.push_back(loads.at(j + 1, 0));
    if (std::ranges::all_of(push, [](double p) { return p == 0; }))
      throw Error("--loads", "the scene has no load that moves a mode", "[[load]] without a history, or --force", Exit::usage);
  } else {
    push = place_of(file, o.force, modes).shape;
  }
  const std::string unit = o.loads ? (o.of == "displacement" ? "m"
                                      : o.of == "velocity"   ? "m/s"
                                                             : "m/s^2")
                           : base  ? (o.of == "displacement" ? "s^2"
                                      : o.of == "velocity"   ? "s"
                                                             : "1")
                                   : (o.of == "displacement" ? "m/N"
                                      : o.of == "velocity"   ? "m/s/N"
                                                             : "m/s^2/N");
  const int rates = o.of == "displacement" ? 0 : o.of == "velocity" ? 1 : 2;
  std::vector<std::string> header{"frequency [Hz]"};
  std::vector<std::vector<double>> columns(1);
  for (int i = 0; i < o.points; ++i) columns[0].push_back(from * std::pow(to / from, static_cast<double>(i) / std::max(1, o.points - 1)));
  std::vector<Eigen::VectorXcd> answers;
  for (const double f : columns[0]) {
    const std::complex<double> i_omega(0, 2 * std::numbers::pi * f);
    Eigen::VectorXcd p(static_cast<Eigen::Index>(modes.omega2.size()));
    for (size_t j = 0; j < modes.omega2.size(); ++j)
      p[static_cast<Eigen::Index>(j)] = base ? -base->part[j] - base->drag[j] / i_omega : std::complex<double>(push[j]);
    answers.push_back(modes.answer(i_omega.imag(), p));
  }
  Figure figure;
  std::tie(figure.width, figure.height) = parse_size(o.size);
  const std::string cause = o.loads ? " under the loads" : base ? " over the acceleration of the base" : " over a force along " + o.force;
  figure.title = o.title.empty() ? fmt::format("{}: {}{}{}", file.title, o.of, o.relative ? " against the base" : "", cause) : o.title;
  figure.panels = {{"", {"frequency [Hz]", true}, {fmt::format("{} [{}]", o.of, unit), true}, {}},
                   {"", {"frequency [Hz]", true}, {"phase [degrees]"}, {}}};
  for (const std::string& at : o.at.empty() ? std::vector{o.force} : o.at) {
    const Place place = place_of(file, at, modes);
    const std::vector<double>& shape = place.shape;
    std::vector<double> size, phase;
    for (size_t i = 0; i < answers.size(); ++i) {
      const double omega = 2 * std::numbers::pi * columns[0][i];
      std::complex<double> sum = (Eigen::Map<const Eigen::VectorXd>(shape.data(), answers[i].size()).transpose() * answers[i]).value();
      if (base && !o.relative) sum -= base->slow_at(place) / (omega * omega);
      sum *= std::pow(std::complex<double>(0, omega), rates);
      size.push_back(std::abs(sum)), phase.push_back(std::arg(sum) * 180 / std::numbers::pi);
    }
    const Rgb colour = curve_colour(static_cast<int>(figure.panels[0].curves.size()));
    figure.panels[0].curves.push_back({at, columns[0], size, colour});
    figure.panels[1].curves.push_back({at, columns[0], phase, colour});
    header.push_back(fmt::format("{} [{}]", at, unit)), columns.push_back(size);
    header.push_back(at + " phase [degrees]"), columns.push_back(phase);
  }
  if (!o.png.empty()) write_chart(figure, o.png);
  if (!o.csv.empty() || o.png.empty()) write_out(o.csv.empty() ? "-" : o.csv, csv_text(header, columns));
}

}  // namespace

Command response_command(CLI::App& app) {
  auto* sub = app.add_subcommand("response", "amplitude and phase of probes under a harmonic force, or on a base that swings, by modes");
  const auto o = std::make_shared<ResponseOptions>();
  sub->add_option("run", o->run, "run.h5 of a scene with time.analysis = \"modes\" and probes")->required();
  sub->add_option("--force", o->force, "probe and axis that a force of 1 N swings along: tip.z");
  sub->add_option("--base", o->base,
                  "axis along which all that stands still swings with 1 m/s^2: z; or a motion of the scene and an axis, whose set swings "
                  "alone: wall.z; --base once for each, they swing together")
      ->allow_extra_args(false);
  sub->add_flag("--loads", o->loads, "all loads of the scene, and gravity, swing together, with the values that they have at t = 0");
  sub->add_flag("--relative", o->relative, "of a base: how probes move against it");
  sub->add_option("--at", o->at, "probe and axis that answers, --at once for each; that of the force by default")->allow_extra_args(false);
  sub->add_option("--of", o->of, "displacement, velocity or acceleration")
      ->check(CLI::IsMember({"displacement", "velocity", "acceleration"}))
      ->capture_default_str();
  sub->add_option("--from", o->from, "lowest frequency in Hz; a thousandth of the highest mode by default")->check(CLI::PositiveNumber);
  sub->add_option("--to", o->to, "highest frequency in Hz; that of the highest mode by default")->check(CLI::PositiveNumber);
  sub->add_option("--points", o->points, "frequencies between")->check(CLI::Range(2, 1000000))->capture_default_str();
  sub->add_option("--damping", o->damping, "ratio added to the damping of every mode")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  sub->add_option("-o,--output", o->csv, "CSV file; stdout when neither this nor --png is given");
  sub->add_option("--png", o->png, "chart of amplitude and phase");
  sub->add_option("--title", o->title, "title of the chart");
  sub->add_option("--size", o->size, "size of the chart, WIDTHxHEIGHT")->capture_default_str();
  example(*sub,
          "  hilo-post response modes.h5 --force tip.z --damping 0.01 -o response.csv --png response.png\n"
          "  hilo-post response modes.h5 --base z --at tip.z --of acceleration --damping 0.01 -o transmissibility.csv\n"
          "  hilo-post response modes.h5 --loads --at tip.z --damping 0.01 -o swing.csv");
  return {sub, [o] { run(*o); }};
}

}  // namespace hilo
