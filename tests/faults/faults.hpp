// SPDX-License-Identifier: GPL-3.0-or-later
// A small model in a folder of its own, and what must hold when a command refuses: exit code, one line on stderr, nothing on stdout,
// and the folder as it was.
#pragma once
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "succeeded.hpp"

namespace hilo::test {

/// Two cubes on top of each other: region hull below, mast above, node set top.
inline const std::string deck = R"(*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1
9, 0, 0, 2
10, 1, 0, 2
11, 1, 1, 2
12, 0, 1, 2
*ELEMENT, TYPE=C3D8, ELSET=hull
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=C3D8, ELSET=mast
2, 5, 6, 7, 8, 9, 10, 11, 12
*NSET, NSET=top
9, 10, 11, 12
*SOLID SECTION, ELSET=hull, MATERIAL=steel
*SOLID SECTION, ELSET=mast, MATERIAL=steel
*MATERIAL, NAME=steel
*ELASTIC
2e11, 0.3
*DENSITY
7850
)";

/// A scene of that mesh which runs in two steps.
inline const std::string scene = R"(gravity = [0, 0, -9.81]
[time]
end = 2e-3
step = 1e-3
[material.steel]
E = 2e11
nu = 0.3
density = 7850
[region.hull]
material = "steel"
[region.mast]
material = "steel"
[[joint]]
kind = "revolute"
name = "hinge"
a = "ground"
b = "hull"
at = [0.5, 0.5, 0]
axis = [0, 1, 0]
[[load]]
kind = "force"
name = "push"
on = "top"
force = [1e3, 0, 0]
history = "pulse"
[history.pulse]
file = "pulse.csv"
)";

class Faults : public ::testing::Test {
 protected:
  Workplace work;
  const std::filesystem::path& folder = work.path();

  void SetUp() override {
    put("two.inp", deck);
    put("scene.toml", scene);
    put("pulse.csv", "t,factor\n0,0\n0.05,1\n0.1,0\n");
  }

  void put(const std::string& file, const std::string& text) const { work.write(file, text); }
  std::string bytes(const std::string& file) const {
    std::ifstream in(folder / file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// two.h5, with hull rigid as tags.h5.
  void make_mesh() const {
    const auto imported = work.run("hilo-import two.inp -o two.h5");
    ASSERT_EQ(imported.exit, 0) << imported.err;
  }
  void make_tags() const {
    make_mesh();
    const auto tagged = work.run("hilo-tag two.h5 --rigid hull --nonlinear mast -o tags.h5");
    ASSERT_EQ(tagged.exit, 0) << tagged.err;
  }

  /// Everything in the folder: kind of file and content.
  std::map<std::string, std::string> snapshot() const {
    std::map<std::string, std::string> files;
    for (const auto& e : std::filesystem::recursive_directory_iterator(folder)) {
      const auto name = e.path().lexically_relative(folder).string();
      struct stat s {};
      ::lstat(e.path().c_str(), &s);
      files[name] = std::to_string(s.st_mode & S_IFMT) + (e.is_regular_file() ? bytes(name) : "");
    }
    return files;
  }

  static std::vector<std::string> lines(const std::string& text) {
    std::vector<std::string> all;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) all.push_back(line);
    return all;
  }

  /// `command` (whose first word that begins with hilo- is the tool) ends with `exit` and this line on stderr, after "tool: "; "..." stands
  /// for any text.
  void refused(const std::string& command, int exit, const std::string& message, int ranks = 1, const std::string& before = "") const {
    SCOPED_TRACE(before + command + " on " + std::to_string(ranks) + " rank(s)");
    const std::string tool = command.substr(command.find("hilo-"), command.find(' ', command.find("hilo-")) - command.find("hilo-"));
    const auto files = snapshot();
    const auto o = ranks > 1 ? mpirun(ranks, command, folder) : run(before + command, folder);
    EXPECT_EQ(o.exit, exit) << o.err;
    std::vector<std::string> said;  // mpirun adds lines of its own
    for (const auto& text : lines(o.err))
      if (ranks == 1 || text.starts_with("hilo-")) said.push_back(text);
    ASSERT_EQ(said.size(), 1u) << "stderr: " << o.err;
    EXPECT_TRUE(matches(said[0], tool + ": " + message)) << "said:     " << said[0] << "\nexpected: " << tool << ": " << message;
    EXPECT_EQ(o.out, "");
    EXPECT_TRUE(snapshot() == files) << "the folder was changed: " << changes(files, snapshot());
  }

 private:
  static bool matches(const std::string& text, const std::string& pattern) {
    size_t at = 0, begin = 0;
    while (true) {
      const size_t end = pattern.find("...", begin);
      const std::string piece = pattern.substr(begin, end - begin);
      const size_t found = text.find(piece, at);
      if (found == text.npos || (begin == 0 && found != 0)) return false;
      at = found + piece.size();
      if (end == pattern.npos) return at == text.size();
      begin = end + 3;
      if (begin == pattern.size()) return true;
    }
  }
  static std::string changes(const std::map<std::string, std::string>& a, const std::map<std::string, std::string>& b) {
    std::string text;
    for (const auto& [name, content] : b)
      if (const auto was = a.find(name); was == a.end())
        text += "+" + name + " ";
      else if (was->second != content)
        text += "*" + name + " ";
    for (const auto& [name, content] : a)
      if (!b.contains(name)) text += "-" + name + " ";
    return text;
  }
};

}  // namespace hilo::test
