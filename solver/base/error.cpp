// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <new>
#include <system_error>

#include "base/printable.hpp"

namespace hilo {
namespace {

std::string compose(const std::string& where, const std::string& what, const std::string& hint) {
  return (where.empty() ? "" : where + ": ") + what + (hint.empty() ? "" : " (" + hint + ")");
}

/// Keys, options and texts of files may hold line breaks.
std::string one_line(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  return text;
}

/// Damerau-Levenshtein distance (optimal string alignment).
size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<size_t>> d(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (size_t i = 1; i <= a.size(); ++i)
    for (size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

bool quiet = false, silent = false;
std::string current_tool = "hilo";

}  // namespace

Error::Error(std::string where_, std::string what_, std::string hint_, Exit exit_)
    : std::runtime_error(one_line(compose(where_, what_, hint_))),
      where(one_line(std::move(where_))),
      message(one_line(std::move(what_))),
      hint(one_line(std::move(hint_))),
      exit(exit_) {}

std::string suggest(std::string_view name, std::span<const std::string> candidates) {
  const std::string* best = nullptr;
  size_t least = std::max<size_t>(2, name.size() / 3) + 1;
  for (const auto& c : candidates)
    if (const size_t d = edit_distance(name, c); d < least) least = d, best = &c;
  return best ? fmt::format("did you mean \"{}\"?", *best) : "";
}

void warn(const std::string& where, const std::string& what) {
  if (!quiet) fmt::print(stderr, "{}: warning: {}\n", current_tool, printable(where + (where.empty() ? "" : ": ") + what));
}
void quiet_warnings(bool q) { quiet = q; }
void be_quiet() { silent = quiet = true; }
bool is_quiet() { return silent; }
void set_tool_name(std::string_view tool) { current_tool = tool; }
const std::string& tool_name() { return current_tool; }

int guarded(std::string_view tool, const std::function<void()>& body) {
  set_tool_name(tool);
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit (ulimit -f) is a write that fails
  const auto fail = [&](Exit exit, const std::string& text) {
    std::fflush(stdout);
    const std::string line = fmt::format("{}: {}\n", tool, printable(text));
    std::fputs(line.c_str(), stderr);  // does not throw when stderr is gone
    return static_cast<int>(exit);
  };
  const auto full = [] { return std::fflush(stdout) != 0 || std::ferror(stdout) != 0; };
  try {
    body();
    if (full()) return fail(Exit::resources, "cannot write to standard output");
    return static_cast<int>(Exit::done);
  } catch (const Error& e) {
    return fail(e.exit, e.what());
  } catch (const std::bad_alloc&) {
    return fail(Exit::resources, "out of memory");
  } catch (const std::system_error& e) {  // a print that failed, or a thread that could not be started
    if (full()) return fail(Exit::resources, "cannot write to standard output");
    if (std::ferror(stderr) != 0) return fail(Exit::resources, "cannot write to standard error");
    if (e.code() == std::errc::resource_unavailable_try_again || e.code() == std::errc::not_enough_memory)
      return fail(Exit::resources, "out of memory, or of processes (ulimit -v, ulimit -u)");
    return fail(Exit::fault, fmt::format("internal fault: {}", e.what()));
  } catch (const std::exception& e) {
    return fail(Exit::fault, fmt::format("internal fault: {}", e.what()));
  }
}

}  // namespace hilo
