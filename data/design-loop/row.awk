# One design as a line of designs.csv.  Variables: name, density [kg/m^3]; files: status, then those of the mesh, peak.txt and injury.csv.
BEGIN { split(name, part, "_"); for (i in part) value[i] = substr(part[i], 2) }
FILENAME ~ /status$/ { at = index($0, "="); status[substr($0, 1, at - 1)] = substr($0, at + 1) }
FILENAME ~ /mesh/ && $1 == "cheeks" { mass = sprintf("%.2f", $3 * density) }
FILENAME ~ /peak/ && $1 == "cheeks" { stress = sprintf("%.1f", $2) }
FILENAME ~ /injury/ {
  split($0, cell, ",")
  if (FNR == 1)
    for (i in cell) { if (cell[i] ~ /^DRI/) column = i }
  else if (cell[1] == "driver")
    dri = cell[column]
}
END {
  if (status["state"] != "done") mass = stress = dri = ""
  gsub(/"/, "\"\"", status["message"])
  printf "%s,%s,%s,%s,%s,%s,%s,%s,%s,\"%s\"\n", name, value[1], value[2], value[3], status["state"] == "done" ? "converged" : "failed",
    mass, stress, dri, status["exit"] + 0, status["message"]
}
