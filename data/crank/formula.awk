# Closed form of a rigid crank drive: the same columns as columns.awk, from the kinematics and the equations of motion of three bodies.
#   awk -f formula.awk bodies.txt gas.csv > FORCES.csv
# bodies.txt is made by bodies.awk from a rigid run: the area of the crown; for each body name, mass, moment of inertia about y, x and z of
# its centre of mass at the top.  Plane x-z, angles positive about y: a vector d that turns at w, alpha gains w d_z, -w d_x.
#   psi = -asin(r/l sin theta)                                      the rod
#   m_p a = W + N + gas + weight                                    piston: W from the rod, N from the liner
#   m_r a = B - W + weight,  J_r alpha = (d_B x B) - (d_S x W)      rod: B from the crank
BEGIN {
  FS = ","
  r = 0.045; l = 0.150; g = 9.80665; pi = 3.14159265358979
  rate = 6000*2*pi/60; ramp = 0.010
}
$1 == "crown" { area = $2; next }
NF == 5 { m[$1] = $2; J[$1] = $3; x[$1] = $4; z[$1] = $5; next }
$1 == "t" {
  print "crank angle [deg],side thrust [kN],big end along the crank [kN],big end across [kN],small end along z [kN],small end along x [kN],main along z [kN],main along x [kN],drive torque [N m]"
  next
}
{
  theta = rate*($1 - ramp/2); w = rate                              # after the smooth start, no angular acceleration
  s = sin(theta); c = cos(theta)
  sp = -r/l*s; cp = sqrt(1 - sp*sp); wr = -r/l*c*w/cp; ar = (r/l*s*w*w + sp*wr*wr)/cp
  bx = -r*s*w*w; bz = -r*c*w*w                                      # acceleration of the crank pin
  # from the pin to the rod's centre and to the piston pin, turned by psi
  ux = cp*x["rod"] + sp*(z["rod"] - r); uz = -sp*x["rod"] + cp*(z["rod"] - r)
  vx = sp*l; vz = cp*l
  cx = bx + ar*uz - wr*wr*ux; cz = bz - ar*ux - wr*wr*uz            # accelerations: rod's centre, piston
  pz = bz - ar*vx - wr*wr*vz
  # forces on the rod: B at the pin, -W at the piston pin
  Wz = m["piston"]*(pz + g) + area*$2
  Bz = m["rod"]*(cz + g) + Wz
  Wx = ((vx - ux)*Wz - J["rod"]*ar - uz*m["rod"]*cx + ux*Bz)/vz
  Bx = m["rod"]*cx + Wx
  # crank: its centre turns about the axis
  kx = c*x["crank"] + s*z["crank"]; kz = -s*x["crank"] + c*z["crank"]
  Fx = -m["crank"]*w*w*kx + Bx; Fz = m["crank"]*(-w*w*kz + g) + Bz
  torque = r*c*Bx - r*s*Bz - kx*m["crank"]*g
  printf "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", ($1 - ramp)*rate*180/pi - 180, -Wx/1e3, (s*Bx + c*Bz)/1e3, (c*Bx - s*Bz)/1e3,
    -Wz/1e3, -Wx/1e3, Fz/1e3, Fx/1e3, torque
}
