// SPDX-License-Identifier: GPL-3.0-or-later
// Every kind of joint, force, load and motion that a scene can name, under every integrator: the matrix of Newton is the derivative of its
// equations.  Kinds, keys and integrators are taken from the schema, so that a new one cannot be forgotten.
#include <cstring>

#include "dynamics/integrator/make.hpp"
#include "dynamics/integrator_kinds.hpp"
#include "model/local_mesh.hpp"
#include "system/along.hpp"
#include "system/dense_kkt.hpp"
#include "system/modal_damping.hpp"
#include "system/somewhere_off.hpp"
#include "verify/verify.hpp"

namespace hilo::test::laws_test {
namespace {

const char* const base = R"(
gravity = [1, -2, -9.81]
[material.soft]
kind = "neo-hookean"
E = 2e5
nu = 0.3
density = 1000
[region.block]
material = "soft"
REGION
[[body]]
name = "one"
mass = 3
com = [0.2, 0.1, 2]
inertia = [0.2, 0.3, 0.4, 0.02, -0.01, 0.03]
[[body]]
name = "two"
mass = 2
com = [0.4, 1.2, 1.6]
inertia = [0.1, 0.12, 0.15]
[[body]]
name = "arm"
mass = 1
com = [0.9, 0.5, 1.1]
inertia = [0.02, 0.03, 0.04]
[[joint]]
kind = "JOINT"
name = "sleeve"
a = "one"
b = "two"
at = [0.3, 0.7, 1.7]
AXIS
[history.course]
t = [0, 1]
value = [0.3, 1]
interpolation = "smooth"
[time]
end = 1
step = 0.02
)";

/// What a key is given; the joint that forces act along is `sleeve`.
std::string value_of(const KindSchema& kind, const Param& p) {
  static const std::map<std::string_view, std::string> values = {
      {"a", "\"one\""},
      {"b", "\"two\""},
      {"carrier", "\"arm\""},
      {"joint", "\"sleeve\""},
      {"history", "\"course\""},
      {"at", "[0.3, 0.6, 1.8]"},
      {"at_a", "[0.1, 0.1, 1.2]"},
      {"at_b", "[0.2, 1.5, 1.9]"},
      {"axis", "[0.1, 0.2, 1]"},
      {"x", "[1, 0.1, 0.2]"},
      {"axis_a", "[0.3, 1, 0.2]"},
      {"axis_b", "[0.2, 0.4, 1]"},
      {"axis_carrier", "[0.1, -0.4, 1]"},
      {"at_carrier", "[0.4, 0.2, 1.1]"},
      {"factors", "[2, -1.5]"},
      {"factor_carrier", "0.7"},
      {"extension", "[-0.5, 1.5]"},
      {"reactions", "\"arm\""},
      {"acceleration", "[30, 20, -50]"},
      {"force_per_length", "[30, 20, -50]"},
      {"force_per_length_end", "[-20, 60, 10]"},
      {"from", "0.757384492638955"},  // the middle of `arc`, below
      {"to", "0.757384492638955"},
      {"speed", "7"},
      {"axle", "[0.2, 1, 0.3]"},
      {"edge", "[0.2, 1, 0.3]"},
      {"direction", "[0, 1, 0.1]"},
      {"radius", "0.3"},
      {"ratio", "-1.7"},
      {"pitch", "0.4"},
      {"length", "0.8"},
      {"points", "[[0.3, 0.4, 1.6], [0.2, 0.5, 1.7], [0.3, 0.6, 1.8], [0.5, 0.9, 1.9], [0.2, 1.1, 1.7]]"},
      {"closed", "true"},
      {"angle", "0.3"},
      {"spin", "0.7"},
      {"displacement", "0.2"},
      {"velocity", "0.4"},
      {"rate", "[-30, 50]"},
      {"torque", "[7, -2]"},
      {"force", "[9, -4]"},
      {"coefficient", "0.3"},
      {"preload", "40"},
      {"slip_velocity", "0.7"},
      {"reaction", "false"},
      {"lower", "0.9"},
      {"upper", "-0.9"},
      {"restitution", "0.5"},
      {"rest_speed", "0.4"},
      {"clearance", "-0.4"},
      {"tangential_stiffness", "[2000, 3000]"},
      {"tangential_damping", "[20, 30]"},
      {"per_node", "true"},
      {"traction", "[300, 200, -500]"},
      {"pressure", "3000"},
      {"follower", "true"},
      {"components", "[\"x\", \"z\"]"},
      {"mass", "5"},
      {"damping", "30"},
      {"stiffness", "4000"},
      {"angular_stiffness", "[500, 600, 700]"},
      {"angular_damping", "[5, 6, 7]"}};
  const std::string key(p.key);
  if (key == "name") return "\"it\"";
  if (kind.section == "region") return key == "damping" ? "0.02" : "0.7";
  if (key == "kind") return '"' + std::string(kind.kind) + '"';
  if (key == "on" && (kind.kind == "acceleration" || kind.kind == "centrifugal")) return "\"block\"";
  if (key == "on" && kind.kind == "line") return "\"it\"";
  if (key == "on") return kind.kind == "torque" ? "\"two\"" : kind.section == "motion" ? "\"line\"" : "\"xmax\"";
  if (key == "displacement" && p.type == Type::vector3) return "[0.1, 0.2, -0.1]";
  if ((key == "torque" || key == "force") && p.type == Type::vector3) return "[50, 20, -30]";
  if ((key == "damping" || key == "stiffness") && p.type == Type::numbers) return key == "damping" ? "[20, 30, 40]" : "[3000, 4000, 5000]";
  if (kind.section == "spring" && kind.kind == "stop" && (key == "lower" || key == "upper")) return key == "lower" ? "5" : "0.2";
  if (const auto it = values.find(key); it != values.end()) return it->second;
  ADD_FAILURE() << kind.section << " " << kind.kind << ": a value for the new key `" << key << "`, please";
  return "1";
}

struct Variant {
  std::string kind, name, scene;
  Fidelity fidelity = Fidelity::nonlinear;  // of the region
};

/// A section that couples all that it can, and a curved beam of it.
const std::string any_section = R"(
[section.any]
kind = "matrix"
stiffness = [3000, 200, 100, 200, 4000, 300, 100, 300, 9000]
coupling = [10, 20, 30, -20, 40, 10, 50, 20, -30]
bending = [200, 10, 20, 10, 150, -20, 20, -20, 120]
line_mass = 2
inertia = [0.03, 0.05, 0.01]
)";
const std::string arc =
    "[beam.it]\npath = \"arc\"\npoints = [[0.2, 0.1, 2.1], [0.3, 0.9, 2.2], [0.5, 1.2, 1.7]]\ncells = [2]\nsection = \"any\"\n";

