// Do parts of the vehicle intersect?   gmsh - check.geo      prints each pair that does, and a count, which should be 0.
// Blocks have no OpenCASCADE shape: the gun and the wheels get exact stand-ins here, from the same dimensions.

Include "vehicle.geo";
SetFactory("OpenCASCADE");
parts() = {hulls(), turrets(), arms()};

Macro Tube                                                // cylinder or cone between radii a, b minus a bore
  v1 = newv;
  If (a == b)
    Cylinder(v1) = {p(0), p(1), p(2), q(0), q(1), q(2), a};
  Else
    Cone(v1) = {p(0), p(1), p(2), q(0), q(1), q(2), a, b};
  EndIf
  v2 = newv; Cylinder(v2) = {p(0), p(1), p(2), q(0), q(1), q(2), in};
  v = newv; BooleanDifference(v) = { Volume{v1}; Delete; }{ Volume{v2}; Delete; };
  parts() += v;
Return

p() = {x_b, 0, z_gun}; q() = {l_rear, 0, 0}; a = r_rear; b = a; in = r_bore;
Call Tube;
p() = {x_front, 0, z_gun}; q() = {l_barrel - l_rear, 0, 0}; b = r_muzzle;
Call Tube;
p() = {x_b, 0, z_gun}; q() = {l_rear, 0, 0}; a = r_house; b = a; in = r_rear;
Call Tube;
v = newv; Cylinder(v) = {x_back, 0, z_gun, l_breech, 0, 0, r_house}; parts() += v;
For m In {0:1}
  For j In {0:3}
    p() = {x_wheel(j), (1 - 2*m)*y_wheel, r_wheel}; q() = {0, (1 - 2*m)*b_wheel, 0}; a = r_wheel; b = a; in = r_hub;
    Call Tube;
  EndFor
  v = newv; Cylinder(v) = {x_tr, (1 - 2*m)*w_crad, z_gun, 0, (1 - 2*m)*l_pin, 0, r_pin}; parts() += v;
EndFor
// cradle: a box less its four edges and its bore
v1 = newv; Box(v1) = {x_tr - l_crad, -w_crad, z_gun - w_crad, 2*l_crad, 2*w_crad, 2*w_crad};
v2 = newv; Box(v2) = {x_tr - l_crad, -r_d, z_gun - r_d, 2*l_crad, 2*r_d, 2*r_d};
Rotate { {1,0,0}, {0,0,z_gun}, Pi/4 } { Volume{v2}; }
v = newv; BooleanIntersection(v) = { Volume{v1}; Delete; }{ Volume{v2}; Delete; };
v1 = v; v2 = newv; Cylinder(v2) = {x_tr - l_crad, 0, z_gun, 2*l_crad, 0, 0, r_crad};
v = newv; BooleanDifference(v) = { Volume{v1}; Delete; }{ Volume{v2}; Delete; };
parts() += v;

box() = {};
For i In {0:#parts()-1}
  box() += BoundingBox Volume{ parts(i) };
EndFor
tried = 0; bad = 0;
For i In {0:#parts()-2}
  For j In {i+1:#parts()-1}
    near = 1;
    For k In {0:2}
      near = near && box(6*i+k) < box(6*j+k+3) && box(6*j+k) < box(6*i+k+3);
    EndFor
    If (near)
      tried += 1; v() = BooleanIntersection { Volume{parts(i)}; }{ Volume{parts(j)}; };
      If (#v())
        bad += 1; Printf("volumes %g and %g intersect", parts(i), parts(j));
        Recursive Delete { Volume{v()}; }
      EndIf
    EndIf
  EndFor
EndFor
Printf("%g parts, %g pairs near each other, %g intersect", #parts(), tried, bad);
