// SPDX-License-Identifier: GPL-3.0-or-later
// Where results go: a file, whole or not at all, or stdout.
#pragma once
#include <string>

namespace hilo {

/// To a file (its folder is made), whole or not at all, or to stdout for "-".
void write_out(const std::string& path, const std::string& bytes);

}  // namespace hilo
