// A single-cylinder crank drive, made from scratch for this scene: crankshaft, connecting rod, piston with its pin, half a liner.
//
//   gmsh -3 -setnumber SIZE 0 crank.geo
//
// Metres.  Crank axis y through the origin, cylinder axis z; drawn at top dead centre.  x to the right when seen from the front (y < 0).
//  - Parts joined by a joint never touch; parts that are bonded share their nodes.
//  - Crank and piston are cut along y = 0 or in front of the pin, so that a picture may leave their front halves away.
//  - The rod is made of hexahedra, three layers and an I-section; the rest is tetrahedra.
SetFactory("OpenCASCADE");
DefineConstant[ SIZE = {0, Name "SIZE"} ];                // 0 small, 1 medium
f = SIZE==0 ? 1 : 0.5;

// ---------------------------------------------------------------- dimensions [m]
r       = 0.045;      // crank radius: 90 mm of stroke
l       = 0.150;      // rod, centre to centre
bore    = 0.086;
r_pin   = 0.024;      // crank pin
r_wrist = 0.011;      // piston pin
gap     = 0.0004;     // of the bearings
b_rod   = 0.022;      // width of the rod
b_web   = 0.005;      // of the web of its I-section
r_big   = 0.034;      // outside of the big eye
r_small = 0.0175;     // of the small eye
y_web   = 0.013;      // inner face of the webs of the crank
t_web   = 0.016;
r_main  = 0.027;
l_main  = 0.026;
r_ctr   = 0.068;      // counterweight
h_crown = 0.033;      // top of the piston above its pin
h_skirt = 0.025;      // its lower end below the pin
zp      = r + l;      // the piston pin
far     = 1;

// ---------------------------------------------------------------- crank
Macro Web                                                 // at y0 over t_web: volume v
  v1 = newv; Cylinder(v1) = {0, y0, r, 0, t_web, 0, r_pin + 0.008};
  v2 = newv; Cylinder(v2) = {0, y0, 0, 0, t_web, 0, r_main + 0.007};
  v3 = newv; Box(v3) = {-r_pin - 0.006, y0, 0, 2*(r_pin + 0.006), t_web, r};
  v4 = newv; Cylinder(v4) = {0, y0, 0, 0, t_web, 0, r_ctr};
  v5 = newv; Box(v5) = {-0.062, y0, -0.08, 0.124, t_web, 0.08 - 0.014};
  v6 = newv; BooleanIntersection(v6) = { Volume{v4}; Delete; }{ Volume{v5}; Delete; };
  v = newv; BooleanUnion(v) = { Volume{v1}; Delete; }{ Volume{v2, v3, v6}; Delete; };
Return

y0 = y_web;
Call Web;
rear = v;
y0 = -y_web - t_web;
Call Web;
front = v;
v1 = newv; Cylinder(v1) = {0, y_web + t_web, 0, 0, l_main, 0, r_main};
v2 = newv; Cylinder(v2) = {0, -y_web, r, 0, 2*y_web, 0, r_pin};
v = newv; BooleanUnion(v) = { Volume{rear}; Delete; }{ Volume{v1, v2}; Delete; };
rear = v;
v1 = newv; Cylinder(v1) = {0, -y_web - t_web, 0, 0, -l_main, 0, r_main};
v = newv; BooleanUnion(v) = { Volume{front}; Delete; }{ Volume{v1}; Delete; };
front = v;
v() = BooleanFragments{ Volume{rear}; Delete; }{ Volume{front}; Delete; };
rear = v(0); front = v(1);

// ---------------------------------------------------------------- piston and pin, liner
rp = bore/2 - 0.0002;
body = newv; Cylinder(body) = {0, 0, zp - h_skirt, 0, 0, h_skirt + h_crown, rp};
v1 = newv; Cylinder(v1) = {0, 0, zp - h_skirt, 0, 0, h_skirt + 0.019, 0.036};        // the hollow
v2 = newv; Box(v2) = {-0.019, 0.0135, zp - 0.018, 0.038, 0.05, 0.05};                 // less the bosses of the pin
v3 = newv; Box(v3) = {-0.019, -0.0135, zp - 0.018, 0.038, -0.05, 0.05};
v4 = newv; BooleanDifference(v4) = { Volume{v1}; Delete; }{ Volume{v2, v3}; Delete; };
cut() = {v4};
For i In {0:1}                                            // two ring grooves
  z0 = zp + 0.0225 + 0.005*i;
  v1 = newv; Cylinder(v1) = {0, 0, z0, 0, 0, 0.002, far};
  v2 = newv; Cylinder(v2) = {0, 0, z0, 0, 0, 0.002, rp - 0.003};
  v = newv; BooleanDifference(v) = { Volume{v1}; Delete; }{ Volume{v2}; Delete; };
  cut() += v;
