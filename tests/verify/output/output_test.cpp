// SPDX-License-Identifier: GPL-3.0-or-later
// What the results hold does not depend on how much of it is kept, nor on who writes it.  Truth: the run that one rank writes whole.
#include "model/block.hpp"
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::output_test {
namespace {

constexpr int nx = 12, ny = 10, nz = 10, border = 5;  // more rows than a rank writes by itself

const std::string scene = "title = \"Two blocks of rubber on a floor, pushed at their end\"\n" + solid(1e6, 0.3, 1000, "front") +
                          solid(1e6, 0.3, 1000, "back") + held("left") + force("push", "end", {0, 0, 2e5}) + in_time(0.02, 5e-3) +
                          "[output]\ninterval = 0.01\n";

void use_two_blocks(Case& c) {
  Mesh mesh = block(nx, ny, nz, {"front", "back"}, [](int i) { return i < border ? 0 : 1; });
  for (std::int64_t n = 0; n < mesh.n_nodes(); ++n)
    if (mesh.X[n].x() == nx) mesh.node_sets["end"].push_back(n);
  c.use(mesh);
}

Results on_ranks(const Case& c, int ranks, const std::string& options, const std::string& output) {
  const std::string parts = fmt::format("parts-{}.h5", ranks);
  EXPECT_EQ(c.run(fmt::format("hilo-part --quiet mesh.h5 -n {} -o {}", ranks, parts)).exit, 0);
  succeeded(mpirun(ranks, fmt::format("hilo-solve --quiet scene.toml {} {} -o {}", parts, options, output), c.path()));
  return c.results(output);
}

/// Largest difference of the rows `nodes` of a field from those of `part`, over the peak of the field.
double difference(const Results& whole, const Results& part, const std::string& field, const std::vector<std::int64_t>& nodes) {
  double worst = 0, peak = 0;
  for (const std::string& step : whole.steps()) {
    const auto a = whole.table("/field/" + step + "/" + field), b = part.table("/field/" + step + "/" + field);
    EXPECT_EQ(b.rows(), static_cast<Eigen::Index>(nodes.size())) << field;
    for (size_t i = 0; i < nodes.size(); ++i) worst = std::max(worst, (a.row(nodes[i]) - b.row(i)).cwiseAbs().maxCoeff());
    peak = std::max(peak, a.cwiseAbs().maxCoeff());
  }
  EXPECT_GT(peak, 0) << field;
  return worst / peak;
}

const char* const fields[] = {"displacement", "velocity", "acceleration", "stress", "von_mises", "stress_error"};

std::vector<std::int64_t> all_nodes() {
  std::vector<std::int64_t> nodes;
  for (std::int64_t n = 0; n < (nx + 1) * (ny + 1) * (nz + 1); ++n) nodes.push_back(n);
  return nodes;
}

/// A node of the blocks is on the skin of a region unless it lies strictly inside one of the two.
std::vector<std::int64_t> skin_nodes() {
  std::vector<std::int64_t> nodes;
  for (const std::int64_t n : all_nodes()) {
    const auto i = n % (nx + 1), j = n / (nx + 1) % (ny + 1), k = n / (nx + 1) / (ny + 1);
    if (i % nx == 0 || i == border || j % ny == 0 || k % nz == 0) nodes.push_back(n);
  }
  return nodes;
}

TEST(Output, OfTheSkinIsThatOfAllNodesOnTheSurfacesOfRegions) {
  SceneCase c(scene);
  use_two_blocks(c);
  const Results all = c.solved("", "all.h5"), skin = c.solved("--set 'output.nodes=\"skin\"'", "skin.h5");
  EXPECT_EQ(skin.file().read<std::int64_t>("/skin/node"), skin_nodes());
  for (const char* field : fields) EXPECT_EQ(difference(all, skin, field, skin_nodes()), 0) << field;
  // two closed boxes of quadrilaterals, each an XDMF number and four nodes
  const std::int64_t facets = 4 * ny * nz + 2 * nx * (ny + nz);
  EXPECT_EQ(skin.file().shape("/xdmf/region"), std::vector<std::int64_t>{facets});
  EXPECT_EQ(skin.file().shape("/xdmf/topology"), std::vector<std::int64_t>{5 * facets});
  EXPECT_EQ(c.run("hilo-show --check skin.h5").exit, 0);
}

TEST(Output, OfTheSkinIsEnoughForPicturesAndPeaksOfRegionsButNotForCuts) {
  SceneCase c(scene);
  use_two_blocks(c);
  c.solved("", "all.h5"), c.solved("--set 'output.nodes=\"skin\"'", "skin.h5");
  const Ran peak = succeeded(c.run("hilo-post peak skin.h5 --field displacement --hide front"));
  EXPECT_EQ(peak.out, c.run("hilo-post peak all.h5 --field displacement --hide front").out) << "the largest displacement is at the surface";
  const std::string picture = "hilo-post render --steps last --hide back --size 200x150 ";
  ASSERT_EQ(c.run(picture + "all.h5 -o all.png").exit, 0);
  succeeded(c.run(picture + "skin.h5 -o skin.png"));
  EXPECT_EQ(c.run("cmp all.png skin.png").exit, 0) << "every pixel";
  expect_end(c.run("hilo-post render skin.h5 --cut y=5 -o cut.png"), 2, "output.nodes");
}

TEST(Output, IsTheSameWhoeverWritesIt) {
  SceneCase c(scene);
  use_two_blocks(c);
  const Results one = c.solved("", "one.h5");
  for (const int ranks : {2, 3}) {
    const Results whole = on_ranks(c, ranks, "", "whole.h5");
    const Results skin = on_ranks(c, ranks, "--set 'output.nodes=\"skin\"'", "skin.h5");
    EXPECT_EQ(skin.file().read<std::int64_t>("/skin/node"), skin_nodes());
    for (const char* field : fields) {
      EXPECT_LT(difference(one, whole, field, all_nodes()), 1e-8) << field << " on " << ranks;
      EXPECT_LT(difference(one, skin, field, skin_nodes()), 1e-8) << field << " on " << ranks;
    }
    EXPECT_EQ(one.file().read<std::int64_t>("/xdmf/topology"), whole.file().read<std::int64_t>("/xdmf/topology"));
    EXPECT_EQ(one.file().read<double>("/xdmf/X"), whole.file().read<double>("/xdmf/X"));
    EXPECT_EQ(whole.file().shape("/parts/rank"), std::vector<std::int64_t>{nx * ny * nz});
    EXPECT_EQ(c.run("hilo-show --check whole.h5 && hilo-show --check skin.h5").exit, 0);
  }
}

TEST(Output, InSinglePrecisionIsRoundedAndHalfAsLarge) {
  SceneCase c(scene);
  use_two_blocks(c);
  const Results fine = c.solved("", "double.h5"), single = c.solved("--set 'output.precision=\"single\"'", "single.h5");
  double largest = 0;
  for (const char* field : fields) {
    EXPECT_EQ(single.file().type("/field/000001/" + std::string(field)), "f4");
    largest = std::max(largest, difference(fine, single, field, all_nodes()));
  }
  EXPECT_LT(largest, 6e-8) << "half a unit in the last place of 24 bits";
  EXPECT_GT(largest, 0);
}

/// Fields at the first step at or behind each multiple of output.interval, and at the end.  A run that goes on has those of one that was
/// never cut.
TEST(Output, HasTheLastStateWhateverTheInterval) {
  SceneCase c(scene);
  Mesh mesh = block(2, 2, 2, {"front", "back"}, [](int i) { return i; });
  for (std::int64_t n = 0; n < mesh.n_nodes(); ++n)
    if (mesh.X[n].x() == 2) mesh.node_sets["end"].push_back(n);
  c.use(mesh);
  const auto times = [&](const Results& r) {
    std::string out;
    for (const std::string& step : r.steps()) out += fmt::format(" {:g}", 1e3 * r.field_time(step));
    return out;
  };
  const std::string by = "--set time.step=1e-3 --set output.interval=6e-3 ";
  EXPECT_EQ(times(c.solved(by, "run.h5")), " 0 6 12 18 20");
  EXPECT_EQ(times(c.solved(by + "--set output.interval=1", "ends.h5")), " 0 20");
  (void)c.solved(by + "--set time.end=0.01 --checkpoint 5steps", "cut.h5");
  EXPECT_EQ(times(c.results("cut.h5")), " 0 6 10");
  succeeded(c.run("hilo-solve --quiet --restart cut.h5 --set time.end=0.02"));
  EXPECT_EQ(times(c.results("cut.h5")), " 0 6 12 18 20");
}

}  // namespace
}  // namespace hilo::test::output_test
