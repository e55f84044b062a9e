// A concept fighting vehicle with a 120 mm gun, made from scratch for the firing scene.
//
//   gmsh -3 -setnumber SIZE 1 vehicle.geo
//
//   gmsh -3 -setnumber HULL 1 vehicle.geo       (the hull as plates: mid-surfaces hull_floor ... hull_side, see hull.toml)
//
// Metres. x forward, y left, z up; the ground is z = 0 and the wheels stand on it. Region masses: budget.csv.
//  - Parts joined by a joint never touch: a gap of some millimetres, so that they share no node.
//  - Parts that are bonded share their nodes.
//  - barrel, recoil_housing and cradle are made of hexahedral blocks (built-in kernel), wheels too; the rest is
//    tetrahedra (OpenCASCADE kernel).

// ---------------------------------------------------------------- size of the mesh
DefineConstant[ SIZE = {0, Name "SIZE"} ];                // 0 small, 1 medium, 2 a million hexahedra in the gun

DefineConstant[ HULL = {0, Name "HULL"} ];                // 0 a solid, 1 the mid-surfaces of its plates

s = SIZE;
DefineConstant[                                 // cells along the edges of the blocks; the tetrahedra
  n_quarter = s==0 ? 4 : s==1 ? 8 : 26,         // around a quarter of barrel and housing
  n_wall    = s==0 ? 2 : s==1 ? 4 : 12,         // through the wall of the barrel
  n_sleeve  = s==0 ? 2 : s==1 ? 4 : 9,          // through the wall of the housing
  n_rear    = s==0 ? 8 : s==1 ? 32 : 160,       // along the barrel inside the housing
  n_taper   = s==0 ? 24 : s==1 ? 96 : 480,      // along the tapered barrel
  n_breech  = s==0 ? 2 : s==1 ? 6 : 27,         // along the breech
  n_plug    = s==0 ? 1 : s==1 ? 2 : 4,          // round the core of the breech
  n_flat    = s==1 ? 8 : 4,                     // across a flat of the cradle
  n_corner  = s==1 ? 3 : 1,                     // across half a corner face of the cradle
  n_cradle  = s==1 ? 4 : 2,                     // through the wall of the cradle
  n_end     = s==1 ? 9 : 3,                     // along the cradle, before and behind the trunnions
  n_pin     = s==1 ? 8 : 3,                     // along a trunnion pin
  n_ring    = s==1 ? 2 : 1,                     // round the core of a trunnion pin
  n_around  = s==1 ? 3 : 2,                     // from a trunnion pin to the edge of its zone
  n_wheel   = s==1 ? 10 : 6,                    // around a quarter of a wheel
  n_tread   = s==1 ? 4 : 2,                     // along the radius and the width of a wheel
  n_circle  = s==1 ? 24 : 12,                   // sides of the circle of a pin or bore of tetrahedra
  n_along   = s==1 ? 5 : 2,                     // along it
  n_race    = s==1 ? 72 : 24,                   // of the turret ring
  n_port    = s==1 ? 36 : 12,                   // of the gun port
  fine      = s==1 ? 0.38 : 1                   // factor on the sizes of the tetrahedra
];

// ---------------------------------------------------------------- dimensions [m]
// gun; its axis is (x, 0, z_gun)
z_gun    = 1.90;      // height of the bore axis
x_tr     = -0.10;     // trunnion axis
x_b      = -0.55;     // rear face of the barrel: the chamber
r_bore   = 0.060;     // 120 mm
r_rear   = 0.140;     // barrel inside the housing
r_muzzle = 0.080;
l_rear   = 1.20;      // barrel inside the housing
l_barrel = 4.80;
l_breech = 0.20;      // the housing closes the barrel by this much behind it
r_house  = 0.210;     // sliding surface of the recoil housing
r_core   = 0.035;     // corners of the core blocks of the breech: mesh only
gap      = 0.004;     // housing in cradle
r_crad   = r_house + gap;
w_crad   = 0.270;     // half width of the octagonal cradle, across flats
a_crad   = 0.150;     // half width of a flat; the trunnion zone is 2a x 2a
l_crad   = 0.50;      // half length, the trunnions in the middle
r_pin    = 0.095;     // trunnion pin
l_pin    = 0.140;
// turret
x_ring   = -0.50;     // axis of the turret ring
z_roof   = 1.40;      // of the hull
h_ring   = 0.05;      // each race
g_ring   = 0.005;     // between the races
y_cheek  = 0.29;      // inner face of the cheeks
t_cheek  = 0.10;
g_pin    = 0.004;     // trunnion pin in its bore
// running gear
x_wheel() = {1.85, 0.55, -0.75, -2.05};
r_wheel  = 0.42;
y_wheel  = 1.065;     // inner side
b_wheel  = 0.235;
dx_arm   = 0.45;      // the pivot is ahead of the axle by dx, above it by dz
dz_arm   = 0.30;
y_arm    = 0.965;     // inner side
t_arm    = 0.08;
r_pivot  = 0.060;
r_axle   = 0.050;
g_arm    = 0.0035;    // pivot pins and axles in their bores
y_hull   = 0.95;
t_side   = 0.15;      // side plates: they hold the pivot bores

