// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/gmsh/script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "model/store.hpp"

namespace hilo {
namespace {
namespace fs = std::filesystem;
using std::string_view;

struct Token {
  enum Kind { word, text, sign, end } kind;
  string_view is;  // without quotes
  size_t line;
};

constexpr const char* trust = "--trust allows it, for a script whose author you know";

/// Words that never stand for anything harmless, in texts neither (a text may become a command where gmsh skips to an EndIf).
constexpr std::array<std::pair<string_view, string_view>, 12> never{{
    {"SystemCall", "runs a command"},
    {"System", "runs a command"},
    {"NonBlockingSystemCall", "runs a command"},
    {"OnelabRun", "runs a command"},
    {"OnelabAction", "runs a command"},
    {"ExternalProcess", "runs a command"},
    {"CommandLine", "runs a command"},
    {"GetEnv", "reads the environment"},
    {"Plugin", "runs a plugin, which may write files"},
    {"Exit", "ends the program"},
    {"CreateDir", "makes a folder"},
    {"SendToServer", "talks to a server"},
}};
/// Commands by their place only: elsewhere they are parts of names.
constexpr std::array<string_view, 2> writers{"Save", "Print"};
constexpr std::array<string_view, 3> printers{"Printf", "Error", "Warning"};
constexpr std::array<string_view, 5> readers{"Include", "Merge", "MergeWithBoundingBox", "ShapeFromFile", "ListFromFile"};
/// What gmsh reads by the ending of its name, as a geometry or mesh; whatever else is merged it takes for a script.
constexpr std::array<string_view, 16> geometries{".step", ".STEP", ".stp", ".STP", ".iges", ".IGES", ".igs",  ".IGS",
                                                 ".brep", ".brp",  ".BRP", ".rle", ".stl",  ".STL",  ".mesh", ".MESH"};

template <class List>
bool among(const List& list, string_view word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
bool is_of_word(char c) { return is_letter(c) || std::isdigit(static_cast<unsigned char>(c)); }

/// gmsh stops at the end of the file, wherever in the last line it then is.
void require_line_end(const std::string& path, const std::string& text) {
  const size_t begin = text.find_last_of('\n') + 1;
  if (std::count(text.begin() + static_cast<std::ptrdiff_t>(begin), text.end(), ';') < 2) return;
  throw Error(fmt::format("{}:{}", path, std::count(text.begin(), text.end(), '\n') + 1),
              "the file ends within a line of several statements, and gmsh may leave out the last of them", "end it with a line break");
}

class Script {
 public:
  Script(const std::string& path, const fs::path& folder, std::set<fs::path>& seen)
      : path_(path), folder_(folder), seen_(seen), text_(read_text_file(path)) {}

  void check() {
    if (text_.find('\0') != text_.npos) throw Error(path_, "a script with a zero byte in it", trust);
    require_line_end(path_, text_);
    if (text_.starts_with('$')) fail(1, "it begins as a mesh, not as a script", "name it .msh");
    look_beside(path_);
    tokens();
    for (size_t i = 0; i < tokens_.size(); ++i)
      if (tokens_[i].kind == Token::word)
        look_at(i);
      else if (tokens_[i].kind == Token::text)
        look_into(tokens_[i]);
  }

 private:
  [[noreturn]] void fail(size_t line, const std::string& what, const std::string& hint = trust) const {
    throw Error(fmt::format("{}:{}", path_, line), what, hint);
  }

  void tokens() {
    size_t line = 1;
    const auto skip_to = [&](size_t from, size_t to) {
      line += static_cast<size_t>(
          std::count(text_.begin() + static_cast<std::ptrdiff_t>(from), text_.begin() + static_cast<std::ptrdiff_t>(to), '\n'));
    };
    for (size_t at = 0; at < text_.size();) {
      const char c = text_[at];
      size_t to = at + 1;
      if (c == '/' && text_.compare(at, 2, "//") == 0) {
        to = std::min(text_.find('\n', at), text_.size());
      } else if (c == '/' && text_.compare(at, 2, "/*") == 0) {
        to = text_.find("*/", at + 2);
        if (to == text_.npos) fail(line, "a comment without an end");
        to += 2;
      } else if (c == '"' || c == '\'') {
        to = text_.find(c, at + 1);
        if (to == text_.npos) fail(line, "a text without an end");
        if (to - at > 1000) fail(line, "a text of more than 1000 letters", "gmsh would read its end as commands");
        tokens_.push_back({Token::text, string_view(text_).substr(at + 1, to - at - 1), line});
        ++to;
      } else if (is_letter(c)) {
        while (to < text_.size() && is_of_word(text_[to])) ++to;
        tokens_.push_back({Token::word, string_view(text_).substr(at, to - at), line});
      } else if (std::isdigit(static_cast<unsigned char>(c)) ||
                 (c == '.' && to < text_.size() && std::isdigit(static_cast<unsigned char>(text_[to])))) {
        to = number(at);
        tokens_.push_back({Token::sign, "0", line});
      } else if (!std::isspace(static_cast<unsigned char>(c))) {
        tokens_.push_back({Token::sign, string_view(text_).substr(at, 1), line});
      }
      skip_to(at, to);
      at = to;
    }
  }

  /// Behind a number: 1, 1., .5, 1e3, 1.5e-3.  "1Include" is the number 1 and a word.
  size_t number(size_t at) const {
    const auto digits = [&] {
      while (at < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at]))) ++at;
    };
    digits();
    if (at < text_.size() && text_[at] == '.') ++at, digits();
    if (at < text_.size() && (text_[at] == 'e' || text_[at] == 'E')) {
      size_t exponent = at + 1;
      if (exponent < text_.size() && (text_[exponent] == '-' || text_[exponent] == '+')) ++exponent;
      if (exponent < text_.size() && std::isdigit(static_cast<unsigned char>(text_[exponent]))) at = exponent, digits();
    }
    return at;
  }

