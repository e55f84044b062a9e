// SPDX-License-Identifier: GPL-3.0-or-later
// What tests of modes share: runs, bodies, slender beams, rows of a response.
#pragma once
#include <numbers>
#include <sstream>

#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test {

constexpr double pi = std::numbers::pi;
inline const std::string steel = solid(2e11, 0, 8000);
/// A spring of three stiffnesses at a point.
inline std::string bushing(const std::string& name, const std::string& on, const Vec3& at, const Vec3& stiffness,
                           const std::string& more = "") {
  return spring("bushing", name, "ground", on, "at = " + list(at) + "\nstiffness = " + list(stiffness) + "\n" + more);
}
/// A revolute about y.
inline std::string pin(const std::string& name, const std::string& a, const std::string& b, const Vec3& at) {
  return axial("revolute", name, a, b, at, Vec3::UnitY());
}

/// A scene of the test, and what modes it has.
class NaturalModes : public ScenePlace {
 protected:
  /// Rows of /history/mode, the state of rest left out.
  Eigen::MatrixXd modes(const std::string& scene, int wanted, const std::string& options = "") {
    work.write("scene.toml", scene + "[time]\nanalysis = \"modes\"\nmodes = " + std::to_string(wanted) + "\n");
    ran = work.run("hilo-solve scene.toml " + mesh + " -o run.h5 " + options);
    succeeded(ran);
    const Eigen::MatrixXd all = Results(work / "run.h5").history("mode");
    EXPECT_LT(all.col(8).maxCoeff(), 1e-5) << "shapes satisfy the equations";
    return all.bottomRows(all.rows() - 1);
  }
  Eigen::VectorXd frequencies(const std::string& scene, int wanted) { return modes(scene, wanted).col(0); }
};

inline Mesh beam(const Vec3& size, int n) { return block_mesh({.shape = Shape::hex20r, .n = {n, 1, 1}, .high = size}); }

/// Timoshenko's beam by its two bending branches would be more than a slender one needs: corrections of order (r/L)^2 are below 2e-4 here.
inline const double r_z = 0.01 / std::sqrt(12), r_y = 0.015 / std::sqrt(12),
                    wave = std::sqrt(2e11 / 8000);                                                // radii of gyration [m], bar speed
inline double bending(double beta_l, double r) { return beta_l * beta_l * r * wave / (2 * pi); }  // of a beam 1 m long  [Hz]

/// Rows of a response: frequency, amplitude and phase.
struct Answer {
  double f, size, phase;
};
inline std::vector<Answer> answers(const Ran& ran) {
  EXPECT_EQ(ran.exit, 0) << ran.err;
  std::istringstream rows(ran.out);
  std::string line;
  std::getline(rows, line);
  std::vector<Answer> out;
  for (Answer a{}; std::getline(rows, line); out.push_back(a))
    EXPECT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", &a.f, &a.size, &a.phase), 3) << line;
  return out;
}

}  // namespace hilo::test
