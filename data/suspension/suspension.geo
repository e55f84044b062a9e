// The left front corner of a light truck on a shaker post: double wishbones, knuckle, wheel, tie rod, strut, the frame they hang on.
//
//   gmsh -3 -setnumber SIZE 0 suspension.geo
//
// Metres.  x forward, y left (outboard), z up; the top of the post is z = 0.  Drawn at ride height, the wheel centre 20 mm low on its tyre.
//  - Parts joined by a joint never touch: a gap of some millimetres, so that they share no node.
//  - The lower arm is made of hexahedral blocks (built-in kernel), the rest is tetrahedra (OpenCASCADE kernel).
DefineConstant[ SIZE = {0, Name "SIZE"} ];                // 0 small, 1 medium

// ---------------------------------------------------------------- dimensions [m]
z_low = 0.30;  y_low = 0.28;  x_low = 0.20;               // lower arm: pivot axis, its bushings at +-x
y_ball = 0.69;                                            // its ball joint
z_up = 0.62;   y_up = 0.38;   x_up = 0.13;                // upper arm likewise
y_uball = 0.67; x_uball = -0.02;
y_mid = (y_low + y_ball)/2;                               // middle of the lower arm: the strut stands here
z_wheel = 0.40; y_wheel = 0.80; r_wheel = 0.42;
z_top = 0.86;  y_top = 0.40;                              // upper end of the strut
z_foot = 0.335;                                           // lower end
r_eye = 0.032; r_bore = 0.018; b_eye = 0.050;             // bushings of the lower arm
h_arm = 0.030;                                            // its thickness
r_ueye = 0.022; r_ubore = 0.012;

SetFactory("OpenCASCADE");

// ---------------------------------------------------------------- frame: rail, tower, shelf for the strut, ears with the pins of the arms
v1 = newv; Box(v1) = {-0.34, 0.09, 0.24, 0.68, 0.10, 0.12};
v2 = newv; Box(v2) = {-0.17, 0.13, 0.36, 0.34, 0.06, 0.52};
v3 = newv; Box(v3) = {-0.09, 0.13, 0.88, 0.18, 0.34, 0.035};
f() = {v2, v3};
For m In {0:1}
  s = 1 - 2*m;
  For i In {0:1}
    t = i ? 0.030 : -0.042;
    v = newv; Box(v) = {s*x_low + t, 0.18, z_low - 0.026, 0.012, 0.128, 0.052}; f() += v;
    v = newv; Box(v) = {s*x_up + t, 0.18, z_up - 0.020, 0.012, 0.222, 0.040}; f() += v;
  EndFor
  v = newv; Cylinder(v) = {s*x_low - 0.048, y_low, z_low, 0.096, 0, 0, r_bore - 0.002}; f() += v;
  v = newv; Cylinder(v) = {s*x_up - 0.048, y_up, z_up, 0.096, 0, 0, r_ubore - 0.0015}; f() += v;
EndFor
v = newv; Box(v) = {-0.165, 0.18, 0.350, 0.05, 0.125, 0.04}; f() += v;      // steering gear
frame = newv; BooleanUnion(frame) = { Volume{v1}; Delete; }{ Volume{f()}; Delete; };

// ---------------------------------------------------------------- upper arm
f() = {};
For m In {0:1}
  s = 1 - 2*m;
  p = newp; Point(p) = {s*x_up - 0.020, y_up + 0.012, z_up - 0.011}; Point(p+1) = {s*x_up + 0.020, y_up + 0.012, z_up - 0.011};
  Point(p+2) = {x_uball + 0.028*(s > 0 ? 1 : 0.2), y_uball, z_up - 0.011}; Point(p+3) = {x_uball - 0.028*(s > 0 ? 0.2 : 1), y_uball, z_up - 0.011};
  c = newl; Line(c) = {p, p+1}; Line(c+1) = {p+1, p+2}; Line(c+2) = {p+2, p+3}; Line(c+3) = {p+3, p};
  k = newll; Curve Loop(k) = {c:c+3}; a = news; Plane Surface(a) = {k};
  e() = Extrude {0, 0, 0.022} { Surface{a}; }; f() += e(1);
  v = newv; Cylinder(v) = {s*x_up - 0.020, y_up, z_up, 0.040, 0, 0, r_ueye}; f() += v;
