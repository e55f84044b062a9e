// SPDX-License-Identifier: GPL-3.0-or-later
// Every key cited in a comment is in docs/references.md.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

namespace hilo::test::references_test {
namespace {
namespace fs = std::filesystem;

TEST(References, CitedInTheCodeAreListed) {
  const fs::path root = HILO_SOURCE;
  std::ifstream list_file(root / "docs/references.md");
  const std::string list(std::istreambuf_iterator<char>(list_file), {});
  ASSERT_FALSE(list.empty());
  const std::regex key(R"([a-z]+(?:-[a-z]+)*-(?:18|19|20)\d\d)"), citation(R"(\[[a-z0-9, -]+-(?:18|19|20)\d\d\])");
  int cited = 0;
  for (const char* folder : {"solver", "tools", "post"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const auto extension = entry.path().extension();
      if (extension != ".hpp" && extension != ".cpp") continue;
      std::ifstream file(entry.path());
      const std::string text(std::istreambuf_iterator<char>(file), {});
      for (std::sregex_iterator c(text.begin(), text.end(), citation), end; c != end; ++c) {
        const std::string keys = c->str();
        for (std::sregex_iterator k(keys.begin(), keys.end(), key); k != end; ++k, ++cited)
          EXPECT_NE(list.find("`" + k->str() + "`"), list.npos) << entry.path() << " cites " << k->str();
      }
    }
  EXPECT_GT(cited, 3);
}

}  // namespace
}  // namespace hilo::test::references_test
