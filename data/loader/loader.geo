// The front of a wheel loader: frame, boom, lift cylinder, tilt cylinder, lever (bell crank), link and bucket, a region each.
// Metres, x forward, y left, z up, bucket level on the ground.  Every part is rigid in scene.toml, so that its mesh is as coarse as it may be;
// tubes and rods overlap, as cylinders do.  The pins are those of scene.toml.
SetFactory("OpenCASCADE");
Mesh.MeshSizeMax = 0.25;
Mesh.MeshSizeMin = 0.04;
Mesh.MeshSizeFromCurvature = 6;

// The part in volumes(): a plate across y from y0, t thick, with the corners xs(), zs().
Macro Plate
  corners() = {};
  For i In {0:#xs() - 1}
    p = newp; Point(p) = {xs(i), y0, zs(i)}; corners() += p;
  EndFor
  sides() = {};
  For i In {0:#xs() - 1}
    l = newl; Line(l) = {corners(i), corners((i + 1)%#xs())}; sides() += l;
  EndFor
  loop = newll; Curve Loop(loop) = {sides()};
  face = news; Plane Surface(face) = {loop};
  made() = Extrude {0, t, 0} { Surface{face}; };
  volumes() += made(1);
Return
// The part in volumes(): a pin tube along y at (x, z), w wide on each side of the middle plane.
Macro Pin
  v = newv; Cylinder(v) = {x, -w, z, 0, 2*w, 0, r};
  volumes() += v;
Return
// All of volumes() becomes one volume, in part().
Macro Unite
  If (#volumes() > 1)
    part() = BooleanUnion{ Volume{volumes(0)}; Delete; }{ Volume{volumes({1:#volumes() - 1})}; Delete; };
  Else
    part() = volumes();
  EndIf
Return
// A cylinder from (x, z) towards (x2, z2): a tube of `long` from there, and a rod of `rod` that ends at (x2, z2).
Macro Ram
  l = Sqrt((x2 - x)^2 + (z2 - z)^2); ux = (x2 - x)/l; uz = (z2 - z)/l;
  v = newv; Cylinder(v) = {x, 0, z, long*ux, 0, long*uz, r};
  w = newv; Cylinder(w) = {x + 0.02*ux, 0, z + 0.02*uz, long*ux, 0, long*uz, 0.7*r};
  tube() = BooleanDifference{ Volume{v}; Delete; }{ Volume{w}; Delete; };
  rods = newv; Cylinder(rods) = {x2 - rod*ux, 0, z2 - rod*uz, rod*ux, 0, rod*uz, 0.5*r};
Return

// ---- Frame: two cheeks on a cross beam.
volumes() = {};
t = 0.05;
For side In {0:1}
  y0 = side ? 0.25 : -0.30;
  xs() = {-0.40, 0.22, 0.30, 0.14, -0.14}; zs() = {0.60, 0.60, 1.62, 2.04, 2.04};
  Call Plate;
EndFor
y0 = -0.30; t = 0.60;
xs() = {-0.40, 0.22, 0.22, -0.40}; zs() = {0.45, 0.45, 0.70, 0.70}; Call Plate;
Call Unite;
Physical Volume("frame") = {part()};

// ---- Boom: two arms on a pivot tube, the lever's tube and the lift cylinder's tube.
volumes() = {};
t = 0.06;
For side In {0:1}
  y0 = side ? 0.36 : -0.42;
  xs() = {-0.13, -0.10, 0.10, 1.30, 2.38, 2.42, 2.24, 1.25, 0.95}; zs() = {1.86, 2.02, 2.04, 1.50, 0.57, 0.40, 0.34, 0.86, 1.02};
  Call Plate;
EndFor
x = 0; z = 1.9; w = 0.42; r = 0.07; Call Pin;
x = 1.15; z = 1.32; r = 0.09; Call Pin;
x = 1.20; z = 0.98; r = 0.06; Call Pin;
Call Unite;
Physical Volume("boom") = {part()};

// ---- Lever, with the tilt cylinder above its pin and the link below.
volumes() = {};
y0 = -0.05; t = 0.10;
xs() = {1.08, 1.26, 1.32, 1.38, 1.24, 1.02}; zs() = {2.26, 2.26, 1.32, 0.50, 0.48, 1.32};
Call Plate;
x = 1.15; z = 1.32; w = 0.12; r = 0.12; Call Pin;
Call Unite;
Physical Volume("lever") = {part()};
link = newv; Cylinder(link) = {1.28, 0, 0.57, 1.00, 0, 0.25, 0.05};
Physical Volume("link") = {link};

// ---- Cylinders: stroke 0.75 m from 1.352 m, and -0.25 to 0.2 m about 1.141 m.
x = -0.15; z = 0.90; x2 = 1.20; z2 = 0.98; long = 1.15; rod = 1.25; r = 0.09; Call Ram;
Physical Volume("lift_tube") = {tube()};
Physical Volume("lift_rod") = {rods};
x = 0.20; z = 1.58; x2 = 1.17; z2 = 2.18; long = 0.75; rod = 0.78; r = 0.10; Call Ram;
Physical Volume("tilt_tube") = {tube()};
Physical Volume("tilt_rod") = {rods};

// ---- Bucket: a shell 2.5 m wide with cheeks, and lugs for the boom and the link.
volumes() = {};
y0 = -1.25; t = 2.50;
xs() = {2.46, 2.42, 2.44, 2.62, 3.45, 3.45, 2.60, 2.38, 2.36, 2.40}; zs() = {1.15, 0.80, 0.42, 0.10, 0.05, 0.01, 0.05, 0.40, 0.80, 1.15};
Call Plate;
t = 0.04;
For side In {0:1}
  y0 = side ? 1.21 : -1.25;
  xs() = {2.43, 2.39, 2.41, 2.61, 3.35, 2.95}; zs() = {1.10, 0.80, 0.41, 0.07, 0.03, 0.85};
  Call Plate;
EndFor
For side In {0:1}
  y0 = side ? 0.30 : -0.34;
  xs() = {2.24, 2.40, 2.42, 2.30}; zs() = {0.52, 0.62, 0.38, 0.36};
  Call Plate;
EndFor
y0 = -0.04; t = 0.08;
xs() = {2.22, 2.40, 2.40, 2.24}; zs() = {0.88, 0.92, 0.70, 0.74}; Call Plate;
Call Unite;
Physical Volume("bucket") = {part()};
