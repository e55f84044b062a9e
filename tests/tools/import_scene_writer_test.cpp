// SPDX-License-Identifier: GPL-3.0-or-later
// Tables that hilo-import writes into a scene: as the scene reads them, and refused where the schema does not have them.
#include <gtest/gtest.h>

#include "import/scene_writer.hpp"
#include "model/scene.hpp"

namespace hilo::test::import_scene_writer_test {
namespace {

TEST(ImportSceneWriter, WritesWhatASceneReads) {
  SceneWriter w;
  const std::string odd = "a \"b\" \\c";
  w.add("body", odd, "deck.inp:7", {{"mass", 2}, {"com", Vec3(1, 0.5, -0.0)}});
  w.add_unique({"load", "force"}, odd, "", {{"on", odd}, {"force", 2 * Vec3::UnitX()}, {"per_node", false}, {"history", ""}});
  w.add_unique({"load", "force"}, odd, "", {{"on", "ground"}, {"force", {0, 1, 1e-20}}}).set_if(false, "history", "no");
  w.add({"material", "stvk"}, "st eel", "", {{"E", 2e11}, {"nu", 0.3}});
  w.add("initial", "", "", {{"on", std::vector{odd}}});
  w.begin("one", Vec3(0, 0, -9.81));
  EXPECT_EQ(w.count("load"), 2);
  EXPECT_EQ(w.ends({"load", "initial"}), (std::set<std::string>{odd, "ground"}));
  EXPECT_EQ(w.ends({"initial"}), std::set<std::string>{odd});

  const Scene s = Scene::parse(w.text(), "written");
  EXPECT_EQ(s.table("scene").text("title"), "one");
  EXPECT_EQ(s.table("scene").vector3("gravity"), Vec3(0, 0, -9.81));
  EXPECT_EQ(s.entries("body")[0].name, odd);
  EXPECT_EQ(s.entries("body")[0].vector3("com"), Vec3(1, 0.5, 0));
  EXPECT_EQ(s.entries("load")[0].name, odd);
  EXPECT_EQ(s.entries("load")[1].name, odd + "_2");
  EXPECT_FALSE(s.entries("load")[0].given("history"));
  EXPECT_EQ(s.entries("load")[1].vector3("force"), Vec3(0, 1, 1e-20));
  EXPECT_EQ(s.entries("material")[0].number("E"), 2e11);
  EXPECT_EQ(s.entries("initial")[0].texts("on"), std::vector{odd});
}

TEST(ImportSceneWriter, WhatTheSchemaDoesNotHaveIsAFaultOfOurs) {
  const auto fault = [](const SceneKind& kind, std::initializer_list<SceneKey> keys) {
    try {
      SceneWriter().add(kind, "x", "", keys);
    } catch (const Error& e) {
      return e.exit == Exit::fault;
    }
    return false;
  };
  EXPECT_FALSE(fault({"joint", "fixed"}, {{"a", "p"}}));
  EXPECT_TRUE(fault({"joint", "fixt"}, {}));
  EXPECT_TRUE(fault("joint", {}));
  EXPECT_TRUE(fault({"joint", "fixed"}, {{"stifness", 1}}));
  EXPECT_TRUE(fault({"joint", "fixed"}, {{"displacement", Vec3(1, 0, 0)}})) << "a key of another section";
  EXPECT_TRUE(fault({"joint", "fixed"}, {{"a", 1}})) << "a number for a text";
  EXPECT_TRUE(fault("body", {{"mass", "1"}})) << "a text for a number";
}

}  // namespace
}  // namespace hilo::test::import_scene_writer_test
