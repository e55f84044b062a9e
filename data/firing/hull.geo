// The plates of the hull as mid-surfaces, for vehicle.geo with HULL 1: hull_floor, hull_roof, hull_rear, hull_step (between these two),
// hull_nose, hull_front (below the nose), hull_glacis, hull_side.  Their middles lie between the outlines of the solid; their thicknesses
// are in the Makefile.  The outer strips hull_rim_floor ... lie within the thick sides, and are as stiff as those hold them.  Bores and the hole under the ring are open.  What stands on a plate or is bolted to it has a foot there, a set of
// its facets.

// The face with the corners qX, qY, qZ: surface f
Macro Face
  pts() = {}; c() = {};
  For i In {0:#qX()-1}
    p = newp; Point(p) = {qX(i), qY(i), qZ(i)}; pts(i) = p;
  EndFor
  For i In {0:#qX()-1}
    l = newl; Line(l) = {pts(i), pts((i+1) % #qX())}; c(i) = l;
  EndFor
  l = newll; Curve Loop(l) = {c()};
  f = news; Plane Surface(f) = {l};
Return

y_side = y_hull - t_side/2; y_in = y_hull - t_side; z_low = (0.45 + z_floor)/2; z_high = (1.34 + z_roof)/2;
mX() = {-2.95, -2.775, 2.275, 2.925, 2.55, 1.975, -2.95};
mZ() = {0.67, z_low, z_low, 0.86, 1.125, z_high, z_high};
whole() = {}; parts() = {};                               // plates; what divides them
For k In {0:6}
  i = (k+1) % 7;
  yA() = {-y_side, -y_in, y_in}; yB() = {-y_in, y_in, y_side};
  For j In {0:2}
    ya = k == 5 ? yB(j) : yA(j); yb = k == 5 ? yA(j) : yB(j);             // a foot lies on the side of the normal
    i = (k+1) % 7;
    qX() = {mX(k), mX(i), mX(i), mX(k)}; qY() = {ya, ya, yb, yb}; qZ() = {mZ(k), mZ(i), mZ(i), mZ(k)};
    Call Face;
    whole() += f;
  EndFor
EndFor
For m In {0:1}
  y0 = (1 - 2*m)*y_side;
  For i In {0:6}
    qX(i) = mX(m ? i : 6 - i); qZ(i) = mZ(m ? i : 6 - i);
  EndFor
  qY() = {y0, y0, y0, y0, y0, y0, y0};
  Call Face;
  whole() += f;
  qX() = {-2.80, 2.00, 2.00, -2.80}; qY() = {y0, y0, y0, y0}; qZ() = {1.05, 1.05, 1.35, 1.35};     // sponson
  If (!m)
    qX() = {-2.80, -2.80, 2.00, 2.00}; qZ() = {1.05, 1.35, 1.35, 1.05};
  EndIf
  Call Face;
  parts() += f;
  For j In {0:3}                                          // bores, in four arcs as those of the solid
    xc = x_wheel(j) + dx_arm; zc = r_wheel + dz_arm; r = r_pivot + g_arm;
    pc = newp; Point(pc) = {xc, y0, zc}; pts() = {}; c() = {};
    For i In {0:3}
      p = newp; Point(p) = {xc + r*Cos(i*Pi/2), y0, zc + r*Sin(i*Pi/2)}; pts(i) = p;
    EndFor
    For i In {0:3}
      l = newl; Circle(l) = {pts(i), pc, pts((i+1) % 4)}; c(i) = l;
    EndFor
    Delete { Point{pc}; }
    l = newll; Curve Loop(l) = {c()};
    f = news; Plane Surface(f) = {l};
    parts() += f;
  EndFor
EndFor
fX() = {-2.70, -1.70, -1.20, 0.40}; fdX() = {0.95, 0.40, 1.40, 1.50}; fdY() = {1.00, 0.90, 1.00, 1.40};     // engine, gears, magazine, capsule
For k In {0:3}
  qX() = {fX(k), fX(k) + fdX(k), fX(k) + fdX(k), fX(k)}; w = fdY(k)/2; qY() = {-w, -w, w, w}; qZ() = {z_low, z_low, z_low, z_low};
  Call Face;
  parts() += f;
EndFor
f = news; Disk(f) = {x_ring, 0, z_high, r_race}; parts() += f;
f = news; Disk(f) = {x_ring, 0, z_high, R_race}; parts() += f;
all() = BooleanFragments{ Surface{whole()}; Delete; }{ Surface{parts()}; Delete; };

d = 1e-3;
// open bores and the hole under the ring
For m In {0:1}
  y0 = (1 - 2*m)*y_side;
  For j In {0:3}
    xc = x_wheel(j) + dx_arm; zc = r_wheel + dz_arm; q = r_pivot + g_arm + d;
    f() = Surface In BoundingBox {xc - q, y0 - d, zc - q, xc + q, y0 + d, zc + q};
    Recursive Delete { Surface{f()}; }
  EndFor
EndFor
q = r_race + d;
f() = Surface In BoundingBox {x_ring - q, -q, z_high - d, x_ring + q, q, z_high + d};
Recursive Delete { Surface{f()}; }

For k In {0:6}
  i = (k+1) % 7;
  name = StrChoice(k==0, "step", StrChoice(k==1, "floor", StrChoice(k==2, "front", StrChoice(k==3, "nose",
         StrChoice(k==4, "glacis", StrChoice(k==5, "roof", "rear"))))));
  xa = (mX(k) < mX(i) ? mX(k) : mX(i)) - d; xb = (mX(k) > mX(i) ? mX(k) : mX(i)) + d;
  za = (mZ(k) < mZ(i) ? mZ(k) : mZ(i)) - d; zb = (mZ(k) > mZ(i) ? mZ(k) : mZ(i)) + d;
  f() = Surface In BoundingBox {xa, -y_in - d, za, xb, y_in + d, zb};
  Physical Surface(StrCat("hull_", name)) = f(); plates() += f();
  f() = Surface In BoundingBox {xa, -y_side - d, za, xb, -y_in + d, zb};
  f() += Surface In BoundingBox {xa, y_in - d, za, xb, y_side + d, zb};
  Physical Surface(StrCat("hull_rim_", name)) = f(); plates() += f();
EndFor
f() = Surface In BoundingBox {-4, y_side - d, 0, 4, y_side + d, 2};
f() += Surface In BoundingBox {-4, -y_side - d, 0, 4, -y_side + d, 2};
Physical Surface("hull_side") = f(); plates() += f();

// feet
For k In {0:3}
  w = fdY(k)/2;
  name = StrChoice(k==0, "engine", StrChoice(k==1, "transmission", StrChoice(k==2, "magazine", "crew_capsule")));
  Physical Surface(StrCat("foot_", name)) =
    Surface In BoundingBox {fX(k) - d, -w - d, z_low - d, fX(k) + fdX(k) + d, w + d, z_low + d};
EndFor
Physical Surface("foot_sponson_l") = Surface In BoundingBox {-2.80 - d, y_side - d, 1.05 - d, 2.00 + d, y_side + d, 1.35 + d};
Physical Surface("foot_sponson_r") = Surface In BoundingBox {-2.80 - d, -y_side - d, 1.05 - d, 2.00 + d, -y_side + d, 1.35 + d};
q = R_race + d;
Physical Surface("foot_ring") = Surface In BoundingBox {x_ring - q, -q, z_high - d, x_ring + q, q, z_high + d};
