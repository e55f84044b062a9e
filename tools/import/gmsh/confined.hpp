// SPDX-License-Identifier: GPL-3.0-or-later
// A library that reads a stranger's file, held by the kernel.
#pragma once
#include <functional>
#include <string>

namespace hilo {

/// Runs `body` in a thread of its own that may read files and nothing else: starting a program, opening a file to write, changing the
/// folder tree or talking to the network fail there (seccomp), and the environment is empty.  What `body` throws is thrown here.  Returns
/// "" or, where the kernel cannot do it, a sentence that says so.
std::string confined(const std::function<void()>& body);

}  // namespace hilo
