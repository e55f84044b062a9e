// SPDX-License-Identifier: GPL-3.0-or-later
// A disk that runs full, imitated by the largest size a process may give a file.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <functional>

#include "base/error.hpp"
#include "folder.hpp"
#include "model/store.hpp"

namespace hilo::test::full_disk_test {
namespace {

using test::Folder;

/// Run `body` in a child whose files may not grow beyond `bytes`; the child's exit code is that of the Error.
int with_file_limit(rlim_t bytes, const std::function<void()>& body, std::string& said) {
  int ends[2];
  EXPECT_EQ(::pipe(ends), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(ends[1], 2);
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, bytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    ::alarm(20);
    std::exit(guarded("test", body));
  }
  ::close(ends[1]);
  char buffer[512];
  for (ssize_t n; (n = ::read(ends[0], buffer, sizeof buffer)) > 0;) said.append(buffer, static_cast<size_t>(n));
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Store, FullDiskIsExitFourAndLeavesNothing) {
  const Folder folder;
  for (const rlim_t room : {0, 1000, 100000, 799000, 801000}) {
    std::string said;
    const int code = with_file_limit(
        room,
        [&] {
          Store store = Store::create(folder / "a.h5");
          store.write<double>("/x", std::vector<double>(100000, 1.), {100000});
          store.write_strings("/s", std::vector<std::string>(100, "name"));
          store.publish();
        },
        said);
    EXPECT_EQ(code, 4) << room << ": " << said;
    EXPECT_NE(said.find("a.h5: cannot write: File too large"), std::string::npos) << room << ": " << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    EXPECT_TRUE(folder.files().empty()) << room;
  }
}

TEST(Store, FullDiskStopsAGrowingFileWithExitFour) {
  const Folder folder;
  std::string said;
  const int code = with_file_limit(
      200000,
      [&] {
        Store store = Store::create_growing(folder / "run.h5");
        store.start_rows<double>("/t", {100});
        for (int step = 0; step < 10000; ++step) {
          store.append<double>("/t", std::vector<double>(100, step));
          store.flush();
        }
      },
      said);
  EXPECT_EQ(code, 4) << said;
  EXPECT_NE(said.find("run.h5: cannot write: File too large"), std::string::npos) << said;
}

TEST(TextFile, IsWrittenWholeOrNotAtAll) {
  const Folder folder;
  write_text_file(folder / "run.json", "{}\n");
  EXPECT_EQ(read_text_file(folder / "run.json"), "{}\n");
  std::string said;
  EXPECT_EQ(with_file_limit(
                10, [&] { write_text_file(folder / "run.json", std::string(100, 'x')); }, said),
            4);
  EXPECT_EQ(read_text_file(folder / "run.json"), "{}\n");
  EXPECT_EQ(folder.files(), std::set<std::string>{"run.json"});
}

}  // namespace
}  // namespace hilo::test::full_disk_test
