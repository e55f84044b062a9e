// SPDX-License-Identifier: GPL-3.0-or-later
// Every array of a results file is one of the schema's, with its type, row, unit and meaning; and every array of the schema is written by
// some run.  docs/format.md is printed from the same table.
#include "model/schema.hpp"

#include "verify/contact/collision.hpp"
#include "verify/everything/half_rigid.hpp"
#include "verify/linear_region/bars.hpp"

namespace hilo::test::schema_test {
namespace {

/// Arrays and links of a file.
void list(const Store& file, const std::string& group, std::vector<std::string>& out) {
  for (const auto& name : file.list(group)) {
    const std::string path = (group == "/" ? "" : group) + "/" + name;
    if (path == "/VTKHDF") continue;  // of VTK's layout: cli.run_exports
    if (file.linked(path) || file.is_array(path))
      out.push_back(path);
    else
      list(file, path, out);
  }
}

void hold_against_schema(const Store& file, std::set<std::string>& met) {
  std::vector<std::string> paths;
  list(file, "/", paths);
  if (file.has("/VTKHDF")) met.insert("/VTKHDF");
  for (const std::string& path : paths) {
    const ArraySchema* row = find_array("run.h5", path);
    ASSERT_NE(row, nullptr) << path << " is not in the schema";
    met.insert(std::string(row->path));
    if (file.linked(path)) {
      EXPECT_EQ(row->type, "link") << path;
      continue;
    }
    const bool may_be_single = path.starts_with("/field/");
    EXPECT_TRUE(file.type(path) == row->type || (may_be_single && file.type(path) == "f4")) << path << ": " << file.type(path);
    if (row->type == "string") continue;
    EXPECT_EQ(file.text_attribute(path, "unit").value_or(""), row->unit) << path;
    EXPECT_EQ(file.text_attribute(path, "meaning").value_or(""), row->meaning) << path;
    const auto shape = file.shape(path);
    auto rest = row_shape(*row);
    if (rest.size() == 1 && rest[0] == 0) rest[0] = shape.at(1);  // as many as a word of the schema says
    EXPECT_EQ(std::vector(shape.begin() + 1, shape.end()), rest) << path;
  }
}

TEST(ResultsSchema, HoldsEveryArrayAndEveryArrayIsWritten) {
  const Everything c;
  std::ofstream(c / "more.toml") << scene_of_everything() << R"(
[section.rod]
kind = "circle"
diameter = 0.02
[material.plain]
E = 1e9
nu = 0.3
density = 1000
[beam.whip]
points = [[0.2, 1.5, 1], [0.2, 2, 1]]
cells = [2]
section = "rod"
material = "plain"
a = "side"
[[joint]]
kind = "cylindrical"
name = "sleeve"
a = "top"
b = "arm"
at = [0.2, 0.1, 2]
axis = [0, 0, 1]
[[body]]
name = "arm"
mass = 1
com = [0.3, 0.1, 2]
inertia = [0.01, 0.01, 0.01]
[[stop]]
kind = "angle"
name = "limit"
joint = "sleeve"
lower = -1
upper = 1
stiffness = 100
[[motor]]
kind = "linear"
name = "push"
joint = "sleeve"
rate = [-1, 1]
force = [2, -2]
[[friction]]
name = "rub"
joint = "sleeve"
coefficient = 0.1
radius = 0.1
[[obstacle]]
kind = "plane"
name = "ground"
at = [0, 0, -9]
[[contact]]
name = "landing"
a = "ground"
b = "zmin"
modulus = 1e6
layer = 0.1
[[sensor]]
name = "seat"
on = "top"
[[probe]]
name = "tip"
on = "zmax"
)";
  std::set<std::string> met;
  for (const char* options : {"", "--set output.precision=single", "--set output.nodes=skin", "--set output.envelope=true",
                              "--set 'material.of_*.kind=\"j2\"' --set 'material.of_*.yield=1e3'"}) {
    succeeded(c.run(std::string("hilo-solve --quiet more.toml tags.h5 --set time.end=0.003 --set output.interval=0.001 ") + options));
    hold_against_schema(Store::open(c / "run.h5"), met);
  }
  SceneCase linear(soft_bars::in_flight);
  linear.use(block_mesh({}), {Fidelity::linear});
  hold_against_schema(linear.solved("--set time.end=0.0158 --set material.soft.E=1e9").file(), met);
  linear.write("scene.toml", soft_bars::sagging);
  for (const std::string analysis : {"modes", "path"}) hold_against_schema(linear.solved("--set time.analysis=" + analysis).file(), met);
  std::ofstream(linear / "rod.toml")
      << "material.m = {E = 1e6, nu = 0.3, density = 1000}\nsection.s = {kind = \"circle\", diameter = 0.01}\n"
         "beam.b = {points = [[0, 0, 0], [0, 0, 1]], cells = [2], section = \"s\", material = \"m\", a = \"ground\"}\n"
         "load = [{name = \"F\", kind = \"force\", on = \"b.end\", force = [0, 0, -1]}]\n"
         "time = {analysis = \"buckling\", modes = 1}\n";
  succeeded(linear.run("hilo-solve --quiet rod.toml -o run.h5"));
  hold_against_schema(Store::open(linear / "run.h5"), met);
  Case tied("output");  // a plate on a block
  BlockOptions block, plate;
  block.regions = {"block"}, plate.regions = {"plate"};
  plate.n[0] = plate.n[1] = 2, plate.low = Vec3(0, 0, 1), plate.high = Vec3(1, 1, 1.1);
  tied.use(together(block_mesh(block), block_mesh(plate)));
  std::ofstream(tied / "tied.toml") << "material.m = {E = 1e6, nu = 0.3, density = 1000}\nregion.block.material = \"m\"\n"
                                       "region.plate = {material = \"m\", shell = true}\n"
                                       "tie = [{name = \"weld\", a = \"blockzmax\", b = \"platezmin\"}]\n"
                                       "motion = [{kind = \"fixed\", name = \"foot\", on = \"blockzmin\"}]\n"
                                       "output.fields = [\"displacement\", \"shell\"]\ntime.analysis = \"static\"\n";
  succeeded(tied.run("hilo-solve --quiet tied.toml mesh.h5 -o run.h5"));
  hold_against_schema(tied.results().file(), met);
  SceneCase wing(solid(1e6, 0.3, 1000, "*", "kind = \"j2\"\nyield = 1e9", "shell = true") + held("xmin") + in_steps(1) +
                 fields("\"stress\", \"von_mises\", \"stress_error\", \"plastic_strain\", \"shell\""));
  wing.use(
      block_mesh({.n = {2, 1, 1}, .high = {2, 1, 0.1}, .regions = {"root", "wing"}, .region_of = [](const Vec3& x) { return x[0] > 1; }}));
  hold_against_schema(wing.solved().file(), met);
  std::ofstream(tied / "face.msh") << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"
                                      "$Elements\n1\n1 2 2 0 1 1 2 3\n$EndElements\n";
  std::ofstream(tied / "beam.toml") << "material.m = {E = 1e6, nu = 0.3}\nsection.s = {kind = \"mesh\", file = \"face.msh\"}\n"
                                       "beam.b = {points = [[0, 0, 0], [9, 0, 0]], section = \"s\", material = \"m\", a = \"ground\"}\n"
                                       "time.analysis = \"static\"\n";
  succeeded(tied.run("hilo-solve --quiet beam.toml -o beam.h5"));
  hold_against_schema(Store::open(tied / "beam.h5"), met);
  std::string many = "[time]\nend = 0.002\nstep = 0.001\n";
  for (int k = 0; k < 300; ++k)
    many += "[[body]]\nname = \"b" + std::to_string(k) + "\"\nmass = 1\ncom = [" + std::to_string(k) + ", 0, 0]\ninertia = [1, 1, 1]\n";
  many += "[[contact]]\nname = \"heap\"\na = \"all\"\nb = \"all\"\nstiffness = 1\n";
  for (int k = 0; k < 50; ++k)
    many += "[[obstacle]]\nkind = \"sphere\"\nname = \"s" + std::to_string(k) + "\"\non = \"b" + std::to_string(k) +
            "\"\nradius = 0.1\nat = [" + std::to_string(k) + ", 0, 0]\n";
  std::ofstream(c / "many.toml") << many;
  ASSERT_EQ(c.run("hilo-solve --quiet many.toml -o many.h5").exit, 0);
  const Store table = Store::open(c / "many.h5");
  hold_against_schema(table, met);
  for (const char* array : {"/history/body/%table", "/history/body/%names"}) {
    EXPECT_TRUE(table.has(array));
    met.insert(std::string(array).replace(9, 4, "<name>"));
  }
  const std::set<std::string> elsewhere{"/parts/rank", "/checkpoint", "/cell/state"};  // of runs on several ranks; reserved
  for (const ArraySchema& row : file_schema()) {
    if (row.file == "run.h5" && !elsewhere.contains(std::string(row.path))) {
      EXPECT_TRUE(met.contains(std::string(row.path))) << row.path << " is in the schema and no run has it";
    }
  }
}

/// Probes at x = their number, in this order.
void write_probes(const Workplace& work, const std::string& name, int first, int last) {
  std::ofstream out(work / name);
  out << "[[body]]\nname = \"b\"\nmass = 1\ncom = [0, 0, 0]\ninertia = [1, 1, 1]\n[time]\nend = 0.02\nstep = 0.001\n";
  for (int k = first; k != last; k += first < last ? 1 : -1)
    out << "[[probe]]\nname = \"p" << k << "\"\non = \"b\"\nat = [" << k << ", 0, 0]\n";
}

// Columns belong to names: a run goes on with the same ones alone, and a file that is refused stays as it was.
TEST(Schema, ATableGoesOnWithItsOwnNames) {
  const Workplace work;
  write_probes(work, "scene.toml", 0, 300), write_probes(work, "turned.toml", 299, -1), write_probes(work, "more.toml", 0, 301);
  ASSERT_EQ(work.run("hilo-solve --quiet scene.toml -o run.h5 --checkpoint 10steps").exit, 0);
  const std::string before = text_of(work / "run.h5");
  const Ran refused = work.run("hilo-solve --quiet --accept --restart run.h5 --set time.end=0.04 more.toml");
  EXPECT_EQ(refused.exit, 2) << refused.err;
  EXPECT_EQ(text_of(work / "run.h5"), before);
  succeeded(work.run("hilo-solve --quiet --restart run.h5 --set time.end=0.04 turned.toml"));
  const Store file = Store::open(work / "run.h5");
  const auto x = file.read<double>("/history/probe/p7");
  EXPECT_EQ(x.size() / static_cast<size_t>(file.shape("/history/probe/p7")[1]), 41u);
  for (size_t i = 0; i < x.size(); i += x.size() / 41) EXPECT_EQ(x[i], 7);
}

}  // namespace
}  // namespace hilo::test::schema_test