eps = 1e-5;

// ================================================================ tetrahedra: all but the gun and the wheels
// This kernel goes first: its booleans number anew and would reuse numbers of the other.
SetFactory("OpenCASCADE");
Geometry.OCCUnionUnify = 0;                               // keep the four faces of a pin

// A prism with the outline (pX, pZ) from y0 over dy: volume v
Macro Prism
  pts() = {}; c() = {};
  For i In {0:#pX()-1}
    p = newp; Point(p) = {pX(i), y0, pZ(i)}; pts(i) = p;
  EndFor
  For i In {0:#pX()-1}
    l = newl; Line(l) = {pts(i), pts((i+1) % #pX())}; c(i) = l;
  EndFor
  l = newll; Curve Loop(l) = {c()};
  f = news; Plane Surface(f) = {l};
  e() = Extrude {0, dy, 0} { Surface{f}; };
  v = e(1);
Return

// The same with the outline (pX, pY) from z0 over dz
Macro Slab
  pts() = {}; c() = {};
  For i In {0:#pX()-1}
    p = newp; Point(p) = {pX(i), pY(i), z0}; pts(i) = p;
  EndFor
  For i In {0:#pX()-1}
    l = newl; Line(l) = {pts(i), pts((i+1) % #pX())}; c(i) = l;
  EndFor
  l = newll; Curve Loop(l) = {c()};
  f = news; Plane Surface(f) = {l};
  e() = Extrude {0, 0, dz} { Surface{f}; };
  v = e(1);
Return

// A rod along y for a pin or a bore: its axis through (xc, zc), radius r, from y0 over dy. Its side is four faces, because
// gmsh can mesh those regularly and a closed cylinder not; the polygons of pin and bore then stay clear of each other.
Macro Rod
  pc = newp; Point(pc) = {xc, y0, zc};
  pts() = {}; c() = {};
  For i In {0:3}
    p = newp; Point(p) = {xc + r*Cos(i*Pi/2), y0, zc + r*Sin(i*Pi/2)}; pts(i) = p;
  EndFor
  For i In {0:3}
    l = newl; Circle(l) = {pts(i), pc, pts((i+1) % 4)}; c(i) = l;
  EndFor
  Delete { Point{pc}; }
  l = newll; Curve Loop(l) = {c()};
  f = news; Plane Surface(f) = {l};
  e() = Extrude {0, dy, 0} { Surface{f}; };
  v = e(1);
Return

// ---------------------------------------------------------------- hull and what is bonded to it
z_floor = 0.51;
r_race = 0.64; R_race = 0.78;                             // of the turret ring
hull = {};
If (!HULL)
  pX() = {-3.0, -2.8, 2.3, 3.0, 2.6, 2.0, -3.0};
  pZ() = {0.65, 0.45, 0.45, 0.85, 1.15, z_roof, z_roof};
  y0 = -y_hull; dy = 2*y_hull;
  Call Prism;
  hull = v;
  pX() = {-2.9, -2.75, 2.25, 2.85, 2.5, 1.95, -2.9};
  pZ() = {0.69, z_floor, z_floor, 0.87, 1.10, 1.34, 1.34};
  y0 = -(y_hull - t_side); dy = -2*y0;
  Call Prism;
  cut() = {v};
  v = newv; Cylinder(v) = {x_ring, 0, 1.30, 0, 0, 0.2, r_race}; cut() += v;
  For m In {0:1}
    side = 1 - 2*m;
    For j In {0:3}
      xc = x_wheel(j) + dx_arm; zc = r_wheel + dz_arm; r = r_pivot + g_arm;
      y0 = side*(y_hull - t_side - 0.02); dy = side*(t_side + 0.04);
      Call Rod;
      cut() += v;
    EndFor
  EndFor
  v = newv; BooleanDifference(v) = { Volume{hull}; Delete; }{ Volume{cut()}; Delete; };
  hull = v;
EndIf

// crew capsule: a closed box on the floor with three seats (each with its occupant)
v1 = newv; Box(v1) = {0.40, -0.70, z_floor, 1.50, 1.40, 0.79};
v2 = newv; Box(v2) = {0.45, -0.65, z_floor + 0.05, 1.40, 1.30, 0.69};
capsule = newv; BooleanDifference(capsule) = { Volume{v1}; Delete; }{ Volume{v2}; Delete; };
z_seat = z_floor + 0.05; h_seat = 0.30;
seat_d = newv; Box(seat_d) = {1.30, -0.20, z_seat, 0.40, 0.40, h_seat};
seat_c = newv; Box(seat_c) = {0.60,  0.15, z_seat, 0.40, 0.40, h_seat};
seat_g = newv; Box(seat_g) = {0.60, -0.55, z_seat, 0.40, 0.40, h_seat};
engine = newv; Box(engine) = {-2.70, -0.50, z_floor, 0.95, 1.00, 0.55};
gears = newv; Box(gears) = {-1.70, -0.45, z_floor, 0.40, 0.90, 0.40};
magazine = newv; Box(magazine) = {-1.20, -0.50, z_floor, 1.40, 1.00, 0.35};
sponson_l = newv; Box(sponson_l) = {-2.80, y_hull, 1.05, 4.80, 0.35, 0.30};
sponson_r = newv; Box(sponson_r) = {-2.80, -y_hull - 0.35, 1.05, 4.80, 0.35, 0.30};
v1 = newv; Cylinder(v1) = {x_ring, 0, z_roof, 0, 0, h_ring, R_race};
v2 = newv; Cylinder(v2) = {x_ring, 0, z_roof, 0, 0, h_ring, r_race};
race_l = newv; BooleanDifference(race_l) = { Volume{v1}; Delete; }{ Volume{v2}; Delete; };
hulls() = {hull(), capsule, seat_d, seat_c, seat_g, engine, gears, magazine, sponson_l, sponson_r, race_l};
BooleanFragments{ Volume{hulls()}; Delete; }{}            // bonded parts share faces; volume numbers stay

plates() = {}; bored() = {};
If (HULL)
  Include "hull.geo";
EndIf

// ---------------------------------------------------------------- turret and what is bonded to it
z_tur = z_roof + 2*h_ring + g_ring; z_base = z_tur + 0.06; z_top = 2.22;
pX() = {-1.6, -1.35, 0, 0.5, 0.5, 0, -1.35, -1.6};
pY() = {-0.55, -0.84, -0.84, -0.48, 0.48, 0.84, 0.84, 0.55};
z0 = z_tur; dz = z_top + 0.06 - z_tur;
Call Slab;
turret = v;
pX() = {-1.52, -1.32, -0.03, 0.42, 0.42, -0.03, -1.32, -1.52};
pY() = {-0.52, -0.76, -0.76, -0.435, 0.435, 0.76, 0.76, 0.52};
z0 = z_base; dz = z_top - z_base;
Call Slab;
cut() = {v};
r_port = 0.25;                                            // where the housing passes the front
v = newv; Cylinder(v) = {0.40, 0, z_gun, 0.12, 0, 0, r_port}; cut() += v;
v = newv; BooleanDifference(v) = { Volume{turret}; Delete; }{ Volume{cut()}; Delete; };
turret = v;
For m In {0:1}
  side = 1 - 2*m;
  v1 = newv; Box(v1) = {x_tr - 0.25, m ? -y_cheek - t_cheek : y_cheek, z_base, 0.50, t_cheek, z_top - z_base};
  xc = x_tr; zc = z_gun; r = r_pin + g_pin; y0 = side*(y_cheek - 0.01); dy = side*(t_cheek + 0.02);
  Call Rod;
  v2 = v; v = newv; BooleanDifference(v) = { Volume{v1}; Delete; }{ Volume{v2}; Delete; };
  cheek(m) = v;
EndFor
v1 = newv; Cylinder(v1) = {0.50, 0, z_gun, 0.10, 0, 0, 0.36};
v2 = newv; Cylinder(v2) = {0.50, 0, z_gun, 0.10, 0, 0, r_port};
mantlet = newv; BooleanDifference(mantlet) = { Volume{v1}; Delete; }{ Volume{v2}; Delete; };
v1 = newv; Cylinder(v1) = {x_ring, 0, z_tur - h_ring, 0, 0, h_ring, R_race};
v2 = newv; Cylinder(v2) = {x_ring, 0, z_tur - h_ring, 0, 0, h_ring, r_race};
race_u = newv; BooleanDifference(race_u) = { Volume{v1}; Delete; }{ Volume{v2}; Delete; };
ammo_l = newv; Box(ammo_l) = {-1.25,  0.45, z_base, 0.80, 0.29, 0.435};
ammo_r = newv; Box(ammo_r) = {-1.25, -0.74, z_base, 0.80, 0.29, 0.435};
loader = newv; Box(loader) = {-1.48, -0.40, z_base, 0.18, 0.80, 0.535};
sight = newv; Box(sight) = {-0.30, 0.40, z_top + 0.06, 0.30, 0.25, 0.22};
turrets() = {turret, cheek(), mantlet, race_u, ammo_l, ammo_r, loader, sight};
BooleanFragments{ Volume{turrets()}; Delete; }{}

If (!HULL)
  Physical Volume("hull") = hull;
EndIf
Physical Volume("crew_capsule") = capsule;
Physical Volume("driver_seat") = seat_d;
Physical Volume("commander_seat") = seat_c;
Physical Volume("gunner_seat") = seat_g;
Physical Volume("engine") = engine;
Physical Volume("transmission") = gears;
Physical Volume("magazine") = magazine;
Physical Volume("sponson_l") = sponson_l;
Physical Volume("sponson_r") = sponson_r;
Physical Volume("ring_lower") = race_l;
Physical Volume("turret") = turret;
Physical Volume("cheek_l") = cheek(0);
Physical Volume("cheek_r") = cheek(1);
Physical Volume("mantlet") = mantlet;
Physical Volume("ring_upper") = race_u;
Physical Volume("ammunition_l") = ammo_l;
Physical Volume("ammunition_r") = ammo_r;
Physical Volume("autoloader") = loader;
Physical Volume("sight") = sight;

// Surfaces are found by their boxes, padded by d. Pins are made after the bores around them, so that a bore's box
// holds only the bore, and a pin's box is too narrow for the bore.
d = 1e-3; q = R_race + d;
Physical Surface("ring_hull") =
  Surface In BoundingBox {x_ring - q, -q, z_roof + h_ring - d, x_ring + q, q, z_roof + h_ring + d};
Physical Surface("ring_turret") =
  Surface In BoundingBox {x_ring - q, -q, z_tur - h_ring - d, x_ring + q, q, z_tur - h_ring + d};
Physical Surface("seat_driver") =
  Surface In BoundingBox {1.30 - d, -0.20 - d, z_seat + h_seat - d, 1.70 + d, 0.20 + d, z_seat + h_seat + d};
Physical Surface("seat_commander") =
  Surface In BoundingBox {0.60 - d, 0.15 - d, z_seat + h_seat - d, 1.00 + d, 0.55 + d, z_seat + h_seat + d};
Physical Surface("seat_gunner") =
  Surface In BoundingBox {0.60 - d, -0.55 - d, z_seat + h_seat - d, 1.00 + d, -0.15 + d, z_seat + h_seat + d};
q = r_pin + g_pin + d;
both() = {}; pins() = {};                                // pins: all cylinders, to set the sides of their circles
For m In {0:1}
  y0 = m ? -y_cheek - t_cheek : y_cheek;
  f() = Surface In BoundingBox {x_tr - q, y0 - d, z_gun - q, x_tr + q, y0 + t_cheek + d, z_gun + q};
  Physical Surface(StrChoice(m, "turret_bore_r", "turret_bore_l")) = f();
  both() += f(); pins() += f();
EndFor
Physical Surface("turret_bores") = both();

// ---------------------------------------------------------------- trailing arms: link, pivot pin inward, axle outward
arms() = {};
phi = Atan2(-dz_arm, -dx_arm); zp = r_wheel + dz_arm; l_pivot = 0.155; l_axle = 0.235;
For m In {0:1}
  side = 1 - 2*m; name = StrChoice(m, "r", "l");
  For j In {0:3}
    xw = x_wheel(j); xp = xw + dx_arm; q = r_pivot + g_arm + d;
    y0 = m ? -y_hull : y_hull - t_side;
    If (HULL)
      f() = Curve In BoundingBox {xp - q, y0 - d, zp - q, xp + q, y0 + t_side + d, zp + q};
      Physical Curve(Sprintf(StrCat("pivot_", name, "%g_hull"), j + 1)) = f(); bored() += f();
    Else
      f() = Surface In BoundingBox {xp - q, y0 - d, zp - q, xp + q, y0 + t_side + d, zp + q};
      Physical Surface(Sprintf(StrCat("pivot_", name, "%g_hull"), j + 1)) = f(); pins() += f();
    EndIf
    pX() = {}; pZ() = {}; y0 = side*y_arm; dy = side*t_arm;
    For i In {0:3}
      t = phi + (2*i - 3)*Pi/6;
      pX(i) = xw + 0.085*Cos(t); pZ(i) = r_wheel + 0.085*Sin(t);
      pX(i+4) = xp - 0.10*Cos(t); pZ(i+4) = zp - 0.10*Sin(t);
    EndFor
    Call Prism;
    link = v;
    xc = xp; zc = zp; r = r_pivot; y0 = side*y_arm; dy = -side*l_pivot;
    Call Rod;
    v1 = v;
    xc = xw; zc = r_wheel; r = r_axle; y0 = side*(y_arm + t_arm); dy = side*l_axle;
    Call Rod;
    arm = newv; BooleanUnion(arm) = { Volume{link}; Delete; }{ Volume{v1, v}; Delete; };
    arms() += arm;
    Physical Volume(Sprintf(StrCat("arm_", name, "%g"), j + 1)) = arm;
    // the pin without its end face
    q = r_pivot + d; ya = side*(y_arm - l_pivot); yb = side*y_arm;
    f() = Surface In BoundingBox {xp - q, (m ? yb : ya) - d, zp - q, xp + q, (m ? ya : yb) + d, zp + q};
    f() -= Surface In BoundingBox {xp - q, ya - d, zp - q, xp + q, ya + d, zp + q};
    Physical Surface(Sprintf(StrCat("pivot_", name, "%g_arm"), j + 1)) = f(); pins() += f();
    q = r_axle + d; ya = side*(y_arm + t_arm + l_axle); yb = side*(y_arm + t_arm);
    f() = Surface In BoundingBox {xw - q, (m ? ya : yb) - d, r_wheel - q, xw + q, (m ? yb : ya) + d, r_wheel + q};
    f() -= Surface In BoundingBox {xw - q, ya - d, r_wheel - q, xw + q, ya + d, r_wheel + q};
    Physical Surface(Sprintf(StrCat("axle_", name, "%g_arm"), j + 1)) = f(); pins() += f();
  EndFor
EndFor

// ---------------------------------------------------------------- sizes of the tetrahedra [m]
MeshSize { PointsOf{ Volume{hulls(), turrets()}; } } = 0.45*fine;
MeshSize { PointsOf{ Volume{capsule, seat_d, seat_c, seat_g}; } } = 0.30*fine;
MeshSize { PointsOf{ Volume{cheek(), mantlet}; } } = 0.20*fine;
MeshSize { PointsOf{ Volume{arms()}; } } = 0.16*fine;
If (HULL)
  MeshSize { PointsOf{ Surface{plates()}; } } = 0.30*fine;
  Transfinite Curve { bored() } = n_circle/4 + 1;
  Recombine Surface { plates() };
  Mesh.RecombinationAlgorithm = 0;                        // the default turns some triangles at the bores over
EndIf
For i In {0:#pins()-1:4}
  f() = pins({i:i+3}); c() = Abs(CombinedBoundary { Surface{f()}; }); e() = Abs(Boundary { Surface{f()}; }); e() -= c();
  Transfinite Curve { c() } = n_circle/4 + 1;
  Transfinite Curve { e() } = n_along + 1;
  Transfinite Surface { f() };
EndFor
q = R_race + d; z_cut() = {1.34, z_roof, z_roof + h_ring, z_tur - h_ring, z_tur};     // turret ring
For i In {0:4}
  c() = Curve In BoundingBox {x_ring - q, -q, z_cut(i) - d, x_ring + q, q, z_cut(i) + d};
  Transfinite Curve { c() } = n_race + 1;
EndFor
q = 0.36 + d; x_cut() = {0.42, 0.50, 0.60};                                           // gun port
For i In {0:2}
  c() = Curve In BoundingBox {x_cut(i) - d, -q, z_gun - q, x_cut(i) + d, q, z_gun + q};
  Transfinite Curve { c() } = n_port + 1;
EndFor

// ================================================================ blocks of hexahedra
SetFactory("Built-in");

// One edge of a block, from corner ia to ib with n cells: an arc where both ends lie on one circle about the gun axis,
// or about the y axis through (x_y, z_y), else a straight line. The ranges of radii leave out the cores and the flats.
bX() = {}; bY() = {}; bZ() = {}; qU() = {}; qW() = {};
x_y = x_tr; z_y = z_gun; ra_y = 0.9*r_pin; rb_y = 1.1*r_pin;
Macro Edge
  ra = Hypot(bY(ia), bZ(ia) - z_gun); rb = Hypot(bY(ib), bZ(ib) - z_gun);
  qa = Hypot(bX(ia) - x_y, bZ(ia) - z_y); qb = Hypot(bX(ib) - x_y, bZ(ib) - z_y);
  pc = 0;
  If (Fabs(bX(ia) - bX(ib)) < eps && Fabs(ra - rb) < eps && ra > r_core + eps && ra < r_crad + eps)
    pc = newp; Point(pc) = {bX(ia), 0, z_gun};
  ElseIf (Fabs(bY(ia) - bY(ib)) < eps && Fabs(bY(ia)) > w_crad - eps && Fabs(qa - qb) < eps && qa > ra_y && qa < rb_y)
    pc = newp; Point(pc) = {x_y, bY(ia), z_y};
  EndIf
  l = newl;
  If (pc)
    Circle(l) = {bP(ia), pc, bP(ib)};
  Else
    Line(l) = {bP(ia), bP(ib)};
  EndIf
  bL(ie) = l; Transfinite Curve {l} = n + 1;
Return

// One block with the corners bX, bY, bZ (0 1 2 3 below, 4 5 6 7 above) and n1, n2, n3 cells along 01, 03, 04.
// Gives volume v and its faces bF: 0 below (01-03), 1 above, 2 (01-04) at 0, 3 at 3, 4 (03-04) at 0, 5 at 1.
// Neighbours repeat points, curves and faces; Coherence merges them afterwards.
Macro Brick
  bP() = {}; bL() = {}; bF() = {};
  For i In {0:7}
    p = newp; Point(p) = {bX(i), bY(i), bZ(i)}; bP(i) = p;
  EndFor
  ea() = {0,3,4,7, 0,1,4,5, 0,1,2,3};
  eb() = {1,2,5,6, 3,2,7,6, 4,5,6,7};
  For ie In {0:11}
    n = ie < 4 ? n1 : ie < 8 ? n2 : n3; ia = ea(ie); ib = eb(ie);
    Call Edge;
  EndFor
  fa() = {0, 2, 0, 1, 4, 5}; fb() = {5, 7, 9, 10, 11, 10}; fc() = {1, 3, 2, 3, 6, 7}; fd() = {4, 6, 8, 11, 8, 9};
  For i In {0:5}
    c = newll; Curve Loop(c) = {bL(fa(i)), bL(fb(i)), -bL(fc(i)), -bL(fd(i))};
    f = news; Surface(f) = {c}; Transfinite Surface {f}; Recombine Surface {f}; bF(i) = f;
  EndFor
  c = newsl; Surface Loop(c) = {bF()};
  v = newv; Volume(v) = {c}; Transfinite Volume {v};
Return

// A block between x0 and x1, angles t0 and t1 about the gun axis, radii ri and ro at (x0,t0) (x1,t0) (x1,t1) (x0,t1).
Macro Sector
  bX() = {x0,x1,x1,x0, x0,x1,x1,x0};
  For i In {0:3}
    t = i < 2 ? t0 : t1;
    bY(i) = ri(i)*Cos(t); bZ(i) = z_gun + ri(i)*Sin(t);
    bY(i+4) = ro(i)*Cos(t); bZ(i+4) = z_gun + ro(i)*Sin(t);
  EndFor
  Call Brick;
Return

// ---------------------------------------------------------------- barrel and recoil housing
barrel() = {}; housing() = {};
muzzle() = {}; breech_face() = {}; slide() = {}; recoil_lug() = {};
x_back = x_b - l_breech; x_front = x_b + l_rear; x_end = x_b + l_barrel;

For k In {0:3}
  t0 = Pi/4 + k*Pi/2; t1 = t0 + Pi/2; n2 = n_quarter;
  // barrel: the straight rear part, then the taper
  x0 = x_b; x1 = x_front; n1 = n_rear; n3 = n_wall;
  ri() = {r_bore,r_bore,r_bore,r_bore}; ro() = {r_rear,r_rear,r_rear,r_rear};
  Call Sector;
  barrel() += v;
  x0 = x_front; x1 = x_end; n1 = n_taper; ro() = {r_rear,r_muzzle,r_muzzle,r_rear};
  Call Sector;
  barrel() += v; muzzle() += bF(5);
  // the sleeve on its rear part
  x0 = x_b; x1 = x_front; n1 = n_rear; n3 = n_sleeve;
  ri() = {r_rear,r_rear,r_rear,r_rear}; ro() = {r_house,r_house,r_house,r_house};
  Call Sector;
  housing() += v; slide() += bF(1);
  // the breech, in rings that continue bore, barrel and sleeve
  x0 = x_back; x1 = x_b; n1 = n_breech;
  Call Sector;
  housing() += v; slide() += bF(1); recoil_lug() += bF(4);
  n3 = n_wall; ro() = ri(); ri() = {r_bore,r_bore,r_bore,r_bore};
  Call Sector;
  housing() += v; recoil_lug() += bF(4);
  n3 = n_plug; ro() = ri(); ri() = {r_core,r_core,r_core,r_core};
  Call Sector;
  housing() += v; recoil_lug() += bF(4); breech_face() += bF(5);
EndFor
// the core of the breech
h = r_core*Sqrt(0.5);
bX() = {x_back,x_b,x_b,x_back, x_back,x_b,x_b,x_back};
bY() = {-h,-h,h,h, -h,-h,h,h}; bZ() = {z_gun-h,z_gun-h,z_gun-h,z_gun-h, z_gun+h,z_gun+h,z_gun+h,z_gun+h};
n1 = n_breech; n2 = n_quarter; n3 = n_quarter;
Call Brick;
housing() += v; recoil_lug() += bF(4); breech_face() += bF(5);

// ---------------------------------------------------------------- cradle: an octagonal tube with two trunnion pins
cradle() = {}; bore() = {}; cradle_lug() = {}; pin_l() = {}; pin_r() = {};
t_a = Atan2(a_crad, w_crad); r_a = Hypot(w_crad, a_crad); r_d = (w_crad + a_crad)*Sqrt(0.5);
xs() = {x_tr - l_crad, x_tr - a_crad, x_tr + a_crad, x_tr + l_crad};
ri() = {r_crad,r_crad,r_crad,r_crad}; n3 = n_cradle;
For j In {0:2}
  x0 = xs(j); x1 = xs(j+1); n1 = j == 1 ? n_flat : n_end;
  For k In {0:3}
    tk = k*Pi/2;
    t0 = tk - Pi/4; t1 = tk - t_a; ro() = {r_d,r_d,r_a,r_a}; n2 = n_corner;
    Call Sector;
    cradle() += v; bore() += bF(0);
    If (j == 0)
      cradle_lug() += bF(4);
    EndIf
    t0 = tk + t_a; t1 = tk + Pi/4; ro() = {r_a,r_a,r_d,r_d};
    Call Sector;
    cradle() += v; bore() += bF(0);
    If (j == 0)
      cradle_lug() += bF(4);
    EndIf
    If (j != 1 || k == 1 || k == 3)               // the flats left and right of the trunnion zone follow below
      t0 = tk - t_a; t1 = tk + t_a; ro() = {r_a,r_a,r_a,r_a}; n2 = n_flat;
      Call Sector;
      cradle() += v; bore() += bF(0);
      If (j == 0)
        cradle_lug() += bF(4);
      EndIf
    EndIf
  EndFor
EndFor

// Trunnion zones: core, ring up to the pin's circle, ring up to the square; from the bore to the flat, and the two
// inner ones on through the pin. A block has its (u, w) = (x - x_tr, z - z_gun) corners in qU, qW.
Macro Column
  For i In {0:3}
    t = Atan2(qW(i), w_crad);
    bX(i) = x_tr + qU(i); bY(i) = side*r_crad*Cos(t); bZ(i) = z_gun + r_crad*Sin(t);
    bX(i+4) = x_tr + qU(i); bY(i+4) = side*w_crad; bZ(i+4) = z_gun + qW(i);
  EndFor
  n3 = n_cradle;
  Call Brick;
  cradle() += v; bore() += bF(0);
  pin() = {};
  If (level < 2)
    For i In {0:3}
      bX(i) = bX(i+4); bY(i) = bY(i+4); bZ(i) = bZ(i+4); bY(i+4) = side*(w_crad + l_pin);
    EndFor
    n3 = n_pin;
    Call Brick;
    cradle() += v;
    If (level == 1)
      pin() = bF(3);
    EndIf
    If (side > 0)
      pin_l() += pin();
    Else
      pin_r() += pin();
    EndIf
  EndIf
Return
half() = {0.5*r_pin*Sqrt(0.5), r_pin*Sqrt(0.5), a_crad};
For m In {0:1}
  side = 1 - 2*m;
  level = 0; h = half(0); qU() = {-h,h,h,-h}; qW() = {-h,-h,h,h}; n1 = n_flat; n2 = n_flat;
  Call Column;
  For level In {1:2}
    n1 = n_flat; n2 = level == 1 ? n_ring : n_around;
    For k In {0:3}
      h0 = half(level-1)*Sqrt(2); h1 = half(level)*Sqrt(2); ta = (k + 0.5)*Pi/2; tb = ta + Pi/2;
      qU() = {h0*Cos(ta), h0*Cos(tb), h1*Cos(tb), h1*Cos(ta)};
      qW() = {h0*Sin(ta), h0*Sin(tb), h1*Sin(tb), h1*Sin(ta)};
      Call Column;
    EndFor
  EndFor
EndFor

// ---------------------------------------------------------------- wheels: solid rings, a node of each on the ground
z_y = r_wheel; ra_y = r_axle; rb_y = 2*r_wheel; r_hub = r_axle + g_arm; wheels() = {};
For m In {0:1}
  side = 1 - 2*m;
  For j In {0:3}
    x_y = x_wheel(j); wheel() = {}; hub() = {}; tread() = {};
    For k In {0:3}
      t0 = k*Pi/2; t1 = t0 + Pi/2; y0 = side*y_wheel; y1 = side*(y_wheel + b_wheel);
      ct() = {Cos(t0), Cos(t1), Cos(t1), Cos(t0)}; st() = {Sin(t0), Sin(t1), Sin(t1), Sin(t0)};
      For i In {0:3}
        bX(i) = x_y + r_hub*ct(i); bZ(i) = r_wheel + r_hub*st(i);
        bX(i+4) = x_y + r_wheel*ct(i); bZ(i+4) = r_wheel + r_wheel*st(i);
      EndFor
      bY() = {y0,y0,y1,y1, y0,y0,y1,y1};
      n1 = n_wheel; n2 = n_tread; n3 = n_tread;
      Call Brick;
      wheel() += v; hub() += bF(0); tread() += bF(1);
    EndFor
    wheels() += wheel();
    name = StrChoice(m, "r", "l");
    Physical Volume(Sprintf(StrCat("wheel_", name, "%g"), j + 1)) = wheel();
    Physical Surface(Sprintf(StrCat("axle_", name, "%g_wheel"), j + 1)) = hub();
    Physical Surface(Sprintf(StrCat("tread_", name, "%g"), j + 1)) = tread();
  EndFor
EndFor

Coherence;                                                // of the blocks: from here on neighbours share faces

Physical Volume("barrel") = barrel();
Physical Volume("recoil_housing") = housing();
Physical Volume("cradle") = cradle();
Physical Surface("muzzle") = muzzle();
Physical Surface("breech_face") = breech_face();
Physical Surface("housing_slide") = slide();
Physical Surface("recoil_lug") = recoil_lug();
Physical Surface("cradle_bore") = bore();
Physical Surface("cradle_lug") = cradle_lug();
Physical Surface("trunnion_l") = pin_l();
Physical Surface("trunnion_r") = pin_r();
Physical Surface("cradle_pins") = {pin_l(), pin_r()};

// ---------------------------------------------------------------- how to mesh
Mesh.MeshSizeExtendFromBoundary = s == 1;                 // small: let the tetrahedra grow at once behind pins and bores
Mesh.MeshSizeMax = 0.45*fine;
Mesh.Algorithm = 5;
Mesh.OptimizeThreshold = 0.5;                             // work on every tetrahedron worse than this
Mesh.ElementOrder = 1;
