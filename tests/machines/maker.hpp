// SPDX-License-Identifier: GPL-3.0-or-later
// The steps from which families are drawn: bodies, joints between them, springs.
#pragma once
#include <string>
#include <vector>

#include "machines/machine.hpp"

namespace hilo::test {

/// Every joint is put together in the configuration in which it is drawn, so a scene needs no assembly.
struct Maker {
  Machine m;
  Dice dice;
  bool wide = false;  // mass ratios up to 1e4

  Mat3 rotation();
  /// A box, plate or rod of about this size, its axes turned at random.
  int add_body(const Vec3& com, double size);
  void throw_bodies(double speed);
  MachineJoint joint(const std::string& kind, const Side& a, const Side& b, const Vec3& at);
  std::string any_kind();
  std::string hinge();
  int mobility() const;
  /// Bodies one after another (a chain) or each on a random earlier one (a tree).
  void grow(int n, bool chain, bool grounded, bool hinges_alone);
  /// Joints between far bodies; by count of rows each of them leaves a freedom.
  void close(int loops);
  /// A closed polygon of links hinged about parallel axes: three rows of its joints are redundant as long as they stay parallel.
  void polygon(int links);
  void hinge_at(const Side& a, const Side& b, const Vec3& at, const Vec3& axis, bool ball);
  /// Cranks of equal length on a common coupler, at an angle to it; a third crank is redundant at every pose.
  void parallelogram(int cranks, double angle);
  void add_springs(int n, double damping_share);
};

/// Families that are not in the suite: attacks for which the judge knows less, or that are known to be hard.
Machine wide_machine(const std::string& family, Maker& k);

}  // namespace hilo::test
