// SPDX-License-Identifier: GPL-3.0-or-later
// The picture of a scene before it runs.
#include <algorithm>

#include "base/error.hpp"
#include "physics/contact/obstacle_kinds.hpp"
#include "picture_file.hpp"
#include "post/scene/scene_items.hpp"
#include "sample_run.hpp"
#include "scene_parts.hpp"
#include "succeeded.hpp"

namespace hilo::test::model_test {
namespace {

const std::string scene_text = "title = \"Sample\"\nmesh = \"mesh.h5\"\ngravity = [0, 0, -9.81]\n" + solid(2.1e11, 0.3, 7850) +
                               axial("revolute", "trunnion", "support", "breech", {0.6, 0, 0.55}, {0, 1, 0}) +
                               spring("torsion", "bar_spring", "support", "breech", "axis = [0, 1, 0]\nstiffness = 1e4") +
                               load("pressure", "gas", "muzzle", "pressure = 1e6") + held("ground_side") + R"([[sensor]]
name = "driver"
on = "hull"
at = [0, 0.3, 0]
)" + in_time(0.1, 1e-4);

TEST(Model, things_of_the_scene_are_where_it_says) {
  const Workplace place;
  MeshFile file;
  file.mesh = sample::machine();
  file.fidelity.assign(file.mesh.region_name.size(), Fidelity::nonlinear);
  place.write("scene.toml", scene_text);
  const SceneItems found = scene_items(Scene::load(place / "scene.toml"), &file);
  ASSERT_EQ(found.items.size(), 5u);
  EXPECT_EQ(found.items[0].glyph, Glyph::hinge);
  EXPECT_EQ(found.items[0].at, Vec3(0.6, 0, 0.55));
  EXPECT_EQ(found.items[1].at, Vec3(0.6, 0, 0.55));                              // a torsion spring sits at the joint of its ends
  EXPECT_LT((found.items[2].at - Vec3(3.2, 0, 0.6)).norm(), 1e-9);               // the middle of the muzzle
  EXPECT_LT((found.items[2].along.normalized() - Vec3(-1, 0, 0)).norm(), 1e-9);  // pressure pushes inwards
  EXPECT_EQ(found.items[3].glyph, Glyph::clamp);
  EXPECT_EQ(found.items[4].above, Vec3(0, 0, 1));
}

TEST(Model, every_kind_of_the_schema_has_a_symbol) {
  size_t seen = 0;
  for (const KindSchema& k : scene_schema())
    for (const char* section : {"joint", "spring", "stop", "motor", "friction", "load", "motion"})
      if (k.section == section) {
        EXPECT_NO_THROW(glyph_of(k.section, k.kind)) << k.section << " " << k.kind;
        ++seen;
      }
  EXPECT_GT(seen, 30u);
  EXPECT_THROW(glyph_of("joint", "glued"), Error);
}

TEST(Model, stops_motors_and_friction_sit_at_their_joint) {
  const Workplace place;
  MeshFile file;
  file.mesh = sample::machine();
  file.fidelity.assign(file.mesh.region_name.size(), Fidelity::nonlinear);
  write_mesh(place / "mesh.h5", file.mesh, {"sample"});
  const std::string more = std::string(scene_text) + R"(
[[stop]]
kind = "angle"
name = "limit"
joint = "trunnion"
upper = 0.3
stiffness = 1e6
[[motor]]
kind = "rotary"
name = "drive"
joint = "trunnion"
rate = [0, 100]
torque = [50, 0]
[[friction]]
name = "seal"
joint = "trunnion"
coefficient = 0.1
radius = 0.05
)";
  place.write("scene.toml", more);
  const SceneItems found = scene_items(Scene::load(place / "scene.toml"), &file);
  const auto item = [&](const std::string& name) {
    for (const auto& i : found.items)
      if (i.name == name) return i;
    return SceneItem{};
  };
  for (const auto& [name, glyph, meaning] :
       {std::tuple{"limit", Glyph::stop, "angle stop"}, std::tuple{"drive", Glyph::turn, "rotary motor"},
        std::tuple{"seal", Glyph::friction, "friction"}}) {
    EXPECT_EQ(item(name).glyph, glyph);
    EXPECT_EQ(item(name).meaning, meaning);
    EXPECT_EQ(item(name).at, Vec3(0.6, 0, 0.55));
    EXPECT_EQ(item(name).along, Vec3(0, 1, 0));
  }
  expect_end(place.run("hilo-post model scene.toml --set motor.drive.joint=truniom -o model.png"), 2,
             "no joint \"truniom\" (did you mean \"trunnion\"?)");
}

