// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/args.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>

#include "base/error.hpp"

namespace hilo {
namespace {

/// CLI11 tells a range as "1 to 8" (2.1) or "[1 - 8]" (2.4), and an open one by the smallest and largest doubles.
std::string in_words(const CLI::ParseError& error) {
  const std::string text = error.what(), words = " not in range ";
  const size_t range = text.rfind(words), value = text.find("Value ");
  if (range == text.npos || value > range) return text;
  const size_t from = text.find_first_not_of('[', range + words.size());
  if (from == text.npos) return text;
  char* after = nullptr;
  const double least = std::strtod(text.c_str() + from, &after);
  const size_t to = text.find_first_of("0123456789", static_cast<size_t>(after - text.c_str()));
  if (to == text.npos) return text;
  const double most = std::strtod(text.c_str() + to, nullptr);
  if (most < 1e300) return text.substr(0, range) + words + fmt::format("{} to {}", least, most);
  const std::string given = text.substr(value + 6, range - value - 6);
  char* end = nullptr;
  const double number = std::strtod(given.c_str(), &end);
  const bool is_number = end == given.c_str() + given.size();
  return text.substr(0, value) + given + (!is_number ? " is not a number" : number < 0 ? " is negative" : " is not above 0");
}

constexpr auto exit_codes =
    "Exit codes: 0 done, 1 usage, 2 bad input, 3 did not converge, 4 resources (memory, disk, packages), 5 internal error, "
    "6 stopped from outside";

/// Long options of an app and its subcommands' names: what a completion offers and a mistyped word is compared with.
std::vector<std::string> long_options(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* o : app.get_options())
    for (const auto& name : o->get_lnames()) names.push_back("--" + name);
  return names;
}
std::vector<std::string> subcommands(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* s : app.get_subcommands({})) names.push_back(s->get_name());
  return names;
}

/// Words left over of the app or the subcommand in use.
std::vector<std::string> left_over(const CLI::App& app) {
  auto words = app.remaining();
  for (const CLI::App* s : app.get_subcommands()) {
    const auto more = left_over(*s);
    words.insert(words.end(), more.begin(), more.end());
  }
  return words;
}

[[noreturn]] void wrong_usage(const CLI::App& app, const CLI::ParseError& error) {
  auto known = long_options(app);
  for (const CLI::App* s : app.get_subcommands()) {
    const auto more = long_options(*s);
    known.insert(known.end(), more.begin(), more.end());
  }
  const std::string help = fmt::format("see {} --help", app.get_name());
  for (const auto& word : left_over(app))
    if (word.starts_with("-") && word.size() > 1) {
      const auto name = word.substr(0, word.find('='));
      const auto hint = suggest(name, known);
      throw Error("", fmt::format("unknown option {}", name), hint.empty() ? help : hint, Exit::usage);
    }
  const auto names = subcommands(app);
  for (const auto& word : left_over(app)) {
    if (!names.empty() && app.get_subcommands().empty()) {
      const auto hint = suggest(word, names);
      throw Error("", fmt::format("unknown command {}", word), hint.empty() ? help : hint, Exit::usage);
    }
    throw Error("", fmt::format("unexpected argument {}", word), help, Exit::usage);
  }
  throw Error("", in_words(error), help, Exit::usage);
}

/// CLI11 takes nan, inf and 1e400 as numbers, and nan as positive.
void refuse_endless(const CLI::App& app, const std::string& help) {
  for (const CLI::Option* o : app.get_options())
    if (o->get_type_name().starts_with("FLOAT"))
      for (const std::string& given : o->results())
        if (!std::isfinite(std::strtod(given.c_str(), nullptr)))
          throw Error("", fmt::format("{}: {} is not a finite number", o->get_name(), given), help, Exit::usage);
  for (const CLI::App* s : app.get_subcommands()) refuse_endless(*s, help);
}

