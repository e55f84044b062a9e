// A block L x B x H along x, its left end at x = 0, its axis on y = z = 0: NX x NY x NZ hexahedra, or tetrahedra when TET = 1.
DefineConstant[ L = {1, Name "L"}, B = {0.1, Name "B"}, H = {0.1, Name "H"}, NX = {4, Name "NX"}, NY = {1, Name "NY"}, NZ = {1, Name "NZ"}, TET = {0, Name "TET"} ];
Point(1) = {0, -B/2, -H/2}; Point(2) = {0, B/2, -H/2}; Point(3) = {0, B/2, H/2}; Point(4) = {0, -B/2, H/2};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Transfinite Curve {1, 3} = NY + 1; Transfinite Curve {2, 4} = NZ + 1;
Curve Loop(1) = {1:4}; Plane Surface(1) = {1}; Transfinite Surface {1};
If (!TET)
  Recombine Surface {1};
  block[] = Extrude {L, 0, 0} {Surface{1}; Layers{NX}; Recombine;};
Else
  block[] = Extrude {L, 0, 0} {Surface{1}; Layers{NX};};
EndIf
Physical Volume("block") = {block[1]};
Physical Surface("left") = {1};
Physical Surface("right") = {block[0]};
