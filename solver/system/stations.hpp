// SPDX-License-Identifier: GPL-3.0-or-later
// Sensors and probes: places that are measured.
#pragma once
#include "system/contribution.hpp"

namespace hilo {

/// A measured place: mean of nodes, or a point of a body.
struct Station {
  std::string name;
  bool sensor = false;
  int body = -1;
  Vec3 arm = Vec3::Zero();                    // body axes
  std::vector<std::pair<int, double>> nodes;  // of this rank, and their shares of the mean
  bool turns = false;                         // nodes off a line, on all ranks, for axes that turn with them
  Vec3 mean = Vec3::Zero();                   // of the nodes at the start
  Mat3 axes = Mat3::Identity();               // sensor axes at the start, columns
};

class Stations final : public Contribution, public Observer {
 public:
  explicit Stations(const Points& points) : points_(points) {}
  std::vector<Station> list;

  std::vector<Output> outputs() const override;
  void observe(const Sight& at) override;

 private:
  /// Position, velocity or acceleration.
  Vec3 mean(const Station& s, const Config& of) const;
  Mat3 axes(const Station& s, const Config& q, const Vec3& centre) const;
  const Points& points_;
};

}  // namespace hilo
