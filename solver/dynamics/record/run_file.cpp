#include "dynamics/record/run_file.hpp"

#include <unistd.h>

namespace hilo {

std::string stem(const std::string& path) { return path.ends_with(".h5") ? path.substr(0, path.size() - 3) : path; }

void RunFile::create() {
  comm_.together([&] {
    if (comm_.rank != 0) return;
    store_ = std::make_unique<Store>(Store::create_growing(path_));
    for (const char* of_former : {".xdmf", ".json"}) ::unlink((stem(path_) + of_former).c_str());  // they told of the file replaced
  });
}

void RunFile::on_store(const std::function<void(Store&)>& write) {
  if (!store_ || failure_) return;
  try {
    write(*store_);
  } catch (const Error& e) {
    failure_ = e;
  }
}

void RunFile::share_failure() const {
  comm_.together([&] {
    if (failure_) throw *failure_;
  });
}

void RunFile::write_piece(const Slabs& rows, const std::string& array, const std::vector<double>& piece, bool exact) {
  const ArraySchema& of = run_array(array);
  const auto row = row_shape(of);
  const int width = row.empty() ? 1 : static_cast<int>(row[0]);
  const std::string unit(of.unit), meaning(of.meaning);
  try {
    Store* f = failure_ ? nullptr : store_.get();
    if (single_precision_ && !exact)
      rows.write<float>(f, path_, array, piece, width, unit, meaning);
    else
      rows.write<double>(f, path_, array, piece, width, unit, meaning);
  } catch (const Error& e) {
    if (!failure_) failure_ = e;
  }
}

void RunFile::discard() {
  if (!store_) return;
  store_->discard();
  store_.reset();
  ::unlink((stem(path_) + ".xdmf").c_str());
}

}  // namespace hilo
