// The part of docs/tour.md as a CAD program would export it: an arm with a hub and a bore, and the block it carries.  Millimetres.
SetFactory("OpenCASCADE");
Cylinder(1) = {0, 0, 0, 0, 0, 30, 25};                                      // hub
Box(2) = {15, -4, 0, 385, 8, 30};                                           // arm
Cylinder(3) = {0, 0, -1, 0, 0, 32, 10};                                     // bore
BooleanUnion(4) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
BooleanDifference(5) = { Volume{4}; Delete; }{ Volume{3}; Delete; };
Box(6) = {400, -30, -15, 60, 60, 60};                                       // block
Save "arm.step";
