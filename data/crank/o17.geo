// The rod of the IVP test set's "crank": 8 x 8 mm, 0.30 m long, from the crank pin at x = 0.15 to the slider.  Metres.
N = 20;                                                   // cells along it, two by two across
h = 0.004;
Point(1) = {0.15, -h, -h}; Point(2) = {0.15, h, -h}; Point(3) = {0.15, h, h}; Point(4) = {0.15, -h, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve{1:4} = 3; Transfinite Surface{1}; Recombine Surface{1};
rod() = {}; face = 1;
Physical Surface("section0") = {1};
For i In {1:N}                                            // each section has a velocity of its own at the start
  e() = Extrude {0.30/N, 0, 0} { Surface{face}; Layers{1}; Recombine; };
  face = e(0); rod() += e(1);
  Physical Surface(Sprintf("section%g", i)) = {face};
EndFor
Physical Volume("rod") = {rod()};
