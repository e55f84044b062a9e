// SPDX-License-Identifier: GPL-3.0-or-later
// Lists by words: what is not in them is an error with a suggestion, what stands in them cannot be added twice, nor too late.
#include "base/registry.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace hilo {
namespace {

struct Tree {
  std::string_view name;
  int height;
};

Registry<Tree> trees() { return {"tree", {{"oak", 40}, {"birch", 25}}}; }

Error refused(const std::function<void()>& body) {
  try {
    body();
  } catch (const Error& e) {
    return e;
  }
  ADD_FAILURE() << "no Error was thrown";
  return Error("", "");
}

TEST(Registry, FindsARowByItsWordInTheOrderOfTheList) {
  Registry<Tree> list = trees();
  list.add({"yew", 15});
  EXPECT_EQ(list.at("birch").height, 25);
  EXPECT_EQ(list.find("elm"), nullptr);
  EXPECT_EQ(list.words(), (std::vector<std::string>{"oak", "birch", "yew"}));
}

TEST(Registry, RefusesAWordThatItDoesNotHaveWithTheNearestOrAll) {
  const Error near = refused([] { trees().at("birhc", "scene.toml:1:2"); }), far = refused([] { trees().at("granite"); });
  EXPECT_STREQ(near.what(), "scene.toml:1:2: no tree \"birhc\" (did you mean \"birch\"?)");
  EXPECT_STREQ(far.what(), "no tree \"granite\" (one of: oak, birch)");
  EXPECT_EQ(near.exit, Exit::input);
}

TEST(Registry, KeepsItsRowsWhereTheyAreWhileOthersAreAdded) {
  Registry<Tree> list = trees();
  const Tree* oak = list.find("oak");
  const std::vector<std::string> words = [] {
    std::vector<std::string> out;
    for (int i = 0; i < 1000; ++i) out.push_back("tree " + std::to_string(i));
    return out;
  }();
  for (const std::string& word : words) list.add({word, 1});
  EXPECT_EQ(list.find("oak"), oak);
}

TEST(Registry, TakesNoWordTwiceAndNoneAfterItIsClosed) {
  Registry<Tree> list = trees();
  EXPECT_EQ(refused([&] { list.add({"oak", 1}); }).exit, Exit::fault);
  list.close();
  EXPECT_EQ(refused([&] { list.add({"elm", 1}); }).exit, Exit::fault);
}

}  // namespace
}  // namespace hilo