EndFor
v = newv; Cylinder(v) = {x_uball, y_uball, z_up - 0.014, 0, 0, 0.028, 0.030};
upper = newv; BooleanUnion(upper) = { Volume{v}; Delete; }{ Volume{f()}; Delete; };
v = newv; Cylinder(v) = {-0.3, y_up, z_up, 0.6, 0, 0, r_ubore};
v1 = newv; BooleanDifference(v1) = { Volume{upper}; Delete; }{ Volume{v}; Delete; };
upper = v1;

// ---------------------------------------------------------------- knuckle: upright, ears with the ball studs, spindle, steering arm
v1 = newv; Box(v1) = {-0.035, 0.735, 0.235, 0.07, 0.035, 0.365};
v = newv; Box(v) = {-0.025, y_ball - 0.025, 0.235, 0.05, 0.08, 0.035}; f() = {v};
v = newv; Cylinder(v) = {0, y_ball, 0.26, 0, 0, 0.020, 0.010}; f() += v;
v = newv; Box(v) = {x_uball - 0.025, y_uball - 0.025, 0.565, 0.05, 0.095, 0.030}; f() += v;
v = newv; Cylinder(v) = {x_uball, y_uball, 0.59, 0, 0, 0.012, 0.010}; f() += v;
v = newv; Cylinder(v) = {0, 0.76, z_wheel, 0, 0.13, 0, 0.030}; f() += v;
v = newv; Box(v) = {-0.165, 0.735, 0.315, 0.14, 0.03, 0.022}; f() += v;
knuckle = newv; BooleanUnion(knuckle) = { Volume{v1}; Delete; }{ Volume{f()}; Delete; };
tie = newv; Cylinder(tie) = {-0.14, 0.335, 0.37, 0, 0.415, -0.01, 0.014};

// ---------------------------------------------------------------- wheel: tyre and rim, disc with five holes
b = 0.24;
v2 = newv; Cylinder(v2) = {0, y_wheel - b/2 - 0.01, z_wheel, 0, 0.135, 0, 0.285};
v3 = newv; Cylinder(v3) = {0, y_wheel + 0.030, z_wheel, 0, 0.2, 0, 0.285};
v4 = newv; Cylinder(v4) = {0, 0.6, z_wheel, 0, 0.5, 0, 0.0315};
f() = {v2, v3, v4};
For i In {0:4}
  t = Pi/2 + 2*Pi*i/5;
  v = newv; Cylinder(v) = {0.165*Cos(t), 0.6, z_wheel + 0.165*Sin(t), 0, 0.5, 0, 0.052}; f() += v;
EndFor
// rounded shoulders
v = newv; Torus(v) = {0, 0, 0, r_wheel - 0.045, 0.045};
Rotate {{1, 0, 0}, {0, 0, 0}, Pi/2} { Volume{v}; }
Translate {0, y_wheel - b/2 + 0.045, z_wheel} { Volume{v}; }
w = newv; Torus(w) = {0, 0, 0, r_wheel - 0.045, 0.045};
Rotate {{1, 0, 0}, {0, 0, 0}, Pi/2} { Volume{w}; }
Translate {0, y_wheel + b/2 - 0.045, z_wheel} { Volume{w}; }
v5 = newv; Cylinder(v5) = {0, y_wheel - b/2, z_wheel, 0, b, 0, r_wheel - 0.045};
v6 = newv; Cylinder(v6) = {0, y_wheel - b/2 + 0.045, z_wheel, 0, b - 0.09, 0, r_wheel};
v1 = newv; BooleanUnion(v1) = { Volume{v5}; Delete; }{ Volume{v6, v, w}; Delete; };
v2 = newv; BooleanDifference(v2) = { Volume{v1}; Delete; }{ Volume{f()}; Delete; };
v3 = newv; Box(v3) = {0, 0, -1, 1, 2, 3};
v4 = newv; BooleanIntersection(v4) = { Volume{v2}; }{ Volume{v3}; };
v5 = newv; BooleanDifference(v5) = { Volume{v2}; Delete; }{ Volume{v3}; Delete; };
v() = BooleanFragments{ Volume{v4}; Delete; }{ Volume{v5}; Delete; };                  // cut, so that a picture may leave the front away
wheel_f = v(0); wheel_r = v(1);

