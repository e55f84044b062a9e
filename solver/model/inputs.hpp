// SPDX-License-Identifier: GPL-3.0-or-later
// What this process was given to read, so that nothing it writes takes its place.
#pragma once
#include <cstddef>
#include <string>

namespace hilo {

/// Remember a file that is read, or that a file which is read links to.  Whatever opens one says so here.
void note_input(const std::string& path);
/// A file that was read and closed, to be written anew, is an input no more.
void release_input(const std::string& path);
/// Error where `path`, to be written, is a file that was read, under this or another name (symbolic or hard link): exit 1; or where a
/// folder, device or pipe is in its place, which a rename would replace: exit 4.  Whatever writes a file asks here.
void check_output(const std::string& path);
/// A text beyond this is no scene, table or deck [bytes].
inline constexpr size_t most_text = size_t{1} << 28;

}  // namespace hilo
