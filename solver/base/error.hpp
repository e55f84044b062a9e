// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of hilo: one line that says where, what and what to do, and the exit code that goes with it.
#pragma once
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace hilo {

/// Exit codes of every command (documented in docs/format.md and in each --help).
enum class Exit : int { done = 0, usage = 1, input = 2, not_converged = 3, resources = 4, fault = 5, stopped = 6 };

/// Wrong input, a missing resource or a run that cannot go on.  Printed as "tool: where: what (hint)".
struct Error : std::runtime_error {
  Error(std::string where, std::string what, std::string hint = "", Exit exit = Exit::input);
  std::string where, message, hint;
  Exit exit;
};

/// `did you mean "turret"?` for the candidate nearest to `name` in edit distance, or "" when none is near.
std::string suggest(std::string_view name, std::span<const std::string> candidates);

/// Run the body of a main: print any Error as one line on stderr, and return the exit code.
/// std::bad_alloc gives 4, any other exception 5.  `hint` texts are put in parentheses.
int guarded(std::string_view tool, const std::function<void()>& body);

/// A one-line warning on stderr: "tool: warning: where: what".  Silent after `quiet_warnings(true)`.
void warn(const std::string& where, const std::string& what);
void quiet_warnings(bool quiet);
/// --quiet was given: no warnings, and progress and remarks on stderr ask is_quiet().  The same on all ranks.
void be_quiet();
bool is_quiet();
void set_tool_name(std::string_view tool);
const std::string& tool_name();

}  // namespace hilo
