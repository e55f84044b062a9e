// SPDX-License-Identifier: GPL-3.0-or-later
// --check: is a file whole?
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/error.hpp"
#include "show/summary.hpp"

namespace hilo {
namespace {

void read_whole(const Store& store, const std::string& array) {
  if (store.type(array) == "string") {
    store.read_strings(array);
    return;
  }
  if (store.number_attribute(array, "fnv1a64")) {  // read at once, its digest is checked
    const auto type = store.type(array);
    if (type == "i8") return void(store.read<std::int64_t>(array));
    if (type == "i4") return void(store.read<std::int32_t>(array));
    if (type == "u1") return void(store.read<std::uint8_t>(array));
    if (type == "f4") return void(store.read<float>(array));
    return void(store.read<double>(array));
  }
  const auto shape = store.shape(array);
  std::int64_t row = 1;
  for (size_t k = 1; k < shape.size(); ++k) row *= shape[k];
  const std::int64_t rows = shape.empty() ? 1 : shape[0], block = std::max<std::int64_t>(1, (1 << 20) / std::max<std::int64_t>(1, row));
  for (std::int64_t at = 0; at < rows; at += block) store.read_rows<double>(array, at, std::min(block, rows - at));
}

int walk(const Store& store, const std::string& group) {
  int arrays = 0;
  for (const auto& name : store.list(group)) {
    const std::string object = (group == "/" ? "" : group) + "/" + name;
    if (store.linked(object)) continue;
    if (!store.is_array(object))
      arrays += walk(store, object);
    else
      read_whole(store, object), ++arrays;
  }
  return arrays;
}

/// All histories of a run have as many rows as its time array.
void check_histories(const Store& store) {
  if (!store.has("/history/t")) throw Error(store.path(), "no array /history/t");
  const auto rows_of_time = [&] { return store.shape("/history/t")[0]; };
  const auto check = [&](const std::string& array) {
    const auto rows = rows_of_time(), n = store.shape(array)[0];
    if (n < rows || n > rows_of_time())  // the run may have gone on in between
      throw Error(store.path(), fmt::format("damaged: {} has {} rows, /history/t has {}", array, n, rows));
  };
  for (const auto& name : store.list("/history")) {
    const std::string path = "/history/" + name;
    if (store.is_array(path))
      check(path);
    else
      for (const auto& link : store.list(path)) check(path + "/" + link);
  }
}

}  // namespace

std::string check_file(const std::string& path) {
  const Store store = Store::open(path);
  const auto format = store.text_attribute("/", "format").value_or("");
  if (!format.starts_with("hilo ")) throw Error(path, "not a hilo file: it has no attribute format = \"hilo ...\"");
  const bool run = format == "hilo run";
  const bool complete = store.number_attribute("/", "complete").value_or(0) == 1;
  if (!complete && !run) throw Error(path, "incomplete file");
  int arrays = walk(store, "/");
  for (const std::string what : {"mesh", "tags"}) {
    const auto link = store.linked(fmt::format("/{}", what));
    if (!link) continue;
    const std::string target = resolved_from(path, link->first);
    if (std::error_code error; !std::filesystem::exists(target, error))
      throw Error(path, fmt::format("{} is in {}, which is missing", what, target));
    check_file(target);
    const auto then = store.text_attribute("/", what + "_digest");
    if (then && *then != digest(target)) throw Error(path, fmt::format("{} has changed since this file was made", target), "make it again");
  }
  if (run) check_histories(store);
  if (store.has("/mesh")) read_mesh_file(path);
  if (complete) return fmt::format("ok, {} arrays", arrays);
  const auto t = store.read<double>("/history/t");
  return t.empty() ? fmt::format("incomplete, sound, no rows yet, {} arrays", arrays)
                   : fmt::format("incomplete, sound up to t = {:.6g} s, {} arrays", t.back(), arrays);
}

}  // namespace hilo
