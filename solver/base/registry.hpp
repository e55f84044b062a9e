// SPDX-License-Identifier: GPL-3.0-or-later
// A list of what the program knows by a word: joints, springs, materials, shapes, integrators, fields, cards of decks.
//
// Each list is one table, in the file where its rows are made; the scene's schema, its checks and docs/format.md are made from it.  A
// program outside this tree adds its own rows, `joint_kinds().add({...})`, before it reads its first scene; nothing registers itself.
#pragma once
#include <concepts>
#include <deque>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.hpp"

namespace hilo {

namespace registry {
/// Throws: `no joint "revolut" (did you mean "revolute"?)`.
[[noreturn]] void refuse(std::string_view what, std::string_view word, const std::vector<std::string>& words, const std::string& where);
/// Throws, a fault of the program: it is too late for another row, or the word stands already.
[[noreturn]] void refuse_row(std::string_view what, std::string_view word, bool late);
}  // namespace registry

template <class Row>
concept Named = requires(const Row& row) {
  { row.name } -> std::convertible_to<std::string_view>;
};

/// Rows by their `name`, in the order in which they were added; they stay where they are.
template <Named Row>
class Registry {
 public:
  /// `what` one of them is called in messages: "joint".
  Registry(std::string_view what, std::initializer_list<Row> rows) : what_(what) {
    for (const Row& row : rows) add(row);
  }
  void add(Row row) {
    if (closed_ || find(row.name)) registry::refuse_row(what_, row.name, closed_);
    rows_.push_back(std::move(row));
  }
  /// What is made of the list has been made: a row added later would be missing there.
  void close() { closed_ = true; }
  const Row* find(std::string_view word) const {
    for (const Row& row : rows_)
      if (row.name == word) return &row;
    return nullptr;
  }
  /// The row of a word; Error with the nearest word for one that is not known.
  const Row& at(std::string_view word, const std::string& where = "") const {
    if (const Row* row = find(word)) return *row;
    registry::refuse(what_, word, words(), where);
  }
  std::vector<std::string> words() const {
    std::vector<std::string> out;
    for (const Row& row : rows_) out.emplace_back(row.name);
    return out;
  }
  auto begin() const { return rows_.begin(); }
  auto end() const { return rows_.end(); }
  size_t size() const { return rows_.size(); }
  const Row& operator[](size_t i) const { return rows_[i]; }

 private:
  std::string_view what_;
  std::deque<Row> rows_;
  bool closed_ = false;
};

}  // namespace hilo
