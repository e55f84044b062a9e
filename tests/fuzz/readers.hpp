// SPDX-License-Identifier: GPL-3.0-or-later
// Every reader of files from outside, as one list: what the fuzzer feeds, and what the suite feeds with the fuzzer's findings.
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace hilo::test {

struct Reader {
  std::string_view name;                  // of the target, and of its files in tests/faults/corpus: NAME-what
  std::string_view ending;                // of a file that it reads
  void (*read)(const std::string& path);  // as its tool does, but for what is written
};
std::span<const Reader> readers();

/// What a reader made of a file: "" where it read it, or refused it as it should; else what was wrong with that.
std::string offence(const Reader& reader, const std::string& path);

}  // namespace hilo::test
