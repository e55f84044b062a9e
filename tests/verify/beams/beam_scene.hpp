// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes of beams, run as a user would.
#pragma once
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "verify/verify.hpp"

namespace hilo::test {

/// A section by its diagonal stiffness, alike to both sides.
inline std::string plain_section(double GA, double EA, double EI, double GJ, const std::string& more = "") {
  return fmt::format("[section.s]\nkind = \"matrix\"\nstiffness = [{0}, {0}, {1}]\nbending = [{2}, {2}, {3}]\n{4}\n", GA, EA, EI, GJ, more);
}
inline std::string beam_of(const std::string& points, int cells, const std::string& more = "a = \"ground\"") {
  return fmt::format("[beam.arm]\npoints = {}\ncells = [{}]\nsection = \"s\"\n{}\n", points, cells, more);
}
inline std::string push(const std::string& on, const Vec3& force, const std::string& more = "") {
  return fmt::format("[[load]]\nkind = \"force\"\nname = \"f{0}{1:.0f}\"\non = \"{0}\"\nforce = [{1}, {2}, {3}]\n{4}\n", on, force[0],
                     force[1], force[2], more);
}
inline std::string twist(const std::string& on, const Vec3& torque, const std::string& more = "") {
  return fmt::format("[[load]]\nkind = \"torque\"\nname = \"t{0}\"\non = \"{0}\"\ntorque = [{1}, {2}, {3}]\n{4}\n", on, torque[0],
                     torque[1], torque[2], more);
}
inline std::string tip_probe(const std::string& on = "arm.end") { return fmt::format("[[probe]]\nname = \"tip\"\non = \"{}\"\n", on); }
inline std::string in_steps(int n) { return fmt::format("[time]\nanalysis = \"static\"\nsteps = {}\n", n); }
inline std::string in_time(double end, double step, const std::string& more = "") {
  return fmt::format("[time]\nend = {}\nstep = {}\n{}\n", end, step, more);
}

class BeamPlace : public testing::Test {
 protected:
  Results solved(const std::string& scene, const std::string& options = "") {
    work.write("scene.toml", scene);
    ran = work.run("hilo-solve --quiet scene.toml -o run.h5 " + options);
    if (ran.exit != 0) throw std::runtime_error(ran.err);
    return Results(work / "run.h5");
  }
  /// Where the tip is at the end.
  Vec3 tip(const std::string& scene, const std::string& options = "") {
    const Eigen::MatrixXd x = solved(scene, options).history("probe/tip");
    return x.bottomRows(1).leftCols<3>().transpose();
  }
  Workplace work;
  Ran ran;
};

}  // namespace hilo::test
