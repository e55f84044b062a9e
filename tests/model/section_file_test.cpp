// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes of sections' faces: what is read of .msh files, and what is refused with its line.
#include "model/section_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.hpp"

namespace hilo::test::section_file_test {
namespace {

/// A file of version 2.2 of these nodes and elements, one a line: the nodes begin at line 6, the elements after two lines more.
std::string msh(const std::vector<std::string>& nodes, const std::vector<std::string>& elements) {
  std::string out = fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", nodes.size());
  for (size_t i = 0; i < nodes.size(); ++i) out += fmt::format("{} {}\n", i + 1, nodes[i]);
  out += fmt::format("$EndNodes\n$Elements\n{}\n", elements.size());
  for (size_t i = 0; i < elements.size(); ++i) out += fmt::format("{} {}\n", i + 1, elements[i]);
  return out + "$EndElements\n";
}
const std::vector<std::string> square{"0 0 0", "1 0 0", "1 1 0", "0 1 0"};
const std::vector<std::string> two{"0 0 0", "1 0 0", "1 1 0", "0 1 0", "2 0 0", "2 1 0"};

std::string refusal(const std::string& text) {
  try {
    (void)section_mesh_of(text, "f.msh");
  } catch (const Error& e) {
    return e.where + ": " + e.message + " | " + e.hint;
  }
  return "taken";
}
double area(const SectionMesh& mesh) { return meshed_face(mesh, 0.3).area.A; }

TEST(SectionFile, ReadsTextOfBothVersions) {
  EXPECT_NEAR(area(section_mesh_of(msh(two, {"15 2 0 1 1", "1 2 0 1 1 2", "3 2 0 1 1 2 3 4", "2 2 1 1 2 5 6", "2 2 1 1 2 6 3"}), "f.msh")),
              2, 1e-12);
  const std::string four =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"face\"\n$EndPhysicalNames\n$Entities\n0 0 1 0\n1 0 0 0 1 1 0 0 0\n"
      "$EndEntities\n$Nodes\n2 4 1 4\n0 1 0 1\n1\n0 0 3\n2 1 0 3\n2\n3\n4\n1 0 3\n1 1 3\n0 1 3\n$EndNodes\n"
      "$Elements\n1 2 1 2\n2 1 2 2\n1 1 2 3\n2 1 3 4\n$EndElements\n";
  EXPECT_NEAR(area(section_mesh_of(four, "f.msh")), 1, 1e-12);
  std::string windows;
  for (const char c : four) windows += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_NEAR(area(section_mesh_of(windows, "f.msh")), 1, 1e-12);
}

// A quadrangle of 8 nodes, one side a parabola of height 0.1: 1 + 2/3 of that; drawn clockwise it is the same.
TEST(SectionFile, TakesCurvedSidesAndEitherSense) {
  std::vector<std::string> nodes = square;
  for (const char* mid : {"0.5 -0.1 0", "1 0.5 0", "0.5 1 0", "0 0.5 0"}) nodes.emplace_back(mid);
  EXPECT_NEAR(area(section_mesh_of(msh(nodes, {"16 2 0 1 1 2 3 4 5 6 7 8"}), "f.msh")), 1 + 0.2 / 3, 1e-12);
  EXPECT_NEAR(area(section_mesh_of(msh(nodes, {"16 2 0 1 4 3 2 1 7 6 5 8"}), "f.msh")), 1 + 0.2 / 3, 1e-12);
  nodes.emplace_back("0.5 0.5 0");
  EXPECT_NEAR(area(section_mesh_of(msh(nodes, {"10 2 0 1 1 2 3 4 5 6 7 8 9"}), "f.msh")), 1 + 0.2 / 3, 1e-12);
}

TEST(SectionFile, RefusesWhatIsNoFaceWithItsLine) {
  const std::string start = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  const auto said = [](const std::string& text, std::initializer_list<const char*> parts) {
    const std::string got = refusal(text);
    for (const char* part : parts) EXPECT_NE(got.find(part), std::string::npos) << got << "\nhas no " << part;
  };
  said("", {"f.msh:1:1: an empty file"});
  said("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n1 3 \"edge\"\n2 1 \"steel\"\n2 2 \"rubber\"\n$EndPhysicalNames\n",
       {"f.msh:8:", "2 groups of surfaces: a section has one material", "kind = \"matrix\""});
  said("*NODE\n1, 0, 0\n", {"f.msh:1:1: this is no mesh of gmsh", "Mesh.Binary = 0"});
  said("$MeshFormat\n4 0 8\n", {"f.msh:2:2: version 4 of .msh"});
  said("$MeshFormat\n2.2 1 8\n", {"f.msh:2", "binary"});
  said(start, {"no triangles or quadrangles"});
  said(start + "$Nodes\n3\n1 0 0 0\n", {"the file ends before a node"});
  said(start + "$Nodes\n9999999\n", {"f.msh:5", "9999999 nodes in a file of"});
  said(start + "$Nodes\n1\n1 0 0 nan\n", {"f.msh:6"});
  said(start + "$Nodes\n2\n1 0 0 0\n1 1 0 0\n", {"f.msh:7", "node 1 stands twice"});
  said(msh(square, {"2 2 0 1 1 2 7"}), {"f.msh:13:1: no node 7"});
  said(msh(square, {"2 2 0 1 1 2"}), {"f.msh:13", "a node is expected here"});
  said(msh(square, {"4 2 0 1 1 2 3 4"}), {"f.msh:13", "a solid", "gmsh -2"});
  said(msh(square, {"21 2 0 1 1 2 3 4"}), {"f.msh:13", "type 21", "Mesh.ElementOrder"});
  said(msh({"0 0 0", "1 0 0", "1 1 0.01"}, {"2 2 0 1 1 2 3"}), {"f.msh:8:1: the face is not plane", "axis 1"});
  said(msh({"0 0 0", "0 1 0", "0 1 1"}, {"2 2 0 1 1 2 3"}), {"not plane"});
  said(msh({"0 0 0", "1 0 0", "2 0 0"}, {"2 2 0 1 1 2 3"}), {"f.msh:12:1: a cell at (0, 0) has no area"});
  said(msh({"1 1 0", "1 1 0", "1 1 0"}, {"2 2 0 1 1 2 3"}), {"f.msh:12:1: the face has no area"});
  said(msh(square, {"3 2 0 1 1 3 2 4"}), {"f.msh:13:1: a cell at", "turned inside out"});
  said(msh(square, {"2 2 0 1 1 2 2"}), {"f.msh:13:1: a cell has a node twice"});
  said(msh(square, {"2 2 0 1 1 2 3", "2 2 0 1 1 2 3"}), {"f.msh:14:1: two cells at", "lie on one another"});
  said(msh({"0 0 0", "1 0 0", "1 1 0", "0.2 0.5 0"}, {"2 2 0 1 1 2 3", "2 2 0 1 1 2 4"}), {"lie on one another"});
  // parts
  said(msh({"0 0 0", "1 0 0", "1 1 0", "5 0 0", "6 0 0", "6 1 0"}, {"2 2 0 1 1 2 3", "2 2 0 1 4 5 6"}),
       {"f.msh:16:1: the face falls into parts", "(5, 0)", "common nodes"});
  said(msh({"0 0 0", "1 0 0", "1 1 0", "0 1 0", "1 0 0", "2 0 0", "2 1 0", "1 1 0"}, {"3 2 0 1 1 2 3 4", "3 2 0 1 5 6 7 8"}),
       {"two nodes are at", "Coherence"});
  said(msh({"0 0 0", "1 0 0", "1 1 0", "0 1 0", "2 1 0", "2 2 0", "1 2 0"}, {"3 2 0 1 1 2 3 4", "3 2 0 1 3 5 6 7"}),
       {"the face falls into parts"});
  // a ring of four squares of which the last two share a corner alone
  const std::vector<std::string> grid{"0 0 0", "1 0 0", "2 0 0", "0 1 0", "1 1 0", "2 1 0", "0 2 0", "1 2 0",
                                      "2 2 0", "3 0 0", "3 1 0", "3 2 0", "0 3 0", "1 3 0", "2 3 0", "3 3 0"};
  said(msh(grid, {"3 2 0 1 1 2 5 4", "3 2 0 1 2 3 6 5", "3 2 0 1 3 10 11 6", "3 2 0 1 6 11 12 9", "3 2 0 1 4 5 8 7", "3 2 0 1 8 9 15 14",
                  "3 2 0 1 7 8 14 13"}),
       {"meet in the point (2, 2) alone"});
  // a node amid an edge of another part, which is joined elsewhere
  said(msh({"0 0 0", "2 0 0", "2 2 0", "0 2 0", "3 0 0", "3 2 0", "2 1.5 0", "2 0.7 0", "3 -1 0", "2 -1 0", "0 -1 0", "0 -2 0", "2 -2 0",
            "3 -2 0"},
           {"3 2 0 1 1 2 3 4", "3 2 0 1 8 5 6 7", "3 2 0 1 10 9 5 8", "3 2 0 1 11 10 2 1", "3 2 0 1 12 13 10 11", "3 2 0 1 13 14 9 10"}),
       {"a node lies on an edge", "Coherence"});
  // a strip that runs through itself
  said(msh({"0 0 0", "4 0 0", "4 1 0", "0 1 0", "5 0 0", "5 3 0", "4 2 0", "1.1 3 0", "1 2 0", "2 2.1 0", "1.1 -1.3 0", "1.9 -1.2 0"},
           {"3 2 0 1 1 2 3 4", "3 2 0 1 2 5 6 3", "2 2 0 1 3 6 7", "3 2 0 1 7 6 8 10", "2 2 0 1 10 8 9", "3 2 0 1 10 9 11 12"}),
       {"crosses itself near"});
}

}  // namespace
}  // namespace hilo::test::section_file_test
