// SPDX-License-Identifier: GPL-3.0-or-later
#include "machines/judge.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "machines/block_energy.hpp"
#include "machines/pose.hpp"
#include "model/store.hpp"

namespace hilo::test {
namespace {

using Table = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Table read(const Store& file, const std::string& path) {
  const auto shape = file.shape(path);
  const auto values = file.read<double>(path);
  const Eigen::Index rows = shape.empty() ? 1 : shape[0];
  return Eigen::Map<const Table>(values.data(), rows, rows ? static_cast<Eigen::Index>(values.size()) / rows : 0);
}

/// Everything at one instant.
struct Instant {
  double t;
  std::vector<Pose> body;
  std::vector<Vec3> x, v;  // nodes
};

struct Energies {
  double kinetic = 0, elastic = 0, gravity = 0;
  double total() const { return kinetic + elastic + gravity; }
};

class Judge {
 public:
  Judge(const Machine& m, const std::string& results, const Limits& limits) : m_(m), limits_(limits), file_(Store::open(results)) {
    if (!m.blocks.empty()) mesh_ = block_of(m.blocks[0]);
    length_ = m.length();
  }
  Verdict go();

 private:
  void check_finite(const std::string& group);
  void load();
  Pose pose(const Side& s, const Instant& at) const;
  Energies energies(const Instant& at, size_t row);
  void check_joints(const Instant& at);
  void check_momentum();
  void wrong(const std::string& what) {
    if (out_.wrong.size() < 6) out_.wrong.push_back(what);
  }

