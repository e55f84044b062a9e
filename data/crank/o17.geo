// The rod of the IVP test set's "crank": 8 x 8 mm, 0.30 m long, from the crank pin at x = 0.15 to the slider.  Metres.
DefineConstant[ N = {20, Name "N"} ];                     // cells along it, an even number, two by two across
h = 0.004;
Point(1) = {0.15, -h, -h};
a() = Extrude {0, h, 0} { Point{1}; Layers{1}; };
b() = Extrude {0, h, 0} { Point{a(0)}; Layers{1}; };
c() = Extrude {0, 0, h} { Line{a(1), b(1)}; Layers{1}; Recombine; };
d() = Extrude {0, 0, h} { Line{c(0), c(4)}; Layers{1}; Recombine; };
face() = {c(1), c(5), d(1), d(5)}; rod() = {};
Physical Surface("section0") = {face()};
For i In {1:N}                                            // each section has a velocity of its own at the start
  e() = Extrude {0.30/N, 0, 0} { Surface{face()}; Layers{1}; Recombine; };
  face() = {e(0), e(6), e(12), e(18)}; rod() += {e(1), e(7), e(13), e(19)};
  Physical Surface(Sprintf("section%g", i)) = {face()};
EndFor
Physical Surface("end") = {face()};
Physical Volume("rod") = {rod()};
Physical Point("middle") = {Point In BoundingBox{0.30 - h/2, -h/2, -h/2, 0.30 + h/2, h/2, h/2}};
