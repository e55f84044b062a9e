# Displacements from ride height as drawn and sizes of the forces of a run:
#   hilo-post series RUN.h5 probe.middle.z probe.frame.z probe.wheel.z spring.tyre.Fz spring.strut.F? 'joint.JOINT.F?' ... | awk -f columns.awk > CURVES.csv
BEGIN { FS = "," }
NR == 1 {
  for (i = 1; i <= NF; ++i) { name = $i; sub(/ \[.*/, "", name); column[name] = i }
  print "time [s],middle of the arm [mm],body [mm],wheel [mm],tyre [kN],strut [kN],lower ball joint [kN],front bushing [kN],rear bushing [kN],upper ball joint [kN],tie rod [kN]"
  next
}
function size(what,  x, y, z) { x = $(column[what ".Fx"]); y = $(column[what ".Fy"]); z = $(column[what ".Fz"]); return sqrt(x*x + y*y + z*z)/1e3 }
{
  printf "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", $1, ($(column["probe.middle.z"]) - 0.285)*1e3,
    ($(column["probe.frame.z"]) - 0.86)*1e3, ($(column["probe.wheel.z"]) - 0.40)*1e3, $(column["spring.tyre.Fz"])/1e3, size("spring.strut"),
    size("joint.lower_ball"), size("joint.lower_front"), size("joint.lower_rear"), size("joint.upper_ball"), size("joint.tie_inner")
}