  const Machine& m_;
  Limits limits_;
  Store file_;
  Mesh mesh_;
  double length_ = 1;
  std::vector<Instant> row_;
  Table told_;  // energies that the run tells, where a metal's state is needed for them: elastic, and what flow took
  std::vector<Turned> spring_turn_, joint_turn_;
  Verdict out_;
};

void Judge::check_finite(const std::string& group) {
  for (const std::string& name : file_.list(group)) {
    const std::string path = group + "/" + name;
    if (!file_.is_array(path)) {
      check_finite(path);
    } else if (file_.type(path) == "f8") {
      for (double value : file_.read<double>(path))
        if (!std::isfinite(value)) return wrong("not finite: " + path);
    }
  }
}

void Judge::load() {
  const Table t = read(file_, "/history/t");
  for (Eigen::Index i = 0; i < t.rows(); ++i) row_.push_back({t(i, 0), std::vector<Pose>(m_.bodies.size()), {}, {}});
  for (size_t b = 0; b < m_.bodies.size(); ++b)
    for (int k = 0; k < 4; ++k) {
      const Table p = read(file_, fmt::format("/history/probe/b{}p{}", b, k));
      for (size_t i = 0; i < row_.size(); ++i) {
        Pose& pose = row_[i].body[b];
        const Vec3 x = p.row(static_cast<Eigen::Index>(i)).head<3>().transpose(),
                   v = p.row(static_cast<Eigen::Index>(i)).segment<3>(3).transpose();
        if (k == 0)
          pose.X = m_.bodies[b].com, pose.c = x, pose.v = v;
        else
          pose.R.col(k - 1) = x - pose.c, pose.V.col(k - 1) = v - pose.v;
      }
    }
  if (mesh_.X.empty()) return;
  if (m_.blocks[0].yield > 0) told_ = read(file_, "/history/energy");
  const auto steps = file_.list("/field");
  if (steps.size() != row_.size()) return wrong(fmt::format("{} fields at {} instants", steps.size(), row_.size()));
  for (size_t i = 0; i < steps.size(); ++i) {
    const Table u = read(file_, "/field/" + steps[i] + "/displacement"), v = read(file_, "/field/" + steps[i] + "/velocity");
    for (Eigen::Index a = 0; a < u.rows(); ++a) {
      row_[i].x.push_back(mesh_.X[a] + u.row(a).transpose());
      row_[i].v.push_back(v.row(a).transpose());
    }
  }
}

Pose Judge::pose(const Side& s, const Instant& at) const {
  if (s.of == Side::Of::body) return at.body[s.body];
  if (s.of == Side::Of::ground) return {};
  return fitted(mesh_.X, at.x, mesh_.nodes_of(s.set, "judge"));
}

Energies Judge::energies(const Instant& at, size_t row) {
  Energies e;
  for (size_t b = 0; b < m_.bodies.size(); ++b) {
    const MachineBody& body = m_.bodies[b];
    const Pose& p = at.body[b];
    const Mat3 euler = body.inertia.trace() / 2 * Mat3::Identity() - body.inertia;
    e.kinetic += body.mass * p.v.squaredNorm() / 2 + (p.V * euler).cwiseProduct(p.V).sum() / 2;
    e.gravity -= body.mass * m_.gravity.dot(p.c);
  }
  spring_turn_.resize(m_.springs.size());
  for (size_t i = 0; i < m_.springs.size(); ++i) {
    const MachineSpring& s = m_.springs[i];
    const Pose a = pose(s.a, at), b = pose(s.b, at);
    double stretch = 0;
    if (s.kind == "stop") {
      const double apart = (b.at(s.at_b) - a.at(s.at_a)).norm();
      stretch = apart > s.upper ? apart - s.upper : apart < s.lower ? apart - s.lower : 0;
    } else if (s.kind == "axial") {
      stretch = (b.at(s.at_b) - a.at(s.at_a)).norm() - s.rest;
    } else {
      if (!spring_turn_[i].follow(a.R, b.R, s.axis)) wrong(fmt::format("t = {:.6g}: spring s{} lost a turn", at.t, i));
      stretch = spring_turn_[i].angle - s.rest;
    }
    e.elastic += s.stiffness * stretch * stretch / 2;
  }
  if (!mesh_.X.empty()) {
    const BlockEnergy b = block_energy(m_.blocks[0], mesh_, at.x, at.v, m_.gravity);
    e.kinetic += b.kinetic, e.elastic += b.elastic, e.gravity += b.gravity;
    out_.least_det = std::min(out_.least_det, b.least_det);
    if (told_.size() > 0) {
      const auto r = static_cast<Eigen::Index>(row);
      e.elastic = told_(r, 1) + told_(r, 4);
      if (r > 0 && told_(r, 4) < told_(r - 1, 4)) wrong(fmt::format("t = {:.6g}: what flow took is given back", at.t));
    }
    if (!(b.least_det > 0)) wrong(fmt::format("t = {:.6g} (row {}): det F = {:.3g}", at.t, row, b.least_det));
  }
  return e;
}

void Judge::check_joints(const Instant& at) {
  joint_turn_.resize(2 * m_.joints.size());
  for (size_t i = 0; i < m_.joints.size(); ++i) {
    const MachineJoint& j = m_.joints[i];
    if (j.gives) continue;
    const double open = opening(j, pose(j.a, at), pose(j.b, at), pose(j.carrier, at), at.t, length_, &joint_turn_[2 * i]);
    if (open > limits_.joint && out_.joint <= limits_.joint)
      wrong(fmt::format("t = {:.6g}: joint j{} ({}) open by {:.3g}", at.t, i, j.kind, open));
    out_.joint = std::max(out_.joint, open);
  }
  for (const auto side : {&MachineJoint::a, &MachineJoint::b})
    for (const MachineJoint& j : m_.joints)
      if ((j.*side).of == Side::Of::block) {
        const double bent = unfit(mesh_.X, at.x, mesh_.nodes_of((j.*side).set, "judge")) / length_;
        if (bent > limits_.joint && out_.joint <= limits_.joint)
          wrong(fmt::format("t = {:.6g}: patch {} is bent by {:.3g}", at.t, (j.*side).set, bent));
        out_.joint = std::max(out_.joint, bent);
      }
}

/// Linear and angular momentum of a machine that touches no ground; gravity adds M g t, and nothing about the centre of mass.
void Judge::check_momentum() {
  const auto grounded = [](const Side& s) { return s.of == Side::Of::ground; };
  for (const auto& j : m_.joints)
    if (grounded(j.a) || grounded(j.b) || (grounded(j.carrier) && (j.kind == "gear" || j.kind == "rack"))) return;
  for (const auto& s : m_.springs)
    if (grounded(s.a) || grounded(s.b)) return;
  if (m_.energy == Machine::Energy::unknown) return;
  Vec3 P0, L0;
  double most = 1e-300, most_angular = 1e-300, worst = 0, worst_angular = 0;
  for (size_t i = 0; i < row_.size(); ++i) {
    double M = 0;
    Vec3 P = Vec3::Zero(), L = Vec3::Zero(), centre = Vec3::Zero();
    double sum = 0, sum_angular = 0;
    for (size_t b = 0; b < m_.bodies.size(); ++b) {
      const MachineBody& body = m_.bodies[b];
      const Pose& p = row_[i].body[b];
      const Mat3 euler = body.inertia.trace() / 2 * Mat3::Identity() - body.inertia, RE = p.R * euler;
      M += body.mass, centre += body.mass * p.c, P += body.mass * p.v, L += body.mass * p.c.cross(p.v);
      for (int k = 0; k < 3; ++k) L += RE.col(k).cross(p.V.col(k)), sum_angular += RE.col(k).norm() * p.V.col(k).norm();
      sum += body.mass * p.v.norm(), sum_angular += body.mass * p.c.norm() * p.v.norm();
    }
    if (!mesh_.X.empty()) {
      const BlockEnergy b = block_energy(m_.blocks[0], mesh_, row_[i].x, row_[i].v, m_.gravity);
      M += b.mass, centre += b.first_moment, P += b.momentum, L += b.angular, sum += b.momentum.norm(), sum_angular += b.angular.norm();
    }
    const Vec3 about = L - centre.cross(P) / M, steady = P - M * m_.gravity * row_[i].t;
    if (i == 0) P0 = steady, L0 = about;
    most = std::max(most, sum), most_angular = std::max(most_angular, sum_angular);
    worst = std::max(worst, (steady - P0).norm()), worst_angular = std::max(worst_angular, (about - L0).norm());
  }
  out_.momentum = worst / most, out_.angular = worst_angular / most_angular;
  if (out_.momentum > limits_.momentum) wrong(fmt::format("linear momentum changes by {:.3g}", out_.momentum));
  if (out_.angular > limits_.momentum) wrong(fmt::format("angular momentum changes by {:.3g}", out_.angular));
}

Verdict Judge::go() {
  check_finite("/history"), check_finite("/field");
  load();
  if (!out_.right()) return out_;
  std::vector<Energies> energy;
  for (size_t i = 0; i < row_.size(); ++i) {
    energy.push_back(energies(row_[i], i));
    check_joints(row_[i]);
    for (size_t b = 0; b < m_.bodies.size(); ++b) {
      const Mat3& R = row_[i].body[b].R;
      if (i == 0) out_.fastest = std::max(out_.fastest, row_[i].body[b].V.norm() / std::numbers::sqrt2);
      if (i == 0) continue;
      const double turn = Eigen::AngleAxisd(Mat3(row_[i - 1].body[b].R.transpose() * R)).angle();
      if (turn > limits_.turn && out_.turn <= limits_.turn)
        wrong(
            fmt::format("t = {:.6g}: body b{} turns by {:.4g} rad in one step of {:.3g} s", row_[i].t, b, turn, row_[i].t - row_[i - 1].t));
      out_.turn = std::max(out_.turn, turn);
    }
  }
  check_momentum();
  double low = 1e300, high = -1e300, kinetic = 0, elastic = 0;
  for (const Energies& e : energy)
    low = std::min(low, e.gravity), high = std::max(high, e.gravity), kinetic = std::max(kinetic, e.kinetic),
    elastic = std::max(elastic, e.elastic);
  double mass = 0;
  for (const auto& b : m_.bodies) mass += b.mass;
  for (const auto& b : m_.blocks) mass += b.density * (b.high - b.low).prod();
  const double rest = mass * length_ * (1e-6 * m_.gravity.norm() + 1e-12 * length_);  // what a machine that stands still has of round-off
  const double scale = std::max({kinetic, elastic, high - low, rest});
  const bool kept = m_.energy == Machine::Energy::kept;
  if (m_.energy != Machine::Energy::unknown && limits_.energy > 0) {
    for (size_t i = 1; i < energy.size(); ++i) {
      const Energies &a = energy[i - 1], &b = energy[i];
      const double change = b.total() - a.total(), sum = b.total() - energy[0].total();
      const double local = a.kinetic + b.kinetic + std::abs(b.gravity - a.gravity) + a.elastic + b.elastic + 1e-4 * scale + rest;
      const double step = (kept ? std::abs(change) : change) / local, whole = (kept ? std::abs(sum) : sum) / scale;
      if (step > limits_.energy && out_.step_energy <= limits_.energy)
        wrong(fmt::format("t = {:.6g}: energy {} by {:.3g} of itself in one step", row_[i].t, kept ? "changes" : "grows", step));
      out_.step_energy = std::max(out_.step_energy, step), out_.energy = std::max(out_.energy, whole);
    }
    if (out_.energy > limits_.energy) wrong(fmt::format("energy is off by {:.3g} in the run", out_.energy));
  }
  const Table told = read(file_, "/history/energy");
  for (size_t i = 0; i < energy.size() && m_.energy != Machine::Energy::unknown; ++i) {
    const auto r = static_cast<Eigen::Index>(i);
    const double flown = told_.size() > 0 ? told(r, 4) : 0;
    const double off = std::max({std::abs(told(r, 0) - energy[i].kinetic), std::abs(told(r, 1) + flown - energy[i].elastic)}) / scale;
    if (off > 1e-7) {
      wrong(fmt::format("t = {:.6g}: the run tells kinetic {:.9g}, elastic {:.9g} J, its positions and velocities {:.9g}, {:.9g}",
                        row_[i].t, told(r, 0), told(r, 1), energy[i].kinetic, energy[i].elastic));
      break;
    }
  }
  return out_;
}

}  // namespace

std::string Verdict::text() const {
  std::string out = fmt::format("energy {:.2g} step {:.2g} joint {:.2g} P {:.2g} L {:.2g} turn {:.3g} det {:.3g}", energy, step_energy,
                                joint, momentum, angular, turn, least_det);
  for (const auto& w : wrong) out += "\n    " + w;
  return out;
}

Verdict judge(const Machine& m, const std::string& results, const Limits& limits) { return Judge(m, results, limits).go(); }

}  // namespace hilo::test
