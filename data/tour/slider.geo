// A slider-crank of five parts, none of them with a name: frame, crank with a counterweight against it, rod, slider.  Millimetres.
SetFactory("OpenCASCADE");
turned = Asin(40/120);
Box(1) = {-60, -60, -10, 260, 120, 8};                          // frame, with a hole for the crank
Cylinder(2) = {0, 0, -10, 0, 0, 8, 6};
BooleanDifference(101) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Box(3) = {-10, -10, 0, 20, 60, 6};                              // crank, upright
Cylinder(4) = {0, 0, 0, 0, 0, 6, 6};
Cylinder(5) = {0, 40, 0, 0, 0, 6, 5};
BooleanDifference(102) = { Volume{3}; Delete; }{ Volume{4, 5}; Delete; };
Box(6) = {-20, -30, 0, 40, 20, 6};                              // counterweight
Box(7) = {-10, 32, 8, 140, 16, 6};                              // rod
Cylinder(8) = {0, 40, 8, 0, 0, 6, 5};
Cylinder(9) = {120, 40, 8, 0, 0, 6, 5};
BooleanDifference(103) = { Volume{7}; Delete; }{ Volume{8, 9}; Delete; };
Rotate {{0, 0, 1}, {0, 40, 0}, -turned} { Volume{103}; }
x = 120*Cos(turned);
Box(10) = {x - 20, -15, 16, 40, 30, 10};                        // slider
Cylinder(11) = {x, 0, 16, 0, 0, 10, 5};
BooleanDifference(104) = { Volume{10}; Delete; }{ Volume{11}; Delete; };
Save "slider.step";
