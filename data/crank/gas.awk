# Gauge pressure in the cylinder over time, one row per degree of crank:  awk -f gas.awk > out/gas.csv
# Four strokes from t0, where the crank stands at the bottom: compression, expansion, exhaust, intake.  One zone of ideal gas,
# dp/dV = -g p/V + (g - 1)/V dQ/dV, heat by Wiebe's law [ghojel-2010]; the valves hold their pressures, and what is left when the exhaust
# valve opens blows down.
BEGIN {
  pi = 3.14159265358979
  r = 0.045; l = 0.150; bore = 0.086        # [m], as in crank.geo
  rate = 6000*2*pi/60; t0 = 0.010           # [rad/s], [s], as in scene.toml
  ratio = 10.5                              # of compression
  p_in = 0.95e5; p_out = 1.15e5; p_case = 1.0e5   # [Pa] intake, exhaust, below the piston
  heat = 1250                               # [J] per cycle
  start = -25; lasts = 60                   # burning, degrees from the top
  opens = 140                               # exhaust valve
  V_stroke = pi/4*bore^2*2*r; V_c = V_stroke/(ratio - 1)
  print "t,p"
  n = 50                                    # sub-steps of a degree
  p = p_in
  for (a = -180; a <= 540; ++a) {
    if (a > 360) p = p_in                   # intake
    # the last crank angle of intake meets the first of compression
    row(a, p)
    if (a >= 180) { target = a < 350 ? p_out : p_in; p = target + (p - target)*exp(-1/8); continue }
    for (i = 0; i < n; ++i) {
      h = 1/n; b = a + i*h
      k1 = slope(b, p); k2 = slope(b + h/2, p + h/2*k1); k3 = slope(b + h/2, p + h/2*k2); k4 = slope(b + h, p + h*k3)
      p += h/6*(k1 + 2*k2 + 2*k3 + k4)
    }
  }
}
function row(a, p) { printf "%.15g,%.9g\n", t0 + (a + 180)*pi/180/rate, p - p_case }
function volume(a,  s, c) {
  s = sin(a*pi/180); c = cos(a*pi/180)
  return V_c + pi/4*bore^2*(l + r - r*c - sqrt(l^2 - r^2*s^2))
}
function burnt(a,  u) {                     # fraction
  u = (a - start)/lasts
  return u <= 0 ? 0 : 1 - exp(-5*u^3)
}
function slope(a, p,  d, dV, g) {           # dp/da [Pa/degree]
  if (a > opens) return -(p - p_out)/8
  d = 0.01; dV = (volume(a + d) - volume(a - d))/(2*d)
  g = a < start ? 1.35 : 1.28
  return (-g*p*dV + (g - 1)*heat*(burnt(a + d) - burnt(a - d))/(2*d))/volume(a)
}
