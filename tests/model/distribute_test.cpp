// SPDX-License-Identifier: GPL-3.0-or-later
// The mesh spread over ranks is the mesh of the file.  The suite DISABLED_Spread runs on 1 to 4 ranks, in a folder with the files.
#include <algorithm>
#include <numeric>

#include "../ranks.hpp"
#include "base/error.hpp"
#include "block.hpp"
#include "model/local_mesh.hpp"
#include "model/partition.hpp"

namespace hilo::test::distribute_test {
namespace {

using test::block;
using test::Folder;

/// Three regions along x, of which the middle one is rigid; sets of all kinds; a node of no cell.
Mesh sample() {
  Mesh m = block(12, 4, 3, {"near", "middle", "far"}, [](int i) { return i / 4; });
  for (auto& id : m.node_id) id += 1000;
  m.node_sets["tip"] = {m.n_nodes() - 1};
  m.node_sets["none"] = {};
  m.node_sets["few"] = {7, 3, 40};
  for (std::int64_t c = 0; c < m.n_cells(); ++c)
    if (c % 5 == 0) m.facet_sets["scattered"].push_back({c, c % 6});
  for (std::int64_t c = 0; c < m.n_cells(); c += 7) m.cell_sets["every seventh"].push_back(c);
  m.cell_sets["middle"] = {0};  // shares the name of a region, which goes before
  m.deck_scene = "[time]\n";
  return m;
}

/// Rows of the file that a rank has, gathered on all ranks; sorted.
std::vector<std::int64_t> gathered(std::vector<std::int64_t> rows) {
  const Comm& comm = Comm::world();
  std::vector<std::int64_t> all;
  for (const auto& list : comm.exchange(std::vector(comm.size, rows))) all.insert(all.end(), list.begin(), list.end());
  std::sort(all.begin(), all.end());
  return all;
}

class DISABLED_Spread : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    const int n = Comm::world().size;
    const bool reordered = GetParam() == "reordered";
    file = GetParam() == "parts" ? "parts-" + std::to_string(n) + ".h5" : (reordered ? "tags" : GetParam()) + ".h5";
    whole = read_mesh_file(file);
    local = read_local_mesh(file, Comm::world());
    if (reordered) {
      std::vector<char> marked;
      for (const auto row : local.node_global) marked.push_back(row * row % 7 == 2);
      const auto n_marked = local.put_first(marked);
      for (size_t i = 0; i < marked.size(); ++i)
        EXPECT_EQ(local.node_global[i] * local.node_global[i] % 7 == 2, static_cast<std::int64_t>(i) < n_marked);
    }
  }
  std::vector<std::int64_t> rows(const std::vector<std::int64_t>& nodes) const {
    std::vector<std::int64_t> out;
    for (const auto i : nodes) out.push_back(local.node_global.at(i));
    std::sort(out.begin(), out.end());
    return out;
  }
  std::string file;
  MeshFile whole;
  LocalMesh local;
};
INSTANTIATE_TEST_SUITE_P(DISABLED_Spread, DISABLED_Spread, testing::Values("mesh", "tags", "parts", "reordered"),
                         [](const auto& p) { return p.param; });

TEST_P(DISABLED_Spread, EveryCellIsOnOneRankAndIsTheCellOfTheFile) {
  std::vector<std::int64_t> all(whole.mesh.shape.size());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(gathered(local.cell_global), all);
  EXPECT_EQ(local.n_cells_global, whole.mesh.n_cells());
  const Mesh& m = local.mesh;
  ASSERT_EQ(m.n_cells(), static_cast<std::int64_t>(local.cell_global.size()));
  for (std::int64_t c = 0; c < m.n_cells(); ++c) {
    const auto g = local.cell_global[c];
    EXPECT_EQ(m.shape[c], whole.mesh.shape[g]);
    EXPECT_EQ(m.region[c], whole.mesh.region[g]);
    EXPECT_EQ(m.cell_id[c], whole.mesh.cell_id[g]);
    ASSERT_EQ(m.cell(c).size(), whole.mesh.cell(g).size());
    for (size_t a = 0; a < m.cell(c).size(); ++a) EXPECT_EQ(local.node_global[m.cell(c)[a]], whole.mesh.cell(g)[a]);
    if (GetParam() == "parts" && Comm::world().size > 1) {
      EXPECT_EQ(whole.rank[g], Comm::world().rank);
    }
  }
}

