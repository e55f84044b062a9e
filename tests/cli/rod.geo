// A connecting rod: two eyes and a shank with fillets at their roots, lengths in metres.
SetFactory("OpenCASCADE");
DefineConstant[ H = 0.005 ];
big = newv; Cylinder(big) = {0, 0, -0.012, 0, 0, 0.024, 0.036};
small = newv; Cylinder(small) = {0.15, 0, -0.012, 0, 0, 0.024, 0.02};
shank = newv; Box(shank) = {0, -0.011, -0.008, 0.15, 0.022, 0.016};
all() = BooleanUnion{ Volume{big}; Delete; }{ Volume{small, shank}; Delete; };
bore = newv; Cylinder(bore) = {0, 0, -0.02, 0, 0, 0.04, 0.025};
pin = newv; Cylinder(pin) = {0.15, 0, -0.02, 0, 0, 0.04, 0.011};
rod() = BooleanDifference{ Volume{all()}; Delete; }{ Volume{bore, pin}; Delete; };
Physical Volume("rod") = rod();
Mesh.MeshSizeMin = H; Mesh.MeshSizeMax = H;
