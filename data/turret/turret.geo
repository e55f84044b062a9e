// The vehicle of data/firing, its hull and running gear made one region: "chassis" stands still, the turret turns on it.
// SIZE as there: 0 small, 1 medium.
Include "../firing/vehicle.geo";

Physical Volume("hull") -= {hull};
Physical Volume("crew_capsule") -= {capsule};
Physical Volume("driver_seat") -= {seat_d};
Physical Volume("commander_seat") -= {seat_c};
Physical Volume("gunner_seat") -= {seat_g};
Physical Volume("engine") -= {engine};
Physical Volume("transmission") -= {gears};
Physical Volume("magazine") -= {magazine};
Physical Volume("sponson_l") -= {sponson_l};
Physical Volume("sponson_r") -= {sponson_r};
Physical Volume("ring_lower") -= {race_l};
For m In {0:1}
  name = StrChoice(m, "r", "l");
  For j In {0:3}
    Physical Volume(Sprintf(StrCat("arm_", name, "%g"), j + 1)) -= {arms(4*m + j)};
    Physical Volume(Sprintf(StrCat("wheel_", name, "%g"), j + 1)) -= {wheels({16*m + 4*j : 16*m + 4*j + 3})};
  EndFor
EndFor
Physical Volume("chassis") = {hulls(), arms(), wheels()};
