// Values kept and restored in the same order, by one function for both ways:
//
//   void archive(Archive& a) { a("spring", angle_, past_); }
//
// A plain struct is walked through all its members (base/members), so a member added later is not forgotten.
// Bits are kept, so what goes on from restored values goes on as it would have.  A mark goes before each list of values; a walk that
// restores others than were kept is an Error (our own fault), not a wrong number.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/members.hpp"

namespace hilo {

class Archive;

/// A class that walks through its own values.
template <class T>
concept Archived = requires(T& x, Archive& a) {
  x.archive(a);
};

class Archive {
 public:
  Archive() = default;  // keeps
  explicit Archive(std::vector<std::byte> kept) : bytes_(std::move(kept)), restores_(true) {}
  bool restores() const { return restores_; }
  const std::vector<std::byte>& bytes() const { return bytes_; }
  /// All that was kept is restored.
  bool is_at_end() const { return at_ == bytes_.size(); }

  template <class... T>
  void operator()(std::string_view mark, T&... values) {
    std::string found(mark);
    walk(found);
    if (found != mark) wrong(mark);
    (walk(values), ...);
  }

 private:
  [[noreturn]] static void wrong(std::string_view what) {
    throw Error("", "kept and restored values differ at \"" + std::string(what) + "\"", "", Exit::fault);
  }
  void raw(void* value, size_t n) {
    auto* at = static_cast<std::byte*>(value);
    if (!restores_) {
      bytes_.insert(bytes_.end(), at, at + n);
      return;
    }
    if (n > bytes_.size() - at_) wrong("the end");
    if (n > 0) std::memcpy(at, bytes_.data() + at_, n);
    at_ += n;
  }
  template <class List>
  void size(List& list) {
    auto n = static_cast<std::uint64_t>(list.size());
    raw(&n, sizeof n);
    if (!restores_) return;
    if (n > bytes_.size()) wrong("the size of a list");
    list.resize(n);
  }
  template <class T>
  requires(Archived<T> || std::is_arithmetic_v<T> || std::is_enum_v<T>) void walk(T& x) {
    if constexpr (Archived<T>)
      x.archive(*this);
    else
      raw(&x, sizeof x);
  }
  template <class T>
  requires(std::is_aggregate_v<T>&& std::is_class_v<T> && !Archived<T>) void walk(T& x) {
    with_members(x, [this](auto&... member) { (walk(member), ...); });
  }
  template <class T, int rows, int columns, int options>
  void walk(Eigen::Matrix<T, rows, columns, options>& x) {
    static_assert(rows > 0 && columns > 0);
    raw(x.data(), sizeof(T) * static_cast<size_t>(x.size()));
  }
  void walk(std::string& text) { size(text), raw(text.data(), text.size()); }
  template <class T, size_t n>
  void walk(std::array<T, n>& list) {
    for (T& x : list) walk(x);
  }
  template <class T>
  void walk(std::vector<T>& list) {
    size(list);
    if constexpr (std::is_arithmetic_v<T>)
      raw(list.data(), sizeof(T) * list.size());
    else
      for (T& x : list) walk(x);
  }
  template <class T>
  void walk(std::deque<T>& list) {
    size(list);
    for (T& x : list) walk(x);
  }
  template <class T>
  void walk(std::optional<T>& x) {
    bool has = x.has_value();
    walk(has);
    if (!has) x.reset();
    if (has && !x) x.emplace();
    if (has) walk(*x);
  }

  std::vector<std::byte> bytes_;
  size_t at_ = 0;
  bool restores_ = false;
};

}  // namespace hilo