// Truth: an outline lies on the surface of its obstacle.
TEST(Model, obstacles_have_their_outlines) {
  const Workplace place;
  const std::string at = "at = [1, 2, 3]\n", axis = "axis = [1, 2, 2]\n";
  place.write("scene.toml", "[[body]]\nname = \"b\"\nmass = 1\ncom = [0, 0, 0]\ninertia = [1, 1, 1]\n[time]\nend = 1\nstep = 0.1\n" +
                                ("[[obstacle]]\nkind = \"plane\"\nname = \"plane\"\n" + at + axis) +
                                "[[obstacle]]\nkind = \"sphere\"\nname = \"sphere\"\nradius = 0.5\non = \"b\"\n" + at +
                                "[[obstacle]]\nkind = \"cylinder\"\nname = \"cylinder\"\nradius = 0.5\nlength = 3\n" + at + axis +
                                "[[obstacle]]\nkind = \"cylinder\"\nname = \"bore\"\nradius = 0.5\ninside = true\n" + at + axis +
                                "[[obstacle]]\nkind = \"capsule\"\nname = \"capsule\"\nradius = 0.5\nlength = 3\n" + at + axis +
                                "[[obstacle]]\nkind = \"torus\"\nname = \"torus\"\nradius = 0.5\ntube = 0.2\n" + at + axis +
                                "[[obstacle]]\nkind = \"box\"\nname = \"box\"\nsize = [1, 2, 3]\nx = [0, 1, 0]\n" + at + axis);
  const Scene scene = Scene::load(place / "scene.toml");
  const SceneItems found = scene_items(scene, nullptr);
  int outlines = 0;
  for (const Entry& e : scene.entries("obstacle")) {
    const Obstacle obstacle = obstacle_kinds().at(e.kind, "").make(e);
    const auto item = std::ranges::find(found.items, e.name, &SceneItem::name);
    ASSERT_NE(item, found.items.end()) << e.name;
    EXPECT_EQ(item->glyph, Glyph::outline);
    EXPECT_GE(item->lines.size(), 3u) << e.name;
    for (const auto& line : item->lines)
      for (const Vec3& x : line) EXPECT_NEAR(obstacle.shape.at(obstacle.axes.transpose() * (x - obstacle.at)), 0, 1e-12) << e.name;
    ++outlines;
  }
  EXPECT_EQ(outlines, 7);
  succeeded(place.run("hilo-post model scene.toml -o model.png"));
}

TEST(Model, an_ellipsoid_has_the_inertia_of_its_body) {
  const Workplace place;
  place.write("scene.toml",
              "[[body]]\nname = \"ball\"\nmass = 5\ncom = [1, 2, 3]\ninertia = [1.3, 1.0, 0.5]\n[time]\nend = 1\nstep = 0.1\n");
  const SceneItems found = scene_items(Scene::load(place / "scene.toml"), nullptr);
  ASSERT_EQ(found.bodies.size(), 1u);
  const Ellipsoid& b = found.bodies[0];
  const Mat3 J = [&] {  // m/5 (r^2 1 - axes r^2 axes^T)
    const Mat3 spread = b.axes * b.radii.cwiseProduct(b.radii).asDiagonal() * b.axes.transpose();
    return Mat3(5.0 / 5 * (spread.trace() * Mat3::Identity() - spread));
  }();
  EXPECT_LT((J - Mat3(Vec3(1.3, 1.0, 0.5).asDiagonal())).norm(), 1e-12);
}

TEST(Model, draws_regions_symbols_and_legend_without_a_display) {
  const Workplace place;
  write_mesh(place / "mesh.h5", sample::machine(), {"sample"});
  place.write("scene.toml", scene_text);
  succeeded(place.run("unset DISPLAY\nhilo-post model scene.toml -o model.png"));
  const PictureFile picture(place / "model.png");
  EXPECT_EQ(picture.width, 1600);
  EXPECT_GT(picture.ink(20, 100, 1260, 880), 0.15);
  EXPECT_GT(picture.ink(1275, 90, 1590, 500), 0.05);
  const auto first = text_of(place / "model.png");
  ASSERT_EQ(place.run("hilo-post model scene.toml -o model.png").exit, 0);
  EXPECT_EQ(text_of(place / "model.png"), first);
}

TEST(Model, a_joint_to_a_set_that_is_not_there_is_an_error) {
  const Workplace place;
  write_mesh(place / "mesh.h5", sample::machine(), {"sample"});
  place.write("scene.toml", scene_text);
  const Ran ran = place.run("hilo-post model scene.toml --set joint.trunnion.b=breach -o model.png");
  expect_end(ran, 2, "no region or set \"breach\"");
  EXPECT_NE(ran.err.find("did you mean \"breech\"?"), std::string::npos) << ran.err;
  EXPECT_EQ(place.files(), (std::set<std::string>{"mesh.h5", "scene.toml"}));
}

}  // namespace
}  // namespace hilo::test::model_test