/// The kind with what it must be given, and once more with each of the other keys.
void add_variants(const KindSchema& kind, std::vector<Variant>& out) {
  const auto find = [&](std::string_view key) {
    const auto it = std::find_if(kind.params.begin(), kind.params.end(), [&](const Param& p) { return p.key == key; });
    return it == kind.params.end() ? nullptr : &*it;
  };
  std::vector<std::string> more{""};
  for (const Param& p : kind.params)
    if (p.fallback != "!" && p.key != "name" && p.key != "a" && p.key != "file") more.emplace_back(p.key);
  for (const std::string& key : more) {
    std::set<std::string> keys{key};
    for (const Param& p : kind.params)
      if (p.fallback == "!" || p.key == "name" || p.key == "a" || (p.key == "points")) keys.insert(std::string(p.key));
    if (kind.section == "joint" && (key.find("stiffness") != key.npos || key.find("damping") != key.npos))
      keys.insert("stiffness"), keys.insert("angular_stiffness");
    if (kind.section == "joint" && key == "history") continue;  // of what drives the joint: with those
    if (kind.section == "joint" && (key == "angle" || key == "spin" || key == "displacement" || key == "velocity")) keys.insert("history");
    if (key.ends_with("_carrier")) keys.insert("carrier");
    if (key == "restitution" || key == "rest_speed") keys.insert("restitution");
    if ((kind.section == "stop" || kind.kind == "stop") && key != "lower") keys.insert("upper");
    if (key == "length" || key == "preload" || (key == "angle" && kind.section == "spring")) keys.insert("stiffness");
    if (kind.section == "friction") keys.insert("radius"), keys.insert("slip_velocity");  // its default is too sharp for differences
    if (kind.section == "friction" && key == "reaction") keys.insert("preload");
    if (kind.section == "stop" && key == "lower") keys.erase("upper");
    std::string entry = "[[" + std::string(kind.section) + "]]\n";
    for (const std::string& k : keys)
      if (const Param* p = find(k)) entry += k + " = " + value_of(kind, *p) + "\n";
    const bool per_node = key == "per_node", on_body = kind.section == "load" && key == "at";
    if (on_body) entry.replace(entry.find("xmax"), 4, "two");
    if (per_node && entry.find("at =") != entry.npos) continue;
    std::vector<std::string> helpers{"spherical"};
    if (kind.section == "stop") helpers = {kind.kind == "angle" ? "revolute" : "prismatic", "cylindrical"};
    if (kind.section == "motor") helpers = {kind.kind == "rotary" ? "revolute" : "prismatic", "screw"};
    if (kind.section == "friction") helpers = {"revolute", "cylindrical", "screw", "spherical"};
    for (const std::string& helper : helpers) {
      std::string text = base;
      const auto put = [&](const std::string& word, const std::string& by) { text.replace(text.find(word), word.size(), by); };
      put("REGION", kind.section == "region" ? entry.substr(entry.find('\n') + 1) : "");
      put("JOINT", helper);
      put("AXIS", std::string(helper == "spherical" ? "" : "axis = [0.2, 1, 0.3]\n") + (helper == "screw" ? "pitch = 0.3\n" : ""));
      if (kind.section != "region") text += entry;
      if (kind.kind == "line") text += any_section + arc + "a = \"one\"\nb = \"two\"\n";
      const std::string its_kind = std::string(kind.section) + " " + std::string(kind.kind), name = its_kind + " " + key + " on " + helper;
      out.push_back({its_kind, name, text});
      for (const Fidelity fidelity : {Fidelity::rigid, Fidelity::linear})
        if (kind.section == "region") out.push_back({its_kind, name + ", " + std::string(word(fidelity)), text, fidelity});
    }
  }
}

