// SPDX-License-Identifier: GPL-3.0-or-later
// One request to end may come as several signals; another, later, ends the process at once.
#include "base/interrupt.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>

using namespace hilo;

namespace {

void signals(useconds_t apart) {
  note_signals();
  std::raise(SIGINT), std::raise(SIGTERM);
  usleep(apart);
  std::raise(SIGTERM);
  _exit(noted_signal() == "SIGINT" ? 6 : 1);
}

}  // namespace

TEST(Signals, WithinASecondAreOne) { EXPECT_EXIT(signals(1000), testing::ExitedWithCode(6), ""); }
TEST(Signals, LaterEndTheProcess) { EXPECT_EXIT(signals(1'100'000), testing::KilledBySignal(SIGTERM), ""); }
