// SPDX-License-Identifier: GPL-3.0-or-later
// Store: reading.
#include <fmt/format.h>

#include "base/digest.hpp"
#include "base/error.hpp"
#include "model/store_impl.hpp"

namespace hilo {

bool Store::Impl::exists(const std::string& object) const {
  if (object == "/" || H5Oexists_by_name(file, object.c_str(), H5P_DEFAULT) > 0) return true;
  for (size_t at = object.find('/', 1);; at = object.find('/', at + 1)) {
    const std::string part = object.substr(0, at);
    if (H5Lexists(file, part.c_str(), H5P_DEFAULT) <= 0 || H5Oexists_by_name(file, part.c_str(), H5P_DEFAULT) <= 0) return false;
    if (at == std::string::npos) return true;
  }
}

Id Store::Impl::open_array(const std::string& array) const {
  if (!exists(array)) throw Error(path, fmt::format("no array {}", array));
  Id set(H5Dopen2(file, array.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.ok()) fail_read(array);
  return set;
}

const Store::Impl::Names* Store::Impl::table_names(const std::string& group) {
  if (const auto found = names.find(group); found != names.end()) return &found->second;
  if (!exists(group + table_link)) return nullptr;
  Names& own = names[group];
  own.list = strings(group + names_link);
  for (size_t k = 0; k < own.list.size(); ++k) own.place[own.list[k]] = static_cast<std::int64_t>(k);
  return &own;
}

std::optional<std::pair<std::string, std::int64_t>> Store::Impl::member(const std::string& array) {
  const auto cut = array.rfind('/');
  if (cut == 0 || cut == array.npos || exists(array)) return {};
  const std::string group = array.substr(0, cut);
  const Names* all = table_names(group);
  const auto found = all ? all->place.find(array.substr(cut + 1)) : decltype(all->place.end()){};
  if (!all || found == all->place.end()) return {};
  return std::pair{group + table_link, found->second};
}

bool Store::is_table(const std::string& group) const {
  return impl_->steadily([&] { return impl_->exists(group + table_link); });
}
bool Store::has(const std::string& object) const {
  return impl_->steadily([&] { return impl_->exists(object) || impl_->member(object); });
}

std::vector<std::string> Store::list(const std::string& group) const {
  return impl_->steadily([&]() -> std::vector<std::string> {
    std::vector<std::string> names;
    if (const auto* members = impl_->table_names(group)) {
      names = members->list;
      std::sort(names.begin(), names.end());
      return names;
    }
    if (!has(group)) return names;
    const Id g(H5Gopen2(impl_->file, group.c_str(), H5P_DEFAULT), H5Gclose);
    if (!g.ok()) return names;
    const auto add = [](hid_t, const char* name, const H5L_info_t*, void* data) -> herr_t {
      static_cast<std::vector<std::string>*>(data)->emplace_back(name);
      return 0;
    };
    if (H5Literate(g, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, add, &names) < 0) impl_->fail_read(group);
    std::sort(names.begin(), names.end());
    return names;
  });
}

bool Store::is_array(const std::string& object) const {
  return impl_->steadily([&]() -> bool {
    if (impl_->member(object)) return true;
    if (!has(object)) return false;
    const Id o(H5Oopen(impl_->file, object.c_str(), H5P_DEFAULT), H5Oclose);
    return o.ok() && H5Iget_type(o) == H5I_DATASET;
  });
}

std::vector<std::int64_t> Store::shape(const std::string& array) const {
  return impl_->steadily([&]() -> std::vector<std::int64_t> {
    impl_->drain();
    const auto in_table = impl_->member(array);
    const Id set = impl_->open_array(in_table ? in_table->first : array);
    const Id space(H5Dget_space(set), H5Sclose);
    auto n = extent(space);
    if (in_table) n.erase(n.begin() + 1);
    return n;
  });
}

std::string Store::type(const std::string& array) const {
  return impl_->steadily([&]() -> std::string {
    const auto in_table = impl_->member(array);
    const Id set = impl_->open_array(in_table ? in_table->first : array);
    const Id t(H5Dget_type(set), H5Tclose);
    const size_t size = H5Tget_size(t);
    switch (H5Tget_class(t)) {
      case H5T_STRING:
        return "string";
      case H5T_FLOAT:
        return fmt::format("f{}", size);
      case H5T_INTEGER:
        return fmt::format("{}{}", H5Tget_sign(t) == H5T_SGN_NONE ? "u" : "i", size);
      default:
        return "other";
    }
  });
}

void Store::Impl::check_room(hid_t array, const std::string& name, std::int64_t elements, size_t bytes) const {
  if (writable) return;  // rows may still be in memory
  hsize_t size = 0;
  const Id holder(H5Iget_file_id(array), H5Fclose);  // not this file where a link led to the array
  if (H5Fget_filesize(holder, &size) < 0) fail_read(name);
  if (elements < 0 || static_cast<hsize_t>(elements) > size / std::max<size_t>(1, bytes))
    throw Error(path, fmt::format("damaged: {} says that it is larger than the file", name));
}

void Store::Impl::check_digest(hid_t array, const std::string& name, std::uint64_t digest) const {
  if (H5Aexists(array, digest_name) <= 0) return;
  std::uint64_t written = 0;
  const Id a(H5Aopen(array, digest_name, H5P_DEFAULT), H5Aclose);
  if (!a.ok() || H5Aread(a, H5T_NATIVE_UINT64, &written) < 0) fail_read(name);
  if (written != digest) throw Error(path, fmt::format("damaged: {} is not what was written", name), "make it again, or copy it again");
}

namespace {

/// One of the types that hilo writes: others would be converted by rules that a damaged file can make up.
bool is_ours(hid_t type) {
  for (const hid_t ours : {H5T_IEEE_F64LE, H5T_IEEE_F32LE, H5T_STD_I32LE, H5T_STD_I64LE, H5T_STD_U8LE})
    if (H5Tequal(type, ours) > 0) return true;
  return false;
}

/// Number of elements, -1 where it does not fit 64 bits.
std::int64_t checked_product(std::span<const std::int64_t> shape) {
  std::int64_t n = 1;
  for (const std::int64_t k : shape)
    if (k < 0 || __builtin_mul_overflow(n, k, &n)) return -1;
  return n;
}

}  // namespace

template <class T>
std::vector<T> Store::read(const std::string& array) const {
  return impl_->steadily([&]() -> std::vector<T> {
    const auto n = shape(array);
    return read_rows<T>(array, 0, n.empty() ? 1 : n[0]);
  });
}

template <class T>
std::vector<T> Store::read_rows(const std::string& array, std::int64_t first, std::int64_t count) const {
  return impl_->steadily([&]() -> std::vector<T> {
    impl_->drain();
    const auto in_table = impl_->member(array);
    const Id set = impl_->open_array(in_table ? in_table->first : array);
    const Id type(H5Dget_type(set), H5Tclose);
    if (const auto c = H5Tget_class(type); c != H5T_INTEGER && c != H5T_FLOAT)
      throw Error(impl_->path, fmt::format("{} does not hold numbers", array));
    if (!is_ours(type)) throw Error(impl_->path, fmt::format("{} holds numbers of a foreign type", array), "damaged?");
    const Id space(H5Dget_space(set), H5Sclose);
    auto n = extent(space);
    const std::int64_t rows = n.empty() ? 1 : n[0];
    if (first < 0 || count < 0 || first + count > rows)
      throw Error(impl_->path, fmt::format("{} has {} rows, wanted {} to {}", array, rows, first, first + count));
    if (n.empty()) n.push_back(1);
    impl_->check_room(set, array, checked_product(n), H5Tget_size(type));
    n[0] = count;
    if (in_table && (n.size() != 3 || in_table->second >= n[1]))
      throw Error(impl_->path, fmt::format("damaged: no {} in its table", array));
    if (in_table) n[1] = 1;
    std::vector<T> values(static_cast<size_t>(product(n)));
    if (values.empty()) return values;
    if (count < rows || in_table) {
      std::vector<hsize_t> start(n.size(), 0), size(n.begin(), n.end());
      start[0] = static_cast<hsize_t>(first);
      if (in_table) start[1] = static_cast<hsize_t>(in_table->second);
      H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr);
      const Id room = simple_space(n);
      if (H5Dread(set, memory_type<T>(), room, space, H5P_DEFAULT, values.data()) < 0) impl_->fail_read(array);
    } else if (H5Dread(set, memory_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
      impl_->fail_read(array);
    } else if (H5Tequal(type, file_type<T>()) > 0) {
      impl_->check_digest(set, array, Digest().add(std::as_bytes(std::span(values))).value());
    }
    return values;
  });
}

namespace {

/// Strings of an open array or attribute, variable or fixed length.  `get(type, buffer)` reads.
template <class Read>
std::optional<std::vector<std::string>> strings_of(hid_t file_type, hid_t space, const Read& get) {
  const auto n = static_cast<size_t>(std::max<std::int64_t>(0, checked_product(extent(space))));
  std::vector<std::string> texts(n);
  if (n == 0) return texts;
  if (H5Tis_variable_str(file_type) > 0) {
    Id type(H5Tcopy(file_type), H5Tclose);
    std::vector<char*> raw(n, nullptr);
    if (get(type, raw.data()) < 0) return std::nullopt;
    for (size_t i = 0; i < n; ++i) texts[i] = raw[i] ? raw[i] : "";
    H5Dvlen_reclaim(type, space, H5P_DEFAULT, raw.data());
  } else {
    const size_t size = H5Tget_size(file_type);
    std::vector<char> raw(n * size);
    if (get(file_type, raw.data()) < 0) return std::nullopt;
    for (size_t i = 0; i < n; ++i) texts[i] = std::string(raw.data() + i * size, strnlen(raw.data() + i * size, size));
  }
  return texts;
}

}  // namespace

std::vector<std::string> Store::read_strings(const std::string& array) const {
  return impl_->steadily([&] { return impl_->strings(array); });
}

std::vector<std::string> Store::Impl::strings(const std::string& array) const {
  const Id set = open_array(array);
  const Id type(H5Dget_type(set), H5Tclose), space(H5Dget_space(set), H5Sclose);
  if (H5Tget_class(type) != H5T_STRING) throw Error(path, fmt::format("{} does not hold text", array));
  check_room(set, array, checked_product(extent(space)), H5Tget_size(type));
  auto texts = strings_of(type, space, [&](hid_t t, void* to) { return H5Dread(set, t, H5S_ALL, H5S_ALL, text_transfer(), to); });
  if (!texts) fail_read(array);
  check_digest(set, array, digest_of(*texts));
  return *texts;
}

std::string Store::read_text(const std::string& array) const {
  const auto texts = read_strings(array);
  if (texts.size() != 1) throw Error(impl_->path, fmt::format("{} holds {} texts, not one", array, texts.size()));
  return texts[0];
}

std::optional<std::string> Store::text_attribute(const std::string& of, const std::string& name) const {
  return impl_->steadily([&]() -> std::optional<std::string> {
    const auto in_table = impl_->member(of);
    const std::string& object = in_table ? in_table->first : of;
    if (!has(object) || H5Aexists_by_name(impl_->file, object.c_str(), name.c_str(), H5P_DEFAULT) <= 0) return std::nullopt;
    const Id a(H5Aopen_by_name(impl_->file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    const Id type(H5Aget_type(a), H5Tclose), space(H5Aget_space(a), H5Sclose);
    if (!a.ok() || H5Tget_class(type) != H5T_STRING) return std::nullopt;
    const auto texts = strings_of(type, space, [&](hid_t t, void* to) { return H5Aread(a, t, to); });
    return texts && texts->size() == 1 ? std::optional(texts->front()) : std::nullopt;
  });
}

std::optional<double> Store::number_attribute(const std::string& object, const std::string& name) const {
  return impl_->steadily([&]() -> std::optional<double> {
    if (!has(object) || H5Aexists_by_name(impl_->file, object.c_str(), name.c_str(), H5P_DEFAULT) <= 0) return std::nullopt;
    const Id a(H5Aopen_by_name(impl_->file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    const Id type(H5Aget_type(a), H5Tclose), space(H5Aget_space(a), H5Sclose);
    if (!a.ok() || H5Tget_class(type) == H5T_STRING || H5Sget_simple_extent_npoints(space) != 1) return std::nullopt;
    double value;
    return H5Aread(a, H5T_NATIVE_DOUBLE, &value) < 0 ? std::nullopt : std::optional(value);
  });
}

std::optional<std::pair<std::string, std::string>> Store::linked(const std::string& name) const {
  return impl_->steadily([&]() -> std::optional<std::pair<std::string, std::string>> {
    H5L_info_t what;
    if (H5Lexists(impl_->file, name.c_str(), H5P_DEFAULT) <= 0 || H5Lget_info(impl_->file, name.c_str(), &what, H5P_DEFAULT) < 0 ||
        what.type != H5L_TYPE_EXTERNAL)
      return std::nullopt;
    std::vector<char> value(what.u.val_size);
    const char *file = nullptr, *object = nullptr;
    if (H5Lget_val(impl_->file, name.c_str(), value.data(), value.size(), H5P_DEFAULT) < 0 ||
        H5Lunpack_elink_val(value.data(), value.size(), nullptr, &file, &object) < 0)
      impl_->fail_read(name);
    return std::pair{std::string(file), std::string(object)};
  });
}

#define HILO_STORE_TYPE(T)                                          \
  template std::vector<T> Store::read<T>(const std::string&) const; \
  template std::vector<T> Store::read_rows<T>(const std::string&, std::int64_t, std::int64_t) const;
HILO_STORE_TYPE(double)
HILO_STORE_TYPE(float)
HILO_STORE_TYPE(std::int32_t)
HILO_STORE_TYPE(std::int64_t)
HILO_STORE_TYPE(std::uint8_t)
#undef HILO_STORE_TYPE

}  // namespace hilo
