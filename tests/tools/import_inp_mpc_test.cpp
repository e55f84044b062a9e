// SPDX-License-Identifier: GPL-3.0-or-later
// *MPC of .inp decks: distances, lines and planes that hold at large turns, and that hold nothing else.
#include <fmt/format.h>

#include "import_case.hpp"
#include "model/scene.hpp"

namespace hilo::test::import_inp_mpc_test {
namespace {

/// A soft bar of four cubes of 1 m along x: nodes 1 to 4 at its foot, 17 to 20 at its head; 100 of no cell.
std::string bar(double nu) {
  std::string s = "*NODE\n100, 9, 9, 9\n";
  const int y[] = {0, 1, 1, 0}, z[] = {0, 0, 1, 1};
  for (int i = 0; i < 20; ++i) s += fmt::format("{}, {}, {}, {}\n", i + 1, i / 4, y[i % 4], z[i % 4]);
  s += "*ELEMENT, TYPE=C3D8, ELSET=bar\n";
  for (int c = 0; c < 4; ++c) {
    s += fmt::format("{}", c + 1);
    for (int a = 1; a <= 8; ++a) s += fmt::format(", {}", 4 * c + a);
    s += "\n";
  }
  return s + fmt::format(
                 "*NSET, NSET=foot, GENERATE\n1, 4\n*NSET, NSET=head, GENERATE\n17, 20\n*NSET, NSET=edge, GENERATE\n2, 18, 4\n"
                 "*MATERIAL, NAME=m\n*ELASTIC\n1e6, {}\n*DENSITY\n1000.\n*SOLID SECTION, ELSET=bar, MATERIAL=m\n*BOUNDARY\nfoot, 1, 3\n",
                 nu);
}
const std::string statics = "*STEP, NLGEOM\n*STATIC\n*CLOAD\n", end = "*END STEP\n", bend = "head, 3, 4e3\n",
                  warp = "17, 1, 3e4\n18, 1, -3e4\n19, 1, 3e4\n20, 1, -3e4\n", pull = "head, 1, 4e4\n";

class ImportInpMpc : public test::Import {
 protected:
  /// Where the nodes are at the end, by number.
  std::map<std::int64_t, Vec3> run(const std::string& text) {
    solve(text);
    std::map<std::int64_t, Vec3> x;
    if (HasFatalFailure()) return x;
    EXPECT_EQ(err.find("not read"), std::string::npos) << err;
    const Store store = Store::open(place / "run.h5");
    const auto frames = store.list("/field");
    const auto u = store.read<double>("/field/" + frames.back() + "/displacement");
    const Mesh m = read_mesh_file(place / "out.h5").mesh;
    for (size_t a = 0; a < m.X.size(); ++a) x[m.node_id[a]] = m.X[a] + Vec3(u[3 * a], u[3 * a + 1], u[3 * a + 2]);
    return x;
  }
};

double off_plane(const std::map<std::int64_t, Vec3>& x) {
  return std::abs((x.at(18) - x.at(17)).cross(x.at(19) - x.at(17)).normalized().dot(x.at(20) - x.at(17)));
}
double off_line(const std::map<std::int64_t, Vec3>& x) {
  double most = 0;
  for (const int a : {6, 10, 14}) most = std::max(most, (x.at(18) - x.at(2)).normalized().cross(x.at(a) - x.at(2)).norm());
  return most;
}

TEST_F(ImportInpMpc, NodesOfABeamKeepTheirDistanceAtLargeTurns) {
  const std::string apart = "17, 3, -2e4\n19, 3, 2e4\n17, 2, -2e4\n19, 2, 2e4\n";
  const auto free = run(bar(0) + statics + bend + apart + end);
  EXPECT_GT((free.at(17) - free.at(19)).norm(), 1.1 * std::sqrt(2));
  for (const std::string mpc : {"BEAM, 17, 19\n", "LINK, 17, 19\n", "BEAM, 17, 0,\n19\n"}) {
    const auto x = run(bar(0) + "*MPC\n" + mpc + statics + bend + apart + end);
    if (x.empty()) return;
    EXPECT_NEAR((x.at(17) - x.at(19)).norm(), std::sqrt(2), 1e-9) << mpc;
    EXPECT_GT(std::abs(x.at(17).x() - x.at(19).x()), .1) << "it turns";
  }
}

// Of sets each pair; a set against one node.
TEST_F(ImportInpMpc, ABeamOfSetsIsOneOfEachPair) {
  const std::string sets = "*NSET, NSET=a, UNSORTED\n17, 18\n*NSET, NSET=b, UNSORTED\n19, 20\n";
  for (const auto& [mpc, pairs] : {std::pair<std::string, std::vector<std::array<int, 2>>>{"BEAM, a, b\n", {{17, 19}, {18, 20}}},
                                   {"BEAM, b, 17\n", {{19, 17}, {20, 17}}}}) {
    const auto x = run(bar(0) + sets + "*MPC\n" + mpc + statics + bend + warp + end);
    if (x.empty()) return;
    for (const auto& [a, b] : pairs) EXPECT_NEAR((x.at(a) - x.at(b)).norm(), a + b == 37 ? 1 : std::sqrt(2), 1e-9) << mpc << a;
  }
}

TEST_F(ImportInpMpc, NodesOfAPlaneStayInOneThatTurns) {
  const auto free = run(bar(0) + statics + bend + warp + end);
  EXPECT_GT(off_plane(free), .01);
  for (const std::string nodes : {"head", "17, 18, 19, 20", "20, 17, 17,\n18, 19"}) {
    const auto x = run(bar(0) + "*MPC\nPLANE, " + nodes + "\n" + statics + bend + warp + end);
    if (x.empty()) return;
    EXPECT_LT(off_plane(x), 1e-9) << nodes;
    EXPECT_LT(std::abs((x.at(18) - x.at(17)).cross(x.at(19) - x.at(17)).normalized().x()), std::cos(.2)) << "it turns";
  }
}

TEST_F(ImportInpMpc, NodesOfALineStayOnOneThatTurns) {
  const auto free = run(bar(0) + statics + bend + end);
  EXPECT_GT(off_line(free), .01);
  for (const std::string nodes : {"edge", "10, 2, 6, 14, 18"}) {
    const auto x = run(bar(0) + "*MPC\nSTRAIGHT, " + nodes + "\n" + statics + bend + "edge, 1, 1e4\n" + end);
    if (x.empty()) return;
    EXPECT_LT(off_line(x), 1e-9) << nodes;
    EXPECT_LT((x.at(18) - x.at(2)).normalized().x(), std::cos(.1)) << "it turns";
    EXPECT_GT((x.at(18) - x.at(2)).norm(), 4.01) << "and its nodes slide along it";
  }
}

// A pull keeps the head plane and, without lateral contraction, the edge straight: the answer is that without a card.
TEST_F(ImportInpMpc, WhatStaysPlaneOrStraightByItselfMovesAsWithoutTheCard) {
  const std::pair<double, const char*> cases[] = {{.3, "PLANE, head\n"}, {0, "STRAIGHT, edge\n"}};
  for (const auto& [nu, mpc] : cases) {
    const auto free = run(bar(nu) + statics + pull + end), x = run(bar(nu) + "*MPC\n" + mpc + statics + pull + end);
    if (x.empty()) return;
    EXPECT_GT(x.at(17).x(), 4.1);
    for (const auto& [a, at] : free) EXPECT_LT((x.at(a) - at).norm(), 1e-7) << mpc << a;
  }
}

TEST_F(ImportInpMpc, TheyHoldInARunInTimeToo) {
  const auto x = run(bar(0) + "*MPC\nPLANE, head\nSTRAIGHT, edge\nBEAM, 17, 19\n*STEP, NLGEOM\n*DYNAMIC, DIRECT\n.02, .4\n*CLOAD\n" + bend +
                     warp + end);
  if (x.empty()) return;
  EXPECT_LT(off_plane(x), 1e-8);
  EXPECT_LT(off_line(x), 1e-8);
  EXPECT_NEAR((x.at(17) - x.at(19)).norm(), std::sqrt(2), 1e-8);
  EXPECT_GT((x.at(17) - Vec3(4, 0, 0)).norm(), .01);
}

TEST_F(ImportInpMpc, WhatIsNotReadIsToldByName) {
  const std::pair<std::string, const char*> cases[] = {
      {"MEANROT, 17, 17, 17, 18, 18, 18,\n19, 19, 19, 100\n", "not read: *MPC, MEANROT (1, a.inp:42)"},
      {"PLANE, 1, 5, 9, 13\n", "not read: *MPC, PLANE of nodes on a line (1,"},
      {"PLANE, 17, 18, 19, 13\n", "not read: *MPC, PLANE of nodes that do not lie in a plane (1,"},
      {"STRAIGHT, 1, 5, 10\n", "not read: *MPC, STRAIGHT of nodes that do not lie on a line (1,"},
      {"PLANE, 17, 18, 19, 100\n", "not read: *MPC, PLANE of a node of no cell (1,"},
      {"BEAM, 17, 100\n", "not read: *MPC, BEAM of a node of no cell (1,"},
      {"BEAM, 17, 17\n", "not read: *MPC, BEAM of two nodes at one place (1,"},
      {"", "not read: *MPC of nothing (1,"},
      {"PLANE, 17, 18, 19\n", "a.inp:43: *MPC, PLANE of 3 nodes says nothing"},
      {"STRAIGHT, 17, 18\n", "a.inp:43: *MPC, STRAIGHT of 2 nodes says nothing"},
  };
  for (const auto& [text, told] : cases) {
    imported_deck("a.inp", bar(0) + "*MPC\n" + text, "--scene-out s.toml");
    expect_said(told);
    EXPECT_TRUE(Scene::load(place / "s.toml").entries("joint").empty()) << text;
  }
  imported_deck("a.inp", bar(0) + "*MASS, ELSET=p\n2.\n*ELEMENT, TYPE=MASS, ELSET=p\n50, 100\n*MPC\nBEAM, 17, 100\n", "--scene-out s.toml");
  expect_said("not read: *MPC, BEAM of a node that may turn, which Abaqus and CalculiX read differently (1,");
  imported_deck("a.inp", bar(0) + "*MPC, USER\n1, 17, 18\n" + statics + bend + "*MPC\nBEAM, 17, 19\n" + end, "--scene-out s.toml");
  expect_said("not read: *MPC, USER (1,");
  expect_said("not read: *MPC in a step (1,");
  const std::pair<const char*, const char*> wrong[] = {
      {"3, 17, 18\n", "a.inp:43:1: *MPC: a kind is expected, found \"3\" (PLANE, STRAIGHT or BEAM, and then nodes)"},
      {"BEAM, 17\n", "a.inp:43: *MPC, BEAM is between two nodes, or sets of as many nodes (name two)"},
      {"BEAM, 17, 18, 19\n", "a.inp:43: *MPC, BEAM is between two nodes, or sets of as many nodes (name two)"},
      {"PLANE, 17, 18, 19, 77\n", "a.inp:43: *MPC, PLANE: no node 77"},
      {"PLANE, haed\n", "a.inp:43:8: no node set \"HAED\" (did you mean \"head\"?)"},
      {"PLANE, 17, 18.5\n", "a.inp:43:12: no node set \"18.5\""},
  };
  for (const auto& [text, message] : wrong) {
    refused_deck("a.inp", bar(0) + "*MPC\n" + text, "-o b.h5 --scene-out t.toml", 2, message);
  }
}

}  // namespace
}  // namespace hilo::test::import_inp_mpc_test
