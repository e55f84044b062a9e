// A strip L x H x B: length along x, height (bending) along y, breadth along z, root at x = 0, axis y = z = 0
DefineConstant[ L = {1, Name "L"}, H = {0.03, Name "H"}, B = {0.04, Name "B"}, NX = {16, Name "NX"}, NY = {2, Name "NY"}, NZ = {2, Name "NZ"} ];
Point(1) = {0, -H/2, -B/2}; Point(2) = {0, H/2, -B/2}; Point(3) = {0, H/2, B/2}; Point(4) = {0, -H/2, B/2};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Transfinite Curve {1, 3} = NY + 1; Transfinite Curve {2, 4} = NZ + 1;
Curve Loop(1) = {1:4}; Plane Surface(1) = {1}; Transfinite Surface {1}; Recombine Surface {1};
b[] = Extrude {L, 0, 0} {Surface{1}; Layers{NX}; Recombine;};
Physical Volume("strip") = {b[1]};
Physical Surface("root") = {1}; Physical Surface("tip") = {b[0]};