EndFor
For i In {0:1}                                            // the skirt is cut back at the pin
  v = newv; Box(v) = {-0.03, i ? -0.038 - 0.01 : 0.038, zp - h_skirt, 0.06, 0.01, h_skirt + 0.016};
  cut() += v;
EndFor
v = newv; Cylinder(v) = {0, -0.1, zp, 0, 0.2, 0, r_wrist}; cut() += v;
v = newv; BooleanDifference(v) = { Volume{body}; Delete; }{ Volume{cut()}; Delete; };
body = v;
pin = newv; Cylinder(pin) = {0, -0.034, zp, 0, 0.068, 0, r_wrist};
v1 = newv; Box(v1) = {-0.1, 0, zp - 0.1, 0.2, 0.1, 0.2};
v2 = newv; BooleanIntersection(v2) = { Volume{body}; }{ Volume{v1}; Delete; };
v3 = newv; Box(v3) = {-0.1, -0.1, zp - 0.1, 0.2, 0.1, 0.2};
v4 = newv; BooleanIntersection(v4) = { Volume{body}; Delete; }{ Volume{v3}; Delete; };
v() = BooleanFragments{ Volume{v2}; Delete; }{ Volume{v4, pin}; Delete; };
p_rear = v(0); p_front = v(1); pin = v(2);

z0 = 0.077; z1 = zp + h_crown + 0.012;
v1 = newv; Cylinder(v1) = {0, 0, z0, 0, 0, z1 - z0, bore/2 + 0.006, Pi};
v2 = newv; Cylinder(v2) = {0, 0, z0, 0, 0, z1 - z0, bore/2 + 0.0003, Pi};
liner = newv; BooleanDifference(liner) = { Volume{v1}; Delete; }{ Volume{v2}; Delete; };

// ---------------------------------------------------------------- rod: its outline in the plane y = -b_web/2, cut into eyes, flanges and web
s1 = news; Disk(s1) = {0, 0, 0, r_big};
s2 = news; Rectangle(s2) = {-0.042, -0.015, 0, 0.084, 0.030};                          // bosses of the bolts
s3 = news; Disk(s3) = {0, l, 0, r_small};
w0 = 0.0145; w1 = 0.0100; t_flange = 0.0045; z0 = 0.028; z1 = l - 0.013;
p = newp; Point(p) = {-w0, z0, 0}; Point(p+1) = {w0, z0, 0}; Point(p+2) = {w1, z1, 0}; Point(p+3) = {-w1, z1, 0};
c = newl; Line(c) = {p, p+1}; Line(c+1) = {p+1, p+2}; Line(c+2) = {p+2, p+3}; Line(c+3) = {p+3, p};
k = newll; Curve Loop(k) = {c:c+3}; s4 = news; Plane Surface(s4) = {k};
q = newp; Point(q) = {-w0 + t_flange, z0, 0}; Point(q+1) = {w0 - t_flange, z0, 0};
Point(q+2) = {w1 - t_flange, z1, 0}; Point(q+3) = {-w1 + t_flange, z1, 0};
c = newl; Line(c) = {q, q+1}; Line(c+1) = {q+1, q+2}; Line(c+2) = {q+2, q+3}; Line(c+3) = {q+3, q};
k = newll; Curve Loop(k) = {c:c+3}; s5 = news; Plane Surface(s5) = {k};
o1 = news; Disk(o1) = {0, 0, 0, r_pin + gap};
o2 = news; Disk(o2) = {0, l, 0, r_wrist + gap};
s6 = news; BooleanUnion(s6) = { Surface{s1}; Delete; }{ Surface{s2}; Delete; };
s7 = news; BooleanDifference(s7) = { Surface{s6}; Delete; }{ Surface{o1}; Delete; };   // big eye
s8 = news; BooleanDifference(s8) = { Surface{s3}; Delete; }{ Surface{o2}; Delete; };   // small eye
s9 = news; BooleanDifference(s9) = { Surface{s4}; Delete; }{ Surface{s7, s8}; };        // shank
s10 = news; BooleanIntersection(s10) = { Surface{s5}; Delete; }{ Surface{s9}; };        // its web
wm = w0 + (w1 - w0)*(l/2 - z0)/(z1 - z0);                                             // across the middle
k = newl; p = newp; Point(p) = {-wm, l/2, 0}; Point(p+1) = {wm, l/2, 0}; Line(k) = {p, p+1};
a() = BooleanFragments{ Surface{s7, s8, s9}; Delete; }{ Surface{s10}; Curve{k}; Delete; };
a() = Surface In BoundingBox {-0.1, -0.1, -1e-4, 0.1, l + 0.1, 1e-4};
Rotate {{1, 0, 0}, {0, 0, 0}, Pi/2} { Surface{a()}; }                                  // (x, y) -> (x, z)
Translate {0, -b_web/2, r} { Surface{a()}; }

