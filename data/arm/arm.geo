// An arm of four links that lifts a load: column, upper arm, forearm, hand.  All of hexahedra, order 2.
//
//   gmsh -3 -order 2 arm.geo
//
// Metres, z up, drawn with both arms along x.  The arms are square tubes with a plug at each end, the hand is a bar, the column a post.
// Links never share nodes: joints hold their ends.
DefineConstant[ SIZE = {0, Name "SIZE"} ];                // 0 small, 1 medium
n_along = SIZE ? 16 : 8;                                  // cells along a tube
n_side = SIZE ? 4 : 2;                                    // and along each of its sides
Mesh.ElementOrder = 2;
Mesh.SecondOrderIncomplete = 1;

// A square ring across x at (x, z) with sides 2b outside and 2c inside, drawn along x by l: volumes of four walls in link().
Macro Tube
  s() = {};
  For i In {0:3}
    a = Pi/4 + i*Pi/2;
    p = newp; Point(p) = {x, Sqrt(2)*b*Cos(a), z + Sqrt(2)*b*Sin(a)}; outer(i) = p;
    p = newp; Point(p) = {x, Sqrt(2)*c*Cos(a), z + Sqrt(2)*c*Sin(a)}; inner(i) = p;
  EndFor
  For i In {0:3}
    j = (i + 1)%4;
    l1 = newl; Line(l1) = {outer(i), outer(j)}; out(i) = l1;
    l2 = newl; Line(l2) = {inner(i), inner(j)}; in(i) = l2;
    l3 = newl; Line(l3) = {outer(i), inner(i)}; ray(i) = l3;
    Transfinite Curve {l1, l2} = n_side + 1;
    Transfinite Curve {l3} = 2;
  EndFor
  For i In {0:3}
    j = (i + 1)%4;
    k = newll; Curve Loop(k) = {out(i), ray(j), -in(i), -ray(i)};
    k2 = news; Plane Surface(k2) = {k}; Transfinite Surface {k2}; Recombine Surface {k2};
    s() += k2;
  EndFor
  // the plug, of the wall's own material, at both ends
  k = newll; Curve Loop(k) = {in(0), in(1), in(2), in(3)};
  core = news; Plane Surface(core) = {k}; Transfinite Surface {core}; Recombine Surface {core};
  link() = {};
  first() = {s(), core};
  e() = Extrude {plug, 0, 0} { Surface{first()}; Layers{1}; Recombine; };
  walls() = {};
  For i In {0:4}
    link() += e(6*i + 1);
    If (i < 4)
      walls() += e(6*i);
    Else
      plugged = e(6*i);
    EndIf
  EndFor
  e() = Extrude {l - 2*plug, 0, 0} { Surface{walls()}; Layers{n_along}; Recombine; };
  walls() = {};
  For i In {0:3}
    link() += e(6*i + 1);
    walls() += e(6*i);
  EndFor
  // the second plug closes what the walls leave open
  ends() = {};
  For i In {0:3}
    b4() = Boundary { Surface{walls(i)}; };
    ends() += b4(2);
  EndFor
  k = newll; Curve Loop(k) = {ends()};
  core = news; Plane Surface(core) = {k}; Transfinite Surface {core}; Recombine Surface {core};
  last() = {walls(), core};
  e() = Extrude {plug, 0, 0} { Surface{last()}; Layers{1}; Recombine; };
  tip() = {};
  For i In {0:4}
    link() += e(6*i + 1);
    tip() += e(6*i);
  EndFor
Return

x = 0; z = 1; b = 0.06; c = 0.052; l = 1.2; plug = 0.08;
Call Tube;
Physical Volume("upper_arm") = {link()};
Physical Surface("upper_arm_root") = {first()};
Physical Surface("upper_arm_tip") = {tip()};

x = 1.24; z = 1; b = 0.04; c = 0.035; l = 0.96; plug = 0.06;
Call Tube;
Physical Volume("forearm") = {link()};
Physical Surface("forearm_root") = {first()};
Physical Surface("forearm_tip") = {tip()};

// Bars: a rectangle across their axis, drawn along it.
p = newp; Point(p) = {2.24, -0.025, 0.975}; Point(p + 1) = {2.24, 0.025, 0.975}; Point(p + 2) = {2.24, 0.025, 1.025}; Point(p + 3) = {2.24, -0.025, 1.025};
k = newl; Line(k) = {p, p + 1}; Line(k + 1) = {p + 1, p + 2}; Line(k + 2) = {p + 2, p + 3}; Line(k + 3) = {p + 3, p};
Transfinite Curve {k : k + 3} = 2;
q = newll; Curve Loop(q) = {k : k + 3};
hand = news; Plane Surface(hand) = {q}; Transfinite Surface {hand}; Recombine Surface {hand};
e() = Extrude {0.24, 0, 0} { Surface{hand}; Layers{3}; Recombine; };
Physical Volume("hand") = {e(1)};
Physical Surface("hand_root") = {hand};
Physical Surface("hand_tip") = {e(0)};

p = newp; Point(p) = {-0.15, -0.08, 0}; Point(p + 1) = {0.01, -0.08, 0}; Point(p + 2) = {0.01, 0.08, 0}; Point(p + 3) = {-0.15, 0.08, 0};
k = newl; Line(k) = {p, p + 1}; Line(k + 1) = {p + 1, p + 2}; Line(k + 2) = {p + 2, p + 3}; Line(k + 3) = {p + 3, p};
Transfinite Curve {k : k + 3} = n_side + 1;
q = newll; Curve Loop(q) = {k : k + 3};
post = news; Plane Surface(post) = {q}; Transfinite Surface {post}; Recombine Surface {post};
e() = Extrude {0, 0, 0.9} { Surface{post}; Layers{n_along}; Recombine; };
Physical Volume("column") = {e(1)};
Physical Surface("column_foot") = {post};
Physical Surface("column_head") = {e(0)};
