// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/redundancy/redundancy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "dynamics/redundancy/independence.hpp"
#include "linear/sparse_cholesky.hpp"

namespace hilo {
namespace {

/// Unit rows of all constraints at q as columns over the unknowns, rotations in units of the scene's length.
struct UnitRows {
  std::vector<std::pair<int, int>> rows;  // constraint, row
  std::vector<double> norm;
  Eigen::SparseMatrix<double> A;  // (3 blocks x rows)
};

bool is_drive(const System& system, std::pair<int, int> row) { return system.constraints()[row.first]->is_driven(row.second); }

bool is_of_positions(const System& system, std::pair<int, int> row) {
  return row.second < system.constraints()[row.first]->n_position_rows() && !is_drive(system, row);
}

enum class Rows { all, active, plain };  // plain: all but those of drives

UnitRows unit_rows(const System& system, const Config& q, Rows which, bool norms_alone = false) {
  UnitRows out;
  std::vector<Eigen::Triplet<double>> entries;
  const auto constraints = system.constraints();
  for (size_t j = 0; j < constraints.size(); ++j) {
    const Constraint& c = *constraints[j];
    const DenseRows G = c.gradient(stage_at(q, 0));
    const auto blocks = c.blocks();
    for (int r = 0; r < c.n_rows(); ++r) {
      if (which == Rows::active && !c.active()[r]) continue;
      if (which == Rows::plain && c.is_driven(r)) continue;
      const double norm = G.row(r).norm();
      for (Eigen::Index i = 0; i < G.cols() && !norms_alone; ++i)
        if (const double x = norm > 0 ? G(r, i) / norm : 0; std::abs(x) > 1e-14)
          entries.emplace_back(3 * blocks[i / 3] + static_cast<int>(i % 3), static_cast<int>(out.rows.size()), x);
      out.rows.emplace_back(static_cast<int>(j), r), out.norm.push_back(norm);
    }
  }
  out.A.resize(3 * static_cast<Eigen::Index>(system.n_blocks()), static_cast<Eigen::Index>(out.rows.size()));
  out.A.setFromTriplets(entries.begin(), entries.end());
  return out;
}

/// Names of constraints, sorted; of many the first in the scene, and how many others.
std::string names_of(const System& system, std::vector<int>& list) {
  constexpr size_t named = 12;
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  std::set<std::string> names;
  for (size_t k = 0; k < std::min(list.size(), named); ++k) names.insert(system.constraints()[list[k]]->name());
  const std::string text = fmt::format("{}", fmt::join(names, ", "));
  return list.size() > named ? fmt::format("{} and {} more", text, list.size() - named) : text;
}

/// Rows that depend on others at q, up to `dependent` of a unit row, are switched off.
Redundancy choose_rows(System& system, const Config& q, double dependent) {
  Redundancy report;
  const auto constraints = system.constraints();
  for (const auto& c : constraints) c->set_active(all_active);
  const UnitRows all = unit_rows(system, q, Rows::all);
  report.rows = static_cast<int>(all.rows.size());
  if (report.rows == 0) return report;
  std::vector<int> number(all.A.rows()), owner;
  for (const auto& [constraint, r] : all.rows) owner.push_back(constraint);
  const std::vector<int> looped = columns_in_loops(all.A, owner);
  report.rank = report.rows - static_cast<int>(looped.size());
  for (auto& group : connected_columns(all.A, looped)) {
    // A row of positions that depends on rows of velocities would follow them no better than the method follows velocities.
    const auto drives = std::stable_partition(group.begin(), group.end(), [&](int k) { return !is_drive(system, all.rows[k]); });
    const auto rates = std::stable_partition(group.begin(), drives, [&](int k) { return is_of_positions(system, all.rows[k]); });
    const Eigen::Index n_plain = rates - group.begin();
    const Eigen::SparseMatrix<double> own = part_of(all.A, group, number);
    const Independence found = independent_columns(own, n_plain, dependent);
    report.rank += static_cast<int>(found.rank);
    const auto place = [&](Eigen::Index k) {
      const auto [one, r] = all.rows[group[found.order[k]]];
      return constraints[one]->row() + r;
    };
    for (Eigen::Index k = 0; k < found.rank; ++k)
      if (found.bears[k]) report.undetermined.push_back(place(k));
    for (Eigen::Index k = found.rank; k < own.cols(); ++k) {
      const auto row = all.rows[group[found.order[k]]];
      const auto [one, r] = row;
      Constraint& c = *constraints[one];
      Active active = c.active();
      active[r] = false;
      c.set_active(active);
      report.undetermined.push_back(place(k));
      const bool drives = is_drive(system, row), is_told = report.dropped.size() < Redundancy::told;
      const auto k_list = static_cast<size_t>(k - found.rank);
      if ((!drives && !is_told) || k_list >= found.depends.size()) continue;
      std::vector<int> others;
      bool on_drives = false;
      for (const auto& [i, factor] : found.depends[k_list]) {
        if (std::abs(factor) <= 1e-6) continue;
        const auto other = all.rows[group[found.order[i]]];
        if (other.first != one) others.push_back(other.first);
        on_drives = on_drives || (drives && is_drive(system, other));
      }
      const std::string names = names_of(system, others);
      if (drives && !on_drives) report.held.push_back({one, names});
      if (is_told)
        report.dropped.push_back(fmt::format(
            "{} row {}{}", c.label(), r + 1,
            others.empty() ? fmt::format(" (depends on the {}'s own rows)", c.section()) : fmt::format(" (depends on {})", names)));
    }
  }
  std::ranges::sort(report.undetermined);
  return report;
}

/// Values of position rows over their norms; 0 for rows of velocities.
Eigen::VectorXd gaps(const System& system, const UnitRows& unit, const Config& q, double t) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(unit.rows.size()));
  double g[max_rows];
  for (size_t k = 0; k < unit.rows.size(); ++k) {
    const auto [j, r] = unit.rows[k];
    if (k == 0 || unit.rows[k - 1].first != j) system.constraints()[j]->gaps(q, t, 1, g);
    out[static_cast<Eigen::Index>(k)] = unit.norm[k] > 0 ? g[r] / unit.norm[k] : 0;
  }
  return out;
}