// The extrusion comes last, for booleans would forget it: the web's thickness first, then eyes and flanges to both sides.
d = 1e-4;
n_out = SIZE==0 ? 1 : 2; n_mid = SIZE==0 ? 1 : 2;
For i In {0:2}
  y0 = i==2 ? b_web/2 : -b_web/2;
  dy = i==0 ? b_web : (3 - 2*i)*(b_web - b_rod)/2;
  s() = Surface In BoundingBox {-0.1, y0 - d, r - 0.04, 0.1, y0 + d, zp + 0.02};
  If(i > 0)
    s() -= Surface In BoundingBox {-w0 + t_flange/2, y0 - d, r + r_big - 0.005, w0 - t_flange/2, y0 + d, zp - r_small + 0.005};
  EndIf
  Extrude {0, dy, 0} { Surface{s()}; Layers{i ? n_out : n_mid}; Recombine; }
EndFor
rod() = Volume In BoundingBox {-0.043, -b_rod/2 - d, r - 0.04, 0.043, b_rod/2 + d, zp + 0.02};
rod() -= {pin};

Physical Volume("crank_rear") = rear;
Physical Volume("crank_front") = front;
Physical Volume("rod") = rod();
Physical Volume("pin") = pin;
Physical Volume("piston_rear") = p_rear;
Physical Volume("piston_front") = p_front;
Physical Volume("liner") = liner;

// ---------------------------------------------------------------- surfaces that joints and loads need, found by their boxes
q = r_main + d; y0 = y_web + t_web;
Physical Surface("journals") = { Surface In BoundingBox {-q, y0 - d, -q, q, y0 + l_main + d, q},
                                 Surface In BoundingBox {-q, -y0 - l_main - d, -q, q, -y0 + d, q} };
q = r_pin + d;
Physical Surface("crank_pin") = Surface In BoundingBox {-q, -y_web - d, r - q, q, y_web + d, r + q};
q += gap;
Physical Surface("big_end") = Surface In BoundingBox {-q, -b_rod/2 - d, r - q, q, b_rod/2 + d, r + q};
q = r_wrist + gap + d;
Physical Surface("small_end") = Surface In BoundingBox {-q, -b_rod/2 - d, zp - q, q, b_rod/2 + d, zp + q};
q = r_wrist + d;
Physical Surface("wrist_pin") = Surface In BoundingBox {-q, -0.0135 - d, zp - q, q, 0.0135 + d, zp + q};
Physical Surface("crown") = Surface In BoundingBox {-bore, -bore, zp + h_crown - d, bore, bore, zp + h_crown + d};

// ---------------------------------------------------------------- mesh
Mesh.MeshSizeExtendFromBoundary = 1;
Mesh.MeshSizeFromCurvature = 24;
Mesh.MeshSizeMin = 0.004*f;
Mesh.MeshSizeMax = 0.010;
p() = PointsOf{ Volume{rod()}; };
MeshSize{ p() } = 0.0055*f;
Recombine Surface{ a() };
Mesh.Algorithm = 6;
Mesh.RecombinationAlgorithm = 1;
