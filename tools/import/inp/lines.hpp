// SPDX-License-Identifier: GPL-3.0-or-later
// The lines of an Abaqus or CalculiX deck: keyword cards with parameters, and data lines cut at commas.
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "import/data_line.hpp"

namespace hilo {

/// A keyword card, "*SOLID SECTION, ELSET=EALL".
struct Card {
  struct Param {
    std::string value;
    int column;
    mutable bool asked = false;  // by a reader
  };
  std::string key;                      // "SOLIDSECTION": upper case, blanks removed
  std::string name;                     // "*SOLID SECTION": as listed to the user
  std::map<std::string, Param> params;  // keys as in `key`, values as written, quotes taken off
  const std::string* file = nullptr;
  int line = 0;

  std::string place() const;
  std::string place(const std::string& param) const;
  /// Null where the card has it not.
  const Param* find(const std::string& param) const;
  bool has(const std::string& param) const { return find(param) != nullptr; }
  std::string value(const std::string& param, const std::string& fallback = "") const;
  /// The value upper case without blanks: what keywords are compared with.
  std::string word(const std::string& param, const std::string& fallback = "") const;
  /// The value of a parameter that must be there.
  std::string need(const std::string& param) const;
  /// The same as a number; Error where it is none.
  double number(const std::string& param) const;
  std::int64_t integer(const std::string& param) const;
};

/// A text without the quotes about it.
std::string_view unquote(std::string_view text);

/// Reads a deck card by card, line by line; *INCLUDE, and INPUT= of a card, are followed in place.  Plain or gzip text.
class InpLines {
 public:
  explicit InpLines(const std::string& path);
  /// The next keyword card; data lines not asked for are skipped.  False at the end of the deck.
  bool next_card(Card& card);
  /// The next data line before the next card.
  bool next_data(DataLine& line);
  /// Data of the card before that nobody asked for: how many lines have some, and the first of them.  Known once the next card is there.
  struct Unread {
    std::int64_t lines = 0;
    std::string place = {};
  };
  Unread take_unread() { return std::exchange(unread_, {}); }
  /// The same as a whole, with its place.
  bool next_text(std::string_view& text, std::string& place);
  /// How many lines of the deck's file begin with this word, "*INSTANCE".
  int count(std::string_view word) const;
  /// The place behind the card at hand, for read_again().
  struct Mark;
  Mark mark() const;
  /// Reads on from there, until go_back().
  void read_again(const Mark& from);
  void go_back();
  /// What stands for `<name>` in the lines that follow (*PARAMETER).
  void set(const std::string& name, const std::string& value) { values_[name] = value; }

 private:
  struct Source {
    std::shared_ptr<const std::string> path;
    std::shared_ptr<const std::string> text;
    size_t at = 0, line_at = 0;  // behind the last line, and where it began
    int line = 0;
  };
  bool next_line(std::string_view& line);
  void settle();
  void count_unread();
  void put_values(std::string_view& line);
  void open(const std::string& path, const std::string& place);
  /// Goes on with the file that a card names, seen from the folder of the deck, then returns to this one.
  void include(const std::string& name, const std::string& card, const std::string& place);
  /// A line read ahead is read once more, behind what is put in front of it.
  void give_back();
  friend struct Mark;
  std::vector<Source> stack_;
  std::vector<Source> kept_;  // texts and names that fields and places point into
  std::string folder_;
  std::optional<std::string_view> ahead_;
  std::uint64_t given_ = 0, asked_ = 0;  // fields of the last data line, as bits
  Unread unread_;
  std::map<std::string, std::string> values_;
  std::deque<std::string> replaced_;  // lines with values, which fields point into
};

struct InpLines::Mark {
  InpLines::Source source;
};

}  // namespace hilo
