// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays that all ranks of one machine see alike: rank 0 makes them, the others find them by its process.  They lie in memory, or in a file
// without a name that goes with the process.
#pragma once
#include <cstddef>
#include <string>
#include <utility>

#include "base/comm.hpp"

namespace hilo {

class SharedMemory {
 public:
  SharedMemory() = default;
  /// Collective.  `bytes` and `folder` (of the file; "": memory) are those of rank 0.  A rank on another machine does not see it.
  /// Errors, on rank 0 alone: no room.
  SharedMemory(const Comm& comm, size_t bytes, const std::string& folder);
  ~SharedMemory();
  SharedMemory(SharedMemory&& other) noexcept { *this = std::move(other); }
  SharedMemory& operator=(SharedMemory&& other) noexcept {
    std::swap(data_, other.data_), std::swap(bytes_, other.bytes_), std::swap(file_, other.file_);
    return *this;
  }
  void* data() const { return data_; }
  size_t bytes() const { return bytes_; }
  bool seen() const { return data_ != nullptr; }

 private:
  void* data_ = nullptr;
  size_t bytes_ = 0;
  int file_ = -1;
};

template <class T>
class SharedArray {
 public:
  SharedArray() = default;
  SharedArray(const Comm& comm, size_t n, const std::string& folder = "") : memory_(comm, n * sizeof(T), folder) {}
  T* data() const { return static_cast<T*>(memory_.data()); }
  T& operator[](size_t i) const { return data()[i]; }
  T* begin() const { return data(); }
  T* end() const { return data() + size(); }
  size_t size() const { return memory_.bytes() / sizeof(T); }
  bool seen() const { return memory_.seen(); }

 private:
  SharedMemory memory_;
};

}  // namespace hilo
