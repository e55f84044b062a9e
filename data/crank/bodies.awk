# The area of the crown, and of each body of a run name, mass, largest moment of inertia, centre of mass (x, z).
#   { hilo-show RUN.h5; hilo-post series RUN.h5 'body.*'; } | awk -f bodies.awk > bodies.txt
function plain(name) { return name ~ /crank/ ? "crank" : name ~ /piston/ ? "piston" : name }
$1 == "crown" { print "crown," $4 }
$1 == "body" && $2 == "mass" { table = 1; next }
NF == 0 { table = 0 }
table { name = plain($1); m[name] = $2; J[name] = $5; next }                 # across the plane of the rod the moment is the largest
/^t \[s\],/ { n = split($0, column, ","); next }
n && !done {                                                               # the first instant
  split($0, value, ",")
  for (i = 2; i <= n; ++i)
    if (column[i] ~ /\.[xz]0 /) {
      name = column[i]; sub(/^body\./, "", name); axis = name ~ /\.x0 / ? "x" : "z"; sub(/\.[xz]0 .*/, "", name)
      centre[plain(name), axis] = value[i]
    }
  done = 1
}
END { for (name in m) if (m[name] > 0) printf "%s,%.9g,%.9g,%.12g,%.12g\n", name, m[name], J[name], centre[name, "x"], centre[name, "z"] }
