// SPDX-License-Identifier: GPL-3.0-or-later
// What a stranger's .geo script may not do.
#pragma once
#include <string>

namespace hilo {

/// Error with file:line where the script, or one that it includes, runs a command, writes a file, reads the environment, ends the program,
/// or reads a file that is not in its folder.  gmsh sees the same words: the lexer is gmsh's, and where texts could make the two disagree
/// the script is refused.
void refuse_commands(const std::string& path);
/// Error with file:line where gmsh would leave out statements of the script: those behind the first of a last line without a line break.
void refuse_lost_statements(const std::string& path);

}  // namespace hilo
