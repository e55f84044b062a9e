# The deflection q1 of the rod's middle from the line of its ends, in two runs, and by one equation of the first sine mode about the rigid
# motion, M q'' = f - (K + k K_N - phi'^2 M) q: k = 0 is the published reduced model, k = 1 has the axial force that it leaves out.
#   awk -f o17.awk BESIDE.csv SOLID.csv > Q1.csv, each of them from hilo-post series RUN.h5 probe.pin probe.slider probe.middle
BEGIN {
  FS = ","; pi = 3.14159265358979
  r = 0.15; l = 0.30; rate = 150; m = 7870*64e-6; m_slider = 0.075552
  v[0] = v[1] = 0.444896105                                        # at the start, published
  M = m*l/2; K = 2e11*0.008^4/12*pi^4/(2*l^3)
  print "time [s],solid: force beside it [mm],solid [mm],mode of the published model [mm],mode with the axial force [mm]"
}
function motion(t,  w, s, c, i, n, x, shear, N_end, ax, ay, beta) {
  w = rate; s = sin(rate*t); c = cos(rate*t)
  sp = -r/l*s; cp = sqrt(1 - sp*sp); wr = -r/l*c*w/cp; beta = (r/l*s*w*w + sp*wr*wr)/cp
  ax = -r*c*w*w; ay = -r*s*w*w                                      # of the pin
  along = cp*ax + sp*ay; across = -sp*ax + cp*ay
  f = -m*(across*2*l/pi + beta*l*l/pi)
  shear = m*(across*l/2 + beta*l*l/3)
  N_end = (m_slider*(r*c*w*w + l*(cp*wr*wr + sp*beta)) + shear*sp)/cp
  K_N = 0; n = 20                                                   # int N (pi/l cos(pi x/l))^2 dx
  for (i = 0; i < n; ++i) {
    x = (i + 0.5)*l/n
    K_N += (N_end - m*(along*(l - x) - wr*wr*(l*l - x*x)/2))*(pi/l*cos(pi*x/l))^2*l/n
  }
}
function acceleration(q, k) { return (f - (K + k*K_N)*q)/M + wr*wr*q }
function size_of(x) { return x < 0 ? -x : x }
function off(k, x) { x = size_of(x); if (x > worst[k]) worst[k] = x }
FNR == 1 { next }
{                                                                   # of a run: q1, and how far the slider is from the rigid one
  ex = $11 - $2; ey = $12 - $3; mx = $20 - $2; my = $21 - $3
  q1 = (ex*my - ey*mx)/sqrt(ex*ex + ey*ey)
  lag = $11 - r*cos(rate*$1) - sqrt(l^2 - (r*sin(rate*$1))^2)
}
FNR == NR { beside[FNR] = q1; beside_lag = lag; next }
FNR > 2 {                                                           # a Runge-Kutta step of both modes from the row before
  h = $1 - t
  for (k = 0; k < 2; ++k) {
    motion(t); a1 = acceleration(q[k], k)
    motion(t + h/2); v2 = v[k] + h/2*a1; a2 = acceleration(q[k] + h/2*v[k], k); v3 = v[k] + h/2*a2; a3 = acceleration(q[k] + h/2*v2, k)
    motion(t + h); v4 = v[k] + h*a3; a4 = acceleration(q[k] + h*v3, k)
    q[k] += h/6*(v[k] + 2*v2 + 2*v3 + v4); v[k] += h/6*(a1 + 2*a2 + 2*a3 + a4)
  }
}
{
  t = $1; b = beside[FNR]
  printf "%.9g,%.6g,%.6g,%.6g,%.6g\n", t, b*1e3, q1*1e3, q[0]*1e3, q[1]*1e3
  off("peak", q[0]); off("beside", b - q[0]); off("solid", q1 - q[1]); off("axial force", q[1] - q[0])
}
function line(what, x, y) {
  printf "%-48s %7.1f %6.1f %%", what, x*1e6, 100*(x/published - 1) > out
  if (y) printf " %16.2f %6.1f %%", y*1e6, 100*(y/x3 - 1) > out
  print "" > out
}
END {
  published = 1.893192460247e-4; x3 = 0.1697373326718410 - r*cos(15) - sqrt(l^2 - (r*sin(15))^2); out = "/dev/stderr"
  print "at 0.1 s, and how far from the published value    q1 [um]            slider from the rigid one [um]" > out
  line("published", published, x3)
  line("mode of the published model", q[0])
  line("solid, the axial force beside it", beside[FNR], beside_lag)
  line("mode with the axial force", q[1])
  line("solid", q1, lag)
  printf "at most, of the peak %.0f um: solid with the force beside it off the published model\047s mode by %.2g %%,\n", 1e6*worst["peak"], 100*worst["beside"]/worst["peak"] > out
  printf "solid off the mode with the axial force by %.2g %%; the two modes are %.2g %% apart\n", 100*worst["solid"]/worst["peak"], 100*worst["axial force"]/worst["peak"] > out
}
