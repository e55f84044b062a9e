// SPDX-License-Identifier: GPL-3.0-or-later
// What takes part in the equations of motion is listed once (Builder::add_contributions), and nobody else knows more than a few by name: a
// list that stands twice is one that forgets.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace {
namespace fs = std::filesystem;

/// Source without comments and texts.
std::string code_of(const fs::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return std::regex_replace(text.str(), std::regex(R"(//[^\n]*|"([^"\\\n]|\\.)*")"), "");
}

std::map<fs::path, std::string> sources(const fs::path& folder) {
  std::map<fs::path, std::string> out;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".hpp" || entry.path().extension() == ".cpp") out[entry.path()] = code_of(entry.path());
  return out;
}

std::set<std::string> words_of(const std::string& code, const std::set<std::string>& wanted) {
  std::set<std::string> out;
  const std::regex word(R"(\b[A-Z]\w*\b)");
  for (auto at = std::sregex_iterator(code.begin(), code.end(), word); at != std::sregex_iterator(); ++at)
    if (wanted.contains(at->str())) out.insert(at->str());
  return out;
}

TEST(Contributions, NoListOfThemStandsTwice) {
  const auto files = sources(fs::path(HILO_SOURCE) / "solver");
  std::set<std::string> kinds;
  const std::regex declared(R"(\bclass (\w+) final : public Contribution\b)");
  for (const auto& [file, code] : files)
    for (auto at = std::sregex_iterator(code.begin(), code.end(), declared); at != std::sregex_iterator(); ++at) kinds.insert((*at)[1]);
  ASSERT_GE(kinds.size(), 8u);
  int lists = 0;
  for (const auto& [file, code] : files) {
    const std::set<std::string> named = words_of(code, kinds);
    if (named.size() < 3) continue;
    ++lists;
    EXPECT_EQ(named, kinds) << fs::relative(file, HILO_SOURCE) << " names some contributions and not the others";
  }
  EXPECT_EQ(lists, 1) << "files that list the contributions";
}

TEST(Contributions, NobodyAboveTheSystemAsksWhichOneItHas) {
  for (const auto& [file, code] : sources(fs::path(HILO_SOURCE) / "solver" / "dynamics"))
    EXPECT_EQ(code.find("dynamic_cast"), code.npos) << fs::relative(file, HILO_SOURCE);
}

// What brings constraint rows is seen as System::constraints alone, and unknowns as Points::unknowns: a contact, or amplitudes of modes,
// then need no change here.  Cells are named where their stress and their memory go into the results.
TEST(Contributions, RowsAndUnknownsHaveNoNamesAboveTheSystem) {
  const std::regex rows(R"(\b(Joints?|JointKind|Springs?|Connector|Carrier)\b|system/joints\.hpp|\bjoints\s*[.\[])");
  const std::regex blocks(R"(\b(node_block|body_block|body_clique)\b)"), parts(R"(\bpart<(\w+)>)");
  const std::set<std::string> of_nodes{"choose_solver.cpp"}, of_bodies{"clock.cpp"};  // how many nodes ranks share; mechanisms of bodies
  for (const auto& [file, code] : sources(fs::path(HILO_SOURCE) / "solver" / "dynamics")) {
    const std::string name = file.filename().string();
    std::smatch found;
    EXPECT_FALSE(std::regex_search(code, found, rows)) << name << " names " << found.str();
    if (!of_nodes.contains(name) && !of_bodies.contains(name)) {
      EXPECT_FALSE(std::regex_search(code, found, blocks)) << name << " names " << found.str();
    }
    for (auto at = std::sregex_iterator(code.begin(), code.end(), parts); at != std::sregex_iterator(); ++at)
      EXPECT_TRUE((*at)[1] == "Solids" || (*at)[1] == "LinearRegions" || (*at)[1] == "ModeOutput" || (*at)[1] == "BucklingModes" ||
                  (*at)[1] == "LoadPath")
          << name << ", " << (*at)[1];
  }
}

}  // namespace
