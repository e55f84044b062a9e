// SPDX-License-Identifier: GPL-3.0-or-later
// Store: writing.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <limits>

#include "base/digest.hpp"
#include "base/error.hpp"
#include "model/store_impl.hpp"

namespace hilo {

void Store::Impl::make_groups(const std::string& object) {
  for (size_t at = object.find('/', 1); at != object.npos; at = object.find('/', at + 1))
    if (const std::string part = object.substr(0, at); H5Lexists(file, part.c_str(), H5P_DEFAULT) <= 0) make_group(part);
}

Id Store::Impl::make_group(const std::string& name) {
  const Id creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, false);  // the same content gives the same bytes
  Id group(H5Gcreate2(file, name.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose);
  need(group.ok(), "cannot create group " + name);
  return group;
}

std::uint64_t digest_of(std::span<const std::string> texts) {
  Digest all;
  for (const auto& t : texts) all.add(std::string_view(t));
  return all.value();
}

Id Store::Impl::make_array(const std::string& array, hid_t type, hid_t space, hid_t creation, hid_t access) {
  if (grows_on && exists(array)) need(H5Ldelete(file, array.c_str(), H5P_DEFAULT) >= 0, "cannot replace " + array);
  make_groups(array);
  const Id link(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_char_encoding(link, H5T_CSET_UTF8);
  H5Pset_obj_track_times(creation, false);  // the same content gives the same bytes
  Id set(H5Dcreate2(file, array.c_str(), type, space, link, creation, access), H5Dclose);
  if (!set.ok() && exists(array)) throw Error(path, fmt::format("array {} written twice", array), "", Exit::fault);
  need(set.ok(), "cannot create " + array);
  return set;
}

void Store::Impl::attribute(hid_t object, const std::string& name, hid_t type, hid_t memory, const void* value,
                            std::span<const std::int64_t> shape) {
  if (H5Aexists(object, name.c_str()) > 0) need(H5Adelete(object, name.c_str()) >= 0, "cannot replace attribute " + name);
  const Id space = simple_space(shape);
  const Id made(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  need(made.ok() && H5Awrite(made, memory, value) >= 0, "cannot write attribute " + name);
}

void Store::Impl::text_attribute(hid_t object, const std::string& name, const std::string& value) {
  const Id type = text_type();
  const char* text = value.c_str();
  attribute(object, name, type, type, &text);
}

Id Store::Impl::owner(const std::string& object) {
  if (exists(object)) return {H5Oopen(file, object.c_str(), H5P_DEFAULT), H5Oclose};
  make_groups(object);
  return make_group(object);
}

namespace {

/// Of an array of rows: no chunks are kept, since rows are gathered here already.
Id rows_access() {
  Id access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  H5Pset_chunk_cache(access, 1, 0, 1);
  return access;
}

}  // namespace

hid_t Store::Impl::opened_rows(const Rows& r, const std::string& array, Id& opened) {
  if (!r.set.ok()) opened = Id(H5Dopen2(file, array.c_str(), rows_access()), H5Dclose);
  const hid_t set = r.set.ok() ? r.set : opened;
  need(set >= 0, "cannot open " + array);
  return set;
}

void Store::Impl::drain(Rows& r, const std::string& array) {
  if (r.pending.empty()) return;
  Id opened;
  const hid_t set = opened_rows(r, array, opened);
  const hsize_t more = r.pending.size() / r.row_bytes;
  std::vector<hsize_t> start(r.shape.size(), 0), count = r.shape;
  start[0] = r.shape[0], count[0] = more;
  r.shape[0] += more;
  need(H5Dset_extent(set, r.shape.data()) >= 0, "cannot extend " + array);
  const Id space(H5Dget_space(set), H5Sclose);
  const Id memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose);
  H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  need(H5Dwrite(set, r.type, memory, space, H5P_DEFAULT, r.pending.data()) >= 0, "cannot write " + array);
  pending_bytes -= r.pending.size();
  r.pending.clear();
}

template <class T>
void Store::write(const std::string& array, std::span<const T> values, std::vector<std::int64_t> shape, const std::string& unit,
                  const std::string& meaning) {
  if (product(shape) != static_cast<std::int64_t>(values.size()))
    throw Error(impl_->path, fmt::format("{}: {} values for {} places", array, values.size(), product(shape)), "", Exit::fault);
  const Id space = simple_space(shape), creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
  const Id set = impl_->make_array(array, file_type<T>(), space, creation);
  if (!values.empty())
    impl_->need(H5Dwrite(set, memory_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0, "cannot write " + array);
  if (!unit.empty()) impl_->text_attribute(set, "unit", unit);
  if (!meaning.empty()) impl_->text_attribute(set, "meaning", meaning);
  impl_->write_digest(set, Digest().add(std::as_bytes(values)).value());
}

template <class T>
std::int64_t Store::reserve(const std::string& array, std::vector<std::int64_t> shape, const std::string& unit,
                            const std::string& meaning) {
  static_assert(std::endian::native == std::endian::little, "write_at copies memory into a little-endian file");
  const Id space = simple_space(shape), creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
  H5Pset_alloc_time(creation, H5D_ALLOC_TIME_EARLY);
  const Id set = impl_->make_array(array, file_type<T>(), space, creation);
  if (!unit.empty()) impl_->text_attribute(set, "unit", unit);
  if (!meaning.empty()) impl_->text_attribute(set, "meaning", meaning);
  if (product(shape) == 0) return -1;
  const haddr_t place = H5Dget_offset(set);
  impl_->need(place != HADDR_UNDEF, "no room for " + array);
  return static_cast<std::int64_t>(place);
}

void write_at(const std::string& path, std::int64_t place, std::span<const std::byte> bytes) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  bool ok = file >= 0;
  for (size_t done = 0; ok && done < bytes.size();) {
    const auto n = ::pwrite(file, bytes.data() + done, bytes.size() - done, place + static_cast<std::int64_t>(done));
    ok = n > 0 || (n < 0 && errno == EINTR);
    if (n > 0) done += static_cast<size_t>(n);
  }
  int error = errno;
  if (file >= 0 && ::close(file) != 0 && ok) ok = false, error = errno;  // a full disk may show only here
  if (!ok) throw Error(path, fmt::format("cannot write: {}", std::strerror(error)), "", Exit::resources);
}

void Store::write_strings(const std::string& array, std::span<const std::string> values) {
  const std::vector<std::int64_t> shape{static_cast<std::int64_t>(values.size())};
  const Id type = text_type(), space = simple_space(shape), creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const Id set = impl_->make_array(array, type, space, creation);
  std::vector<const char*> raw;
  for (const auto& v : values) raw.push_back(v.c_str());
  if (!raw.empty()) impl_->need(H5Dwrite(set, type, H5S_ALL, H5S_ALL, text_transfer(), raw.data()) >= 0, "cannot write " + array);
  impl_->write_digest(set, digest_of(values));
}

void Store::write_text(const std::string& array, const std::string& text) {
  const Id type = text_type(), space = simple_space({}), creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const Id set = impl_->make_array(array, type, space, creation);
  const char* raw = text.c_str();
  impl_->need(H5Dwrite(set, type, H5S_ALL, H5S_ALL, text_transfer(), &raw) >= 0, "cannot write " + array);
  impl_->write_digest(set, digest_of(std::span(&text, 1)));
}

template <class T>
void Store::start_rows(const std::string& array, std::vector<std::int64_t> row_shape, const std::string& unit, const std::string& meaning,
                       const std::string& time) {
  const size_t row_bytes = static_cast<size_t>(product(row_shape)) * sizeof(T);
  const size_t room = std::min(row_buffer, all_row_buffers / (impl_->rows.size() + 1)) / 4;  // many arrays take less each
  std::vector<hsize_t> now{0}, most{H5S_UNLIMITED}, chunk{std::clamp<hsize_t>(room / std::max<size_t>(1, row_bytes), 1, 1024)};
  for (const auto n : row_shape) {
    now.push_back(static_cast<hsize_t>(n)), most.push_back(static_cast<hsize_t>(n));
    chunk.push_back(std::max<hsize_t>(1, static_cast<hsize_t>(n)));
  }
  size_t gathered = row_buffer;
  if (row_shape.size() == 2 && row_bytes > room / 32) {  // of a table: some rows of some members, which are read alone
    chunk[0] = std::clamp<hsize_t>(all_row_buffers / 16 / row_bytes, 1, 32);
    chunk[1] = std::clamp<hsize_t>(row_buffer / 2 / (chunk[0] * chunk[2] * sizeof(T)), 1, now[1]);
    gathered = std::max<size_t>(gathered, chunk[0] * row_bytes);
  }
  if (impl_->grows_on && impl_->exists(array)) {
    const auto had = shape(array);
    Id set = impl_->open_array(array);
    const Id type(H5Dget_type(set), H5Tclose);
    if (had.size() != now.size() || !std::equal(had.begin() + 1, had.end(), row_shape.begin()) || H5Tequal(type, file_type<T>()) <= 0)
      throw Error(impl_->path, fmt::format("{} has other rows than the run that goes on", array));
    now[0] = static_cast<hsize_t>(had[0]);
    if (impl_->rows.size() >= most_open) set = Id();
    impl_->rows.emplace(array, Rows{std::move(set), memory_type<T>(), row_bytes, gathered, std::move(now), {}});
    return;
  }
  const Id space(H5Screate_simple(static_cast<int>(now.size()), now.data(), most.data()), H5Sclose);
  const Id creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data());
  H5Pset_fletcher32(creation);
  Id set = impl_->make_array(array, file_type<T>(), space, creation, rows_access());
  if (!unit.empty()) impl_->text_attribute(set, "unit", unit);
  if (!meaning.empty()) impl_->text_attribute(set, "meaning", meaning);
  if (!time.empty()) impl_->text_attribute(set, "time", time);
  if (impl_->rows.size() >= most_open) set = Id();
  impl_->rows.emplace(array, Rows{std::move(set), memory_type<T>(), row_bytes, gathered, std::move(now), {}});
}

template <class T>
void Store::start_table(const std::string& group, const std::vector<std::string>& members, std::int64_t width, const std::string& unit,
                        const std::string& meaning, const std::string& time) {
  const bool goes_on = impl_->grows_on && impl_->exists(group + names_link);
  if (goes_on && impl_->strings(group + names_link) != members)
    throw Error(impl_->path, group + " has other members than in the run that goes on, or in another order",
                "give it their names and order");
  start_rows<T>(group + table_link, {static_cast<std::int64_t>(members.size()), width}, unit, meaning, time);
  if (!goes_on) write_strings(group + names_link, members);
}
template <class T>
void Store::append_table(const std::string& group, std::span<const T> row) {
  append<T>(group + table_link, row);
}

template <class T>
void Store::append(const std::string& array, std::span<const T> rows) {
  const auto found = impl_->rows.find(array);
  if (found == impl_->rows.end() || rows.size_bytes() % std::max<size_t>(1, found->second.row_bytes) != 0 ||
      found->second.type != memory_type<T>())
    throw Error(impl_->path, fmt::format("{}: rows of {} values of {} bytes do not fit", array, rows.size(), sizeof(T)), "", Exit::fault);
  auto& r = found->second;
  const auto bytes = std::as_bytes(rows);
  r.pending.insert(r.pending.end(), bytes.begin(), bytes.end());
  impl_->pending_bytes += bytes.size();
  if (r.pending.size() >= r.room)
    impl_->drain(r, array);
  else if (impl_->pending_bytes >= all_row_buffers)
    impl_->drain();
}

void Store::keep_rows(const std::string& name, std::int64_t count) {
  const std::string array = impl_->rows.contains(name) ? name : name + table_link;
  auto& r = impl_->rows.at(array);
  if (static_cast<hsize_t>(count) > r.shape[0])
    throw Error(impl_->path, fmt::format("{} has {} rows, wanted {} to go on from", array, r.shape[0], count));
  r.shape[0] = static_cast<hsize_t>(count);
  Id opened;
  impl_->need(H5Dset_extent(impl_->opened_rows(r, array, opened), r.shape.data()) >= 0, "cannot shorten " + array);
}

void Store::remove(const std::string& object) {
  if (H5Lexists(impl_->file, object.c_str(), H5P_DEFAULT) > 0)
    impl_->need(H5Ldelete(impl_->file, object.c_str(), H5P_DEFAULT) >= 0, "cannot remove " + object);
}

void Store::set(const std::string& object, const std::string& attribute, const std::string& value) {
  const Id o = impl_->owner(object);
  impl_->text_attribute(o, attribute, value);
}
void Store::set(const std::string& object, const std::string& attribute, double value) {
  const Id o = impl_->owner(object);
  impl_->attribute(o, attribute, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}
void Store::set(const std::string& object, const std::string& attribute, std::int64_t value) {
  const Id o = impl_->owner(object);
  impl_->attribute(o, attribute, H5T_STD_I64LE, H5T_NATIVE_INT64, &value);
}

void Store::set(const std::string& object, const std::string& attribute, std::span<const std::int64_t> values) {
  const std::int64_t count[] = {static_cast<std::int64_t>(values.size())};
  impl_->attribute(impl_->owner(object), attribute, H5T_STD_I64LE, H5T_NATIVE_INT64, values.data(), count);
}
void Store::set_ascii(const std::string& object, const std::string& attribute, const std::string& value) {
  const Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, value.size());
  impl_->attribute(impl_->owner(object), attribute, type, type, value.c_str());
}

void Store::write_view(const std::string& array, const std::vector<std::string>& parts) {
  std::vector<std::int64_t> of;  // shape of a part
  bool is_double = false;
  for (const std::string& part : parts) {
    if (part.empty()) continue;
    if (const auto n = shape(part); of.empty())
      of = n;
    else if (n != of)
      throw Error(impl_->path, fmt::format("{} is not of the shape of the other parts of {}", part, array), "", Exit::fault);
    is_double |= type(part) == "f8";
  }
  auto all = of;
  all.at(0) *= static_cast<std::int64_t>(parts.size());
  const Id space = simple_space(all), part_space = simple_space(of), creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  H5Pset_fill_value(creation, H5T_NATIVE_DOUBLE, &nothing);
  std::vector<hsize_t> start(of.size(), 0), count(of.begin(), of.end());
  for (size_t k = 0; k < parts.size(); ++k) {
    if (parts[k].empty()) continue;
    start[0] = k * count[0];
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
    impl_->need(H5Pset_virtual(creation, space, ".", parts[k].c_str(), part_space) >= 0, "cannot map " + parts[k]);
  }
  H5Sselect_all(space);
  impl_->make_array(array, is_double ? file_type<double>() : file_type<float>(), space, creation);
}

void Store::name_also(const std::string& array, const std::string& name) {
  impl_->make_groups(name);
  impl_->need(H5Lcreate_hard(impl_->file, array.c_str(), impl_->file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT) >= 0, "cannot name " + name);
}

void Store::link(const std::string& name, const std::string& target, const std::string& object) {
  const std::string relative = relative_to(impl_->path, target);
  impl_->make_groups(name);
  if (impl_->grows_on) remove(name);
  impl_->need(H5Lcreate_external(relative.c_str(), object.c_str(), impl_->file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT) >= 0,
              "cannot link " + name);
}

#define HILO_STORE_TYPE(T)                                                                                                        \
  template void Store::write<T>(const std::string&, std::span<const T>, std::vector<std::int64_t>, const std::string&,            \
                                const std::string&);                                                                              \
  template std::int64_t Store::reserve<T>(const std::string&, std::vector<std::int64_t>, const std::string&, const std::string&); \
  template void Store::start_rows<T>(const std::string&, std::vector<std::int64_t>, const std::string&, const std::string&,       \
                                     const std::string&);                                                                         \
  template void Store::start_table<T>(const std::string&, const std::vector<std::string>&, std::int64_t, const std::string&,      \
                                      const std::string&, const std::string&);                                                    \
  template void Store::append_table<T>(const std::string&, std::span<const T>);                                                   \
  template void Store::append<T>(const std::string&, std::span<const T>);
HILO_STORE_TYPE(double)
HILO_STORE_TYPE(float)
HILO_STORE_TYPE(std::int32_t)
HILO_STORE_TYPE(std::int64_t)
HILO_STORE_TYPE(std::uint8_t)
#undef HILO_STORE_TYPE

}  // namespace hilo
