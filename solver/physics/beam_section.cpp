// SPDX-License-Identifier: GPL-3.0-or-later
// Closed forms of areas; shear factors after Cowper (1966).
#include "physics/beam_section.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace hilo {
namespace {

using enum Type;
using std::numbers::pi;

double cubed(double x) { return x * x * x; }

SectionArea circle(const EntryValues& e, double nu) {
  const double r = e.number("diameter") / 2, I = pi * r * r * r * r / 4, k = 6 * (1 + nu) / (7 + 6 * nu);
  return {pi * r * r, I, I, 2 * I, k, k};
}

SectionArea tube(const EntryValues& e, double nu) {
  const double ro = e.number("diameter") / 2, ri = ro - e.number("thickness");
  if (ri < 0) e.refuse("thickness", "the wall is thicker than half the diameter");
  const double I = pi * (std::pow(ro, 4) - std::pow(ri, 4)) / 4, m2 = ri * ri / (ro * ro), one = (1 + m2) * (1 + m2);
  const double k = 6 * (1 + nu) * one / ((7 + 6 * nu) * one + (20 + 12 * nu) * m2);
  return {pi * (ro * ro - ri * ri), I, I, 2 * I, k, k};
}

SectionArea rectangle(const EntryValues& e, double nu) {
  const double b = e.number("width"), h = e.number("height"), k = 10 * (1 + nu) / (12 + 11 * nu);
  return {b * h, b * cubed(h) / 12, h * cubed(b) / 12, torsion_of_rectangle(b, h), k, k};
}

/// Shear along the webs of a thin-walled box or, of two half webs, of an I: b, h between the middles of the walls.
double shear_of_webs(double nu, double m, double n, double lips) {
  const double one = 1 + 3 * m;
  return 10 * (1 + nu) * one * one /
         (12 + 72 * m + 150 * m * m + 90 * cubed(m) + nu * (11 + 66 * m + 135 * m * m + 90 * cubed(m)) + n * n * lips);
}

SectionArea box(const EntryValues& e, double nu) {
  const double b = e.number("width"), h = e.number("height"), t = e.number("thickness");
  if (2 * t >= std::min(b, h)) e.refuse("thickness", "two walls are thicker than the box");
  const double bi = b - 2 * t, hi = h - 2 * t, bm = b - t, hm = h - t;
  const auto shear = [nu](double across, double along) {
    const double m = across / along;
    return shear_of_webs(nu, m, m, 10 * ((3 + nu) * m + 3 * m * m));
  };
  return {b * h - bi * hi,
          (b * cubed(h) - bi * cubed(hi)) / 12,
          (h * cubed(b) - hi * cubed(bi)) / 12,
          2 * t * bm * bm * hm * hm / (bm + hm),
          shear(hm, bm),
          shear(bm, hm)};
}

SectionArea double_tee(const EntryValues& e, double nu) {
  const double b = e.number("width"), h = e.number("height"), tf = e.number("flange"), tw = e.number("web");
  if (2 * tf >= h) e.refuse("flange", "two flanges are thicker than the height");
  if (tw > b) e.refuse("web", "the web is thicker than the width");
  const double hi = h - 2 * tf, hm = h - tf, A = 2 * b * tf + hi * tw, m = 2 * b * tf / (hm * tw), n = b / hm;
  const double along_web = shear_of_webs(nu, m, n, 30 * (m + m * m) + 5 * nu * (8 * m + 9 * m * m));
  return {A,
          (b * cubed(h) - (b - tw) * cubed(hi)) / 12,
          (2 * tf * cubed(b) + hi * cubed(tw)) / 12,
          2 * torsion_of_rectangle(b, tf) + torsion_of_rectangle(hi, tw),
          5.0 / 6 * 2 * b * tf / A,
          along_web};
}

SectionArea general(const EntryValues& e, double) { return {e.number("area"), e.number("I1"), e.number("I2"), e.number("J"), 1, 1}; }

/// Three numbers, a diagonal, or nine, by rows.
Mat3 matrix_of(const EntryValues& e, std::string_view key) {
  if (!e.has(key)) return Mat3::Zero();
  const std::vector<double>& v = e.numbers(key);
  Mat3 out = Mat3::Zero();
  for (int i = 0; i < 9; ++i)
    if (v.size() == 9) out(i / 3, i % 3) = v[i];
  for (int i = 0; i < 3 && v.size() == 3; ++i) out(i, i) = v[i];
  return out;
}

}  // namespace

