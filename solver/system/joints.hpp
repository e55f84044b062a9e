// SPDX-License-Identifier: GPL-3.0-or-later
// Joints: constraint rows with multipliers.
#pragma once
#include <map>

#include "system/connector_clique.hpp"
#include "system/constraint.hpp"

namespace hilo {

class Joints final : public Contribution, public Equations, public Constraining, public Jumping, public Stateful, public Observer {
 public:
  explicit Joints(const Points& points) : points_(points) {}
  std::vector<Joint> list;
  size_t n_bonds = 0;  // last in the list: of rigid beams with bodies, whose rows may depend on those of joints; no history tells of them
  size_t n_told() const { return list.size() - n_bonds; }
  /// Axes, carried by a body or inertial (-1), in which the reactions of a joint are told; by joint.  The others: its frame, carried by a.
  struct Axes {
    int body = -1;
    Mat3 in = Mat3::Identity();
  };
  std::map<size_t, Axes> told_in;
  auto begin() { return list.begin(); }
  auto end() { return list.end(); }
  auto begin() const { return list.begin(); }
  auto end() const { return list.end(); }
  size_t size() const { return list.size(); }
  bool empty() const { return list.empty(); }
  Joint& operator[](size_t j) { return list[j]; }
  const Joint& operator[](size_t j) const { return list[j]; }
  /// First block of the multipliers of a joint, and where these begin in lambda.
  int block(size_t j) const { return block_[j]; }
  int row(size_t j) const { return 3 * (block_[j] - points_.first_joint_block()); }

  Traits traits() const override;
  std::string count() const override;
  void number(Layout& layout) override;
  void add_constraints(std::vector<std::unique_ptr<Constraint>>& out) override;
  std::string owner(int block) const override;
  std::string too_far(const Config& q0, const Config& q1) const override;
  void evaluate(Pass& p) const override;
  void add_work(const Moment& m, Work& sum) const override;
  void look_at_rows(const Config& q, double t, double factor, Violation& worst) const override;
  void add_row_rates(const Rates& at, std::vector<double>& rate, std::vector<double>* acceleration) const override;
  void add_jumps(double t, const Config& before, const Config& after, std::span<const double> slack,
                 std::vector<Jump>& jumps) const override;
  std::string fault(const Config& q) const override;
  void commit(const Config& q, const Config* v) override;
  void archive(Archive& a) override;
  std::vector<Output> outputs() const override;
  void observe(const Sight& at) override;
  void tie(Ties& ties) const override;
  /// Of a joint whose rows are single components of points of b that ground holds: the points, and the forces on them.
  std::vector<std::array<Vec3, 2>> held_points(const Moment& at, int joint) const;

 private:
  const Points& points_;
  std::vector<int> block_, clique_;
  std::vector<char> owned_;
};

/// Values of a joint's rows less what drives them, at time t; `factor` is that of the load step.
void gaps(const Joint& joint, const Config& q, double t, double factor, double* g);
/// Gradient of a joint's rows by its measures as the stage takes it: over the step where it conserves energy, else at `left`.
void row_gradient(const Joint& c, const Stage& s, const ConnectorGradient& left, RowLaw::Gradient& out);
/// Forces conjugate to the measures of a joint for the multipliers of its rows.
void joint_forces(const Joint& c, const Stage& s, const ConnectorGradient& left, const double* lambda, double* force);

}  // namespace hilo
