// SPDX-License-Identifier: GPL-3.0-or-later
// Balls on bodies that all may meet each other.  Pairs of those that are near are found before each step (system/near_boxes) and are the
// structure of the matrix; what they feel is the force of any ball on a ball.
#pragma once
#include "system/contact/contact_pair.hpp"
#include "system/points.hpp"

namespace hilo {

class BallHeap {
 public:
  struct Ball {
    int body = 0;
    Vec3 arm = Vec3::Zero();  // from the centre of the body to that of the ball, body axes [m]
    double radius = 0;        // [m]
  };
  std::string name, told;  // `told`: what the stiffness is and from what
  std::vector<Ball> balls;
  std::vector<std::pair<int, int>> never;  // ascending: on one body, both held, or of another contact
  PointLaw law;                            // of all, but for what depends on the radii
  double modulus = 0;                      // E* [Pa], or 0: `law.k` is given
  bool loses = false;                      // by restitution
  bool is_mine = true;                     // one rank evaluates all pairs
  std::vector<ContactPair> near;           // of `which`
  std::vector<std::pair<int, int>> which;  // ascending
  ContactSums sums, next;

  bool search(const Config& q, const Config* v, double h);
  /// Why the step from q0 to q1 cannot be, or "".
  std::string unforeseen(const Config& q0, const Config& q1) const;
  /// Pairs that overlap in q; `near` is not asked.
  std::vector<std::pair<int, int>> overlaps(const Config& q) const;
  ContactPair pair_of(int i, int j) const;
  void archive(Archive& a, const Comm& comm);

 private:
  std::vector<Vec3> centres(const Config& q) const;
  std::vector<std::pair<int, int>> find(const std::vector<Vec3>& from, const std::vector<Vec3>& to, double within) const;
  void list(std::vector<std::pair<int, int>> pairs);
  double margin() const;
  std::vector<Vec3> from_, to_;  // of the step at work: where the balls are, and were to go
};

}  // namespace hilo