  Token at(size_t i) const { return i < tokens_.size() ? tokens_[i] : Token{Token::end, "", tokens_.empty() ? 1 : tokens_.back().line}; }

  void look_at(size_t i) {
    const Token& t = tokens_[i];
    const bool option = i > 0 && at(i - 1).kind == Token::sign && at(i - 1).is == ".";
    for (const auto& [word, does] : never)
      if (t.is == word) fail(t.line, fmt::format("{} {}", t.is, does));
    if (t.is.ends_with("FileName") && t.is != "CurrentFileName") fail(t.line, fmt::format("{} names a file", t.is));
    if (t.is == "Solver" && at(i + 1).is == ".") fail(t.line, "Solver options name programs to run");
    if (option) return;
    if (among(writers, t.is) &&
        !(at(i + 1).kind == Token::sign && string_view("=.([~+-*/,;)]}<>!&|?:").find(at(i + 1).is) != string_view::npos))
      fail(t.line, fmt::format("{} writes a file", t.is));
    if (among(printers, t.is)) look_behind_brackets(i);
    if (among(readers, t.is)) look_at_file(i);
  }

  /// Printf(...) > "file", >> "file"
  void look_behind_brackets(size_t i) const {
    const size_t first = i;
    int depth = 0;
    for (++i; i < tokens_.size(); ++i) {
      if (at(i).kind != Token::sign) continue;
      const char c = at(i).is[0];
      if (c == '(' || c == '[' || c == '{') ++depth;
      if (c == ')' || c == ']' || c == '}') --depth;
      if (depth <= 0 && c == '>') fail(at(first).line, fmt::format("{} writes a file", at(first).is));
      if (depth <= 0 && c == ';') return;
    }
  }

  /// gmsh runs NAME.opt after NAME.
  void look_beside(const std::string& file) {
    std::error_code bad;
    if (fs::is_regular_file(file + ".opt", bad) && seen_.insert(fs::weakly_canonical(fs::absolute(file + ".opt"))).second)
      Script(file + ".opt", folder_, seen_).check();
  }

  void look_at_file(size_t i) {
    const Token command = at(i);
    size_t next = i + 1;
    while (at(next).kind == Token::sign && (at(next).is == "(" || at(next).is == "[")) ++next;
    const Token name = at(next), behind = at(next + 1);
    if (name.kind != Token::text || behind.kind != Token::sign || !(behind.is == ";" || behind.is == ")" || behind.is == "]"))
      fail(command.line, fmt::format("{} of a file whose name is not written out", command.is));
    const fs::path file(name.is);
    std::error_code bad;
    const fs::path whole = fs::weakly_canonical(fs::absolute(fs::path(path_).parent_path() / file), bad);
    const auto within = whole.lexically_relative(folder_);
    if (file.is_absolute() || bad || within.empty() || *within.begin() == "..")
      fail(command.line, fmt::format("{} of \"{}\", which is not in the script's folder", command.is, name.is));
    if (!fs::is_regular_file(whole, bad)) return;  // gmsh says so, or does without
    const std::string beside = (fs::path(path_).parent_path() / file).lexically_normal().string();
    look_beside(beside);
    const std::string ending = whole.extension().string();
    if (command.is == "ListFromFile") return;
    if (command.is != "Include" && among(geometries, ending)) return;
    if (command.is == "ShapeFromFile")
      fail(command.line, fmt::format("ShapeFromFile of \"{}\", which is not named as a geometry", name.is));
    if (command.is != "Include" && ending == ".msh") {
      std::string head(11, ' ');
      std::ifstream(whole).read(head.data(), 11);
      if (head == "$MeshFormat") return;
    }
    if (command.is != "Include" && ending != ".geo")
      fail(command.line, fmt::format("{} of \"{}\", which gmsh would take for a script", command.is, name.is),
           "name a script .geo; or " + std::string(trust));
    if (seen_.insert(whole).second) Script(beside, folder_, seen_).check();
  }

  void look_into(const Token& text) const {
    for (const auto& [word, does] : never)
      if (word != "System" && word != "Exit" && word != "Plugin")
        for (size_t from = 0; (from = text.is.find(word, from)) != text.is.npos; ++from)
          if ((from == 0 || !is_of_word(text.is[from - 1])) &&
              (from + word.size() == text.is.size() || !is_of_word(text.is[from + word.size()])))
            fail(text.line, fmt::format("{} (in a text) {}", word, does));
  }

  std::string path_;
  fs::path folder_;
  std::set<fs::path>& seen_;
  std::string text_;
  std::vector<Token> tokens_;
};

}  // namespace

void refuse_lost_statements(const std::string& path) { require_line_end(path, read_text_file(path)); }

void refuse_commands(const std::string& path) {
  std::set<fs::path> seen{fs::weakly_canonical(fs::absolute(path))};
  const fs::path parent = fs::path(path).parent_path();
  Script(path, fs::weakly_canonical(parent.empty() ? "." : parent), seen).check();
}

}  // namespace hilo
