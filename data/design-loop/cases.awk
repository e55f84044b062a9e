# Names of the designs of sweep.txt: t8_k100_c6 is 8 mm, 100 kN/m, 6 kN s/m.
/^[ \t]*(#|$)/ { next }
NF != 3 {
  print FILENAME ":" FNR ": expected thickness, stiffness and damping, comma-separated values without blanks" > "/dev/stderr"
  exit 2
}
{
  n_t = split($1, t, ","); n_k = split($2, k, ","); n_c = split($3, c, ",")
  for (i = 1; i <= n_t; ++i)
    for (j = 1; j <= n_k; ++j)
      for (l = 1; l <= n_c; ++l) {
        name = "t" t[i] "_k" k[j] "_c" c[l]
        if (!(name in seen)) print name
        seen[name]
      }
}
