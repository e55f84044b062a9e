// SPDX-License-Identifier: GPL-3.0-or-later
// Where joints stand: slide along the axis and angle about it, of the kinds that leave them free, as drives, stops and motors count them.
// They take part in no equation.
#pragma once
#include "physics/connector.hpp"
#include "physics/turn.hpp"
#include "system/contribution.hpp"

namespace hilo {

class JointCoordinates final : public Contribution, public Stateful, public Observer {
 public:
  struct Coordinates {
    std::string name;
    Connector geometry;  // measures: slide, sine and cosine, as coordinates_of says
    bool slides, turns;
    Turn turn = {};                       // angle of the state accepted last, which the next one goes on from
    double angle(const Config& q) const;  // through whole turns, as long as the joint turns by less than half of one since then
  };
  std::vector<Coordinates> list;

  void archive(Archive& a) override;
  std::vector<Output> outputs() const override;
  void commit(const Config& q, const Config* v) override;
  void observe(const Sight& at) override;
};

}  // namespace hilo
