// Two rubber pads, 40 x 40 x 20 mm, the upper one turned and above the edge of the lower.  Millimetres.
SetFactory("OpenCASCADE");
DefineConstant[ N = {8, Name "N"} ];
Box(1) = {0, 0, 0, 40, 40, 20};
Box(2) = {-20, -20, 0, 40, 40, 20};
Rotate {{0, 0, 1}, {0, 0, 0}, 0.5} { Volume{2}; }
Rotate {{0, 1, 0}, {0, 0, 0}, 0.4} { Volume{2}; }
Translate {28, 22, 40} { Volume{2}; }
Transfinite Curve {:} = N + 1;
Transfinite Surface {:};
Transfinite Volume {:};
Recombine Surface {:};
Physical Volume("lower") = {1};
Physical Volume("upper") = {2};