// ---------------------------------------------------------------- strut: tube and rod along the line from top to foot; the post
l = Sqrt((y_mid - y_top)^2 + (z_top - z_foot)^2); dy = (y_mid - y_top)/l; dz = (z_foot - z_top)/l;
v1 = newv; Cylinder(v1) = {0, y_top, z_top, 0, 0.30*dy, 0.30*dz, 0.042};
v2 = newv; Cylinder(v2) = {0, y_top + 0.02*dy, z_top + 0.02*dz, 0, 0.30*dy, 0.30*dz, 0.026};
tube = newv; BooleanDifference(tube) = { Volume{v1}; Delete; }{ Volume{v2}; Delete; };
v1 = newv; Cylinder(v1) = {0, y_top + 0.16*dy, z_top + 0.16*dz, 0, (l - 0.16)*dy, (l - 0.16)*dz, 0.016};
v2 = newv; Cylinder(v2) = {0, y_mid - 0.022*dy, z_foot - 0.022*dz, 0, 0.012*dy, 0.012*dz, 0.034};
rod = newv; BooleanUnion(rod) = { Volume{v1}; Delete; }{ Volume{v2}; Delete; };
post = newv; Box(post) = {-0.24, 0.64, -0.05, 0.48, 0.32, 0.05};

Physical Volume("frame") = frame;
Physical Volume("upper_arm") = upper;
Physical Volume("knuckle") = knuckle;
Physical Volume("tie_rod") = tie;
Physical Volume("wheel_front") = wheel_f;
Physical Volume("wheel_rear") = wheel_r;
Physical Volume("strut_tube") = tube;
Physical Volume("strut_rod") = rod;
Physical Volume("post") = post;

// ---------------------------------------------------------------- lower arm: two bushing eyes, two legs, a seat for the strut, a head for the ball
SetFactory("Built-in");
n_eye = SIZE==0 ? 4 : 6; n_wall = SIZE==0 ? 2 : 3; n_z = SIZE==0 ? 3 : 4; n_leg = SIZE==0 ? 3 : 4;
n_y() = {SIZE==0 ? 8 : 12, SIZE==0 ? 6 : 8, SIZE==0 ? 6 : 8, SIZE==0 ? 3 : 5};       // along y: leg, seat, web, head
n_c = SIZE==0 ? 4 : 6;                                                                // across the seat
beta = Asin(h_arm/2/r_eye);
// stations along y, outside and inside of the legs there
y_s() = {y_low + r_eye*Cos(beta), y_mid - 0.045, y_mid + 0.045, y_ball - 0.035, y_ball + 0.030};
x_o() = {x_low + b_eye/2, 0.110, 0.088, 0.042, 0.034};
x_i() = {x_low - b_eye/2, 0.072, 0.054, 0.018, 0.015};
// One face z = low for each side m and station: points out, in; the volumes are extruded upwards.
zl = z_low - h_arm/2;
For m In {0:1}
  s = 1 - 2*m;
  For i In {0:4}
    po~{m}~{i} = newp; Point(po~{m}~{i}) = {s*x_o(i), y_s(i), zl};
    pi~{m}~{i} = newp; Point(pi~{m}~{i}) = {s*x_i(i), y_s(i), zl};
    lx~{m}~{i} = newl; Line(lx~{m}~{i}) = {po~{m}~{i}, pi~{m}~{i}};
    Transfinite Curve{lx~{m}~{i}} = n_leg + 1;
  EndFor
  For i In {0:3}
    lo~{m}~{i} = newl; Line(lo~{m}~{i}) = {po~{m}~{i}, po~{m}~{i+1}};
    li~{m}~{i} = newl; Line(li~{m}~{i}) = {pi~{m}~{i}, pi~{m}~{i+1}};
    Transfinite Curve{lo~{m}~{i}, li~{m}~{i}} = n_y(i) + 1;
  EndFor
EndFor
plan() = {};
For i In {1:4}
  lc~{i} = newl; Line(lc~{i}) = {pi~{0}~{i}, pi~{1}~{i}};
  Transfinite Curve{lc~{i}} = n_c + 1;
