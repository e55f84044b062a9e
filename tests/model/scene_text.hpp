// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes written into a folder of their own and read from there.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "model/scene.hpp"

namespace hilo::test {

namespace fs = std::filesystem;

/// A folder of its own for each test, removed at its end.
class SceneText : public ::testing::Test {
 protected:
  fs::path folder = fs::temp_directory_path() / ("hilo-scene-" + std::to_string(getpid()));
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }

  void put(const std::string& file, const std::string& text) const { std::ofstream(folder / file) << text; }
  Scene load(const std::string& text, const std::vector<std::string>& overrides = {}) const {
    put("scene.toml", text);
    return Scene::load((folder / "scene.toml").string(), overrides);
  }
  /// The message of the error a scene is refused with, without the folder; "" when it is accepted.
  std::string refusal(const std::string& text, const std::vector<std::string>& overrides = {}) const {
    try {
      load(text, overrides);
    } catch (const Error& e) {
      EXPECT_EQ(e.exit, Exit::input) << e.what();
      return without_folder(e.what());
    }
    return "";
  }
  std::string without_folder(std::string s) const {
    const std::string prefix = folder.string() + "/";
    for (size_t at; (at = s.find(prefix)) != s.npos;) s.erase(at, prefix.size());
    return s;
  }
};

inline const std::string hinge = R"(
[[joint]]
kind = "revolute"
name = "trunnion"
a = "turret"
b = "cradle"
at = [0, 0, 1]
axis = [0, 1, 0]
)";

inline const std::string pull = R"(
[[load]]
kind = "force"
name = "pull"
on = "tip"
force = [1, 0, 0]
)";

}  // namespace hilo::test
