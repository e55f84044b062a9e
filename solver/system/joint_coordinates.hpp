// SPDX-License-Identifier: GPL-3.0-or-later
// Where joints stand: slide along the axis and angle about it, of the kinds that leave them free, as drives, stops and motors count them.
// They take part in no equation.
#pragma once
#include "physics/connector.hpp"
#include "physics/turn.hpp"
#include "system/contribution.hpp"

namespace hilo {

class JointCoordinates final : public Contribution, public Observer {
 public:
  struct Coordinates {
    std::string name;
    Connector geometry;  // measures: slide, sine and cosine, as coordinates_of says
    bool slides, turns;
    Turn turn = {};  // angle of the last step, which the next one goes on from
  };
  std::vector<Coordinates> list;

  void archive(Archive& a) override;
  std::vector<Output> outputs() const override;
  void observe(const Sight& at) override;
};

}  // namespace hilo
