// SPDX-License-Identifier: GPL-3.0-or-later
// output.envelope: the largest values over all steps, whatever is put out, on any number of ranks, through a restart, and against a closed
// form.
#include "verify/everything/half_rigid.hpp"

namespace hilo::test::envelope_test {
namespace {

using Array = Eigen::ArrayXd;

Array envelope(const Results& r, const std::string& name) { return r.table("/envelope/" + name).col(0).array(); }

/// Largest sizes over the fields of all outputs and when they were.
std::pair<Array, Array> largest(const Results& r, const std::string& name) {
  Array most, t;
  for (const std::string& step : r.steps()) {
    const Array size = r.table("/field/" + step + "/" + name).rowwise().norm().array();
    if (most.size() == 0) most = Array::Constant(size.size(), -1), t = most;
    for (Eigen::Index i = 0; i < size.size(); ++i)
      if (size[i] > most[i]) most[i] = size[i], t[i] = r.field_time(step);
  }
  return {most, t};
}

// steps of 2^-10 s, so that times have no round-off
const std::string run = "--set output.envelope=true --set time.step=0.0009765625 --set time.end=0.0625 ";

TEST(Envelope, IsTheLargestOfTheFieldsOfAllSteps) {
  const Everything c;
  const Results all = c.solved(run + "--set output.interval=1e-9"), few = c.solved(run + "--set output.interval=0.025", "few.h5");
  EXPECT_EQ(all.steps().size(), static_cast<size_t>(all.t().size()));
  EXPECT_LT(few.steps().size(), 5u);
  double unseen = 0;  // by the fields of a few outputs
  for (const char* name : {"displacement", "acceleration", "von_mises"}) {
    const auto [most, t] = largest(all, name);
    const double scale = most.maxCoeff();
    EXPECT_GT(scale, 0) << name;
    EXPECT_LT((envelope(all, name) - most).abs().maxCoeff(), 1e-14 * scale) << name;
    EXPECT_LT((envelope(all, std::string(name) + "_time") - t).abs().maxCoeff(), 1e-12) << name;
    EXPECT_TRUE((envelope(few, name) == envelope(all, name)).all()) << name << ": what is put out does not matter";
    unseen = std::max(unseen, (most - largest(few, name).first).maxCoeff() / scale);
  }
  EXPECT_GT(unseen, 0.01) << "or this test would see nothing";
  EXPECT_FALSE(c.solved("--set time.end=0.01", "none.h5").file().has("/envelope"));
}

TEST(Envelope, IsTheSameOnRanks) {
  const Everything c;
  const Results one = c.solved(run + "--set solver.tolerance=1e-12");
  for (const int ranks : {2, 3}) {
    succeeded(mpirun(ranks, "hilo-solve --quiet scene.toml tags.h5 -o ranks.h5 --set solver.tolerance=1e-12 " + run, c.path()));
    const Results other(c / "ranks.h5");
    for (const char* name : {"displacement", "acceleration", "von_mises"}) {
      const Array a = envelope(one, name), b = envelope(other, name);
      EXPECT_LT((a - b).abs().maxCoeff(), 1e-7 * a.maxCoeff()) << name << " on " << ranks;
    }
    EXPECT_LT((envelope(one, "von_mises_time") - envelope(other, "von_mises_time")).abs().maxCoeff(), 1e-9);
  }
}

TEST(Envelope, GoesOnFromACheckpointBitByBit) {
  for (const int ranks : {1, 2}) {
    const Everything c;
    const std::string solve = "hilo-solve --quiet scene.toml tags.h5 --checkpoint 15steps " + run;
    ASSERT_EQ(mpirun(ranks, solve + "-o whole.h5", c.path()).exit, 0);
    ASSERT_EQ(mpirun(ranks, solve + "--set time.end=0.03125 -o run.h5", c.path()).exit, 0);
    const Array half = envelope(Results(c / "run.h5"), "displacement");
    succeeded(mpirun(ranks, "hilo-solve --quiet --restart run.h5 --checkpoint 15steps --set time.end=0.0625", c.path()));
    const Results whole(c / "whole.h5"), parts(c / "run.h5");
    ASSERT_TRUE((whole.t().array() == parts.t().array()).all());
    for (const char* name : {"displacement", "acceleration", "von_mises"})
      for (const char* ending : {"", "_time"})
        EXPECT_TRUE((envelope(whole, std::string(name) + ending) == envelope(parts, std::string(name) + ending)).all()) << name << ending;
    // something was largest before the checkpoint, so that what was kept is needed
    EXPECT_LT(envelope(whole, "von_mises_time").minCoeff(), 0.03);
    EXPECT_GT((envelope(whole, "displacement") - half).maxCoeff(), 0);
  }
}

TEST(Envelope, CannotBeAskedForLater) {
  const Everything c;
  ASSERT_EQ(c.run("hilo-solve --quiet scene.toml tags.h5 --set time.end=0.01 --checkpoint 5steps").exit, 0);
  expect_end(c.run("hilo-solve --quiet --restart run.h5 --accept --set output.envelope=true --set time.end=0.02"), 2,
             "the run that was kept had none");
}

// A rigid block turns about z at w: a point at r from the axis comes 2 r away after half a turn, under the acceleration r w^2.
TEST(Envelope, OfASpinningBlockIsTheDiameter) {
  const Mesh mesh = block_mesh({});
  SceneCase c(solid(1e9, 0.3, 1000) + axial("revolute", "axle", "ground", "block", {0, 0, 0}, {0, 0, 1}) +
              initial("block", "spin = [0, 0, 10]\nabout = [0, 0, 0]") + in_time(0.5, 1e-3) +
              "[output]\ninterval = 0.2\nenvelope = true\n");
  c.use(mesh, {Fidelity::rigid});
  const double w = 10, half_turn = M_PI / w;
  const Results r = c.solved();
  const Array u = envelope(r, "displacement"), a = envelope(r, "acceleration"), t = envelope(r, "displacement_time");
  for (size_t i = 0; i < mesh.X.size(); ++i) {
    const double radius = mesh.X[i].head<2>().norm();
    const auto k = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(u[k], 2 * radius, 1e-5 * radius + 1e-12);  // within half a step of half a turn: 2 r (1 - (w h/4)^2/2)
    EXPECT_NEAR(a[k], radius * w * w, 1e-4 * radius * w * w + 1e-9);
    if (radius > 1e-9) {
      EXPECT_NEAR(t[k], half_turn, 0.6e-3);
    }
  }
  expect_end(c.run("hilo-solve --quiet scene.toml tags.h5 --set 'time.analysis=\"modes\"'"), 2,
             "an analysis of modes or buckling has no steps");
}

TEST(Envelope, IsWhatPeakTells) {
  const Everything c;
  const Results all = c.solved(run + "--set output.interval=1e-9", "all.h5");
  c.solve("--quiet " + run + "--set output.interval=0.025", "few.h5");
  for (const std::string field : {"displacement", "acceleration", "von_mises"}) {
    const Ran whole = c.run("hilo-post peak all.h5 --steps 0,1,2,3,4,5,6,7,8,9,10 --field " + field),
              few = c.run("hilo-post peak few.h5 --field " + field), every = c.run("hilo-post peak all.h5 --field " + field),
              outputs = c.run("hilo-post peak few.h5 --times 0,0.025,0.05 --field " + field);
    ASSERT_EQ(few.exit, 0) << few.err;
    EXPECT_EQ(few.out, every.out);
    if (field == "acceleration") continue;  // largest at the start
    EXPECT_NE(few.out, outputs.out) << field;
    EXPECT_NE(few.out, whole.out) << field;
  }
  EXPECT_EQ(c.run("hilo-post render few.h5 --field von_mises_envelope --steps last --size 320x240 -o a.png").exit, 0);
  EXPECT_EQ(c.run("hilo-post at few.h5 von_mises_envelope_time --node 15").exit, 0);
  EXPECT_NE(c.run("hilo-post at all.h5 velocity_envelope --node 15").exit, 0);
}

// A clamped bar of three pieces, struck between two outputs.  The middle piece has all its nodes in common with others.
TEST(Envelope, TellsRegionsWhoseNodesAreThoseOfOthers) {
  const BlockOptions o{.n = {5, 1, 1}, .high = {1, 0.1, 0.1}, .regions = {"root", "tip", "weld"}, .region_of = [](const Vec3& x) {
                         return x[0] < 0.4 ? 0 : x[0] > 0.6 ? 1 : 2;
                       }};
  SceneCase c(solid(2e11, 0.3, 7850) +
              "[[motion]]\nkind = \"fixed\"\nname = \"clamp\"\non = \"xmin\"\n"
              "[[load]]\nkind = \"force\"\nname = \"F\"\non = \"xmax\"\nforce = [0, 1e3, 0]\n"
              "history = {t = [0, 0.01, 0.02, 1], value = [0, 1, 0, 0]}\n" +
              in_time(0.1, 1e-3) + "[output]\ninterval = 1\nenvelope = true\n");
  c.use(block_mesh(o), {Fidelity::linear, Fidelity::linear, Fidelity::linear});
  c.solved();
  const Ran all = c.run("hilo-post peak run.h5 --unit MPa");
  EXPECT_NE(all.err.find("peaks of \"weld\" there are known at the steps written alone"), std::string::npos) << all.err;
  EXPECT_NE(all.out.find("all steps"), std::string::npos) << all.out;
  const auto row = all.out.find("weld");
  ASSERT_NE(row, std::string::npos);
  EXPECT_NE(all.out.find("steps written", row), std::string::npos) << all.out;
  const Ran shown = c.run("hilo-post peak run.h5 --field von_mises_envelope");
  EXPECT_EQ(shown.out.find("weld"), std::string::npos) << shown.out;
  EXPECT_NE(shown.err.find("\"weld\""), std::string::npos) << shown.err;
}

}  // namespace
}  // namespace hilo::test::envelope_test