TEST_P(DISABLED_Spread, EveryNodeIsOwnedOnceByALowestRankThatHasACellOfIt) {
  std::vector<std::int64_t> all(whole.mesh.X.size()), owned, with_cell;
  std::iota(all.begin(), all.end(), 0);
  std::vector<char> has_cell(local.node_global.size(), 0);
  for (const auto i : local.mesh.nodes) has_cell[i] = 1;
  for (size_t i = 0; i < local.node_global.size(); ++i)
    if (local.node_owned[i]) owned.push_back(local.node_global[i]);
  EXPECT_EQ(gathered(owned), all);
  EXPECT_EQ(local.n_nodes_global, whole.mesh.n_nodes());
  // no rank below the owner has a cell of the node
  std::vector<std::int64_t> facts;
  for (size_t i = 0; i < local.node_global.size(); ++i)
    if (has_cell[i]) facts.push_back(local.node_global[i] * 64 + 2 * Comm::world().rank + (local.node_owned[i] ? 0 : 1));
  const auto sorted = gathered(facts);
  for (size_t k = 0; k < sorted.size(); ++k) {
    const bool first = k == 0 || sorted[k] / 64 != sorted[k - 1] / 64;
    EXPECT_EQ(sorted[k] % 2 == 0, first) << "node " << sorted[k] / 64;
  }
}

TEST_P(DISABLED_Spread, PlacesAndNumbersOfNodesAreThoseOfTheFile) {
  ASSERT_EQ(local.mesh.X.size(), local.node_global.size());
  for (size_t i = 0; i < local.node_global.size(); ++i) {
    EXPECT_EQ(local.mesh.X[i], whole.mesh.X[local.node_global[i]]);
    EXPECT_EQ(local.mesh.node_id[i], whole.mesh.node_id[local.node_global[i]]);
  }
  EXPECT_NEAR(local.length, std::sqrt(12. * 12 + 4 * 4 + 3 * 3), 1e-14);
}

TEST_P(DISABLED_Spread, RegionsTagsAndTextsAreOnEveryRank) {
  EXPECT_EQ(local.mesh.region_name, whole.mesh.region_name);
  EXPECT_EQ(local.mesh.region_data.size(), whole.mesh.region_data.size());
  EXPECT_EQ(local.fidelity, whole.fidelity);
  EXPECT_EQ(local.tagged, whole.tagged);
  EXPECT_EQ(local.provenance, whole.provenance);
  EXPECT_EQ(local.mesh.deck_scene, whole.mesh.deck_scene);
  EXPECT_EQ(local.mesh.all_names(), whole.mesh.all_names());
  EXPECT_EQ(local.file, file);
}

TEST_P(DISABLED_Spread, EverySetHasTheLocalPartOfItsEntries) {
  std::vector<char> here(whole.mesh.X.size(), 0);
  for (const auto g : local.node_global) here[g] = 1;
  for (const auto& [name, set] : whole.mesh.node_sets) {
    std::vector<std::int64_t> expected;
    for (const auto g : set)
      if (here[g]) expected.push_back(g);
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(rows(local.mesh.node_sets.at(name)), expected) << name;
  }
  for (const auto& [name, set] : whole.mesh.cell_sets) {
    std::vector<std::int64_t> mine, expected = set;
    for (const auto c : local.mesh.cell_sets.at(name)) mine.push_back(local.cell_global.at(c));
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(gathered(mine), expected) << name;
  }
  for (const auto& [name, set] : whole.mesh.facet_sets) {
    std::vector<std::int64_t> mine, expected;
    for (const auto& f : local.mesh.facet_sets.at(name)) mine.push_back(10 * local.cell_global.at(f.cell) + f.facet);
    for (const auto& f : set) expected.push_back(10 * f.cell + f.facet);
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(gathered(mine), expected) << name;
  }
}

TEST_P(DISABLED_Spread, NodesOfANameAreCompleteOnEveryRankThatHasThem) {
  for (const auto& name : whole.mesh.all_names()) {
    std::vector<std::int64_t> expected;
    for (const auto g : whole.mesh.nodes_of(name, ""))
      if (std::find(local.node_global.begin(), local.node_global.end(), g) != local.node_global.end()) expected.push_back(g);
    EXPECT_EQ(rows(local.nodes_of(name, "")), expected) << name;
  }
}

TEST_P(DISABLED_Spread, TheNodeOfASetOfOneIsOnEveryRank) {
  const auto& tip = local.mesh.node_sets.at("tip");
  ASSERT_EQ(tip.size(), 1u);
  EXPECT_EQ(local.node_global[tip[0]], whole.mesh.node_sets.at("tip")[0]);
}

TEST_P(DISABLED_Spread, FlexibleAndRigidCellsAreBothBalanced) {
  if (GetParam() == "parts") GTEST_SKIP() << "the parts file decides";
  const Comm& comm = Comm::world();
  for (const auto f : {Fidelity::nonlinear, Fidelity::rigid}) {
    double n = 0;
    for (const auto r : local.mesh.region) n += local.fidelity[r] == f;
    EXPECT_LE(comm.max(n), std::ceil(1.05 * comm.sum(n) / comm.size) + 1);
  }
}