/// A curved one whose ends ride on bodies, coupled and damped; one with a corner whose first section is a body of its own.
void add_beams(std::vector<Variant>& out) {
  std::string text = base;
  for (const auto& [word, by] : {std::pair{"REGION", ""}, {"JOINT", "spherical"}, {"AXIS", ""}})
    text.replace(text.find(word), std::strlen(word), by);
  for (const char* more : {"", "damping = 0.02\n", "mass_damping = 0.7\n", "orientation = [1, 0.2, 0.3]\n",
                           "fidelity = \"linear\"\ndamping = 0.02\nmass_damping = 0.7\n"})
    out.push_back({"beam", std::string("beam ") + more + " on bodies", text + any_section + arc + "a = \"one\"\nb = \"two\"\n" + more});
  out.push_back({"beam", "linear beam under a load that turns with it",
                 text + any_section + arc +
                     "a = \"one\"\nb = \"two\"\nfidelity = \"linear\"\n[[load]]\nkind = \"line\"\nname = \"l\"\non = \"it\"\n"
                     "force_per_length = [0.3, 0.5, 0.2]\nforce_per_length_end = [0.1, -0.4, 0.7]\nfollower = true\n"});
  out.push_back({"beam", "beam with a corner on a set",
                 text + any_section +
                     "[beam.it]\npoints = [[0.2, 0.1, 2.1], [0.3, 0.4, 2.2], [0.3, 0.2, 0.8]]\ncells = [1, 2]\n"
                     "section = \"any\"\nb = \"xmax\"\n"});
}

std::vector<Variant> all_variants() {
  std::vector<Variant> out;
  // sections that no equation of motion is made of
  const std::set<std::string_view> others{"scene",  "material", "set",      "body",     "initial", "sensor",
                                          "probe",  "section",  "history",  "quantity", "time",    "solver",
                                          "output", "left_out", "obstacle", "contact",  "tie"};
  for (const KindSchema& kind : scene_schema()) {
    if (others.contains(kind.section)) continue;
    if (kind.section == "beam") {
      add_beams(out);
      continue;
    }
    if (kind.section != "region") {
      add_variants(kind, out);
      continue;
    }
    KindSchema damping = kind;  // the other keys of a region are its material and mass
    std::erase_if(damping.params, [](const Param& p) { return p.key.find("damping") == p.key.npos; });
    add_variants(damping, out);
  }
  return out;
}

/// Newton's matrix times a direction, and the same by differences.
struct Comparison {
  Eigen::VectorXd product, difference;
  double scale = 0;  // of the largest row
};

class Laws : public testing::TestWithParam<std::string> {
 protected:
  static const LocalMesh& mesh() {
    static const Workplace place;
    static LocalMesh local = [] {
      Mesh m = block_mesh(
          {.n = {1, 1, 2}, .high = {0.4, 0.3, 0.8}, .map = [](const Vec3& x) { return Vec3(x + 0.02 * Vec3(std::sin(7 * x[2]), 0, 0)); }});
      add_node_set(m, "line", [](const Vec3& x) { return std::abs(x[2] - 0.8) < 1e-9 && x[0] > 0.2; });
      write_mesh(place / "mesh.h5", m, {"test"});
      return read_local_mesh(place / "mesh.h5", Comm::world());
    }();
    return local;
  }
};

void expect_equal(const Comparison& c, const std::vector<char>& used, const std::string& what) {
  const size_t n = used.size();
  for (Eigen::Index i = 0; i < c.product.size(); ++i) {
    if (!used[static_cast<size_t>(i) % n]) continue;
    ASSERT_NEAR(c.product[i], c.difference[i], 1e-7 * c.scale) << what << ", row " << i;
  }
}

