// A box girder of four walls by their mid-surfaces: B wide and high, L long, N quadrangles across each wall.
DefineConstant[ N = 10, B = 0.3, L = 1.8 ];
Point(1) = {0, -B/2, -B/2}; Point(2) = {0, B/2, -B/2}; Point(3) = {0, B/2, B/2}; Point(4) = {0, -B/2, B/2};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Transfinite Curve{1:4} = N + 1;
s() = Extrude {L, 0, 0} { Curve{1:4}; Layers{Round(N*L/B)}; Recombine; };
Physical Surface("girder") = {s(1), s(5), s(9), s(13)};
Physical Curve("left") = {1:4}; Physical Curve("right") = {s(0), s(4), s(8), s(12)};