void displace(const System& system, Config& q, const Eigen::VectorXd& y) {
  std::vector<double> z(y.data(), y.data() + y.size());
  for (const UnknownField& f : system.unknowns)
    for (size_t k = 0; k < f.size() && f.turns(); ++k)
      for (int i = 0; i < 3; ++i) z[3 * f.block(k) + i] /= system.length;
  system.move(q, z);
}

/// Nearest increments that unit rows A see as b.  Dependent rows may be among them: A A^T + mu finds the increments of what is independent.
/// Its entries couple what a row acts on, so that a body with many joints costs no more than they would apart.
class Nearest {
 public:
  static constexpr double mu = 1e-10;  // far below the square of `aside`, which rows that are independent beside q alone have
  bool factor(Eigen::SparseMatrix<double> A) {
    A_ = std::move(A), plane_.resize(0);
    return factors_.factor_square(A_, mu);
  }
  /// The part of y that the rows leave.
  Eigen::VectorXd left_of(const Eigen::VectorXd& y) const { return mu * factors_.solve(y); }
  /// A (A^T A)^-1 b, without what leaves the plane of this normal.
  Eigen::VectorXd within(const Eigen::VectorXd& plane, const Eigen::VectorXd& b) {
    if (plane_.size() != plane.size() || plane != plane_) plane_ = plane, through_ = factors_.solve(plane);
    const Eigen::VectorXd y = factors_.solve(A_ * b);
    return y - plane.dot(y) / (1 + plane.dot(through_)) * through_;
  }

 private:
  Eigen::SparseMatrix<double> A_;
  SparseCholesky factors_;
  Eigen::VectorXd plane_, through_;  // the normal of the last plane, and that through the factors
};

constexpr double round_off = 1e-9;  // what others leave of a unit row that depends on them
constexpr double aside = 1e-3;      // how far to look, over the scene's length
const double independent_beside =
    std::pow(aside, 1.5);  // what others leave there of a unit row that depends on them at q alone is about `aside`

/// Poses beside q that these rows allow.
class Beside {
 public:
  Beside(const System& system, const Config& q, double t, Rows rows) : system_(system), q_(q), t_(t), rows_(rows) {}
  /// That along the part of `direction` that they leave; nothing where they leave none or do not close.  The increments that close them
  /// stay in the plane `far` ahead, or branches would draw them back to q, where all of them meet.
  std::optional<Config> operator()(const Eigen::VectorXd& direction, double far) {
    constexpr int iterations = 40;
    if (!at_q_ && !factor(q_)) return {};
    at_q_ = true;
    Eigen::VectorXd y = nearest_.left_of(direction);
    if (!(y.norm() > 1e-6 * direction.norm())) return {};
    y *= far * system_.length / y.cwiseAbs().maxCoeff();
    const Eigen::VectorXd plane = y.normalized();
    Config out = q_;
    displace(system_, out, y);
    double last = 0;  // gap of the pose before
    for (int k = 0;; ++k) {
      const Eigen::VectorXd g = gaps(system_, unit_, out, t_);
      const double gap = g.size() > 0 ? g.cwiseAbs().maxCoeff() : 0;
      if (gap < (k < iterations ? 1e-14 : 1e-12) * system_.length) return out;
      if (k == iterations) return {};
      // Rows of a pose before close the gap too, where they are not about to become dependent: a factor is dear in large nets.
      Eigen::VectorXd back;
      const bool closes = k == 0 || gap < 0.5 * last;
      if (closes) back = nearest_.within(plane, g);
      if (!closes || back.cwiseAbs().maxCoeff() > far * system_.length) {
        if (at_q_ = false; !factor(out)) return {};
        back = nearest_.within(plane, g);
      }
      displace(system_, out, -back);
      last = gap;
    }
  }

