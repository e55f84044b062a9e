// SPDX-License-Identifier: GPL-3.0-or-later
// Floors (docs/design.md): base 0; physics, model 1; system, linear 2; dynamics 3; tools, post and the mains of the solver 4.  No include
// points upward or to a neighbour on the same floor, but for the lists of kinds of physics that the scene's schema is made of.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace {
namespace fs = std::filesystem;

const std::map<std::string, std::set<std::string>> may_include{
    {"base", {"base"}},
    // each law, joint, spring, section and obstacle brings its rows of the scene's schema; a section's mesh is read into its own form
    {"model",
     {"base", "model", "physics/beam_section.hpp", "physics/contact/obstacle_kinds.hpp", "physics/material/materials.hpp",
      "physics/section_mesh.hpp", "physics/spring_kinds.hpp"}},
    {"physics", {"base", "physics"}},
    {"linear", {"base", "linear"}},
    {"system", {"base", "model", "physics", "linear", "system"}},
    {"dynamics", {"base", "model", "physics", "linear", "system", "dynamics"}},
    {"main", {"base", "model", "physics", "linear", "system", "dynamics"}},
    // sections of beams: what a deck says of one is what a scene says
    {"tools", {"base", "model", "physics/beam_section.hpp", "physics/section_mesh.hpp"}},
    // values at points: the shape functions, which know base alone; stress at points of the sections of beams; outlines of obstacles
    {"post",
     {"base", "model", "physics/beam_section.hpp", "physics/contact/obstacle_kinds.hpp", "physics/section_mesh.hpp",
      "physics/shape/shapes.hpp"}},
};
const std::set<std::string> floors{"base", "model", "physics", "linear", "system", "dynamics"};

/// Includes in quotes of every source below a folder, with the file that has them.
std::vector<std::pair<fs::path, std::string>> includes(const fs::path& folder) {
  std::vector<std::pair<fs::path, std::string>> found;
  const std::regex line(R"(^\s*#\s*include\s*[<"]([^">]+)[">])");
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".hpp" && entry.path().extension() != ".cpp") continue;
    std::ifstream file(entry.path());
    for (std::string text; std::getline(file, text);)
      if (std::smatch m; std::regex_search(text, m, line)) found.emplace_back(entry.path(), m[1]);
  }
  return found;
}

TEST(Floors, NoIncludePointsUpwardOrSideways) {
  const fs::path root = HILO_SOURCE;
  int seen = 0;
  const auto check = [&](const fs::path& folder, const std::function<std::string(const fs::path&)>& floor_of) {
    for (const auto& [file, included] : includes(folder)) {
      const std::string target = included.substr(0, included.find('/'));
      if (included.find('/') == std::string::npos || !floors.contains(target)) continue;
      const std::string own = floor_of(file);
      ASSERT_TRUE(may_include.contains(own)) << file << " is on no floor";
      const auto& allowed = may_include.at(own);
      EXPECT_TRUE(allowed.contains(target) || allowed.contains(included)) << fs::relative(file, root) << " includes " << included;
      ++seen;
    }
  };
  check(root / "solver", [&](const fs::path& file) {
    const fs::path inside = fs::relative(file, root / "solver");
    return inside.has_parent_path() ? inside.begin()->string() : std::string("main");  // main.cpp, reduce.cpp
  });
  check(root / "tools", [](const fs::path&) { return std::string("tools"); });
  check(root / "post", [](const fs::path&) { return std::string("post"); });
  EXPECT_GT(seen, 100);
}

TEST(Floors, EveryFolderOfTheSolverIsOne) {
  for (const auto& entry : fs::directory_iterator(fs::path(HILO_SOURCE) / "solver"))
    if (entry.is_directory()) {
      EXPECT_TRUE(floors.contains(entry.path().filename().string())) << entry.path();
    }
}

TEST(Floors, NoFileOfTheSolverIsLong) {
  constexpr int most = 500;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(HILO_SOURCE) / "solver")) {
    if (!entry.is_regular_file()) continue;
    std::ifstream file(entry.path());
    int lines = 0;
    for (std::string text; std::getline(file, text);) ++lines;
    EXPECT_LT(lines, most) << fs::relative(entry.path(), HILO_SOURCE);
  }
}

