// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numeric>
#include <sstream>

#include "../model/block.hpp"
#include "succeeded.hpp"
#include "tool_case.hpp"

namespace hilo::test::part_test {
namespace {

using test::block;

/// 20 x 4 x 4 hexahedra; the last quarter, `barrel`, is flexible.
Mesh bar() {
  return block(20, 4, 4, {"hull", "barrel"}, [](int i) { return i >= 15; });
}

/// Largest over mean of the number of flexible (or rigid) cells, counted from the file.
double balance(const MeshFile& f, Fidelity fidelity) {
  std::vector<double> count(f.n_parts, 0);
  for (std::int64_t c = 0; c < f.mesh.n_cells(); ++c) count[f.rank[c]] += f.fidelity[f.mesh.region[c]] == fidelity;
  return *std::max_element(count.begin(), count.end()) * f.n_parts / std::accumulate(count.begin(), count.end(), 0.);
}
std::vector<int> cells_of_parts(const MeshFile& f) {
  std::vector<int> count(f.n_parts, 0);
  for (const auto r : f.rank) ++count[r];
  return count;
}

class Part : public ToolCase {
 protected:
  void SetUp() override {
    write_mesh(place / "mesh.h5", bar(), {"hilo-import bar.msh"});
    write_tags(place / "tags.h5", place / "mesh.h5", {Fidelity::rigid, Fidelity::nonlinear}, {"hilo-import bar.msh", "hilo-tag"});
  }
  MeshFile parted(const std::string& arguments) {
    succeeded(place.run("hilo-part " + arguments + " -o parts.h5"));
    return read_mesh_file(place / "parts.h5");
  }
};

TEST_F(Part, FlexibleAndRigidWorkAreBothBalanced) {
  for (const int n : {2, 3, 4, 5, 7, 8}) {
    const MeshFile f = parted("tags.h5 -n " + std::to_string(n));
    EXPECT_EQ(f.n_parts, n);
    EXPECT_LE(balance(f, Fidelity::nonlinear), std::ceil(80. / n) / (80. / n) + 0.051) << n;  // no better than whole cells allow
    EXPECT_LE(balance(f, Fidelity::rigid), 1.5) << n;
    EXPECT_GT(std::ranges::min(cells_of_parts(f)), 0) << n;
  }
}

// A step costs a nonlinear cell a tangent, a linear one nothing: its region is a body with modes.
TEST_F(Part, LinearCellsWeighAsLittleAsRigidOnes) {
  write_tags(place / "linear.h5", place / "mesh.h5", {Fidelity::linear, Fidelity::nonlinear}, {});
  for (const int n : {2, 4, 7}) {
    const auto ran = succeeded(place.run("hilo-part linear.h5 -o parts.h5 -n " + std::to_string(n)));
    const MeshFile f = read_mesh_file(place / "parts.h5");
    EXPECT_LE(balance(f, Fidelity::nonlinear), std::ceil(80. / n) / (80. / n) + 0.051) << n << ran.out;
    EXPECT_LE(balance(f, Fidelity::linear), 1.5) << n;
    expect_words(ran.out, "nonlinear work, ");
    expect_words(ran.out, "(rigid and linear cells)");
  }
  write_tags(place / "all.h5", place / "mesh.h5", {Fidelity::linear, Fidelity::linear}, {});
  EXPECT_LE(balance(parted("all.h5 -n 4"), Fidelity::linear), 1.15);
}

TEST_F(Part, UniformWeightsBalanceCellsAndLeaveTheFlexibleWorkUneven) {
  const MeshFile f = parted("tags.h5 -n 8 --weights uniform");
  const auto cells = cells_of_parts(f);
  EXPECT_LE(*std::max_element(cells.begin(), cells.end()), 42);
  EXPECT_GT(balance(f, Fidelity::nonlinear), 1.5);
}

TEST_F(Part, OnePartHoldsEverything) {
  const MeshFile f = parted("tags.h5 -n 1");
  EXPECT_EQ(f.rank, std::vector<std::int32_t>(320, 0));
  EXPECT_EQ(f.n_parts, 1);
  EXPECT_TRUE(f.tagged);
}

TEST_F(Part, AllRigidAndUntaggedMeshesArePartedToo) {
  write_tags(place / "rigid.h5", place / "mesh.h5", {Fidelity::rigid, Fidelity::rigid}, {});
  EXPECT_LE(balance(parted("rigid.h5 -n 4"), Fidelity::rigid), 1.15);
  const auto ran = place.run("hilo-part mesh.h5 -n 4");
  EXPECT_EQ(ran.err, "hilo-part: mesh.h5 has no tags, so every region is nonlinear\n");
  EXPECT_LE(balance(read_mesh_file(place / "parts-4.h5"), Fidelity::nonlinear), 1.05);
}

TEST_F(Part, EveryCellCanHaveAPartOfItsOwn) {
  write_mesh(place / "small.h5", block(3, 2, 1), {});
  EXPECT_EQ(cells_of_parts(parted("small.h5 -n 6 --quiet")), std::vector<int>(6, 1));
  EXPECT_EQ(std::ranges::min(cells_of_parts(parted("tags.h5 -n 80"))), 1);
}

TEST_F(Part, MoreCostlyShapesWeighMore) {
  // Ten linear hexahedra apart from ten of twenty nodes: two parts of equal work cannot have equal numbers of cells.
  Mesh m = block(10, 1, 1);
  for (int i = 0; i < 10; ++i) {
    std::vector<std::int64_t> nodes;
    for (const Vec3& x : test::reference_nodes(Shape::hex20)) {
      nodes.push_back(m.n_nodes());
      m.X.push_back(x + Vec3(2. * i, 5, 0)), m.node_id.push_back(m.n_nodes());
    }
    m.add_cell(Shape::hex20, nodes, 0, 100 + i);
  }
  write_mesh(place / "mixed.h5", m, {});
  const MeshFile f = parted("mixed.h5 -n 2 --quiet");
  std::vector<int> work(2, 0);
  for (std::int64_t c = 0; c < f.mesh.n_cells(); ++c) work[f.rank[c]] += f.mesh.shape[c] == static_cast<int>(Shape::hex20) ? 540 : 100;
  EXPECT_LE(std::abs(work[0] - work[1]), 540);
}

TEST_F(Part, FiringSceneIsBalancedFromTwoTo128Parts) {
  const std::string scene = HILO_SOURCE "/data/firing/";
  for (const char* size : {"0", "1"}) {
    ASSERT_EQ(place.run("hilo-import --quiet " + scene + "vehicle.geo -o vehicle.h5 --define SIZE=" + size).exit, 0);
    ASSERT_EQ(place.run("hilo-tag --quiet vehicle.h5 " HILO_SOURCE "/data/scaling/tags.toml -o vehicle-tags.h5").exit, 0);
    succeeded(place.run("hilo-part vehicle-tags.h5 " + scene + "scene.toml --table -o table.csv"));
    std::istringstream lines(place.run("cat table.csv").out);
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line.rfind("parts,uniform work,uniform speed-up,weighted work,weighted speed-up,", 0), 0u);
    int rows = 0;
    for (int n = 2; std::getline(lines, line); n *= 2, ++rows) {
      double parts, uniform, slow, weighted, fast, rigid, pieces, flexible_pieces;
      std::replace(line.begin(), line.end(), ',', ' ');
      ASSERT_TRUE(std::istringstream(line) >> parts >> uniform >> slow >> weighted >> fast >> rigid >> pieces >> flexible_pieces) << line;
      EXPECT_EQ(parts, n);
      EXPECT_LE(weighted, 1.05) << size << " " << n;
      EXPECT_GE(weighted, 1) << size << " " << n;
      EXPECT_GT(uniform, 1.9) << size << " " << n;  // a quarter of the cells and fewer are flexible
      EXPECT_GE(fast, n / 1.06);
      EXPECT_LE(slow, n / 1.8);
      EXPECT_LE(pieces, 2 * n + 19) << line;  // of the gun and of the rest, and 19 bodies that hang on joints alone
      EXPECT_LE(flexible_pieces, 1.2 * n + 2) << line;
    }
    EXPECT_EQ(rows, 7);
  }
}

TEST_F(Part, TableEndsWhereFlexibleCellsDo) {
  const auto ran = place.run("hilo-part tags.h5 --table -n 128 --json");  // 80 of them
  EXPECT_NE(ran.out.find("\"parts\": 64"), std::string::npos) << ran.out << ran.err;
  EXPECT_EQ(ran.out.find("\"parts\": 128"), std::string::npos) << ran.out;
}

TEST_F(Part, ChainOfBarsIsCutIntoConnectedParts) {
  Mesh m;
  m.region_name = {"chain"};
  for (std::int64_t i = 0; i <= 40; ++i) m.X.emplace_back(i, 0, 0), m.node_id.push_back(i);
  for (std::int64_t i = 0; i < 40; ++i) m.add_cell(Shape::bar2, std::vector<std::int64_t>{i, i + 1}, 0, i);
  write_mesh(place / "chain.h5", m, {});
  const MeshFile f = parted("chain.h5 -n 4 --quiet");
  int changes = 0;
  for (size_t c = 1; c < f.rank.size(); ++c) changes += f.rank[c] != f.rank[c - 1];
  EXPECT_EQ(changes, 3);
}

TEST_F(Part, TableAgreesWithTheFile) {
  const auto ran = place.run("hilo-part tags.h5 -n 2 -o parts.h5");
  const MeshFile f = read_mesh_file(place / "parts.h5");
  const auto cells = cells_of_parts(f);
  EXPECT_EQ(ran.out.find("part  cells  nonlinear  nonlinear work  other work  pieces\n"), 0u) << ran.out;
  EXPECT_NE(ran.out.find("   0    " + std::to_string(cells[0])), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("\nweighted: largest divided by mean: 1.0"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("\nuniform: largest divided by mean: 2.000 nonlinear work"), std::string::npos) << ran.out;
  EXPECT_EQ(f.provenance.back(), "hilo-part tags.h5 -n 2 -o parts.h5");
  // Facets between parts, counted from the nodes that cells share.
  std::map<std::set<std::int64_t>, std::vector<std::int64_t>> facets;
  for (std::int64_t c = 0; c < f.mesh.n_cells(); ++c)
    for (std::int64_t k = 0; k < 6; ++k) {
      const auto nodes = f.mesh.facet_nodes({c, k});
      facets[{nodes.begin(), nodes.end()}].push_back(c);
    }
  int cut = 0;
  for (const auto& [nodes, cells_at] : facets) cut += cells_at.size() == 2 && f.rank[cells_at[0]] != f.rank[cells_at[1]];
  EXPECT_NE(ran.out.find("other work (rigid and linear cells); cut " + std::to_string(cut) + " facets"), std::string::npos) << cut << "\n"
                                                                                                                            << ran.out;
}

TEST_F(Part, SameInputGivesSameBytes) {
  place.run("hilo-part tags.h5 -n 7 -o parts.h5 && mv parts.h5 first.h5");
  EXPECT_EQ(place.run("hilo-part tags.h5 -n 7 -o parts.h5 && cmp parts.h5 first.h5").exit, 0);
}

TEST_F(Part, JointsOfASceneKeepTheirEndsTogether) {
  // Two blocks that share no node: a joint between them is an edge of the graph and work of a cell.
  Mesh m = block(8, 1, 1, {"a", "b"});
  const Mesh other = block(8, 1, 1);
  for (const Vec3& x : other.X) m.X.push_back(x + Vec3(9, 0, 0)), m.node_id.push_back(m.n_nodes());
  for (std::int64_t c = 0; c < 8; ++c) {
    std::vector<std::int64_t> nodes;
    for (const auto n : other.cell(c)) nodes.push_back(n + other.n_nodes());
    m.add_cell(Shape::hex8, nodes, 1, 100 + c);
  }
  write_mesh(place / "two.h5", m, {});
  place.write("scene.toml",
              "[[joint]]\nkind = \"spherical\"\nname = \"pin\"\na = \"a\"\nb = \"b\"\nat = [8.5, 0.5, 0.5]\n[time]\nend = 1.0\nstep = 0.1\n"
              "[material.steel]\nE = 2e11\nnu = 0.3\ndensity = 7800\n[region.\"*\"]\nmaterial = \"steel\"\n");
  const auto ran = succeeded(place.run("hilo-part two.h5 scene.toml -n 2 --quiet --json"));
  EXPECT_NE(ran.out.find("\"joints\": 1"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("\"pieces\": 1"), std::string::npos) << ran.out;
  EXPECT_EQ(ran.out.find("\"pieces\": 2", ran.out.find("\"parts\": [")), std::string::npos) << ran.out;
  std::int64_t work = 0;
  for (size_t at = ran.out.find("\"nonlinear work\": "); at != std::string::npos; at = ran.out.find("\"nonlinear work\": ", at + 1))
    work += std::stoi(ran.out.substr(at + 18));
  EXPECT_EQ(work, 16 * 100 + 16);
}

TEST_F(Part, WrongRequestsHaveTheirExitCodes) {
  expect_refused("hilo-part tags.h5", 1, "--parts is required (see hilo-part --help)");
  expect_refused("hilo-part tags.h5 -n 0", 1, "--parts: Value 0 not in range 1 to 1048576 (see hilo-part --help)");
  expect_refused("hilo-part tags.h5 -n 2 --weigths uniform", 1, "unknown option --weigths (did you mean \"--weights\"?)");
  expect_refused("hilo-part tags.h5 -n 2 -o tags.h5", 1, "tags.h5: would overwrite the file it reads (give another -o)");
  expect_refused("hilo-part tags.h5 -n 81", 2, "tags.h5: 81 parts of 80 nonlinear cells would leave parts without work (at most 80)");
  expect_refused("hilo-part none.h5 -n 2", 2, "none.h5: no such file");
  expect_refused("hilo-part tags.h5 none.toml -n 2", 2, "none.toml: no such file");
  expect_refused("hilo-part tags.h5 -n 2 -o nowhere/parts.h5", 4, "nowhere/parts.h5: cannot write: No such file or directory");
  place.run("mv mesh.h5 elsewhere.h5");
  expect_refused("hilo-part tags.h5 -n 2", 2,
                 "tags.h5: mesh is in mesh.h5, which is missing (files that belong together stay in the same places)");
}

TEST_F(Part, HelpEndsWithAnExampleThatRuns) {
  const auto help = place.run("hilo-part --help").out;
  ASSERT_NE(help.rfind("Example:\n"), std::string::npos);
  EXPECT_EQ(place.run(help.substr(help.rfind("Example:\n") + 9)).exit, 0);
}

}  // namespace
}  // namespace hilo::test::part_test
