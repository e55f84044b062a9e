// SPDX-License-Identifier: GPL-3.0-or-later
// The table of joints and the schema of scenes know the same kinds; a word that neither knows is an error.
#include <set>

#include "base/error.hpp"
#include "model/scene.hpp"
#include "physics/connectors.hpp"

namespace hilo::test::joint_kinds_test {
namespace {

TEST(JointKinds, AreThoseThatAScenesSchemaHas) {
  std::set<std::string> of_schema, of_table;
  for (const KindSchema& kind : scene_schema())
    if (kind.section == "joint") of_schema.emplace(kind.kind);
  for (const JointKind& kind : hilo::joint_kinds()) EXPECT_TRUE(of_table.emplace(kind.name).second) << kind.name << " stands twice";
  EXPECT_EQ(of_schema, of_table);
}

TEST(JointKinds, AWordThatIsNoneIsAnErrorAndNotTheLastOfTheList) {
  try {
    joint("revolut", somewhere(3));
    ADD_FAILURE() << "no error";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("\"revolut\""), std::string::npos) << e.what();
    EXPECT_NE(e.hint.find("revolute"), std::string::npos) << e.hint;
  }
}

// Counted from the text: as many rows as the table says that the joint holds, and its free directions are not among them.
TEST(JointKinds, HoldAsManyDirectionsAsTheyHaveRows) {
  const Config q = somewhere(3);
  for (const std::string& name : joint_kinds()) {
    const JointKind& kind = hilo::joint_kinds().at(name);
    EXPECT_EQ(joint(name, q).n_rows(), static_cast<int>(kind.holds.size())) << name;
    if (kind.frees(Freedom::slide)) {
      EXPECT_EQ(kind.holds.find('z'), kind.holds.npos) << name;
    }
    if (kind.frees(Freedom::angle)) {
      EXPECT_EQ(kind.holds.find('C'), kind.holds.npos) << name;
    }
    for (const int r : kind.pressing) EXPECT_LT(r, static_cast<int>(kind.holds.size())) << name;
  }
}

}  // namespace
}  // namespace hilo::test::joint_kinds_test
