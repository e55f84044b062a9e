# What the ring should carry, by hand, beside what it carries:
#   hilo-show RIGID/run.h5 | awk -f slew.awk - RIGID/all.csv FLEXIBLE/all.csv > slew.csv
# all.csv: momentum, joint.ring, motor.slew, friction.race, probe.turret and body.* of a run.  The ring's axis stands at x = x_ring, y = 0;
# forces are on the chassis, forward along the gun and to the right.  The balance and the differences are told on stderr.
BEGIN { x_ring = -0.50; OFS = ","; name[2] = "rigid   "; name[3] = "flexible" }
FNR == 1 { ++file; if (file == 2) FS = ","; $0 = $0 }

file == 1 {                                               # the table of bodies: name, mass, moments, nodes
  if ($1 == "body" && $2 == "mass") inside = 1
  else if (NF == 0) inside = 0
  else if (inside && $1 != "chassis") mass[$1] = $2
  next
}
FNR == 1 { for (i = 1; i <= NF; ++i) { split($i, word, " "); column[file, word[1]] = i }; next }
function value(what) { return $(column[file, what]) }
{
  n = FNR - 1; t[n] = $1
  torque[file, n] = value("motor.slew.Mz") + value("friction.race.Mz")
  motor[n] = value("motor.slew.Mz"); friction[n] = value("friction.race.Mz")
  L[file, n] = value("momentum.Lz") - x_ring*value("momentum.py")
  F[file, n] = value("joint.ring.Fx"); R[file, n] = value("joint.ring.Fy")
  dx = value("probe.turret.x") - x_ring; dy = value("probe.turret.y")
  omega[file, n] = (dx*value("probe.turret.vy") - dy*value("probe.turret.vx"))/(dx*dx + dy*dy)
}
file == 2 && n == 1 {                                     # sums of m and m r, the gun pointing forward
  for (b in mass) { m += mass[b]; mx += mass[b]*(value("body." b ".x0") - x_ring); my += mass[b]*value("body." b ".y0") }
}
function size(x) { return x < 0 ? -x : x }
function worst(what, x) { if (size(x) > most[what]) most[what] = size(x) }
END {
  print "t [s]", "motor [N m]", "friction [N m]", "rate of angular momentum [N m]", "forward [N]", "m r omega^2 [N]", "right [N]", "m r alpha [N]"
  for (i = 2; i < n; ++i) {
    span = t[i+1] - t[i-1]
    for (file = 2; file <= 3; ++file) {
      rate = (L[file, i+1] - L[file, i-1])/span
      worst("torque" file, torque[file, i]); worst("balance" file, rate - torque[file, i])
    }
    alpha = (omega[2, i+1] - omega[2, i-1])/span
    x = mx*omega[2, i]^2 + my*alpha; y = mx*alpha - my*omega[2, i]^2
    worst("x", x); worst("y", y); worst("dx", F[2, i] - x); worst("dy", R[2, i] - y)
    worst("fx", F[3, i] - F[2, i]); worst("fy", R[3, i] - R[2, i]); worst("omega", omega[2, i])
    print t[i], motor[i], friction[i], rate, F[3, i], x, R[3, i], y
  }
  err = "/dev/stderr"
  for (file = 2; file <= 3; ++file)
    printf "%s torque up to %.0f N m; torque - rate of angular momentum: %.1e of it\n", name[file], most["torque" file], most["balance" file]/most["torque" file] > err
  printf "by hand  %.0f kg, centre %.4f m off the axis, up to %.2f degrees a second\n", m, sqrt(mx*mx + my*my)/m, most["omega"]*57.29577951 > err
  printf "forward  up to %.1f N; rigid run - m r omega^2: %.1e of it; flexible - rigid: %.1e\n", most["x"], most["dx"]/most["x"], most["fx"]/most["x"] > err
  printf "right    up to %.1f N; rigid run - m r alpha:   %.1e of it; flexible - rigid: %.1e\n", most["y"], most["dy"]/most["y"], most["fy"]/most["y"] > err
}
