// hilo-post response: what a harmonic force at a probe does to probes, by the modes of an analysis of modes,
//
//   H(omega) = sum_j phi_j(out) phi_j(in) / (omega_j^2 - omega^2 + 2 i zeta_j omega_j omega),   phi of unit mass.
#include <fmt/format.h>

#include <complex>
#include <memory>
#include <numbers>

#include "base/args.hpp"
#include "base/error.hpp"
#include "post/charts/figure.hpp"
#include "post/commands/commands.hpp"
#include "post/files/csv.hpp"
#include "post/files/output.hpp"
#include "post/picture/picture.hpp"
#include "post/run/run_file.hpp"

namespace hilo {
namespace {

struct Options {
  std::string run, force, of = "displacement", csv, png, title, size = "1280x720";
  std::vector<std::string> at;
  double from = 0, to = 0, damping = 0;
  int points = 1000;
};

struct Modes {
  std::vector<double> omega2, damping, amplitude;
};

/// "tip.z": how much each mode of unit mass moves a probe along an axis.
std::vector<double> shape_at(const RunFile& run, const std::string& name, const Modes& modes) {
  const auto dot = name.rfind('.');
  const std::string axes = "xyz", axis = dot == name.npos ? "" : name.substr(dot + 1);
  if (axis.size() != 1 || axes.find(axis) == axes.npos)
    throw Error("response", fmt::format("\"{}\" is no direction of a probe", name), "write the probe and its axis: tip.z", Exit::usage);
  const Series probe = run.series("probe." + name.substr(0, dot));
  std::vector<double> out;
  for (size_t k = 1; k < probe.rows(); ++k)
    out.push_back((probe.at(k, axes.find(axis)) - probe.at(0, axes.find(axis))) / modes.amplitude[k - 1]);
  return out;
}

void run(const Options& o) {
  const RunFile file(o.run);
  if (file.frequencies.size() < 2) throw Error(o.run, "holds no modes", "run the scene with time.analysis = \"modes\"");
  const Series table = file.series("mode");
  Modes modes;
  double highest = 0;
  for (size_t k = 1; k < table.rows(); ++k) {
    const double f = table.at(k, 0), omega = 2 * std::numbers::pi * f;
    modes.omega2.push_back(omega * std::abs(omega)), modes.damping.push_back(table.at(k, 1) + o.damping);
    modes.amplitude.push_back(table.at(k, 9));
    highest = std::max(highest, f);
    if (table.at(k, 9) == 0) throw Error(o.run, "its modes turn with the spin of bodies: they have no response of this kind");
  }
  const double from = o.from > 0 ? o.from : highest / 1000, to = o.to > 0 ? o.to : highest;
  if (!(to > from)) throw Error("--to", fmt::format("{:g} Hz is not above {:g} Hz", to, from), "", Exit::usage);
  const std::vector<double> push = shape_at(file, o.force, modes);
  const std::string unit = o.of == "displacement" ? "m/N" : o.of == "velocity" ? "m/s/N" : "m/s^2/N";
  const int rates = o.of == "displacement" ? 0 : o.of == "velocity" ? 1 : 2;
  std::vector<std::string> header{"frequency [Hz]"};
  std::vector<std::vector<double>> columns(1);
  for (int i = 0; i < o.points; ++i) columns[0].push_back(from * std::pow(to / from, static_cast<double>(i) / std::max(1, o.points - 1)));
  Figure figure;
  std::tie(figure.width, figure.height) = parse_size(o.size);
  figure.title = o.title.empty() ? fmt::format("{}: {} over a force along {}", file.title, o.of, o.force) : o.title;
  figure.panels = {{"", {"frequency [Hz]", true}, {fmt::format("{} [{}]", o.of, unit), true}, {}},
                   {"", {"frequency [Hz]", true}, {"phase [degrees]"}, {}}};
  for (const std::string& at : o.at.empty() ? std::vector{o.force} : o.at) {
    const std::vector<double> shape = shape_at(file, at, modes);
    std::vector<double> size, phase;
    for (const double f : columns[0]) {
      const double omega = 2 * std::numbers::pi * f;
      std::complex<double> sum = 0;
      for (size_t j = 0; j < shape.size(); ++j)
        sum += shape[j] * push[j] /
               std::complex<double>(modes.omega2[j] - omega * omega, 2 * modes.damping[j] * std::sqrt(std::abs(modes.omega2[j])) * omega);
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
  auto* sub = app.add_subcommand("response", "amplitude and phase of probes under a harmonic force at one of them, by modes");
  const auto o = std::make_shared<Options>();
  sub->add_option("run", o->run, "run.h5 of a scene with time.analysis = \"modes\" and probes")->required();
  sub->add_option("--force", o->force, "probe and axis that a force of 1 N swings along: tip.z")->required();
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
  example(*sub, "  hilo-post response modes.h5 --force tip.z --damping 0.01 -o response.csv --png response.png");
  return {sub, [o] { run(*o); }};
}

}  // namespace hilo
