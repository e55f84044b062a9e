# Efficiency E(P) = T(1) / (P T(P)) from runs.csv.  T(1): the run of one subdomain.  "modelled: vehicle M":
#   T(P) = imbalance (W(P) - undivided(P))/P + undivided(P) + exchange(P)
# W(P): work of P subdomains, measured in one process; undivided: the coarse problem, which every rank solves whole; exchange: messages at
# 2 us and sums at 2 us log2(P) each, bytes at 5 GB/s: the counts of the largest measured run, messages by as many neighbours as 4 ranks have.
# "modelled: vehicle L": one million hexahedra, E = (W/P)/T, against the same work on one rank; work per unknown of the measured subdomains
# of that size (102, 51 and 25 thousand unknowns), iterations of P subdomains.
BEGIN { FS = OFS = ","; latency = 2e-6; bandwidth = 5e9; imbalance = 1.04; print "ranks,case,efficiency" }
NR == 1 { for (i = 1; i <= NF; i++) c[$i] = i; next }
{ work = $c["assembly"] + $c["set_up"] + $c["solve"] + $c["output"] + $c["rest"] }
$1 == 1 && $2 == 1 { one = work }
$1 == 1 { W[$2] = work; solve[$2] = $c["solve"]; U[$2] = $c["undivided"]; iterations[$2] = $c["iterations"]; order[++n] = $2 }
$1 > 1 { measured[$1] = work; its = $c["iterations"]; messages = $c["messages"] / its; sums = $c["sums"] / its; bytes = $c["bytes"] / its }
END {
  for (i = 1; i <= n; i++) {
    P = order[i]
    exchange = P == 1 ? 0 : iterations[P] * (messages * latency + bytes / bandwidth + sums * latency * log(P) / log(2))
    T = P == 1 ? W[1] : imbalance * (W[P] - U[P]) / P + U[P] + exchange
    printf "%d,modelled: vehicle M,%.3f\n", P, one / (P * T)
  }
  ratio = 3256659 / 85152
  for (P = 32; P <= 128; P *= 2) {
    m = P / 32
    share = ratio * (W[m] - solve[m] + solve[m] * iterations[P] / iterations[m]) / P
    exchange = iterations[P] * (messages * latency + bytes / bandwidth + sums * latency * log(P) / log(2))
    printf "%d,modelled: vehicle L,%.3f\n", P, share / (imbalance * share + U[P] + exchange)
  }
  print "1,measured,1.000"
  if (2 in measured) printf "2,measured,%.3f\n", one / (2 * measured[2])
  if (4 in measured) printf "4,measured (4 ranks on 2 cores),%.3f\n", one / (4 * measured[4])
}