TEST_P(Laws, EveryMatrixOfNewtonIsTheDerivativeOfItsEquations) {
  static const std::vector<Variant> variants = all_variants();
  const double h = 0.02;
  int compared = 0;
  std::set<std::string> refused, kinds, compared_kinds;
  for (const Variant& v : variants) {
    kinds.insert(v.kind);
    LocalMesh local = mesh();
    local.fidelity.assign(1, v.fidelity);
    std::string how = GetParam();
    const bool averaged = how.starts_with("averaged ");
    if (averaged) how = how.substr(9);
    const std::vector<std::string> set{"time.integrator=\"" + how + "\"", "time.dissipation=0.1",
                                       std::string("time.averaged=") + (averaged ? "true" : "false"), "time.rho1=0.9", "time.rho3=0.5"};
    std::unique_ptr<System> system;
    std::unique_ptr<Scene> scene;
    try {
      scene = std::make_unique<Scene>(Scene::parse(v.scene, "scene.toml", set));
      system = build_system(*scene, &local, Comm::world());
      system->part<ModalDamping>().find(system->start);
    } catch (const Error& e) {
      refused.insert(v.name.substr(0, v.name.find(" on ")) + ": " + e.what());
      continue;
    }
    const std::vector<char> used = in_use(*system);
    const int n = static_cast<int>(used.size());
    const State s = state_of(*system);
    system->commit(s.q, &s.v);
    for (int seed = 0; seed < 2; ++seed) {
      const auto direction = [&](int i) { return used[i % n] ? scatter(1000 * seed + 77 + i) : 0.0; };
      Comparison c;
      if (how == "radau") {
        if (system->traits().lumps_masses) continue;  // refused by name
        auto solver = std::make_unique<Along>(direction);
        Along& along = *solver;
        DenseKkt none;
        const StepTools tools{*system, none, {.tolerance = 1e-300}};
        const auto radau = make_radau(std::move(solver));
        radau->solve(tools, s, h, Predictor::velocity);
        ASSERT_EQ(along.b.size(), 3u) << v.name;
        c.product = along.A * along.d;
        c.difference = (along.b[1] - 100 * along.b[2] + 99 * along.b[0]) / (9 * Along::step);
        c.scale = (along.A.cwiseAbs() * along.d.cwiseAbs()).maxCoeff();
        expect_equal(c, used, v.name);
        ++compared, compared_kinds.insert(v.kind);
        continue;
      }
      const auto made = make_integrator(scene->table("time"));
      auto& integrator = dynamic_cast<StageIntegrator&>(*made);
      integrator.begin(*system, s, h);
      Config q1 = s.q;
      std::vector<double> kick(n);
      for (int i = 0; i < n; ++i) kick[i] = h * scatter(5000 + i);
      system->move(q1, kick);
      system->prescribe(q1, s.t + h);
      for (int stage = 0; stage < (how == "bathe" ? 2 : 1); ++stage) {
        DenseKkt K;
        K.structure(system->layout.cliques, system->layout.map);
        Residual at;
        system->evaluate(integrator.stage(stage, Unknown(*system, s.q, q1)), s.lambda, at, &K);
        const int first = 3 * system->first_joint_block();
        const auto residual = [&](double f) {
          std::vector<double> z(n);
          for (int i = 0; i < n; ++i) z[i] = f * direction(i);
          Config q = q1;
          system->move(q, z);
          auto lambda = s.lambda;
          for (int i = first; i < n; ++i) lambda[i - first] += at.sigma * z[i];
          Residual r;
          system->evaluate(integrator.stage(stage, Unknown(*system, s.q, q)), lambda, r, nullptr);
          system->mask_fixed(r.r);
          return Eigen::Map<const Eigen::VectorXd>(r.r.data(), n).eval();
        };
        Eigen::VectorXd d(n);
        for (int i = 0; i < n; ++i) d[i] = direction(i);
        c.product = K.A * d;
        c.difference = (residual(1e-7) - residual(-1e-7)) / 2e-7;
        c.scale = (K.A.cwiseAbs() * d.cwiseAbs()).maxCoeff();
        expect_equal(c, used, v.name);
        ++compared, compared_kinds.insert(v.kind);
      }
    }
  }
  if (GetParam() == "radau") kinds.erase("point_mass ");  // it gives nodes mass, which radau refuses
  EXPECT_EQ(compared_kinds, kinds) << "no kind is refused in every one of its scenes";
  EXPECT_GT(compared, 200);
  for (const std::string& r : refused) std::cout << "refused: " << r << "\n";
}

std::vector<std::string> integrators() {
  auto list = choices("time", "integrator");
  std::erase(list, "gauss");  // its matrix: tests/dynamics/gauss_test.cpp
  for (const char* averaged : {"averaged U0", "averaged V0"}) list.emplace_back(averaged);
  return list;
}

INSTANTIATE_TEST_SUITE_P(Integrators, Laws, testing::ValuesIn(integrators()), [](const auto& p) { return as_name(p.param); });

}  // namespace
}  // namespace hilo::test::laws_test
