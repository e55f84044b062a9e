// SPDX-License-Identifier: GPL-3.0-or-later
// Entries that scenes of many tests have, one call each.  `more`: further keys as lines, what is particular to a test.
#pragma once
#include <fmt/format.h>

#include <string>

#include "base/math.hpp"

namespace hilo::test {

inline std::string list(const Vec3& v) { return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]); }

/// Regions of one material; `law` and `of_region` are further keys of the two.
inline std::string solid(double E, double nu, double density, const std::string& region = "*", const std::string& law = "",
                         const std::string& of_region = "") {
  return fmt::format("[material.\"of_{0}\"]\nE = {1}\nnu = {2}\ndensity = {3}\n{4}\n[region.\"{0}\"]\nmaterial = \"of_{0}\"\n{5}\n", region,
                     E, nu, density, law, of_region);
}
inline std::string body(const std::string& name, double mass, const Vec3& com, const Vec3& inertia, const std::string& more = "") {
  return fmt::format("[[body]]\nname = \"{}\"\nmass = {}\ncom = {}\ninertia = {}\n{}\n", name, mass, list(com), list(inertia), more);
}
inline std::string initial(const std::string& on, const std::string& more) {
  return fmt::format("[[initial]]\non = [\"{}\"]\n{}\n", on, more);
}
inline std::string joint(const std::string& kind, const std::string& name, const std::string& a, const std::string& b, const Vec3& at,
                         const std::string& more = "") {
  return fmt::format("[[joint]]\nkind = \"{}\"\nname = \"{}\"\na = \"{}\"\nb = \"{}\"\nat = {}\n{}\n", kind, name, a, b, list(at), more);
}
/// A joint with an axis.
inline std::string axial(const std::string& kind, const std::string& name, const std::string& a, const std::string& b, const Vec3& at,
                         const Vec3& axis, const std::string& more = "") {
  return joint(kind, name, a, b, at, "axis = " + list(axis) + "\n" + more);
}
inline std::string spring(const std::string& kind, const std::string& name, const std::string& a, const std::string& b,
                          const std::string& more) {
  return fmt::format("[[spring]]\nkind = \"{}\"\nname = \"{}\"\na = \"{}\"\nb = \"{}\"\n{}\n", kind, name, a, b, more);
}
inline std::string motion(const std::string& kind, const std::string& name, const std::string& on, const std::string& more) {
  return fmt::format("[[motion]]\nkind = \"{}\"\nname = \"{}\"\non = \"{}\"\n{}\n", kind, name, on, more);
}
/// `components`: such as "xz".
inline std::string held(const std::string& on, const std::string& components = "xyz") {
  std::string quoted;
  for (const char c : components) quoted += fmt::format("{}\"{}\"", quoted.empty() ? "" : ", ", c);
  return motion("fixed", on + " " + components, on, "components = [" + quoted + "]");
}
inline std::string load(const std::string& kind, const std::string& name, const std::string& on, const std::string& more = "") {
  return fmt::format("[[load]]\nkind = \"{}\"\nname = \"{}\"\non = \"{}\"\n{}\n", kind, name, on, more);
}
inline std::string force(const std::string& name, const std::string& on, const Vec3& F, const std::string& more = "") {
  return load("force", name, on, "force = " + list(F) + "\n" + more);
}
inline std::string push(const std::string& on, const Vec3& F, const std::string& more = "") {
  return force(list(F) + " on " + on, on, F, more);
}
/// `on` "": what has the name of the probe.
inline std::string probe(const std::string& name, const std::string& on = "", const std::string& more = "") {
  return fmt::format("[[probe]]\nname = \"{}\"\non = \"{}\"\n{}\n", name, on.empty() ? name : on, more);
}
inline std::string in_steps(int steps, const std::string& more = "", const std::string& analysis = "static") {
  return fmt::format("[time]\nanalysis = \"{}\"\nsteps = {}\n{}\n", analysis, steps, more);
}
inline std::string in_time(double end, double step, const std::string& more = "") {
  return fmt::format("[time]\nend = {}\nstep = {}\n{}\n", end, step, more);
}
/// Fields are quoted: "\"stress\", \"von_mises\"".
inline std::string fields(const std::string& names, const std::string& more = "") {
  return fmt::format("[output]\nfields = [{}]\n{}\n", names, more);
}
inline std::string solved_to(double tolerance) { return fmt::format("[solver]\ntolerance = {}\n", tolerance); }

/// A cart of 1 kg on a rail along x, which a spring of 100 N/m holds and a force pushes.
inline std::string pushed_cart(double F) {
  return body("cart", 1, Vec3::Zero(), Vec3::Ones()) + axial("prismatic", "rail", "ground", "cart", Vec3::Zero(), Vec3::UnitX()) +
         spring("bushing", "soft", "ground", "cart", "at = [0, 0, 0]\nstiffness = [100, 0, 0]") + force("push", "cart", {F, 0, 0}) +
         probe("cart");
}

}  // namespace hilo::test
