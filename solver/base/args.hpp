// SPDX-License-Identifier: GPL-3.0-or-later
// Command lines: CLI11 with the habits that all tools share (--help with an example, --version, --quiet, hidden --completion, --man,
// --markdown).
#pragma once
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

namespace hilo {

/// What a tool says of itself.  `name` is the command ("hilo-tag"), `summary` one sentence, `example` command lines that run as printed,
/// `about` further lines of --version.
struct ToolInfo {
  std::string name, summary, example, about = {};
};

/// An app with --version, --quiet, --completion and --man.  Its help ends with the exit codes and the example.
/// Add options with the CLI11 calls; a subcommand gets its example with example().
std::unique_ptr<CLI::App> make_app(const ToolInfo& info);
/// Give a subcommand its own example, printed at the end of its help.
void example(CLI::App& subcommand, const std::string& lines);

/// Parse the command line.  False when --help, --version, --completion, --man or --markdown was printed: main then ends with exit 0.
/// A wrong command line is an Error with Exit::usage and, for a mistyped option or subcommand, the nearest one.
bool parse(CLI::App& app, int argc, const char* const* argv);

/// Version of hilo, "0.1.0".
std::string version();

/// Bash completion script and man page (roff), both from the app's option table.
std::string bash_completion(const CLI::App& app);
std::string man_page(const CLI::App& app);
/// The page of docs/tools: tables of options and the examples, subcommands below.
std::string markdown_page(const CLI::App& app);

}  // namespace hilo
