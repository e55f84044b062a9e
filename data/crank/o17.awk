# The deflection q1 of the rod's middle from the line of its ends, in a run, and by one equation of the first sine mode about the rigid
# motion, M q'' = f - (K + K_N - phi'^2 M) q: the published reduced model, and that with the axial force that it leaves out.
#   hilo-post series RUN.h5 probe.pin probe.slider probe.middle | awk -f o17.awk > Q1.csv
BEGIN {
  FS = ","; pi = 3.14159265358979
  r = 0.15; l = 0.30; rate = 150; m = 7870*64e-6; m_slider = 0.075552
  v[0] = v[1] = 0.444896105                                        # at the start, published
  M = m*l/2; K = 2e11*0.008^4/12*pi^4/(2*l^3)
  print "time [s],solid [mm],published first mode [mm],with the axial force [mm]"
}
function motion(t,  w, s, c, i, n, x, shear, N_end, ax, ay, beta) {
  theta = rate*t; w = rate; s = sin(theta); c = cos(theta)
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
NR == 1 { next }
NR > 2 {                                                            # a Runge-Kutta step of both from the row before
  h = $1 - t
  for (k = 0; k < 2; ++k) {
    motion(t); a1 = acceleration(q[k], k)
    motion(t + h/2); v2 = v[k] + h/2*a1; a2 = acceleration(q[k] + h/2*v[k], k); v3 = v[k] + h/2*a2; a3 = acceleration(q[k] + h/2*v2, k)
    motion(t + h); v4 = v[k] + h*a3; a4 = acceleration(q[k] + h*v3, k)
    q[k] += h/6*(v[k] + 2*v2 + 2*v3 + v4); v[k] += h/6*(a1 + 2*a2 + 2*a3 + a4)
  }
}
{
  t = $1; motion(t)
  ex = $11 - $2; ey = $12 - $3; mx = $20 - $2; my = $21 - $3; size = sqrt(ex*ex + ey*ey)
  q1 = (ex*my - ey*mx)/size
  printf "%.9g,%.6g,%.6g,%.6g\n", t, q1*1e3, q[0]*1e3, q[1]*1e3
  if (size_of(q[0]) > peak) peak = size_of(q[0])
  if (size_of(q1 - q[1]) > off) off = size_of(q1 - q[1])
  x3 = $11 - r*cos(theta) - sqrt(l^2 - (r*sin(theta))^2)
}
function size_of(x) { return x < 0 ? -x : x }
END {
  printf "q1 at 0.1 s: solid %.4g um, first mode %.4g, with the axial force %.4g; published 189.3 um\n", q1*1e6, q[0]*1e6, q[1]*1e6 > "/dev/stderr"
  printf "off the mode with the axial force by at most %.3g %% of the peak %.4g um\n", 100*off/peak, peak*1e6 > "/dev/stderr"
  printf "slider behind the rigid one: %.4g um; published %.4g um\n", x3*1e6, (0.1697373326718410 - r*cos(15) - sqrt(l^2 - (r*sin(15))^2))*1e6 > "/dev/stderr"
}
