# A scene of o17-*.toml with the velocities of the IVP test set at the start: those of the rigid rod and of two sine modes, section by section.
#   awk -v n=20 -f o17-start.awk o17-solid.toml > scene.toml, with n cells along the rod
{ print }
END {
  pi = 3.14159265358979; r = 0.15; l = 0.30; rate = 150; q1 = 0.444896105; q2 = 0.00463434311
  for (i = 0; i <= n; ++i) {
    s = i/n
    v = rate*r*(1 - s) + q1*sin(pi*s) + q2*sin(2*pi*s)
    spin = (-rate*r + q1*pi*cos(pi*s) + q2*2*pi*cos(2*pi*s))/l
    printf "\n[[initial]]\non = [\"section%d\"]\nvelocity = [0, %.12g, 0]\nspin = [0, 0, %.12g]\nabout = [%.12g, 0, 0]\n", i, v, spin, r + s*l
  }
}
