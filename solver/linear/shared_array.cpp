// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/shared_array.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

#include "base/error.hpp"

namespace hilo {

SharedMemory::SharedMemory(const Comm& comm, size_t bytes, const std::string& folder) {
  const auto no_room = [&](const std::string& why) {
    return Error(folder, fmt::format("no room for {:.3g} GB: {}", static_cast<double>(bytes) / 1e9, why), "", Exit::resources);
  };
  const bool alone = comm.size == 1 && folder.empty();
  if (comm.rank == 0 && !alone) {
    file_ = folder.empty() ? memfd_create("hilo", MFD_CLOEXEC) : open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (file_ < 0) throw no_room(std::strerror(errno));
    const auto size = static_cast<off_t>(std::max<size_t>(bytes, 1));
    const int failed = folder.empty() ? (ftruncate(file_, size) ? errno : 0) : posix_fallocate(file_, 0, size);
    if (failed) throw no_room(std::strerror(failed));
  }
  double about[3] = {static_cast<double>(bytes), static_cast<double>(getpid()), static_cast<double>(file_)};
  comm.copy(about, 0);
  bytes_ = static_cast<size_t>(about[0]);
  if (comm.rank != 0) {
    const std::string path = fmt::format("/proc/{:.0f}/fd/{:.0f}", about[1], about[2]);
    file_ = open(path.c_str(), O_RDWR | O_CLOEXEC);
  }
  if (file_ >= 0 || alone) {
    data_ = mmap(nullptr, std::max<size_t>(bytes_, 1), PROT_READ | PROT_WRITE, alone ? MAP_PRIVATE | MAP_ANONYMOUS : MAP_SHARED, file_, 0);
    if (data_ == MAP_FAILED) data_ = nullptr;
    if (!data_ && comm.rank == 0) throw no_room(std::strerror(errno));
    if (data_ && alone) madvise(data_, bytes_, MADV_HUGEPAGE);
  }
  comm.barrier();  // the file of rank 0 stays open until all have it
}

SharedMemory::~SharedMemory() {
  if (data_) munmap(data_, std::max<size_t>(bytes_, 1));
  if (file_ >= 0) close(file_);
}

}  // namespace hilo
