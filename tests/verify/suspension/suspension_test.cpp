// SPDX-License-Identifier: GPL-3.0-or-later
// The rigid run of data/suspension against its kinematics, made here from the table of joints: the velocities that all joints allow are the
// null space of their rows, two of them, named by the vertical velocities of frame and wheel.
//   at rest    the work of strut, tyre and weights along both is zero: the strut carries the corner load divided by its motion ratio
//   small      M q'' + K q = 0 with M and K on these two: bounce of the body and hop of the wheel
#include <Eigen/Eigenvalues>

#include "verify/verify.hpp"

namespace hilo::test::suspension_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct JointRow {
  const char *kind, *a, *b;
  Vec3 at, axis = Vec3::UnitZ(), x = Vec3::UnitX();
};
const std::vector<JointRow> joints = {  // as in data/suspension/scene.toml; the post is ground
    {"prismatic", "ground", "frame", {0, 0.16, 0.60}},
    {"spherical", "frame", "lower_arm", {0.20, 0.28, 0.30}},
    {"in-line", "frame", "lower_arm", {-0.20, 0.28, 0.30}, Vec3::UnitX()},
    {"spherical", "knuckle", "lower_arm", {0, 0.69, 0.30}},
    {"spherical", "frame", "upper_arm", {0.13, 0.38, 0.62}},
    {"in-line", "frame", "upper_arm", {-0.13, 0.38, 0.62}, Vec3::UnitX()},
    {"spherical", "knuckle", "upper_arm", {-0.02, 0.67, 0.62}},
    {"fixed", "knuckle", "wheel", {0, 0.80, 0.40}},
    {"spherical", "frame", "tie_rod", {-0.14, 0.335, 0.37}},
    {"universal", "knuckle", "tie_rod", {-0.14, 0.75, 0.36}, Vec3::UnitZ(), Vec3::UnitX()},
    {"universal", "frame", "strut_tube", {0, 0.40, 0.86}, Vec3::UnitX(), {0, 0.52, 0.08}},
    {"prismatic", "strut_tube", "strut_rod", {0, 0.44, 0.60}, {0, 0.085, -0.525}},
    {"spherical", "lower_arm", "strut_rod", {0, 0.485, 0.335}}};
const Vec3 strut_top(0, 0.40, 0.86), strut_foot(0, 0.485, 0.335), contact(0, 0.80, 0);
constexpr double g = 9.80665, strut_stiffness = 155e3, tyre_stiffness = 250e3;

Mat3 cross(const Vec3& d) { return (Mat3() << 0, -d.z(), d.y(), d.z(), 0, -d.x(), -d.y(), d.x(), 0).finished(); }

/// The bodies of a run at an instant and the velocities their joints allow; a body's six columns are the velocity of its centre and its
/// spin.
class Corner {
 public:
  Corner(const Results& run, Eigen::Index row) {
    const auto names = run.file().read_strings("/body/name");
    const auto mass = run.file().read<double>("/body/mass"), moment = run.file().read<double>("/body/inertia");
    for (size_t b = 0; b < names.size(); ++b) {
      if (names[b] == "post") continue;
      const MatrixXd x = run.history("body/" + names[b]);
      Body body{names[b], mass[b], reference(run, b, -1), x.row(row).head<3>()};
      Mat3 A0, A;
      for (int k = 0; k < 3; ++k) {
        A0.col(k) = reference(run, b, k);
        A.col(k) = (x.row(row).segment<3>(3 * k + 3).transpose() - body.c).normalized();
      }
      body.R = A * A0.transpose();
      body.J = A * Vec3(moment[3 * b], moment[3 * b + 1], moment[3 * b + 2]).asDiagonal() * A.transpose();
      bodies_.push_back(body);
    }
    // rows of all joints; their null space
    MatrixXd G = MatrixXd::Zero(6 * static_cast<Eigen::Index>(joints.size()), columns());
    Eigen::Index rows = 0;
    for (const JointRow& j : joints) {
      const Vec3 x = place(j.b, j.at), axis = turn(j.a) * j.axis.normalized();
      const MatrixXd slip = velocity(j.b, x) - velocity(j.a, x), spin = rate(j.b) - rate(j.a);
      const Vec3 e1 = axis.unitOrthogonal(), e2 = axis.cross(e1);
      const auto add = [&](const MatrixXd& block) { G.middleRows(rows, block.rows()) = block, rows += block.rows(); };
      const std::string kind = j.kind;
      if (kind == "in-line" || kind == "prismatic")
        add(e1.transpose() * slip), add(e2.transpose() * slip);
      else
        add(slip);
      if (kind == "fixed" || kind == "prismatic") add(spin);
      if (kind == "universal") {
        const Vec3 across = j.x - j.x.dot(j.axis.normalized()) * j.axis.normalized();
        add((turn(j.b) * across.normalized()).cross(axis).transpose() * spin);
      }
    }
    Eigen::FullPivLU<MatrixXd> lu(G.topRows(rows));
    lu.setThreshold(1e-10);
    const MatrixXd free = lu.kernel();
    if (free.cols() != 2) throw std::runtime_error("two motions, not " + std::to_string(free.cols()));
    Eigen::Matrix2d named;  // vertical velocities of frame and wheel in the two columns
    named << velocity("frame", centre("frame")).row(2) * free, velocity("wheel", place("wheel", contact)).row(2) * free;
    N = free * named.inverse();
  }

