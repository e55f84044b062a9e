# How far the rod's middle is off the line of its eyes, and how much longer that line has become, against the crank angle:
#   hilo-post series RUN.h5 probe.big_eye probe.small_eye probe.middle | awk -f bending.awk > BENDING.csv
BEGIN { FS = ","; t0 = 0.010; degrees = 360*100 }
NR == 1 { next }
{
  ex = $11 - $2; ez = $13 - $4; mx = $20 - $2; mz = $22 - $4         # nine columns a probe: x y z, velocity, acceleration
  length_now = sqrt(ex*ex + ez*ez)
  off = (mx*ez - mz*ex)/length_now                                  # positive to the right of the line, seen from the front
  if (NR == 2) { length_0 = length_now; off_0 = off }
  if ($1 < t0 - 1e-9) next
  angle[++n] = ($1 - t0)*degrees - 180; bend[n] = off - off_0; stretch[n] = length_now - length_0
  if (bend[n] > 1e-3 || stretch[n] > 1e-3) large = 1
}
END {
  unit = large ? "mm" : "um"; scale = large ? 1e3 : 1e6
  printf "crank angle [deg],deflection of the middle [%s],stretch [%s]\n", unit, unit
  for (i = 1; i <= n; ++i) printf "%.9g,%.6g,%.6g\n", angle[i], scale*bend[i], scale*stretch[i]
}