std::string roff(const std::string& text) {
  std::string out;
  bool line_start = true;
  for (const char c : text) {
    if (line_start && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
    line_start = c == '\n';
  }
  return out;
}

/// "-o, --output FILE"
std::string signature(const CLI::Option& o) {
  std::string names;
  for (const auto& s : o.get_snames()) names += (names.empty() ? "-" : ", -") + s;
  for (const auto& l : o.get_lnames()) names += (names.empty() ? "--" : ", --") + l;
  if (names.empty()) names = o.get_name(true);
  const bool flag = o.get_items_expected_max() == 0;
  return flag ? names : fmt::format("{} {}{}", names, o.get_type_name(), o.get_expected_max() > 1 ? " ..." : "");
}

std::string man_options(const CLI::App& app) {
  std::string out;
  for (const CLI::Option* o : app.get_options())
    if (!o->get_group().empty()) out += fmt::format(".TP\n.B {}\n{}\n", roff(signature(*o)), roff(o->get_description()));
  return out;
}

/// Rows of a Markdown table, positionals first.
std::string markdown_options(const CLI::App& app) {
  std::string first, then;
  const auto cell = [](std::string text) {
    for (size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
    return text;
  };
  for (const CLI::Option* o : app.get_options()) {
    if (o->get_group().empty()) continue;
    const std::string fallback = o->get_required()              ? "required"
                                 : o->get_default_str().empty() ? ""
                                                                : fmt::format("`{}`", o->get_default_str());
    (o->get_positional() ? first : then) +=
        fmt::format("| `{}` | {} | {} |\n", cell(signature(*o)), cell(fallback), cell(o->get_description()));
  }
  return "| option | default | meaning |\n|---|---|---|\n" + first + then;
}

std::string example_of(const CLI::App& app) {
  const std::string footer = app.get_footer();
  const auto at = footer.find("Example:\n");
  return at == std::string::npos ? "" : footer.substr(at + 9);
}

}  // namespace

std::string version() { return HILO_VERSION; }

std::unique_ptr<CLI::App> make_app(const ToolInfo& info) {
  auto app = std::make_unique<CLI::App>(info.summary, info.name);
  app->set_help_flag("-h,--help", "this text");
  app->set_version_flag("--version", fmt::format("{} {}{}{}", info.name, version(), info.about.empty() ? "" : "\n", info.about),
                        "version, commit, and versions of libraries");
  app->add_flag_callback("--quiet", be_quiet, "no warnings, no progress, and no table where a file is written");
  app->fallthrough();  // --quiet is understood behind a subcommand too
  app->get_formatter()->column_width(34);
  example(*app, info.example);
  return app;
}

void example(CLI::App& app, const std::string& lines) {
  std::string indented;
  for (const auto& line : CLI::detail::split(lines, '\n')) {
    const auto first = line.find_first_not_of(' ');
    if (first != std::string::npos) indented += (indented.empty() ? "  " : "\n  ") + line.substr(first);
  }
  app.footer(fmt::format("{}\n\nExample:\n{}", exit_codes, indented));
}

bool parse(CLI::App& app, int argc, const char* const* argv) {
  if (argc == 2 && std::string_view(argv[1]) == "--completion") return fmt::print("{}", bash_completion(app)), false;
  if (argc == 2 && std::string_view(argv[1]) == "--man") return fmt::print("{}", man_page(app)), false;
  if (argc == 2 && std::string_view(argv[1]) == "--markdown") return fmt::print("{}", markdown_page(app)), false;
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", app.help());
    return false;
  } catch (const CLI::CallForVersion& v) {
    fmt::print("{}\n", v.what());
    return false;
  } catch (const CLI::ParseError& error) {
    wrong_usage(app, error);
  }
  refuse_endless(app, fmt::format("see {} --help", app.get_name()));
  return true;
}

std::string bash_completion(const CLI::App& app) {
  std::string function = "_" + app.get_name();
  std::replace(function.begin(), function.end(), '-', '_');
  const auto top = long_options(app);
  std::string cases;
  for (const CLI::App* s : app.get_subcommands({}))
    cases += fmt::format("      {}) words=\"{} {}\" ;;\n", s->get_name(), fmt::join(long_options(*s), " "), fmt::join(top, " "));
  std::string out = fmt::format("# bash completion of {0}\n{1}() {{\n  local cur=${{COMP_WORDS[COMP_CWORD]}} words=\"{2}\" word\n",
                                app.get_name(), function, fmt::join(top, " "));
  if (!cases.empty())
    out += fmt::format(
        "  [[ $COMP_CWORD == 1 ]] && words=\"{} $words\"\n  for word in \"${{COMP_WORDS[@]:1}}\"; do\n    case $word in\n{}    esac\n  "
        "done\n",
        fmt::join(subcommands(app), " "), cases);
  out += fmt::format("  COMPREPLY=()\n  if [[ $cur == -* || {} ]]; then COMPREPLY=($(compgen -W \"$words\" -- \"$cur\")); fi\n}}\n",
                     cases.empty() ? "1 == 0" : "$COMP_CWORD == 1");
  return out + fmt::format("complete -o default -F {} {}\n", function, app.get_name());
}

std::string man_page(const CLI::App& app) {
  std::string upper = app.get_name();
  std::transform(upper.begin(), upper.end(), upper.begin(), [](unsigned char c) { return std::toupper(c); });
  std::string arguments;
  for (const CLI::Option* o : app.get_options())
    if (o->get_positional() && !o->get_group().empty())
      arguments += o->get_required() ? fmt::format(" {}", o->get_name(true)) : fmt::format(" [{}]", o->get_name(true));
  const auto commands = app.get_subcommands({});
  std::string out = fmt::format(".TH {} 1 \"\" \"hilo {}\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n.B {}\n[options]{}{}\n", upper, version(),
                                roff(app.get_name()), roff(app.get_description()), roff(app.get_name()), commands.empty() ? "" : " command",
                                roff(arguments));
  out += ".SH OPTIONS\n" + man_options(app);
  for (const CLI::App* s : commands)
    out += fmt::format(".SH COMMAND {}\n{}\n{}.PP\nExample:\n.nf\n{}\n.fi\n", roff(s->get_name()), roff(s->get_description()),
                       man_options(*s), roff(example_of(*s)));
  out += fmt::format(".SH EXIT STATUS\n{}\n.SH EXAMPLE\n.nf\n{}\n.fi\n", roff(std::string(exit_codes).substr(12)), roff(example_of(app)));
  return out;
}

std::string markdown_page(const CLI::App& app) {
  const auto commands = app.get_subcommands({});
  std::string out = fmt::format("# {0}\n\n*Generated by `docs/tools/write.sh` from the options of {0}; do not edit.*\n\n{1}\n\n",
                                app.get_name(), app.get_description());
  const auto block = [](const std::string& lines) { return fmt::format("\n```sh\n{}\n```\n", lines); };
  const auto plain = [](std::string lines) {  // without the indent of the help text
    for (size_t at = 0; (at = lines.find("  ", at)) != std::string::npos && (at == 0 || lines[at - 1] == '\n');) lines.erase(at, 2);
    return lines;
  };
  out += markdown_options(app) + block(plain(example_of(app)));
  for (const CLI::App* s : commands)
    out += fmt::format("\n## {} {}\n\n{}\n\n{}{}", app.get_name(), s->get_name(), s->get_description(), markdown_options(*s),
                       block(plain(example_of(*s))));
  return out + fmt::format("\n{}.\n", exit_codes);
}

}  // namespace hilo
