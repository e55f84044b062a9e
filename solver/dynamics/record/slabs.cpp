// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/record/slabs.hpp"

#include <algorithm>
#include <optional>

#include "base/error.hpp"

namespace hilo {

Slabs::Slabs(const Comm& comm, std::vector<std::int64_t> row, std::int64_t n_rows) : comm_(&comm), row_(std::move(row)), n_(n_rows) {
  // pieces begin where pages of the file do, whatever the width: two ranks never write one page
  most_ = std::max<std::int64_t>(1, (n_ + comm.size - 1) / comm.size);
  if (comm.size > 1) most_ = (most_ + slab_rows - 1) / slab_rows * slab_rows;
  first_ = std::min(n_, most_ * comm.rank), count_ = std::min(n_, first_ + most_) - first_;
}

std::vector<double> Slabs::collect(const std::vector<double>& local, int width) const {
  if (local.size() != row_.size() * static_cast<size_t>(width))
    throw Error("", "values of a field are not as many as nodes or cells", "all_nodes(q) has those of all nodes", Exit::fault);
  std::vector<double> piece(count_ * width, 0.0);
  const auto put = [&](std::int64_t row, const double* from) { std::copy_n(from, width, piece.data() + (row - first_) * width); };
  std::vector<std::vector<double>> send(comm_->size);
  for (size_t i = 0; i < row_.size(); ++i) {
    if (row_[i] < 0) continue;
    if (rank_of(row_[i]) == comm_->rank) {
      put(row_[i], local.data() + i * width);
    } else {
      auto& to = send[rank_of(row_[i])];
      to.push_back(static_cast<double>(row_[i]));
      to.insert(to.end(), local.begin() + i * width, local.begin() + (i + 1) * width);
    }
  }
  if (comm_->size > 1)
    for (const auto& list : comm_->exchange(send))
      for (size_t k = 0; k < list.size(); k += width + 1) put(static_cast<std::int64_t>(list[k]), list.data() + k + 1);
  return piece;
}

template <class T>
void Slabs::write(Store* f, const std::string& path, const std::string& array, const std::vector<double>& piece, int width,
                  const std::string& unit, const std::string& meaning) const {
  std::vector<std::int64_t> shape{n_};
  if (width > 1) shape.push_back(width);
  const std::vector<T> values(piece.begin(), piece.end());
  if (comm_->size == 1) {
    if (f) f->write<T>(array, values, shape, unit, meaning);
    return;
  }
  double place = -1;  // in the file; below 2^53, so a double tells it
  std::optional<Error> failure;
  if (comm_->rank == 0 && f) try {
      place = static_cast<double>(f->reserve<T>(array, shape, unit, meaning));
    } catch (const Error& e) {
      failure = e;
    }
  place = comm_->max(place);
  if (failure) throw *failure;
  if (place >= 0 && count_ > 0)
    write_at(path, static_cast<std::int64_t>(place) + first_ * width * static_cast<std::int64_t>(sizeof(T)),
             std::as_bytes(std::span(values)));
}

template void Slabs::write<double>(Store*, const std::string&, const std::string&, const std::vector<double>&, int, const std::string&,
                                   const std::string&) const;
template void Slabs::write<float>(Store*, const std::string&, const std::string&, const std::vector<double>&, int, const std::string&,
                                  const std::string&) const;

}  // namespace hilo
