// SPDX-License-Identifier: GPL-3.0-or-later
// A file written through a journal: what is read is what was written, what is on disk is what was committed, whatever happens in between.
#include "model/journalled_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <memory>
#include <random>

#include "base/digest.hpp"
#include "base/error.hpp"
#include "folder.hpp"
#include "model/store.hpp"

namespace hilo::test::journalled_file_test {
namespace {

using Bytes = std::vector<std::byte>;

Bytes on_disk(const std::string& path) {
  const std::string text = text_of(path);
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

std::unique_ptr<JournalledFile> opened(const std::string& path) {
  return std::make_unique<JournalledFile>(path, ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
}

// Any writes, reads, ends and commits, against the same in memory; left at any moment the file is as committed.
TEST(JournalledFile, IsWhatWasWrittenAndOnDiskWhatWasCommitted) {
  std::mt19937 random(7);
  const auto below = [&](size_t n) { return static_cast<size_t>(random() % n); };
  for (int trial = 0; trial < 200; ++trial) {
    const Folder folder;
    const std::string path = folder / "a.h5";
    auto file = opened(path);
    Bytes now, committed;
    bool shrunk = false;
    for (int k = 0; k < 60; ++k) {
      const size_t what = below(10);
      if (what < 6) {
        const size_t at = below(now.size() + 50), n = 1 + below(80);
        Bytes piece(n);
        for (std::byte& b : piece) b = static_cast<std::byte>(random());
        ASSERT_TRUE(file->write(at, piece));
        now.resize(std::max(now.size(), at + n));
        std::copy(piece.begin(), piece.end(), now.begin() + static_cast<std::ptrdiff_t>(at));
      } else if (what < 8 && !now.empty()) {
        const size_t at = below(now.size());
        Bytes piece(1 + below(now.size() - at));
        ASSERT_TRUE(file->read(at, piece));
        ASSERT_TRUE(std::equal(piece.begin(), piece.end(), now.begin() + static_cast<std::ptrdiff_t>(at))) << "trial " << trial;
      } else if (what == 8) {
        ASSERT_TRUE(file->commit(below(20) == 0));
        committed = now;
        ASSERT_TRUE(on_disk(path) == committed) << "trial " << trial;
      } else if (below(3) == 0 && now.size() > committed.size()) {  // what HDF5 gives back lies at the end
        now.resize(committed.size() + below(now.size() - committed.size()));
        file->end_at(now.size());
        shrunk = true;
        ASSERT_TRUE(file->commit());
        committed = now;
      }
    }
    file->give_up();
    file.reset();
    ASSERT_TRUE(on_disk(path) == committed) << "trial " << trial << (shrunk ? " with" : " without") << " a shorter end";
    ASSERT_EQ(folder.files().size(), 1u);
  }
}

// The journal of a process that was killed while it put it in place.
TEST(JournalledFile, IsMendedByTheNextWhoOpensIt) {
  const Folder folder;
  const std::string path = folder / "run.h5";
  {
    Store run = Store::create_growing(path);
    run.start_rows<double>("/t", {});
    for (int k = 0; k < 10; ++k) run.append<double>("/t", std::vector<double>{1. * k});
    run.flush();
  }
  const std::string first = text_of(path);
  std::string journal;
  {
    Store run = Store::open_growing(path);
    run.start_rows<double>("/t", {});
    for (int k = 10; k < 3000; ++k) run.append<double>("/t", std::vector<double>{1. * k});
    run.flush();
  }
  const std::string second = text_of(path);
  // as JournalledFile has it: all of the second content, to be put over the first
  const auto put = [&](std::uint64_t value) { journal.append(reinterpret_cast<const char*>(&value), 8); };
  journal = "hilojrnl";
  put(second.size()), put(0), put(second.size());
  journal += second;
  const std::string without_digest = journal;
  put(Digest().add(std::as_bytes(std::span(journal))).value());
  const auto rows = [&] { return Store::open(path).shape("/t")[0]; };
  // cut off anywhere it is dropped, and the file is as it was
  for (const size_t n : {size_t{0}, size_t{5}, size_t{30}, journal.size() / 2, journal.size() - 1}) {
    write_text(path, first), write_text(path + ".journal", journal.substr(0, n));
    EXPECT_EQ(rows(), 10) << n;
    EXPECT_EQ(folder.files(), std::set<std::string>{"run.h5"});
  }
  // whole it is put in place, also over a file of which half was written
  write_text(path, second.substr(0, second.size() / 2) + std::string(first.size(), 'x')), write_text(path + ".journal", journal);
  EXPECT_EQ(rows(), 3000);
  EXPECT_EQ(text_of(path), second);
  EXPECT_EQ(folder.files(), std::set<std::string>{"run.h5"});
}

TEST(GrowingFile, ReplacesTheFormerOneWithItsFirstFlush) {
  const Folder folder;
  const std::string path = folder / "run.h5";
  write_text(path, "former");
  {
    Store run = Store::create_growing(path);
    run.set("/", "format", std::string("hilo run"));
    EXPECT_EQ(text_of(path), "former");
  }
  EXPECT_EQ(text_of(path), "former") << "left before its first flush";
  EXPECT_EQ(folder.files(), std::set<std::string>{"run.h5"});
  {
    Store run = Store::create_growing(path);
    run.set("/", "format", std::string("hilo run"));
    run.flush();
    run.set("/", "more", std::string("text"));
  }
  const Store run = Store::open(path);
  EXPECT_EQ(run.text_attribute("/", "format"), "hilo run");
  EXPECT_FALSE(run.text_attribute("/", "more")) << "as the last flush left it";
}

TEST(GrowingFile, GrowsOnWithFewerRowsAndOthers) {
  const Folder folder;
  const std::string path = folder / "run.h5";
  {
    Store run = Store::create_growing(path);
    run.start_rows<double>("/t", {2});
    for (int k = 0; k < 5000; ++k) run.append<double>("/t", std::vector<double>{1. * k, 2. * k});
    run.write<double>("/x", std::vector<double>{1, 2, 3}, {3});
    run.write_text("/scene", "one");
    run.write<double>("/field/000001/v", std::vector<double>(5000, 1.0), {5000});
    run.flush();
  }
  {
    Store run = Store::open_growing(path);
    run.start_rows<double>("/t", {2});
    run.keep_rows("/t", 100);
    run.append<double>("/t", std::vector<double>{-1, -2});
    run.write_text("/scene", "two");
    run.remove("/field/000001");
    run.flush();
    EXPECT_THROW(run.start_rows<double>("/x", {2}), Error);
  }
  const Store run = Store::open(path);
  EXPECT_EQ(run.shape("/t"), (std::vector<std::int64_t>{101, 2}));
  EXPECT_EQ(run.read_rows<double>("/t", 99, 2), (std::vector<double>{99, 198, -1, -2}));
  EXPECT_EQ(run.read_text("/scene"), "two");
  EXPECT_EQ(run.read<double>("/x"), (std::vector<double>{1, 2, 3}));
  EXPECT_FALSE(run.has("/field/000001"));
}

TEST(GrowingFile, IsOfOneWriterAtATime) {
  const Folder folder;
  const std::string path = folder / "run.h5";
  for (const bool has_name : {false, true}) {
    Store first = Store::create_growing(path);
    if (has_name) first.flush();
    try {
      Store::create_growing(path);
      FAIL() << "a second writer";
    } catch (const Error& e) {
      EXPECT_EQ(e.exit, Exit::resources);
      EXPECT_EQ(e.message, "another program has it open");
    }
    if (has_name) {
      EXPECT_THROW(Store::open_growing(path), Error);
    }
  }
  Store::create_growing(path).flush();  // the first is gone
}

}  // namespace
}  // namespace hilo::test::journalled_file_test