 private:
  bool factor(const Config& at) {
    unit_ = unit_rows(system_, at, rows_);
    return nearest_.factor(std::move(unit_.A));
  }
  const System& system_;
  const Config& q_;
  double t_;
  Rows rows_;
  UnitRows unit_;  // where the factors are
  Nearest nearest_;
  bool at_q_ = false;
};

/// Largest move of a node or centre, and turn times the scene's length, between two poses.
double way(const System& system, const Config& a, const Config& b) { return system.largest_difference(a, b, std::sqrt(2) * system.length); }

/// A pose beside q that all rows but those of drives allow; nothing where they lead back.
std::optional<Config> branch(const System& system, const Config& q, const Eigen::VectorXd& direction, double t, double far) {
  std::optional<Config> out = Beside(system, q, t, Rows::plain)(direction, far);
  if (out && way(system, q, *out) < 0.1 * far * system.length) out.reset();
  return out;
}

/// Some direction of all that constraints hold, the same on all ranks.
Eigen::VectorXd some_direction(const System& system, unsigned seed) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(system.n_blocks()));
  std::minstd_rand random(seed);
  for (const auto& c : system.constraints())
    for (const int block : c->blocks())
      for (int i = 0; i < 3; ++i) {
        const double x = static_cast<double>(random()) / std::minstd_rand::max() - 0.5;
        if (out[3 * block + i] == 0) out[3 * block + i] = x;
      }
  return out;
}

}  // namespace

std::vector<Active> active_rows(const System& system) {
  std::vector<Active> out;
  for (const auto& c : system.constraints()) out.push_back(c->active());
  return out;
}

void set_rows(System& system, const std::vector<Active>& rows) {
  for (size_t j = 0; j < rows.size(); ++j) system.constraints()[j]->set_active(rows[j]);
}

Redundancy drop_redundant_rows(System& system, const Config& q, double t) {
  Redundancy here = choose_rows(system, q, round_off);
  if (here.dropped.empty()) return here;
  // Rows that depend on others at q alone open with the square of the way aside, redundant ones do not.  A branch that closes all of them
  // tells which are independent along it: more than at q, and fewer than at any pose off the branches.
  const std::vector<Active> at_pose = active_rows(system);
  Beside beside(system, q, t, Rows::active);
  for (unsigned seed = 1; seed <= 2; ++seed) {
    const Eigen::VectorXd direction = some_direction(system, seed);
    std::optional<Config> near = beside(direction, aside);
    if (!near) break;
    const UnitRows all = unit_rows(system, *near, Rows::all, true);
    const Eigen::VectorXd g = gaps(system, all, *near, t);
    if (g.cwiseAbs().maxCoeff() < 1e-4 * aside * aside * system.length) continue;
    if (const auto pose = branch(system, q, direction, t, aside)) near = pose;
    Redundancy there = choose_rows(system, *near, independent_beside);
    if (there.rank > here.rank) {
      there.at_pose = at_pose, there.rank_at_pose = here.rank;
      for (size_t j = 0; j < at_pose.size(); ++j)
        if (const Constraint& c = *system.constraints()[j]; at_pose[j] != c.active()) there.singular_joints.push_back(c.name());
      return there;
    }
    set_rows(system, at_pose);
  }
  return here;
}

bool recheck_redundant_rows(System& system, const Config& q, double t, Redundancy& now) {
  const std::vector<Active> before = active_rows(system);
  Redundancy found = drop_redundant_rows(system, q, t);
  if (found.rank >= now.rank) {
    const bool changed = active_rows(system) != before;
    now = std::move(found);
    return changed;
  }
  set_rows(system, before);
  return false;
}

std::optional<Config> pose_ahead(const System& system, const Config& q, const Config& v, double t, double far) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(system.n_blocks()));
  for (const UnknownField& f : system.unknowns)
    for (size_t k = 0; k < f.size(); ++k) {
      const int i = f.item[k];
      if (!f.turns()) {
        y.segment<3>(3 * f.block(k)) = (v.*f.array)[i];
        continue;
      }
      const Mat3 S = v.R[i] * q.R[i].transpose();
      y.segment<3>(3 * f.block(k)) = system.length / 2 * Vec3(S(2, 1) - S(1, 2), S(0, 2) - S(2, 0), S(1, 0) - S(0, 1));
    }
  if (y.isZero(0)) return {};
  return branch(system, q, y, t, far);
}

std::optional<Config> pose_aside(const System& system, const Config& q, unsigned seed, double t, double far) {
  return branch(system, q, some_direction(system, seed), t, far);
}

void choose_rows_beside(System& system, const Config& q, Redundancy& now) {
  Redundancy there = choose_rows(system, q, independent_beside);
  now.rank = there.rank, now.dropped = std::move(there.dropped);
}

}  // namespace hilo
