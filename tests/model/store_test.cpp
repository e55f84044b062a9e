// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/store.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <functional>

#include "base/error.hpp"
#include "folder.hpp"

namespace hilo::test::store_test {
namespace {

using test::Folder;
using test::text_of;
using test::write_text;

Error error_of(const std::function<void()>& body) {
  try {
    body();
  } catch (const Error& e) {
    return e;
  }
  ADD_FAILURE() << "no Error was thrown";
  return Error("", "");
}

TEST(Store, EveryElementTypeComesBackAsWritten) {
  const Folder folder;
  const std::string path = folder / "a.h5";
  const std::vector<double> d{1.5, -2e300, 0};
  const std::vector<float> f{1.5f, -2e30f};
  const std::vector<std::int32_t> i{-5, 7};
  const std::vector<std::int64_t> l{-(std::int64_t{1} << 62), 3, 4, 5, 6, 7};
  const std::vector<std::uint8_t> u{0, 255};
  const std::vector<std::string> s{"rotor", "", "größe"};
  Store store = Store::create(path);
  store.write<double>("/x/y/d", d, {3}, "kg/m^3", "density");
  store.write<float>("/f", f, {2});
  store.write<std::int32_t>("/i", i, {2});
  store.write<std::int64_t>("/l", l, {3, 2});
  store.write<std::uint8_t>("/u", u, {2});
  store.write<double>("/none", {}, {0, 3});
  store.write_strings("/s", s);
  store.write_text("/t", "one\ntwo");
  store.set("/", "n", std::int64_t{3});
  store.set("/", "n", std::int64_t{4});
  store.set("/group", "t", 0.25);
  store.publish();
  const Store back = Store::open(path);
  EXPECT_EQ(back.read<double>("/x/y/d"), d);
  EXPECT_EQ(back.read<float>("/f"), f);
  EXPECT_EQ(back.read<std::int32_t>("/i"), i);
  EXPECT_EQ(back.read<std::int64_t>("/l"), l);
  EXPECT_EQ(back.read<std::uint8_t>("/u"), u);
  EXPECT_EQ(back.read<double>("/i"), (std::vector<double>{-5, 7}));
  EXPECT_EQ(back.read_rows<std::int64_t>("/l", 1, 2), (std::vector<std::int64_t>{4, 5, 6, 7}));
  EXPECT_EQ(back.shape("/l"), (std::vector<std::int64_t>{3, 2}));
  EXPECT_EQ(back.shape("/none"), (std::vector<std::int64_t>{0, 3}));
  EXPECT_EQ(back.type("/u"), "u1");
  EXPECT_EQ(back.read_strings("/s"), s);
  EXPECT_EQ(back.read_text("/t"), "one\ntwo");
  EXPECT_EQ(back.text_attribute("/x/y/d", "unit"), "kg/m^3");
  EXPECT_EQ(back.number_attribute("/", "n"), 4.);
  EXPECT_EQ(back.number_attribute("/group", "t"), 0.25);
  EXPECT_EQ(back.text_attribute("/", "absent"), std::nullopt);
  EXPECT_EQ(back.list("/x"), std::vector<std::string>{"y"});
  EXPECT_TRUE(back.list("/nowhere").empty());
  EXPECT_TRUE(back.has("/x/y/d"));
  EXPECT_FALSE(back.has("/x/z/d"));
}

TEST(Store, SameContentGivesSameBytes) {
  const Folder folder;
  const auto write = [&](const std::string& path) {
    Store store = Store::create(path);
    store.write<double>("/a/b", std::vector<double>(1000, 3.25), {1000}, "m");
    store.write_strings("/names", std::vector<std::string>{"hull", "turret"});
    store.set("/", "format", "hilo mesh");
    store.start_rows<double>("/h/t", {}, "s");
    store.append<double>("/h/t", std::vector<double>{1});
    store.publish();
  };
  write(folder / "one.h5");
  ::sleep(1);  // a time stamp would differ
  write(folder / "two.h5");
  EXPECT_EQ(text_of(folder / "one.h5"), text_of(folder / "two.h5"));
  EXPECT_EQ(digest(folder / "one.h5"), digest(folder / "two.h5"));
}

TEST(Store, DigestIsTheFnv1aOfTheBytes) {
  const Folder folder;
  write_text(folder / "empty", "");
  write_text(folder / "a", "foobar");
  EXPECT_EQ(digest(folder / "empty"), "fnv1a64:cbf29ce484222325");
  EXPECT_EQ(digest(folder / "a"), "fnv1a64:85944171f73967e8");  // test vector of the FNV authors
}

TEST(Store, UnpublishedFileLeavesNothingBehind) {
  const Folder folder;
  {
    Store store = Store::create(folder / "a.h5");
    store.write<double>("/x", std::vector<double>{1}, {1});
    EXPECT_EQ(folder.files().size(), 1u);
    EXPECT_FALSE(folder.files().contains("a.h5"));
  }
  EXPECT_TRUE(folder.files().empty());
}

TEST(Store, OldFileStaysUntilTheNewOneIsPublished) {
  const Folder folder;
  write_text(folder / "a.h5", "old");
  Store store = Store::create(folder / "a.h5");
  store.write<double>("/x", std::vector<double>{1}, {1});
  EXPECT_EQ(text_of(folder / "a.h5"), "old");
  store.publish();
  EXPECT_EQ(Store::open(folder / "a.h5").read<double>("/x"), std::vector<double>{1});
  EXPECT_EQ(folder.files(), std::set<std::string>{"a.h5"});
}

TEST(Store, WrongFilesAreNamedForWhatTheyAre) {
  const Folder folder;
  const auto opening = [&](const std::string& name) { return error_of([&] { Store::open(folder / name); }); };
  EXPECT_EQ(opening("missing.h5").message, "no such file");
  write_text(folder / "text.h5", "solid cube\n");
  EXPECT_EQ(opening("text.h5").message, "not an HDF5 file");
  write_text(folder / "empty.h5", "");
  EXPECT_EQ(opening("empty.h5").message, "empty file");
  std::filesystem::create_directory(folder / "folder.h5");
  EXPECT_EQ(opening("folder.h5").message, "is a folder, not a file");
  Store store = Store::create(folder / "whole.h5");
  store.write<double>("/x", std::vector<double>(10000, 1.), {10000});
  store.publish();
  const auto bytes = text_of(folder / "whole.h5");
  for (const size_t kept : {size_t{9}, size_t{100}, size_t{3000}, bytes.size() - 1}) {
    write_text(folder / "cut.h5", bytes.substr(0, kept));
    const Error e = opening("cut.h5");
    EXPECT_NE(e.message.find("truncated"), std::string::npos) << kept << ": " << e.message;
    EXPECT_EQ(e.exit, Exit::input);
    EXPECT_EQ(e.where, folder / "cut.h5");
  }
}

TEST(Store, MissingAndForeignArraysAreErrorsOfTheInput) {
  const Folder folder;
  Store store = Store::create(folder / "a.h5");
  store.write_text("/t", "text");
  store.write<double>("/x", std::vector<double>{1, 2}, {2});
  store.publish();
  const Store back = Store::open(folder / "a.h5");
  EXPECT_EQ(error_of([&] { back.read<double>("/y"); }).message, "no array /y");
  EXPECT_EQ(error_of([&] { back.read<double>("/t"); }).message, "/t does not hold numbers");
  EXPECT_EQ(error_of([&] { back.read_text("/x"); }).message, "/x does not hold text");
  EXPECT_EQ(error_of([&] { back.read_rows<double>("/x", 1, 2); }).exit, Exit::input);
}

TEST(Store, GrowingFileCanBeReadAfterEachFlush) {
  const Folder folder;
  Store store = Store::create_growing(folder / "run.h5");
  store.start_rows<double>("/history/t", {}, "s");
  store.start_rows<double>("/history/f", {2, 3}, "N", "force", "/history/t");
  store.set("/", "complete", std::int64_t{0});
  for (int step = 0; step < 5000; ++step) {
    store.append<double>("/history/t", std::vector<double>{0.5 * step});
    store.append<double>("/history/f", std::vector<double>(6, step));
    if (step % 1000 != 999) continue;
    store.flush();
    const Store reader = Store::open(folder / "run.h5");
    EXPECT_EQ(reader.shape("/history/f"), (std::vector<std::int64_t>{step + 1, 2, 3}));
    EXPECT_EQ(reader.read_rows<double>("/history/t", step, 1), std::vector<double>{0.5 * step});
    EXPECT_EQ(reader.read_rows<double>("/history/f", step, 1), std::vector<double>(6, step));
    EXPECT_EQ(reader.text_attribute("/history/f", "time"), "/history/t");
  }
}

TEST(Store, MembersOfATableAreReadAsIfTheyWereApart) {
  const Folder folder;
  constexpr std::int64_t n = 500, width = 6, rows = 90;
  std::vector<std::string> names;
  for (int k = 0; k < n; ++k) names.push_back("m" + std::to_string((7 * k) % n));
  const auto value = [](std::int64_t row, std::int64_t k, std::int64_t c) { return 1e6 * static_cast<double>(row) + 10. * k + c; };
  const auto append = [&](Store& f, std::int64_t row) {
    std::vector<double> all;
    for (std::int64_t k = 0; k < n; ++k)
      for (std::int64_t c = 0; c < width; ++c) all.push_back(value(row, k, c));
    f.append_table<double>("/history/joint", all);
  };
  {
    Store f = Store::create_growing(folder / "a.h5");
    f.start_table<double>("/history/joint", names, width, "N", "force", "/t");
    for (std::int64_t row = 0; row < rows; ++row) {
      append(f, row);
      if (row == 40) f.flush();
    }
    f.flush();
  }
  {
    Store f = Store::open_growing(folder / "a.h5");  // goes on from row 70
    f.start_table<double>("/history/joint", names, width, "N", "force", "/t");
    f.keep_rows("/history/joint", 70);
    append(f, 70);
    f.flush();
  }
  const Store f = Store::open(folder / "a.h5");
  std::vector<std::string> sorted = names;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(f.list("/history/joint"), sorted);
  for (const std::int64_t k : {std::int64_t{0}, std::int64_t{257}, n - 1}) {
    const std::string array = "/history/joint/" + names[k];
    EXPECT_TRUE(f.has(array) && f.is_array(array));
    EXPECT_EQ(f.shape(array), (std::vector<std::int64_t>{71, width}));
    EXPECT_EQ(f.type(array), "f8");
    EXPECT_EQ(f.text_attribute(array, "unit"), "N");
    EXPECT_EQ(f.text_attribute(array, "time"), "/t");
    const std::vector<double> own = f.read<double>(array), some = f.read_rows<double>(array, 60, 2);
    for (std::int64_t row = 0; row < 71; ++row)
      for (std::int64_t c = 0; c < width; ++c) ASSERT_EQ(own[row * width + c], value(row, k, c));
    EXPECT_EQ(some.front(), value(60, k, 0));
  }
  EXPECT_FALSE(f.has("/history/joint/m500"));
  EXPECT_FALSE(f.is_array("/history/joint"));
  EXPECT_NE(error_of([&] { f.read<double>("/history/joint/m500"); }).message.find("no array"), std::string::npos);
}

TEST(Store, WhatWasFlushedSurvivesAKilledRun) {
  const Folder folder;
  const pid_t child = ::fork();
  if (child == 0) {
    Store store = Store::create_growing(folder / "run.h5");
    store.start_rows<double>("/t", {});
    for (int step = 0; step < 300; ++step) {
      store.append<double>("/t", std::vector<double>{1. * step});
      if (step == 200) store.flush();
    }
    ::raise(SIGKILL);
  }
  int status;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  const Store reader = Store::open(folder / "run.h5");
  ASSERT_EQ(reader.shape("/t"), std::vector<std::int64_t>{201});
  EXPECT_EQ(reader.read<double>("/t").back(), 200.);
}

// Commits rewrite what describes arrays while a reader goes from one piece of it to the next.
TEST(Store, IsReadWhileItGrows) {
  const Folder folder;
  constexpr int arrays = 60;
  const auto name = [](int k) { return "/history/body/b" + std::to_string(k); };
  const pid_t child = ::fork();
  if (child == 0) {
    Store store = Store::create_growing(folder / "run.h5");
    store.start_rows<double>("/history/t", {});
    for (int k = 0; k < arrays; ++k) store.start_rows<double>(name(k), {12});
    for (int step = 0;; ++step) {
      store.append<double>("/history/t", std::vector<double>{1. * step});
      for (int k = 0; k < arrays; ++k) store.append<double>(name(k), std::vector<double>(12, step + 1.));
      store.write<double>("/field/" + std::to_string(step), std::vector<double>(200, step + 1.), {200});
      if (step % 20 == 0) store.flush(false), ::usleep(50000);
    }
  }
  while (!std::filesystem::exists(folder / "run.h5")) ::usleep(1000);
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(4);
  std::string wrong;
  int rounds = 0;
  try {
    const Store kept = Store::open(folder / "run.h5");
    for (; std::chrono::steady_clock::now() < until; ++rounds) {
      const Store now = Store::open(folder / "run.h5");
      for (const Store* store : {&kept, &now}) {
        const auto t = store->read<double>("/history/t");
        for (int k = 0; k < arrays; k += 7) {
          const auto x = store->read<double>(name(k));
          if (x.size() < 12 * t.size()) wrong = "fewer rows than before";
          for (size_t i = 0; i < x.size(); ++i)
            if (x[i] != static_cast<double>(i / 12) + 1) wrong = "other numbers than were written";
        }
        const auto fields = store->list("/field");
        if (fields.empty() || store->read<double>("/field/" + fields.back()).size() != 200) wrong = "no field";
      }
    }
  } catch (const Error& e) {
    wrong = e.what();
  }
  ::kill(child, SIGKILL);
  int status;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(wrong, "");
  EXPECT_GT(rounds, 3);
}

TEST(Store, LinksAreRelativeAndFollowAMovedFolder) {
  const Folder folder;
  std::filesystem::create_directories(folder / "case/geometry");
  std::filesystem::create_directories(folder / "case/out");
  Store mesh = Store::create(folder / "case/geometry/mesh.h5");
  mesh.write<double>("/mesh/X", std::vector<double>{1, 2}, {2});
  mesh.publish();
  Store tags = Store::create(folder / "case/out/tags.h5");
  tags.link("/mesh", folder / "case/geometry/mesh.h5", "/mesh");
  tags.publish();
  std::filesystem::rename(folder / "case", folder / "moved");
  const Store reader = Store::open(folder / "moved/out/tags.h5");
  ASSERT_TRUE(reader.linked("/mesh"));
  EXPECT_EQ(reader.linked("/mesh")->first, "../geometry/mesh.h5");
  EXPECT_EQ(reader.read<double>("/mesh/X"), (std::vector<double>{1, 2}));
  EXPECT_FALSE(reader.linked("/"));
}

TEST(Store, FolderThatDoesNotExistIsExitFour) {
  const Folder folder;
  const Error e = error_of([&] { Store::create(folder / "nowhere/a.h5"); });
  EXPECT_EQ(e.exit, Exit::resources);
  EXPECT_EQ(e.message, "cannot write: No such file or directory");
}

TEST(Store, NoPermissionIsExitFour) {
  const Folder folder;
  write_text(folder / "secret.h5", "x");
  std::filesystem::permissions(folder / "secret.h5", std::filesystem::perms::none);
  std::filesystem::permissions(folder.path(), std::filesystem::perms(0555));
  const uid_t me = ::geteuid();
  ASSERT_TRUE(me != 0 || ::seteuid(65534) == 0);  // root may write anywhere
  const Error writing = error_of([&] { Store::create(folder / "a.h5"); }),
              growing = error_of([&] { Store::create_growing(folder / "a.h5"); });
  const Error reading = error_of([&] { Store::open(folder / "secret.h5"); });
  ASSERT_TRUE(me != 0 || ::seteuid(0) == 0);
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
  for (const Error& e : {writing, growing}) {
    EXPECT_EQ(e.exit, Exit::resources);
    EXPECT_EQ(e.message, "cannot write: Permission denied");
  }
  EXPECT_EQ(reading.exit, Exit::resources);
  EXPECT_EQ(reading.message, "cannot read: Permission denied");
  EXPECT_EQ(folder.files(), std::set<std::string>{"secret.h5"});
}

TEST(Store, PythonReadsEveryKindOfArray) {
  const Folder folder;
  Store store = Store::create(folder / "a.h5");
  store.write<double>("/x", std::vector<double>{1.5, 2.5}, {2}, "m");
  store.write_strings("/names", std::vector<std::string>{"hull", "größe"});
  store.write_text("/scene", "[time]");
  store.set("/", "format", "hilo mesh");
  store.publish();
  const std::string script =
      "import h5py; f = h5py.File(\"" + (folder / "a.h5") +
      "\"); assert list(f[\"x\"][:]) == [1.5, 2.5]; assert f[\"x\"].attrs[\"unit\"] == \"m\"; "
      "assert list(f[\"names\"].asstr()[:]) == [\"hull\", \"größe\"]; assert f[\"scene\"].asstr()[()] == \"[time]\"; "
      "assert f.attrs[\"format\"] == \"hilo mesh\"";
  EXPECT_EQ(std::system(("/usr/bin/python3 -c '" + script + "'").c_str()), 0);
}

TEST(Store, AViewShowsArraysOneAfterTheOther) {
  const Folder folder;
  Store store = Store::create(folder / "a.h5");
  store.write<float>("/a", std::vector<float>{1, 2, 3, 4}, {2, 2});
  store.write<double>("/b", std::vector<double>{5, 6, 7, 0.1}, {2, 2});
  store.write<double>("/short", std::vector<double>{5, 6}, {1, 2});
  store.write_view("/v/all", {"/a", "", "/b"});
  store.name_also("/b", "/v/b");
  store.set("/v", "version", std::vector<std::int64_t>{2, 0});
  store.set_ascii("/v", "type", "grid");
  EXPECT_EQ(error_of([&] { store.write_view("/v/odd", {"/a", "/short"}); }).exit, Exit::fault);
  store.publish();
  const Store back = Store::open(folder / "a.h5");
  EXPECT_EQ(back.shape("/v/all"), (std::vector<std::int64_t>{6, 2}));
  EXPECT_EQ(back.type("/v/all"), "f8") << "as exact as its parts";
  EXPECT_EQ(back.read_rows<double>("/v/all", 0, 2), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(back.read_rows<double>("/v/all", 4, 2), (std::vector<double>{5, 6, 7, 0.1}));
  for (const double x : back.read_rows<double>("/v/all", 2, 2)) EXPECT_TRUE(std::isnan(x));
  EXPECT_EQ(back.read<double>("/v/b"), back.read<double>("/b"));
  EXPECT_EQ(back.text_attribute("/v", "type"), "grid");
}

TEST(Store, NamesWithSlashesComeBackUnchanged) {
  for (const std::string name : {"hull", "a/b", "50%", "%2F", ".", "a.b", "/"}) {
    EXPECT_EQ(to_link_name(name).find('/'), std::string::npos);
    EXPECT_EQ(from_link_name(to_link_name(name)), name);
  }
}

TEST(CommandLine, IsQuotedSoThatAShellReadsItBack) {
  const char* argv[] = {"/usr/bin/hilo-tag", "mesh.h5", "--rigid", "wheel_*", "it's", ""};
  EXPECT_EQ(command_line(6, const_cast<char**>(argv)), "hilo-tag mesh.h5 --rigid 'wheel_*' 'it'\\''s' ''");
}

}  // namespace
}  // namespace hilo::test::store_test
