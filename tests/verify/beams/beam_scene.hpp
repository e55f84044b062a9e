// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes of beams, run as a user would.
#pragma once
#include <Eigen/LU>
#include <complex>
#include <map>
#include <numbers>
#include <sstream>

#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test {

/// A section by its diagonal stiffness, alike to both sides.
inline std::string plain_section(double GA, double EA, double EI, double GJ, const std::string& more = "") {
  return fmt::format("[section.s]\nkind = \"matrix\"\nstiffness = [{0}, {0}, {1}]\nbending = [{2}, {2}, {3}]\n{4}\n", GA, EA, EI, GJ, more);
}
inline std::string beam_of(const std::string& points, int cells, const std::string& more = "a = \"ground\"") {
  return fmt::format("[beam.arm]\npoints = {}\ncells = [{}]\nsection = \"s\"\n{}\n", points, cells, more);
}
inline std::string twist(const std::string& on, const Vec3& torque, const std::string& more = "") {
  return load("torque", "t" + on, on, "torque = " + list(torque) + "\n" + more);
}
inline std::string tip_probe(const std::string& on = "arm.end") { return probe("tip", on); }

/// What a cantilever of a metre does at x under 1 N of circular frequency w at its tip: EI (1 + i w beta) d4u/dx4 = m (w^2 - i w alpha) u.
inline std::complex<double> damped_cantilever(double EI, double m, double beta, double alpha, double x, double w) {
  using C = std::complex<double>;
  const C stiff = EI * C(1, w * beta), k = std::pow(m * C(w * w, -w * alpha) / stiff, 0.25);
  Eigen::Matrix2cd ends;  // of cosh - cos and sinh - sin: no moment, the force
  ends << std::cosh(k) + std::cos(k), std::sinh(k) + std::sin(k), std::sinh(k) - std::sin(k), std::cosh(k) + std::cos(k);
  const Eigen::Vector2cd c = ends.inverse() * Eigen::Vector2cd(0, -1.0 / (stiff * k * k * k));
  return c[0] * (std::cosh(k * x) - std::cos(k * x)) + c[1] * (std::sinh(k * x) - std::sin(k * x));
}

class BeamPlace : public ScenePlace {
 protected:
  /// Where the tip is at the end.
  Vec3 tip(const std::string& scene, const std::string& options = "") {
    const Eigen::MatrixXd x = solved(scene, options).history("probe/tip");
    return x.bottomRows(1).leftCols<3>().transpose();
  }
  /// Columns of `hilo-post beam run.h5 WHAT -o -` by their first word.
  std::map<std::string, std::vector<double>> curves(const std::string& scene, const std::string& what = "arm") {
    (void)solved(scene);
    const Ran post = succeeded(work.run("hilo-post beam run.h5 " + what + " -o -"));
    std::istringstream lines(post.out);
    std::string line, cell;
    std::getline(lines, line);
    std::vector<std::string> names;
    for (std::istringstream header(line); std::getline(header, cell, ',');) names.push_back(cell.substr(0, cell.find(' ')));
    std::map<std::string, std::vector<double>> out;
    while (std::getline(lines, line)) {
      size_t c = 0;
      for (std::istringstream row(line); std::getline(row, cell, ',');)
        out[names.at(c++)].push_back(cell.empty() ? std::nan("") : std::stod(cell));
    }
    return out;
  }
};

}  // namespace hilo::test
