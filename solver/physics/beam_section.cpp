// SPDX-License-Identifier: GPL-3.0-or-later
// Closed forms of areas; shear factors after Cowper (1966).
#include "physics/beam_section.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/section_face.hpp"

namespace hilo {
namespace {

using enum Type;
using std::numbers::pi;

double cubed(double x) { return x * x * x; }

/// Adds what a rectangle b x h with its middle at (x, y) has of r^2 X1, r^2 X2 and r^4.
void add_higher(double x, double y, double b, double h, SectionArea& out, double sign = 1) {
  const double A = sign * b * h, bb = b * b, hh = h * h, x2 = x * x + bb / 12, y2 = y * y + hh / 12;  // means of powers
  const double x3 = x * (x * x + bb / 4), y3 = y * (y * y + hh / 4);
  const double x4 = x * x * (x * x + bb / 2) + bb * bb / 80, y4 = y * y * (y * y + hh / 2) + hh * hh / 80;
  out.H1 += A * (x3 + x * y2), out.H2 += A * (y3 + y * x2), out.I4 += A * (x4 + 2 * x2 * y2 + y4);
}

SectionArea circle(const EntryValues& e, double nu) {
  const double r = e.number("diameter") / 2, I = pi * r * r * r * r / 4, k = 6 * (1 + nu) / (7 + 6 * nu);
  SectionArea out{pi * r * r, I, I, 2 * I, k, k};
  out.I4 = pi * std::pow(r, 6) / 3;
  return out;
}

SectionArea tube(const EntryValues& e, double nu) {
  const double ro = e.number("diameter") / 2, ri = ro - e.number("thickness");
  if (ri < 0) e.refuse("thickness", "the wall is thicker than half the diameter");
  const double I = pi * (std::pow(ro, 4) - std::pow(ri, 4)) / 4, m2 = ri * ri / (ro * ro), one = (1 + m2) * (1 + m2);
  const double k = 6 * (1 + nu) * one / ((7 + 6 * nu) * one + (20 + 12 * nu) * m2);
  SectionArea out{pi * (ro * ro - ri * ri), I, I, 2 * I, k, k};
  out.I4 = pi * (std::pow(ro, 6) - std::pow(ri, 6)) / 3;
  return out;
}

SectionArea rectangle(const EntryValues& e, double nu) {
  const double b = e.number("width"), h = e.number("height"), k = 10 * (1 + nu) / (12 + 11 * nu);
  SectionArea out{b * h, b * cubed(h) / 12, h * cubed(b) / 12, torsion_of_rectangle(b, h), k, k};
  add_higher(0, 0, b, h, out);
  return out;
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
  SectionArea out{b * h - bi * hi,
                  (b * cubed(h) - bi * cubed(hi)) / 12,
                  (h * cubed(b) - hi * cubed(bi)) / 12,
                  2 * t * bm * bm * hm * hm / (bm + hm),
                  shear(hm, bm),
                  shear(bm, hm)};
  add_higher(0, 0, b, h, out), add_higher(0, 0, bi, hi, out, -1);
  return out;
}

SectionArea double_tee(const EntryValues& e, double nu) {
  const double b = e.number("width"), h = e.number("height"), tf = e.number("flange"), tw = e.number("web");
  if (2 * tf >= h) e.refuse("flange", "two flanges are thicker than the height");
  if (tw > b) e.refuse("web", "the web is thicker than the width");
  const double hi = h - 2 * tf, hm = h - tf, A = 2 * b * tf + hi * tw, m = 2 * b * tf / (hm * tw), n = b / hm;
  const double along_web = shear_of_webs(nu, m, n, 30 * (m + m * m) + 5 * nu * (8 * m + 9 * m * m));
  SectionArea out{A,
                  (b * cubed(h) - (b - tw) * cubed(hi)) / 12,
                  (2 * tf * cubed(b) + hi * cubed(tw)) / 12,
                  2 * torsion_of_rectangle(b, tf) + torsion_of_rectangle(hi, tw),
                  5.0 / 6 * 2 * b * tf / A,
                  along_web};
  for (const double y : {-hm / 2, hm / 2}) add_higher(0, y, b, tf, out);
  add_higher(0, 0, tw, hi, out);
  return out;
}

/// An open section of rectangles, about its centre of area, and of the middles of its walls.
SectionArea area_of(const OpenShape& shape) {
  SectionArea out;
  const Eigen::Vector2d centre = shape.centre();
  for (const OpenShape::Part& p : shape.parts) {
    const double A = p.b * p.h, dx = p.x - centre.x(), dy = p.y - centre.y();
    out.A += A;
    out.I1 += A * (p.h * p.h / 12 + dy * dy), out.I2 += A * (p.b * p.b / 12 + dx * dx), out.I12 += A * dx * dy;
    out.J += torsion_of_rectangle(p.b, p.h);
    add_higher(dx, dy, p.b, p.h, out);
  }
  const OpenWalls thin = open_walls(shape.walls);
  out.s1 = thin.shear_centre[0], out.s2 = thin.shear_centre[1];
  out.shear_1 = thin.stiffness(0, 0), out.shear_2 = thin.stiffness(1, 1), out.shear_12 = thin.stiffness(0, 1);
  return out;
}

void check_walls(const EntryValues& e, double flanges, double webs) {
  if (flanges >= e.number("height")) e.refuse(e.has("flange") ? "flange" : "thickness", "the walls fill the height");
  if (webs >= e.number("width")) e.refuse(e.has("web") ? "web" : "thickness", "the walls fill the width");
}

OpenShape double_tee_shape(const EntryValues& e) {
  const double b = e.number("width"), h = e.number("height"), f = e.number("flange"), w = e.number("web"), top = (h - f) / 2;
  return {{{0, -top, b, f}, {0, top, b, f}, {0, 0, w, h - 2 * f}},
          {{{-b / 2, -top}, {0, -top}, f},
           {{b / 2, -top}, {0, -top}, f},
           {{-b / 2, top}, {0, top}, f},
           {{b / 2, top}, {0, top}, f},
           {{0, -top}, {0, top}, w}}};
}

OpenShape tee_shape(const EntryValues& e) {
  const double b = e.number("width"), h = e.number("height"), f = e.number("flange"), w = e.number("web"), top = h - f / 2;
  check_walls(e, f, w);
  return {{{0, top, b, f}, {0, (h - f) / 2, w, h - f}}, {{{-b / 2, top}, {0, top}, f}, {{b / 2, top}, {0, top}, f}, {{0, 0}, {0, top}, w}}};
}

OpenShape angle_shape(const EntryValues& e) {
  const double b = e.number("width"), h = e.number("height"), t = e.number("thickness");
  check_walls(e, t, t);
  return {{{b / 2, t / 2, b, t}, {t / 2, (h + t) / 2, t, h - t}}, {{{b, t / 2}, {t / 2, t / 2}, t}, {{t / 2, t / 2}, {t / 2, h}, t}}};
}

/// Of a channel or a Z: where the lower flange goes.
OpenShape two_flanges(const EntryValues& e, double side) {
  const double b = e.number("width"), h = e.number("height"), f = e.number("flange"), w = e.number("web"), top = (h - f) / 2;
  check_walls(e, 2 * f, w);
  const double beside = b / 2, tip = b - w / 2;  // from the middle of the web, whose outer side is that of the flange
  return {{{0, 0, w, h}, {beside, top, b - w, f}, {side * beside, -top, b - w, f}},
          {{{tip, top}, {0, top}, f}, {{0, top}, {0, -top}, w}, {{0, -top}, {side * tip, -top}, f}}};
}

SectionArea tee(const EntryValues& e, double) { return area_of(tee_shape(e)); }
SectionArea angle(const EntryValues& e, double) { return area_of(angle_shape(e)); }
SectionArea channel(const EntryValues& e, double) { return area_of(two_flanges(e, 1)); }
SectionArea zed(const EntryValues& e, double) { return area_of(two_flanges(e, -1)); }

SectionFace circle_face(const EntryValues& e, double nu) { return round_face(circle(e, nu), e.number("diameter") / 2, 0, nu); }
SectionFace tube_face(const EntryValues& e, double nu) {
  const double r = e.number("diameter") / 2;
  return round_face(tube(e, nu), r, r - e.number("thickness"), nu);
}
SectionFace rectangle_face(const EntryValues& e, double nu) { return full_face(rectangle(e, nu), e.number("width"), e.number("height")); }
SectionFace box_face(const EntryValues& e, double nu) {
  return hollow_face(box(e, nu), e.number("width"), e.number("height"), e.number("thickness"));
}
SectionFace double_tee_face(const EntryValues& e, double nu) { return open_face(double_tee(e, nu), double_tee_shape(e)); }
SectionFace tee_face(const EntryValues& e, double nu) { return open_face(tee(e, nu), tee_shape(e)); }
SectionFace angle_face(const EntryValues& e, double nu) { return open_face(angle(e, nu), angle_shape(e)); }
SectionFace channel_face(const EntryValues& e, double nu) { return open_face(channel(e, nu), two_flanges(e, 1)); }
SectionFace zed_face(const EntryValues& e, double nu) { return open_face(zed(e, nu), two_flanges(e, -1)); }

SectionArea general(const EntryValues& e, double) { return {e.number("area"), e.number("I1"), e.number("I2"), e.number("J"), 1, 1}; }

/// Axial stress at the points that are given; none of shear, which the numbers do not say.
SectionFace fibres_of(const EntryValues& e, double nu) {
  SectionFace face{.area = general(e, nu)};
  if (!e.has("fibres")) return face;
  const std::vector<double>& x = e.numbers("fibres");
  for (size_t i = 0; i + 1 < x.size(); i += 2) face.points.push_back({{x[i], x[i + 1]}, Eigen::Matrix<double, 2, 3>::Zero()});
  return face;
}

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

BeamSection section_of_area(const EntryValues& entry, SectionArea a, double E, double nu, double density) {
  if (entry.given("shear")) a.shear_1 = entry.numbers("shear").front(), a.shear_2 = entry.numbers("shear").back(), a.shear_12 = 0;
  if (!(std::min(a.shear_1, a.shear_2) > 0)) entry.refuse("shear", "a factor of shear is not above 0");
  const double G = E / (2 * (1 + nu));
  BeamSection out;
  out.C = Eigen::Matrix<double, 6, 1>(a.shear_1 * G * a.A, a.shear_2 * G * a.A, E * a.A, E * a.I1, E * a.I2, G * a.J).asDiagonal();
  out.C(3, 4) = out.C(4, 3) = -E * a.I12;
  const Eigen::Vector2d twist(-a.s2, a.s1);  // shear strain in the shear centre by twist about the origin
  out.C(0, 1) = out.C(1, 0) = a.shear_12 * G * a.A;
  const Eigen::Vector2d coupled = out.C.topLeftCorner<2, 2>() * twist;
  out.C.block<2, 1>(0, 5) = coupled, out.C.block<1, 2>(5, 0) = coupled.transpose();
  out.C(5, 5) += coupled.dot(twist);
  out.mass = density * a.A, out.J11 = density * a.I2, out.J22 = density * a.I1, out.J12 = density * a.I12;
  out.size = std::sqrt((a.I1 + a.I2) / a.A);
  out.has_fibres = true, out.H1 = E * a.H1, out.H2 = E * a.H2, out.I4 = E * a.I4;
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
  static const Param of_flange{"flange", number, "m", "!", "thickness of each", above(0)};
  static const Param of_web{"web", number, "m", "!", "its thickness", above(0)};
  static Registry<SectionKind> kinds{
      "kind of section",
      {{"circle", "a full circle", {diameter}, circle, circle_face},
       {"tube", "a round tube", {diameter, thickness}, tube, tube_face},
       {"rectangle", "a full rectangle", {width, height}, rectangle, rectangle_face},
       {"box", "a rectangular tube of one thickness; J after Bredt", {width, height, thickness}, box, box_face},
       {"I", "two flanges and a web between them; open: it warps freely", {width, height, of_flange, of_web}, double_tee, double_tee_face},
       {"T", "a flange on a web below it; shear by the flow in its walls", {width, height, of_flange, of_web}, tee, tee_face},
       {"L",
        "two legs, along axes 1 and 2 from their corner; shear by the flow in its walls",
        {width, height, thickness},
        angle,
        angle_face},
       {"C",
        "two flanges along axis 1 from a web; shear by the flow in its walls",
        {width, height, of_flange, of_web},
        channel,
        channel_face},
       {"Z",
        "a flange along axis 1 above a web, one against it below; width: of each flange with the web",
        {width, height, of_flange, of_web},
        zed,
        zed_face},
       {"general",
        "given by its numbers",
        {{"area", number, "m^2", "!", "A", above(0)},
         {"I1", number, "m^4", "!", "int X2^2: bending about axis 1", above(0)},
         {"I2", number, "m^4", "!", "int X1^2: bending about axis 2", above(0)},
         {"J", number, "m^4", "!", "of torsion", above(0)},
         {"fibres", numbers, "m", "", "points with axial stress, from the centre of area along axes 1 and 2, [[x1, x2], ...]"}},
        general,
        fibres_of},
       {"mesh",
        "the face in a mesh of triangles and quadrangles; factors of shear by the energy of Saint-Venant's flexure",
        {{"file", text, "", "", ".msh of gmsh, as text: x along axis 1, y along axis 2, in the scene's unit of length"},
         {"scale", number, "1", "1", "factor on the lengths of the file", above(0)}},
        nullptr,
        nullptr,
        true},
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
