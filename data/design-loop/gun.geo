// A light open vehicle with a recoiling gun on two cheek plates, and a driver's seat: the small model of the design loop.
//
//   gmsh -3 -setnumber thickness 0.008 gun.geo
//
// Metres; x forward, y left, z up; the deck is z = 0, the ground z = -0.55.  The cheeks are hexahedra, `layers` through the thickness;
// all else is rigid and there for its mass and its shape.  Parts held by joints share no node.
DefineConstant[ thickness = {0.008, Name "thickness"} ];  // of a cheek plate
DefineConstant[ size = {0.06, Name "size"} ];            // of a cheek's cells
DefineConstant[ layers = {1, Name "layers"} ];            // of cells through a cheek

If (thickness <= 0)
  Error("a cheek is %g m thick", thickness);
  Abort;
EndIf

SetFactory("OpenCASCADE");
Geometry.OCCBoundsUseStl = 1;
Mesh.Algorithm = 6;
Mesh.RecombinationAlgorithm = 2;  // quadrilaterals alone
Mesh.MeshSizeFromCurvature = 12;

x_gun = -0.45;  z_gun = 0.75;     // trunnion
r_bore = 0.055;                   // trunnion bore in a cheek
inner = 0.16;                     // half distance of the cheeks
e = 1e-4;

// ---- cheeks: foot 0.7 m long on the deck, round head about the trunnion, a hole to save mass
Point(1) = {x_gun - 0.35, inner, 0};
Point(2) = {x_gun + 0.35, inner, 0};
Point(3) = {x_gun + 0.11, inner, z_gun};
Point(4) = {x_gun, inner, z_gun + 0.11};
Point(5) = {x_gun - 0.11, inner, z_gun};
Point(6) = {x_gun, inner, z_gun};
Line(1) = {1, 2}; Line(2) = {2, 3}; Circle(3) = {3, 6, 4}; Circle(4) = {4, 6, 5}; Line(5) = {5, 1};
Circle(6) = {x_gun, inner, z_gun, r_bore, 0, 2*Pi};
Circle(7) = {x_gun, inner, 0.28, 0.13, 0, 2*Pi};
Rotate { {1, 0, 0}, {x_gun, inner, z_gun}, Pi/2 } { Curve{6}; }
Rotate { {1, 0, 0}, {x_gun, inner, 0.28}, Pi/2 } { Curve{7}; }
Delete { Point{6}; }
Curve Loop(1) = {1:5}; Curve Loop(2) = {6}; Curve Loop(3) = {7};
Plane Surface(1) = {1, 2, 3};
Recombine Surface {1};
left[] = Extrude {0, thickness, 0} { Surface{1}; Layers{layers}; Recombine; };
between[] = Extrude {0, -2*inner, 0} { Surface{1}; Layers{1}; Recombine; };
right[] = Extrude {0, -thickness, 0} { Surface{between[0]}; Layers{layers}; Recombine; };
Delete { Volume{between[1]}; }    // it only carries one mesh to both cheeks
MeshSize { PointsOf { Volume{left[1], right[1]}; } } = size;
Physical Volume("cheeks") = {left[1], right[1]};

For side In {-1:1:2}
  y_1 = side > 0 ? inner - e : -inner - thickness - e;
  y_2 = y_1 + thickness + 2*e;
  foot[] += Surface In BoundingBox {x_gun - 1, y_1, -e, x_gun + 1, y_2, e};
  bores[] += Surface In BoundingBox {x_gun - r_bore - e, y_1, z_gun - r_bore - e, x_gun + r_bore + e, y_2, z_gun + r_bore + e};
EndFor
Physical Surface("foot") = {foot[]};
Physical Surface("bores") = {bores[]};

// ---- rigid parts, coarse
v = newv;
Cylinder(v) = {x_gun - 0.30, 0, z_gun, 0.70, 0, 0, 0.110};                            // cradle, bored below, with two pins
Cylinder(v + 1) = {x_gun - 0.31, 0, z_gun, 0.72, 0, 0, 0.085};
cradle[] = BooleanDifference { Volume{v}; Delete; }{ Volume{v + 1}; Delete; };
v = newv;
Cylinder(v) = {x_gun, 0.095, z_gun, 0, inner - 0.095 + 0.012, 0, r_bore - 0.004};
Cylinder(v + 1) = {x_gun, -0.095, z_gun, 0, -(inner - 0.095 + 0.012), 0, r_bore - 0.004};
whole[] = BooleanUnion { Volume{cradle[]}; Delete; }{ Volume{v, v + 1}; Delete; };
cradle[] = whole[];
Physical Volume("cradle") = {cradle[]};

v = newv;
Cylinder(v) = {x_gun - 0.45, 0, z_gun, 2.00, 0, 0, 0.060};                            // barrel and breech
Cylinder(v + 1) = {x_gun - 0.75, 0, z_gun, 0.30, 0, 0, 0.100};
barrel[] = BooleanUnion { Volume{v}; Delete; }{ Volume{v + 1}; Delete; };
Physical Volume("barrel") = {barrel[]};

v = newv;
Box(v) = {-1.60, -0.85, -0.14, 3.20, 1.70, 0.14 - 0.002};                             // deck, and four wheels that stand for looks
For i In {0:3}
  sx = (i % 2) ? 1 : -1;  sy = (i < 2) ? 1 : -1;
  Cylinder(v + 1 + i) = {1.10*sx, 0.60*sy, -0.30, 0, 0.24*sy, 0, 0.25};
EndFor
deck[] = BooleanUnion { Volume{v}; Delete; }{ Volume{v + 1 : v + 4}; Delete; };
Physical Volume("hull") = {deck[]};

v = newv;
Box(v) = {0.75, 0.22, 0.22, 0.46, 0.46, 0.10};                                        // seat: pan and back
Box(v + 1) = {0.65, 0.22, 0.22, 0.10, 0.46, 0.70};
seat[] = BooleanUnion { Volume{v}; Delete; }{ Volume{v + 1}; Delete; };
Physical Volume("seat") = {seat[]};

coarse[] = {cradle[], barrel[], deck[], seat[]};
MeshSize { PointsOf { Volume{coarse[]}; } } = 0.16;
