# The bearing forces of a run against the crank angle of the cycle, 0 at the firing top:
#   hilo-post series RUN.h5 joint.liner joint.big_end joint.small_end joint.main | awk -f columns.awk > FORCES.csv
BEGIN { FS = ","; t0 = 0.010; degrees = 360*100 }                   # from the bottom, at 6000 rpm
NR == 1 {
  print "crank angle [deg],side thrust [kN],big end along the crank [kN],big end across [kN],small end along z [kN],small end along x [kN],main along z [kN],main along x [kN],drive torque [N m]"
  next
}
# six columns a joint: Fx Fy Fz Mx My Mz
$1 > t0 - 1e-9 {
  printf "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", ($1 - t0)*degrees - 180, $2/1e3, $8/1e3, $9/1e3, $14/1e3, $15/1e3, $20/1e3, $21/1e3, $25
}