EndFor
For i In {0:3}
  For m In {0:1}
    k = newll; Curve Loop(k) = {lx~{m}~{i}, li~{m}~{i}, -lx~{m}~{i+1}, -lo~{m}~{i}};
    a = news; Plane Surface(a) = {k}; plan() += a;
  EndFor
  If(i > 0)
    k = newll; Curve Loop(k) = {lc~{i}, li~{1}~{i}, -lc~{i+1}, -li~{0}~{i}};
    a = news; Plane Surface(a) = {k}; plan() += a;
  EndIf
EndFor
Transfinite Surface{plan()};
Recombine Surface{plan()};
arm() = {};
For i In {0:#plan()-1}
  e() = Extrude {0, 0, h_arm} { Surface{plan(i)}; Layers{n_z}; Recombine; };
  arm() += e(1);
EndFor
// An eye: four sectors in the plane at its inner side, the one towards the leg with a flat outside; extruded along x
eyes() = {};
For m In {0:1}
  s = 1 - 2*m; x0 = s*x_i(0);
  pc = newp; Point(pc) = {x0, y_low, z_low};
  t() = {-beta, beta, 3*Pi/4, 5*Pi/4};
  For i In {0:3}
    pb(i) = newp; Point(pb(i)) = {x0, y_low + r_bore*Cos(t(i)), z_low + r_bore*Sin(t(i))};
    pe(i) = newp; Point(pe(i)) = {x0, y_low + r_eye*Cos(t(i)), z_low + r_eye*Sin(t(i))};
    lr(i) = newl; Line(lr(i)) = {pb(i), pe(i)};
    Transfinite Curve{lr(i)} = n_wall + 1;
  EndFor
  For i In {0:3}
    j = (i + 1) % 4; n = i == 0 ? n_z : n_eye;
    lb(i) = newl; Circle(lb(i)) = {pb(i), pc, pb(j)};
    le(i) = newl;
    If(i == 0)
      Line(le(i)) = {pe(i), pe(j)};
    Else
      Circle(le(i)) = {pe(i), pc, pe(j)};
    EndIf
    Transfinite Curve{lb(i), le(i)} = n + 1;
  EndFor
  q() = {};
  For i In {0:3}
    k = newll; Curve Loop(k) = {lr(i), le(i), -lr((i + 1) % 4), -lb(i)};
    a = news; Plane Surface(a) = {k}; q() += a;
  EndFor
  Transfinite Surface{q()};
  Recombine Surface{q()};
  For i In {0:3}
    e() = Extrude {s*b_eye, 0, 0} { Surface{q(i)}; Layers{n_leg}; Recombine; };
    eyes() += e(1);
  EndFor
EndFor
Coherence;

Physical Volume("lower_arm") = {arm(), eyes()};

// ---------------------------------------------------------------- surfaces that joints need, found by their boxes
d = 1e-4;
Physical Surface("seat") = Surface In BoundingBox {-0.1, y_mid - 0.045 - d, z_low + h_arm/2 - d, 0.1, y_mid + 0.045 + d, z_low + h_arm/2 + d};
Physical Surface("ball") = { Surface In BoundingBox {-0.1, y_ball - 0.035 - d, z_low - h_arm/2 - d, 0.1, y_ball + 0.03 + d, z_low - h_arm/2 + d},
                             Surface In BoundingBox {-0.1, y_ball - 0.035 - d, z_low + h_arm/2 - d, 0.1, y_ball + 0.03 + d, z_low + h_arm/2 + d} };
q = r_bore + d;
Physical Surface("bushing_front") = Surface In BoundingBox {x_i(0) - d, y_low - q, z_low - q, x_o(0) + d, y_low + q, z_low + q};
Physical Surface("bushing_rear") = Surface In BoundingBox {-x_o(0) - d, y_low - q, z_low - q, -x_i(0) + d, y_low + q, z_low + q};

// ---------------------------------------------------------------- mesh
Mesh.MeshSizeFromCurvature = 16;
Mesh.MeshSizeMin = 0.006;
Mesh.MeshSizeMax = 0.06;
Mesh.MeshSizeExtendFromBoundary = 1;
