// SPDX-License-Identifier: GPL-3.0-or-later
// What a deck becomes in a scene: tables in the order of the file, of keys that the schema has.
#pragma once
#include <concepts>
#include <initializer_list>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/math.hpp"
#include "base/param.hpp"

namespace hilo {

struct KindSchema;

std::string toml_text(const std::string& s);

/// The value of a key as TOML; of nothing or of an empty text it is none, and its key is not written.
class SceneValue {
 public:
  SceneValue() = default;
  SceneValue(const std::string& text);
  SceneValue(const char* text) : SceneValue(std::string(text)) {}
  SceneValue(double x);
  template <std::integral T>
  SceneValue(T x) : type_(Type::number), toml_(std::to_string(x)) {}
  SceneValue(bool x) : type_(Type::boolean), toml_(x ? "true" : "false") {}
  template <class T>
  SceneValue(const std::vector<T>& list) : type_(std::is_same_v<T, std::string> ? Type::texts : Type::numbers), toml_("[") {
    for (const SceneValue one : list) {
      toml_ += (toml_.size() > 1 ? ", " : "") + one.toml_;
      texts_.insert(texts_.end(), one.texts_.begin(), one.texts_.end());
    }
    toml_ += ']';
  }
  SceneValue(std::initializer_list<double> list) : SceneValue(std::vector(list)) {}
  SceneValue(const Vec3& v) : SceneValue(std::vector{v.x(), v.y(), v.z()}) {}
  template <class V>
  SceneValue(const Eigen::MatrixBase<V>& v) : SceneValue(Vec3(v)) {}
  bool given() const { return !toml_.empty(); }

 private:
  friend class SceneTable;
  Type type_ = Type::text;
  std::string toml_;
  std::vector<std::string> texts_;
};

struct SceneKey {
  std::string_view key;
  SceneValue value;
};

/// A section of a scene, and the kind where it has kinds: "body", or {"joint", "revolute"}.
struct SceneKind {
  SceneKind(const char* section, std::string_view kind = "") : section(section), kind(kind) {}
  std::string_view section, kind;
};

/// What holds or moves the nodes of a set: along x, y and z (bits), or none of them and an axis.
struct SceneSupport {
  std::string set, place, history;
  unsigned components = 0;
  Vec3 by = Vec3::Zero(), axis = Vec3::Zero();
};

/// A table of a scene: [[joint]], [material.NAME], or [time], whose name is "".  A kind or key that the schema does not have, and a value
/// of another type, is a fault of ours.
class SceneTable {
 public:
  /// `place` in the deck is told behind the table's name.
  SceneTable(const SceneKind& kind, const std::string& name, const std::string& place, std::initializer_list<SceneKey> keys);
  explicit SceneTable(std::string text) : text_(std::move(text)) {}
  SceneTable& set(std::string_view key, const SceneValue& value);
  SceneTable& set_if(bool given, std::string_view key, const SceneValue& value) { return given ? set(key, value) : *this; }
  SceneTable& comment(const std::string& line);

  /// The same with other values of keys that it has.
  SceneTable with(std::initializer_list<SceneKey> keys) const;
  /// A number that it has, or 0.
  double number(std::string_view key) const;

  bool is(std::string_view section) const;
  /// What it acts on, or is between: the texts of its keys on, a and b.
  const std::vector<std::string>& ends() const { return ends_; }
  const std::string& text() const { return text_; }

 private:
  size_t value_at(std::string_view key) const;
  const KindSchema* schema_ = nullptr;  // of a comment: null
  std::string text_;
  std::vector<std::string> ends_;
};

class SceneWriter {
 public:
  /// Behind all others; the reference holds until the next.
  SceneTable& add(const SceneKind& kind, const std::string& name, const std::string& place, std::initializer_list<SceneKey> keys = {}) {
    return items_.emplace_back(kind, name, place, keys);
  }
  /// The same under a name that is free.
  SceneTable& add_unique(const SceneKind& kind, const std::string& wish, const std::string& place,
                         std::initializer_list<SceneKey> keys = {}) {
    return add(kind, unique(kind.section, wish), place, keys);
  }
  /// Units and title before all others, where there are others or gravity.
  void begin(const std::string& title, const SceneValue& gravity);
  void append(const SceneWriter& more) { items_.insert(items_.end(), more.items_.begin(), more.items_.end()); }
  /// Lines beginning with #.
  void comment(const std::string& lines) { items_.emplace_back(lines + '\n'); }
  /// A name in a section that no other has been given: the wish, or with _2, _3 ... behind it.
  std::string unique(std::string_view section, const std::string& wish);
  /// A force on each node of `sets.front()`, and a mass that these share, act once more on those of each further set, of so many nodes.
  void repeat(const std::vector<std::pair<std::string, size_t>>& sets);
  /// False where another has it.
  bool take(std::string_view section, const std::string& name);

  bool empty() const { return items_.empty(); }
  std::int64_t count(std::string_view section) const;
  /// What the tables of these sections act on, or are between.
  std::set<std::string> ends(std::initializer_list<std::string_view> sections) const;
  std::string text() const;

  std::vector<SceneSupport> supports;  // of those that the tables say

 private:
  std::vector<SceneTable> items_;
  std::set<std::string> given_;  // "section/name"
};

}  // namespace hilo
