// SPDX-License-Identifier: GPL-3.0-or-later
// [[contact]] of all with all: the pairs that it stands for, and the run that these give one by one.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "succeeded.hpp"
#include "verify/block_mesh.hpp"
#include "verify/contact/collision.hpp"
#include "verify/verify.hpp"

namespace hilo::test::contact_all_test {
namespace {

const std::string ranks =
    "export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_mpi_yield_when_idle=1 "
    "OMPI_MCA_hwloc_base_binding_policy=none OPENBLAS_NUM_THREADS=1\n";

std::string contact(const std::string& name, const std::string& a, const std::string& b, const std::string& more = "friction = 0.3") {
  return fmt::format("[[contact]]\nname = \"{}\"\na = \"{}\"\nb = \"{}\"\n{}\n", name, a, b, more);
}

/// Two blocks, one above the other, that fall on the ground.
struct Blocks : Case {
  explicit Blocks(bool sharing = false, Fidelity upper = Fidelity::nonlinear) : Case("contact") {
    BlockOptions A, B;
    A.regions = {"A"}, B.regions = {"B"};
    A.n[0] = A.n[1] = A.n[2] = 2, B.n[0] = B.n[1] = 1, B.n[2] = 2;
    A.high = Vec3(1, 1, 0.5), B.low = Vec3(0.2, 0.2, 0.51), B.high = Vec3(0.8, 0.8, 1);
    if (sharing)
      A.regions = {"A", "B"}, A.region_of = [](const Vec3& x) { return x[0] < 0.5 ? 0 : 1; },
      use(block_mesh(A), {Fidelity::nonlinear, upper});
    if (!sharing) use(together(block_mesh(A), block_mesh(B)), {Fidelity::nonlinear, upper});
  }
  std::string scene(const std::string& contacts) const {
    return "gravity = [0, 0, -9.81]\n[material.soft]\nE = 2e6\nnu = 0.3\ndensity = 1000\n[region.\"*\"]\nmaterial = "
           "\"soft\"\n[[obstacle]]\nkind = "
           "\"plane\"\nname = \"ground\"\nat = [0, 0, -0.02]\n[[initial]]\non = [\"A\", \"B\"]\nvelocity = [0.3, 0, -1]\n[[probe]]\nname = "
           "\"a\"\non = "
           "\"A\"\n[[probe]]\nname = \"b\"\non = \"B\"\n[solver]\ntolerance = 1e-13\n[time]\nend = 0.1\nstep = 0.005\n" +
           contacts;
  }
  Ran solve(const std::string& contacts, const std::string& output, const std::string& launcher = "", const std::string& more = "") const {
    std::ofstream(*this / "scene.toml") << scene(contacts);
    return run(launcher + "hilo-solve --quiet scene.toml tags.h5 -o " + output + " " + more);
  }
  Results solved(const std::string& contacts, const std::string& output, const std::string& launcher = "") const {
    const Ran ran = solve(contacts, output, launcher);
    EXPECT_EQ(ran.exit, 0) << ran.err;
    return Results(*this / output);
  }
};

std::vector<std::string> pairs(const Results& r) {
  auto out = r.file().list("/history/contact");
  std::ranges::sort(out);
  return out;
}

// Truth: the run whose three pairs the scene names; the same on ranks.
TEST(ContactOfAll, IsEveryPair) {
  const Blocks c;
  const Results one = c.solved(contact("x", "ground", "A") + contact("y", "ground", "B") + contact("z", "A", "B"), "one.h5");
  const auto same = [&](const Results& r) {
    EXPECT_EQ(pairs(r), (std::vector<std::string>{"c_A_B", "c_ground_A", "c_ground_B"}));
    for (const char* probe : {"probe/a", "probe/b"}) EXPECT_LT((one.history(probe) - r.history(probe)).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_GT(r.history("contact/c_A_B").col(3).maxCoeff(), 0) << "they meet";
    EXPECT_GT(r.history("contact/c_ground_A").col(3).maxCoeff(), 0);
  };
  same(c.solved(contact("c", "all", "all"), "all.h5"));
  same(c.solved(contact("c", "all", "all"), "ranks.h5", ranks + "timeout 60 mpirun -n 2 "));
  const Ran explained = c.run("hilo-solve --quiet scene.toml tags.h5 --explain");
  for (const char* line : {"# contact \"c_ground_A\": a = \"ground\", b = \"A\"", "# contact \"c_A_B\": a = \"A\", b = \"B\""})
    EXPECT_NE(explained.out.find(line), std::string::npos) << explained.out;
}

TEST(ContactOfAll, OfOnePartAndBesideOthers) {
  const Blocks c;
  EXPECT_EQ(pairs(c.solved(contact("c", "all", "A"), "run.h5")), (std::vector<std::string>{"c_B_A", "c_ground_A"}));
  EXPECT_EQ(pairs(c.solved(contact("c", "ground", "all"), "run.h5")), (std::vector<std::string>{"c_ground_A", "c_ground_B"}));
  EXPECT_EQ(pairs(c.solved(contact("own", "B", "A", "friction = 0.1") + contact("c", "all", "all"), "run.h5")),
            (std::vector<std::string>{"c_ground_A", "c_ground_B", "own"}));
  EXPECT_EQ(pairs(c.solved(contact("c", "all", "Azmax"), "run.h5")), (std::vector<std::string>{"c_B_Azmax", "c_ground_Azmax"}));
}

// Truth: what another entry names by a set of facets is met once: friction 0.1 there, and a tie bears all of its force alone.
TEST(ContactOfAll, LeavesOutWhatSetsName) {
  const Blocks c;
  const std::string all = contact("c", "all", "all");
  const std::vector<std::string> rest{"c_ground_A", "c_ground_B"};
  const Ran ran = c.solve(contact("own", "B", "Azmax", "friction = 0.1") + all, "run.h5");
  EXPECT_EQ(ran.exit, 0) << ran.err;
  EXPECT_EQ(pairs(Results(c / "run.h5")), (std::vector<std::string>{"c_ground_A", "c_ground_B", "own"}));
  const Ran told = c.run("hilo-solve scene.toml tags.h5 --dry-run");
  EXPECT_NE(told.err.find("\"all\" leaves out \"A\" with \"B\", as contact \"own\" names facets of both"), std::string::npos) << told.err;
  const std::string tie = "[[tie]]\nname = \"t\"\na = \"Azmax\"\nb = \"Bzmin\"\ngap = 0.02\n";
  EXPECT_EQ(pairs(c.solved(tie + all, "run.h5")), rest);
  const Ran shared = c.solve(all + tie, "run.h5", ranks + "timeout 60 mpirun -n 2 ", "--set time.end=0.01");
  EXPECT_EQ(shared.exit, 0) << shared.err;
  EXPECT_EQ(pairs(Results(c / "run.h5")), rest);
  EXPECT_EQ(pairs(c.solved(contact("c", "ground", "all") + contact("d", "ground", "Bxmin", "friction = 0.5"), "run.h5")),
            (std::vector<std::string>{"c_ground_A", "d"}));
}

// Truth: two entries with facets of both sides in common would press and rub twice.
TEST(ContactOfAll, TwoThatMeetTheSameAreRefused) {
  const Blocks c;
  for (const std::string& second :
       {contact("y", "A", "B"), contact("y", "B", "A"), contact("y", "Azmax", "B"), contact("y", "Bzmin", "Asurface")}) {
    const Ran ran = c.solve(contact("x", "A", "B") + second, "run.h5");
    EXPECT_EQ(ran.exit, 2);
    EXPECT_NE(ran.err.find("contact \"y\": contact \"x\" has "), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find("both sides too, which would meet twice"), std::string::npos) << ran.err;
  }
  c.solved(contact("x", "Azmax", "B") + contact("y", "Axmin", "B") + contact("z", "ground", "A"), "run.h5");
}

// Truth: keys for rigid surfaces go to pairs of these alone; linear regions need not be named otherwise.
TEST(ContactOfAll, OfRigidAndLinearRegions) {
  const Blocks rigid(false, Fidelity::rigid), linear(false, Fidelity::linear);
  const Ran ran = rigid.solve(contact("c", "all", "all"), "run.h5");
  EXPECT_EQ(ran.exit, 2);
  EXPECT_NE(ran.err.find("contact \"c_ground_B\": region \"B\" is rigid, and so is the obstacle"), std::string::npos) << ran.err;
  EXPECT_EQ(pairs(rigid.solved(contact("c", "all", "all", "modulus = 2e6\nlayer = 0.1"), "run.h5")).size(), 3u);
  EXPECT_GT(linear.solved(contact("c", "all", "all"), "run.h5").history("contact/c_A_B").col(3).maxCoeff(), 0);
}

TEST(ContactOfAll, LeavesOutWhatHangsTogether) {
  const Blocks c(true);
  EXPECT_EQ(pairs(c.solved(contact("c", "all", "all"), "run.h5")), (std::vector<std::string>{"c_ground_A", "c_ground_B"}));
  const Ran ran = c.solve(contact("c", "all", "all") + contact("x", "ground", "A") + contact("y", "ground", "B"), "run.h5");
  EXPECT_EQ(ran.exit, 2);
  EXPECT_NE(ran.err.find("contact \"c\": \"all\" stands for no pair"), std::string::npos) << ran.err;
}

// Truth: two balls and a box on bodies: the box has corners for the ground, and is an obstacle to the balls.
TEST(ContactOfAll, OfBodies) {
  const Case c("contact");
  std::string scene = "gravity = [0, 0, -9.81]\n[[obstacle]]\nkind = \"plane\"\nname = \"ground\"\n";
  for (int k = 0; k < 3; ++k)
    scene += fmt::format(
        "[[body]]\nname = \"b{0}\"\nmass = 1\ncom = [{0}, 0, 0.3]\ninertia = [0.01, 0.01, 0.01]\n[[obstacle]]\nname = \"s{0}\"\non = "
        "\"b{0}\"\nat = [{0}, 0, 0.3]\n{1}\n",
        k, k < 2 ? "kind = \"sphere\"\nradius = 0.2" : "kind = \"box\"\nsize = [0.2, 0.2, 0.2]");
  std::ofstream(c / "scene.toml") << scene << contact("c", "all", "all", "stiffness = 1e5\nmodulus = 1e7")
                                  << "[time]\nend = 0.3\nstep = 0.01\n";
  const Ran ran = c.run("hilo-solve scene.toml -o run.h5");
  EXPECT_EQ(ran.exit, 0) << ran.err;
  EXPECT_EQ(ran.err.find("touches it"), std::string::npos) << "what may meet something is not forgotten: " << ran.err;
  EXPECT_EQ(pairs(Results(c / "run.h5")),
            (std::vector<std::string>{"c_ground_s0", "c_ground_s1", "c_ground_s2", "c_s0_s1", "c_s2_s0", "c_s2_s1"}));
  const std::string told = text_of(c / "run.json");
  EXPECT_NE(told.find("\"c_s0_s1\": {\"points\": 1, \"stiffness\": \"F = "), std::string::npos) << "Hertz of two balls";
  EXPECT_NE(told.find("\"c_s2_s0\": {\"points\": 1, \"stiffness\": \"1e+05 N/m"), std::string::npos) << told;
}

}  // namespace
}  // namespace hilo::test::contact_all_test