double torsion_of_rectangle(double a, double b) {
  if (a < b) std::swap(a, b);
  double sum = 0;
  for (int n = 1; n < 20; n += 2) sum += std::tanh(n * pi * a / (2 * b)) / std::pow(n, 5);
  return a * cubed(b) / 3 * (1 - 192 / std::pow(pi, 5) * b / a * sum);
}

BeamSection section_of_area(const EntryValues& entry, const SectionKind& kind, double E, double nu, double density) {
  SectionArea a = kind.area(entry, nu);
  if (entry.given("shear")) a.shear_1 = entry.numbers("shear").front(), a.shear_2 = entry.numbers("shear").back();
  if (!(std::min(a.shear_1, a.shear_2) > 0)) entry.refuse("shear", "a factor of shear is not above 0");
  const double G = E / (2 * (1 + nu));
  BeamSection out;
  out.C = Eigen::Matrix<double, 6, 1>(a.shear_1 * G * a.A, a.shear_2 * G * a.A, E * a.A, E * a.I1, E * a.I2, G * a.J).asDiagonal();
  out.mass = density * a.A, out.J11 = density * a.I2, out.J22 = density * a.I1;
  out.size = std::sqrt((a.I1 + a.I2) / a.A);
  return out;
}

BeamSection section_of_stiffness(const EntryValues& entry) {
  BeamSection out;
  out.C << matrix_of(entry, "stiffness"), matrix_of(entry, "coupling"), matrix_of(entry, "coupling").transpose(),
      matrix_of(entry, "bending");
  for (const char* key : {"stiffness", "bending"})
    if (const Mat3 m = matrix_of(entry, key); (m - m.transpose()).norm() > 1e-9 * m.norm())
      entry.refuse(key, "the matrix is not symmetric");
  if (Eigen::LLT<SectionStiffness>(out.C).info() != Eigen::Success)
    entry.refuse("stiffness", "the section has a strain that nothing resists");
  const std::vector<double>& J = entry.numbers("inertia");
  out.mass = entry.number("line_mass"), out.J11 = J[0], out.J22 = J[1], out.J12 = J.size() > 2 ? J[2] : 0;
  if (std::min(out.J11, out.J22) < 0 || out.J12 * out.J12 > out.J11 * out.J22 * (1 + 1e-9))
    entry.refuse("inertia", "no section has this inertia");
  out.size = std::sqrt((out.C(3, 3) + out.C(4, 4)) / out.C(2, 2));
  return out;
}

Registry<SectionKind>& section_kinds() {
  static const Param width{"width", number, "m", "!", "along axis 1", above(0)};
  static const Param height{"height", number, "m", "!", "along axis 2", above(0)};
  static const Param diameter{"diameter", number, "m", "!", "outside", above(0)};
  static const Param thickness{"thickness", number, "m", "!", "of the walls", above(0)};
  static Registry<SectionKind> kinds{
      "kind of section",
      {{"circle", "a full circle", {diameter}, circle},
       {"tube", "a round tube", {diameter, thickness}, tube},
       {"rectangle", "a full rectangle", {width, height}, rectangle},
       {"box", "a rectangular tube of one thickness; J after Bredt", {width, height, thickness}, box},
       {"I",
        "two flanges and a web between them; open: it warps freely",
        {width, height, {"flange", number, "m", "!", "thickness of each", above(0)}, {"web", number, "m", "!", "its thickness", above(0)}},
        double_tee},
       {"general",
        "given by its numbers",
        {{"area", number, "m^2", "!", "A", above(0)},
         {"I1", number, "m^4", "!", "int X2^2: bending about axis 1", above(0)},
         {"I2", number, "m^4", "!", "int X1^2: bending about axis 2", above(0)},
         {"J", number, "m^4", "!", "of torsion", above(0)}},
        general},
       {"matrix",
        "given by its stiffness about the origin, without a material; three numbers are a diagonal, nine a matrix by rows",
        {{"stiffness", numbers, "N", "!", "shear along 1 and 2, stretch", any_number, {3, 9}},
         {"coupling", numbers, "N m", "", "of these (rows) with bending about 1 and 2, twist", any_number, {9}},
         {"bending", numbers, "N m^2", "!", "bending about 1 and 2, twist", any_number, {3, 9}},
         {"line_mass", number, "kg/m", "0", "mass by length", at_least(0)},
         {"inertia", numbers, "kg m", "[0, 0]", "int rho X1^2, int rho X2^2 [int rho X1 X2]", any_number, {2, 3}}}}}};
  return kinds;
}

}  // namespace hilo
