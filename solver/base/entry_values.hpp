// SPDX-License-Identifier: GPL-3.0-or-later
// The values of an entry of the scene, checked and in SI units, as those see them who make something of them and know no files.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "base/history.hpp"
#include "base/math.hpp"

namespace hilo {

class EntryValues {
 public:
  virtual ~EntryValues() = default;
  virtual bool has(std::string_view key) const = 0;    // present, given or by default
  virtual bool given(std::string_view key) const = 0;  // written in the scene
  virtual double number(std::string_view key) const = 0;
  virtual Vec3 vector3(std::string_view key) const = 0;
  virtual const std::vector<double>& numbers(std::string_view key) const = 0;
  virtual const std::string& text(std::string_view key) const = 0;
  virtual const std::vector<std::string>& texts(std::string_view key) const = 0;
  virtual bool boolean(std::string_view key) const = 0;
  virtual const History& history(std::string_view key) const = 0;  // constant 1 where absent
  virtual std::string where(std::string_view key) const = 0;       // "scene.toml:14:7" of the key, or of the entry
  virtual std::string label() const = 0;                           // joint "trunnion"
  /// Throws the Error that a key deserves; "": the entry as a whole.
  [[noreturn]] void refuse(std::string_view key, const std::string& what, const std::string& hint = "") const {
    throw Error(where(key), label() + ": " + what, hint);
  }

 protected:
  EntryValues() = default;
  EntryValues(const EntryValues&) = default;
  EntryValues(EntryValues&&) = default;
  EntryValues& operator=(const EntryValues&) = default;
  EntryValues& operator=(EntryValues&&) = default;
};

}  // namespace hilo