TEST(DISABLED_SpreadFaults, PartsForOtherRanksAreRefusedByName) {
  const int n = Comm::world().size;
  if (n == 1) {
    EXPECT_EQ(read_local_mesh("parts-3.h5", Comm::world()).mesh.n_cells(), 144);
    return;
  }
  const std::string other = "parts-" + std::to_string(n + 1) + ".h5";
  try {
    read_local_mesh(other, Comm::world());
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.where, other);
    EXPECT_EQ(e.message, "made for " + std::to_string(n + 1) + " parts, this run has " + std::to_string(n) + " ranks");
    EXPECT_EQ(e.exit, Exit::input);
  }
}

TEST(DISABLED_SpreadFaults, DamageInOneSliceIsTheSameErrorOnAllRanks) {
  for (const auto& [name, message] : {std::pair("bad-node.h5", "damaged: /mesh/cells/nodes holds 777777"),
                                      std::pair("bad-set.h5", "damaged: /mesh/sets/nodes/few holds -5")}) {
    try {
      read_local_mesh(name, Comm::world());
      FAIL();
    } catch (const Error& e) {
      EXPECT_EQ(e.message.substr(0, std::string(message).size()), message);
      EXPECT_EQ(e.exit, Exit::input);
    }
  }
}

TEST(DISABLED_SpreadFaults, MissingFilesAreTheSameErrorOnAllRanks) { EXPECT_THROW(read_local_mesh("nowhere.h5", Comm::world()), Error); }

TEST(Distribute, MeshIsTheSameOnOneToFourRanks) {
  const Folder folder;
  const Mesh m = sample();
  write_mesh(folder / "mesh.h5", m, {"test"});
  write_tags(folder / "tags.h5", folder / "mesh.h5", {Fidelity::nonlinear, Fidelity::rigid, Fidelity::nonlinear}, {"test", "tag"});
  for (int n = 1; n <= 5; ++n) {
    std::vector<std::int32_t> rank;
    for (std::int64_t c = 0; c < m.n_cells(); ++c) rank.push_back(static_cast<std::int32_t>((c * 7 / 3) % n));
    write_parts(folder / ("parts-" + std::to_string(n) + ".h5"), folder / "tags.h5", n, rank, {"test", "tag", "part"});
  }
  Mesh bad = sample();
  bad.nodes[bad.nodes.size() - 20] = 777777;
  write_mesh(folder / "bad-node.h5", bad, {});
  bad = sample();
  bad.node_sets["few"][0] = -5;
  write_mesh(folder / "bad-set.h5", bad, {});
  for (int n = 1; n <= 4; ++n)
    for (const char* suite : {"Spread", "SpreadFaults"}) test::expect_passes_on(n, suite, folder.path().string());
}

TEST(Distribute, MoreRanksThanCellsLeavesSomeEmpty) {
  const Folder folder;
  write_mesh(folder / "mesh.h5", test::one_cell(Shape::tet10), {});
  test::expect_passes_on(3, "Few", folder.path().string());
}

TEST(DISABLED_Few, OneCellOnThreeRanksIsOnOneOfThem) {
  const LocalMesh local = read_local_mesh("mesh.h5", Comm::world());
  EXPECT_EQ(gathered(local.cell_global), std::vector<std::int64_t>{0});
  std::vector<std::int64_t> owned;
  for (size_t i = 0; i < local.node_global.size(); ++i)
    if (local.node_owned[i]) owned.push_back(local.node_global[i]);
  EXPECT_EQ(gathered(owned).size(), 10u);
}

TEST(Partition, BisectionBalancesUnequalWorkOnAnyNumberOfParts) {
  Cloud cloud;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 20; ++j)
      for (int k = 0; k < 10; ++k) {
        cloud.x.emplace_back(i, j, k);
        cloud.work.push_back(1 + i % 3);
        cloud.kind.push_back(j < 5);
      }
  for (const int n : {1, 2, 3, 5, 7, 8}) {
    const auto part = bisect(cloud, n, Comm::world());
    for (const int kind : {0, 1}) {
      std::vector<double> work(n, 0.0);
      for (size_t i = 0; i < part.size(); ++i)
        if (cloud.kind[i] == kind) work.at(part[i]) += cloud.work[i];
      const double mean = std::accumulate(work.begin(), work.end(), 0.0) / n;
      for (const double w : work) EXPECT_NEAR(w, mean, 0.02 * mean + 3) << n << " parts";
    }
  }
}

}  // namespace
}  // namespace hilo::test::distribute_test