  MatrixXd N;  // velocities of all bodies by those of frame and wheel

  Vec3 centre(const std::string& body) const { return at(body).c; }
  Vec3 place(const std::string& body, const Vec3& X) const {
    return body == "ground" ? X : Vec3(at(body).c + at(body).R * (X - at(body).X));
  }
  /// Velocity of the body's material at x: 3 rows.
  MatrixXd velocity(const std::string& body, const Vec3& x) const {
    MatrixXd v = MatrixXd::Zero(3, columns());
    if (body != "ground") v.middleCols<3>(first(body)).setIdentity(), v.middleCols<3>(first(body) + 3) = -cross(x - at(body).c);
    return v;
  }
  /// Work of the weights along both motions.
  VectorXd weights() const {
    VectorXd Q = VectorXd::Zero(2);
    for (const Body& b : bodies_) Q -= b.m * g * N.transpose() * velocity(b.name, b.c).row(2).transpose();
    return Q;
  }
  double strut_length() const { return (place("lower_arm", strut_foot) - place("frame", strut_top)).norm(); }
  /// Heights of the frame and of the tyre's contact.
  VectorXd heights() const { return Eigen::Vector2d(centre("frame").z(), place("wheel", contact).z()); }
  /// Work along both motions of weights, strut and tyre by their laws, per velocity.
  VectorXd forces(double strut_free, double tyre_free) const {
    return weights() - strut_stiffness * (strut_length() - strut_free) * lengthening() -
           tyre_stiffness * (heights()[1] - tyre_free) * VectorXd::Unit(2, 1);
  }
  /// Rate of the strut's length.
  VectorXd lengthening() const {
    const Vec3 top = place("frame", strut_top), foot = place("lower_arm", strut_foot);
    return N.transpose() * (velocity("lower_arm", foot) - velocity("frame", top)).transpose() * (foot - top).normalized();
  }
  Eigen::Matrix2d mass() const {
    MatrixXd M = MatrixXd::Zero(columns(), columns());
    for (const Body& b : bodies_) {
      M.block<3, 3>(first(b.name), first(b.name)) = b.m * Mat3::Identity();
      M.block<3, 3>(first(b.name) + 3, first(b.name) + 3) = b.J;
    }
    return N.transpose() * M * N;
  }

 private:
  struct Body {
    std::string name;
    double m;
    Vec3 X, c;
    Mat3 R = Mat3::Identity(), J = Mat3::Zero();
  };
  std::vector<Body> bodies_;

  /// Centre (k = -1) or direction of a principal axis in the drawn position.
  static Vec3 reference(const Results& run, size_t b, int k) {
    const auto points = run.file().read<double>("/body/points");
    const Vec3 c(&points[12 * b]);
    return k < 0 ? c : Vec3((Vec3(&points[12 * b + 3 * (k + 1)]) - c).normalized());
  }
  size_t index(const std::string& part) const {
    for (size_t b = 0; b < bodies_.size(); ++b)
      if (bodies_[b].name.find(part) != std::string::npos) return b;
    throw std::runtime_error("no body " + part);
  }
  const Body& at(const std::string& part) const { return bodies_[index(part)]; }
  Mat3 turn(const std::string& part) const { return part == "ground" ? Mat3(Mat3::Identity()) : at(part).R; }
  Eigen::Index first(const std::string& part) const { return 6 * static_cast<Eigen::Index>(index(part)); }
  Eigen::Index columns() const { return 6 * static_cast<Eigen::Index>(bodies_.size()); }
  MatrixXd rate(const std::string& body) const {
    MatrixXd w = MatrixXd::Zero(3, columns());
    if (body != "ground") w.middleCols<3>(first(body) + 3).setIdentity();
    return w;
  }
};

/// A rigid run of the scene; the mesh is made once.
Results solved(const std::string& options) {
  static const Case c("suspension");
  const std::string data = std::string(HILO_SOURCE) + "/data/suspension/";
  succeeded(c.run("[ -f tags.h5 ] || { hilo-import --quiet '" + data + "suspension.geo' -o mesh.h5 && hilo-tag --quiet mesh.h5 '" + data +
                  "tags-rigid.toml' -o tags.h5; } && hilo-solve --quiet '" + data +
                  "scene.toml' tags.h5 --set solver.tolerance=1e-12 --set output.interval=10 " + options + " -o run.h5"));
  return c.results();
}

