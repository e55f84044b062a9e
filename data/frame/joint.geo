// One joint of the frame as a solid: 0.6 m of the rail, a box of 80 x 160 x 6 mm along x, and 0.5 m of a cross member along -y, a tube of
// 90 x 5 mm welded to a plate of 140 x 140 x 12 mm.  Four washers of 36 mm hold the plate on the rail's inner web.
//
//   gmsh -3 joint.geo
SetFactory("OpenCASCADE");
gap = 0.003;                                              // height of the washers
Box(1) = {-0.3, -0.04, -0.08, 0.6, 0.08, 0.16};
Box(2) = {-0.3, -0.034, -0.074, 0.6, 0.068, 0.148};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Box(4) = {-0.07, -0.052 - gap, -0.07, 0.14, 0.012, 0.14};
Cylinder(5) = {0, -0.052 - gap, 0, 0, -0.488, 0, 0.045};
Cylinder(6) = {0, -0.052 - gap, 0, 0, -0.488, 0, 0.040};
BooleanDifference(7) = { Volume{5}; Delete; }{ Volume{6}; Delete; };
For i In {0:1}
  For j In {0:1}
    Cylinder(10 + 2*i + j) = {0.1*i - 0.05, -0.04, 0.1*j - 0.05, 0, -gap, 0, 0.018};
  EndFor
EndFor
BooleanUnion(20) = { Volume{3}; Delete; }{ Volume{4, 7, 10, 11, 12, 13}; Delete; };
Mesh.MeshSizeMax = 0.022;
Mesh.MeshSizeMin = 0.006;
Mesh.ElementOrder = 2;
Mesh.HighOrderOptimize = 1;
Physical Volume("joint") = {20};
