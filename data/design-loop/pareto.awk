# From designs.csv to the points of the chart: for each thickness its front of stress and DRI as a line, the dominated designs as points
# between lines without numbers, which break a curve.
BEGIN { FS = ","; print "cheeks,stress [MPa],DRI [1]" }
NR > 1 && $5 == "converged" {
  if (!($2 in count)) order[++n] = $2
  i = ++count[$2]
  stress[$2, i] = $7; dri[$2, i] = $8; mass[$2] = sprintf("%.1f", $6)
}
END {
  for (k = 1; k <= n; ++k) {
    t = order[k]
    label = t " mm, " mass[t] " kg"
    for (i = 1; i <= count[t]; ++i) {  # by rising stress
      at = i
      for (j = i + 1; j <= count[t]; ++j)
        if (stress[t, j] + 0 < stress[t, at] + 0) at = j
      swap = stress[t, i]; stress[t, i] = stress[t, at]; stress[t, at] = swap
      swap = dri[t, i]; dri[t, i] = dri[t, at]; dri[t, at] = swap
    }
    least = ""; rest = ""
    for (i = 1; i <= count[t]; ++i)
      if (least == "" || dri[t, i] + 0 < least) {
        print label_of() stress[t, i] "," dri[t, i]
        least = dri[t, i] + 0
      } else
        rest = rest label_of() ",\n" label_of() stress[t, i] "," dri[t, i] "\n"
    printf "%s", rest
  }
}
function label_of() { return "\"" label "\"," }