// The rooms of post/: no circle among them, and a new one must be drawn here.
TEST(Floors, RoomsOfPostUseOnlyThoseBelow) {
  const std::map<std::string, std::set<std::string>> below{
      {"files", {}},
      {"run", {}},
      {"surface", {}},
      {"picture", {"files"}},
      {"charts", {"picture"}},
      {"scene", {"run", "surface", "picture", "charts"}},
      {"injury", {"files", "run", "picture", "charts"}},
      {"quantity", {"files", "run", "injury"}},
      {"commands", {"files", "run", "picture", "charts", "scene", "injury", "quantity"}}};
  const fs::path root = fs::path(HILO_SOURCE) / "post";
  std::set<std::string> met;
  for (const auto& [file, included] : includes(root)) {
    const fs::path inside = fs::relative(file, root);
    if (inside == "main.cpp" || included.rfind("post/", 0) != 0) continue;
    const std::string own = inside.begin()->string(), target = fs::path(included).parent_path().filename().string();
    ASSERT_TRUE(below.contains(own)) << inside << " is in no room";
    EXPECT_TRUE(own == target || below.at(own).contains(target)) << inside << " includes " << included;
    met.insert(own);
  }
  for (const char* room : {"charts", "scene", "injury", "quantity", "commands"}) EXPECT_TRUE(met.contains(room)) << room;
}

// The heavy libraries stay where they belong: MPI in base, PETSc in linear, VTK in post, HDF5 in model, gmsh in tools, METIS there and
// where a rank's cells are split into subdomains; about.cpp reads their versions.
TEST(Floors, LibrariesAreIncludedOnlyWhereTheyBelong) {
  const fs::path root = HILO_SOURCE;
  const std::vector<std::pair<std::regex, std::string>> home{{std::regex("^petsc.*"), "solver/linear"},
                                                             {std::regex("^vtk[A-Z_].*"), "post"},
                                                             {std::regex("^hdf5\\.h$|^H5.*"), "solver/model"},
                                                             {std::regex("^gmsh.*"), "tools"},
                                                             {std::regex("^metis.*"), "tools"},
                                                             {std::regex("^toml\\+\\+.*"), "solver/model"},
                                                             {std::regex("^mpi\\.h$"), "solver/base"},
                                                             {std::regex("^(med|exodusII)\\.h$"), "tools/import"}};
  std::set<std::string> met;
  for (const char* folder : {"solver", "tools", "post"})
    for (const auto& [file, included] : includes(root / folder))
      for (const auto& [library, place] : home)
        if (std::regex_match(included, library)) {
          const std::string at = fs::relative(file, root).string();
          EXPECT_TRUE(at.starts_with(place) || (included == "metis.h" && at.starts_with("solver/linear")) || at == "solver/about.cpp")
              << at << " includes " << included;
          if (at.starts_with(place)) met.insert(place);
        }
  for (const auto& [library, place] : home) EXPECT_TRUE(met.contains(place)) << place;
}

// All is one namespace, and what is linked together by name alone (destructors, members of std::vector) would be one of two by chance.
TEST(Floors, NoTwoClassesShareAName) {
  std::map<std::string, std::vector<fs::path>> where;
  const std::regex line(R"(^(?:struct|class) (\w+)(?: final)?(?: :.*)? \{)");
  for (const char* folder : {"solver", "tools", "post"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(HILO_SOURCE) / folder)) {
      if (entry.path().extension() != ".hpp") continue;
      std::ifstream file(entry.path());
      for (std::string text; std::getline(file, text);)
        if (std::smatch m; std::regex_search(text, m, line)) where[m[1]].push_back(fs::relative(entry.path(), HILO_SOURCE));
    }
  EXPECT_GT(where.size(), 300u);
  for (const auto& [name, files] : where) EXPECT_EQ(files.size(), 1u) << name << " in " << files.front() << " and " << files.back();
}

}  // namespace