TEST(Suspension, AtRestTheStrutCarriesTheCornerByItsMotionRatio) {
  const Results run = solved("--set time.end=0.01");
  const Corner corner(run, 0);
  const Vec3 strut = run.history("spring/strut").row(0).head<3>(), tyre = run.history("spring/tyre").row(0).head<3>();
  const VectorXd L = corner.lengthening();
  const double pressed = strut.dot((corner.place("lower_arm", strut_foot) - corner.place("frame", strut_top)).normalized());
  const VectorXd rest = corner.weights() + pressed * L + tyre.z() * VectorXd::Unit(2, 1);
  EXPECT_LT(tyre.head<2>().norm(), 1e-9 * tyre.z());
  for (int k = 0; k < 2; ++k) EXPECT_LT(std::abs(rest[k]), 1e-8 * tyre.z()) << (k ? "wheel" : "frame");
  std::printf("motion ratio %.5f, strut %.3f N, tyre %.3f N, left over %.1e and %.1e N\n", -L[1], pressed, tyre.z(), rest[0], rest[1]);
}

TEST(Suspension, BouncesAndHopsAsTheTwoDegreeFormula) {
  const Results run = solved("--set spring.strut.damping=0 --set spring.tyre.damping=0 --set history.road.scale=1e-3 --set time.end=3");
  // the textbook's formula has the springs alone; loads on arms that turn add stiffness of their own, seen in the forces at the run's poses
  const Corner corner(run, 0);
  const VectorXd L = corner.lengthening(), t = VectorXd::Unit(2, 1), at_rest = corner.heights();
  const Eigen::Matrix2d springs = strut_stiffness * L * L.transpose() + tyre_stiffness * t * t.transpose();
  const double strut_free = corner.strut_length() + run.history("spring/strut").row(0).head<3>().norm() / strut_stiffness;
  const double tyre_free = at_rest[1] + run.history("spring/tyre")(0, 2) / tyre_stiffness;
  MatrixXd q(50, 2), Q(50, 2);
  for (int i = 0; i < 50; ++i) {
    const Corner pose(run, 1000 + 20 * i);
    q.row(i) = (pose.heights() - at_rest).transpose(), Q.row(i) = -pose.forces(strut_free, tyre_free).transpose();
  }
  const Eigen::Matrix2d all = q.colPivHouseholderQr().solve(Q).transpose();
  EXPECT_LT(std::abs(all(0, 1) - all(1, 0)), 1e-3 * all.norm()) << "forces with a potential";
  using Modes = Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d>;
  const Modes textbook(springs, corner.mass()), modes((all + all.transpose()) / 2, corner.mass());
  // two undamped modes, sampled: y[n+2] + y[n-2] + a (y[n+1] + y[n-1]) + b y[n] is constant, w^2 - 2 + a w + b = 0 with w = 2 cos(omega
  // tau)
  const int every = 20;
  const double tau = every * 1e-3;
  std::vector<Eigen::RowVector3d> rows;
  std::vector<double> right;
  for (const char* name : {"frame", "wheel"}) {
    const VectorXd z = run.history(std::string("probe/") + name).col(2);
    const double mean = z[0];
    for (Eigen::Index n = run.index(0.95) + 2 * every; n + 2 * every < z.size(); n += 5) {
      rows.emplace_back(z[n + every] + z[n - every] - 2 * mean, z[n] - mean, 1e-5);
      right.push_back(-(z[n + 2 * every] + z[n - 2 * every] - 2 * mean));
    }
  }
  MatrixXd A(rows.size(), 3);
  for (size_t i = 0; i < rows.size(); ++i) A.row(i) = rows[i];
  const VectorXd s = A.colPivHouseholderQr().solve(Eigen::Map<VectorXd>(right.data(), right.size()));
  const double root = std::sqrt(s[0] * s[0] - 4 * (s[1] - 2));
  for (int k = 0; k < 2; ++k) {
    const auto hertz = [](double square) { return std::sqrt(square) / (2 * M_PI); };
    const double measured = std::acos((-s[0] + (k ? -1 : 1) * root) / 4) / tau / (2 * M_PI);
    const double formula = hertz(textbook.eigenvalues()[k]), exact = hertz(modes.eigenvalues()[k]);
    std::printf("%s %.4f Hz; springs alone %.4f, with the loads on the arms %.4f Hz\n", k ? "hop" : "bounce", measured, formula, exact);
    EXPECT_NEAR(measured, formula, 0.03 * formula);
    EXPECT_NEAR(measured, exact, 1e-3 * exact);
  }
}

}  // namespace
}  // namespace hilo::test::suspension_test
