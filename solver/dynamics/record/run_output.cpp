// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/record/run_output.hpp"

#include <unistd.h>

#include <algorithm>
#include <utility>

namespace hilo {

std::string stem(const std::string& path) { return path.ends_with(".h5") ? path.substr(0, path.size() - 3) : path; }

void RunOutput::create() {
  comm_.on_first([&] { store_ = std::make_unique<Store>(Store::create_growing(path_)); });
}

void RunOutput::open(const std::function<void(Store&)>& shorten) {
  comm_.on_first([&] {
    store_ = std::make_unique<Store>(Store::open_growing(path_));
    shorten(*store_);
    store_->flush();  // before ranks write where removed arrays were
  });
  has_name_ = true;
}

bool RunOutput::commit(When when) {
  const bool first = !std::exchange(has_name_, true);
  const double began = wall_clock();
  if (!store_ || failure_ || (when == When::now_and_then && !first && began < next_commit_)) return false;
  const bool safe = when == When::now_safe || began - opened_ > 2;  // what takes seconds can be done again
  const auto replace = [this] {                                     // they told of the former file
    for (const char* ending : {".xdmf", ".json"}) ::unlink((stem(path_) + ending).c_str());
    if (has_checkpoint_) return;
    for (const char* ending : {".checkpoint.h5", ".checkpoint-1.h5"}) ::unlink((stem(path_) + ending).c_str());
  };
  on_store([&](Store& f) { f.flush(safe, replace); });
  const double ended = wall_clock();
  next_commit_ = ended + std::max(0.5, 30 * (ended - began));
  return true;
}

void RunOutput::on_store(const std::function<void(Store&)>& write) {
  if (!store_ || failure_) return;
  const Comm::Alone now(comm_);
  try {
    write(*store_);
  } catch (const Error& e) {
    failure_ = e;
  }
}

void RunOutput::share_failure() const {
  comm_.together([&] {
    if (failure_) throw *failure_;
  });
}

void RunOutput::write_piece(const Slabs& rows, const std::string& array, const std::vector<double>& piece, bool exact) {
  const ArraySchema& of = run_array(array);
  const auto row = row_shape(of);
  const int width = row.empty() ? 1 : static_cast<int>(row[0]);
  const std::string unit(of.unit), meaning(of.meaning), name = has_name_ ? path_ : unpublished(path_);
  try {
    Store* f = failure_ ? nullptr : store_.get();
    if (single_precision_ && !exact)
      rows.write<float>(f, name, array, piece, width, unit, meaning);
    else
      rows.write<double>(f, name, array, piece, width, unit, meaning);
  } catch (const Error& e) {
    if (!failure_) failure_.emplace(path_, e.message, e.hint, e.exit);  // not the name it has for now
  }
}

}  // namespace hilo
