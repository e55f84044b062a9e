// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/height_grid.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>

#include "base/error.hpp"
#include "base/units.hpp"
#include "model/scene.hpp"
#include "model/store.hpp"

namespace hilo {
namespace {

constexpr double most_pixels = 1 << 24;

/// A grey image, read by libpng, whose errors are jumps: functions that call it hold nothing that a jump would lose.
class GreyImage {
 public:
  explicit GreyImage(const std::string& bytes) : bytes_(bytes) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, fail, [](png_structp, png_const_charp) {});
    if (png_) info_ = png_create_info_struct(png_);
    if (!info_) throw std::bad_alloc();
    png_set_read_fn(png_, this, give);
  }
  GreyImage(const GreyImage&) = delete;
  ~GreyImage() { png_destroy_read_struct(&png_, &info_, nullptr); }

  size_t width() const { return png_get_image_width(png_, info_); }
  size_t height() const { return png_get_image_height(png_, info_); }
  int bits() const { return bits_; }
  bool is_grey() const { return png_get_color_type(png_, info_) == PNG_COLOR_TYPE_GRAY && !png_get_valid(png_, info_, PNG_INFO_tRNS); }
  const std::string& why() const { return why_; }

  bool read_head() {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_read_info(png_, info_);
    bits_ = png_get_bit_depth(png_, info_);  // packing changes it
    png_set_packing(png_), png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }
  bool read_pixels() {
    pixels_.resize(png_get_rowbytes(png_, info_) * height());
    for (size_t j = 0; j < height(); ++j) rows_.push_back(pixels_.data() + j * png_get_rowbytes(png_, info_));
    return take_pixels();
  }
  double at_one_level() const { return 1 / (std::ldexp(1, bits()) - 1); }
  /// A pixel of a line from above: 0 is black, 1 is white.
  double at(size_t line, size_t column) const {
    const unsigned char* row = rows_[line];
    return (bits() == 16 ? row[2 * column] * 256 + row[2 * column + 1] : row[column]) * at_one_level();
  }

 private:
  bool take_pixels() {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_read_image(png_, rows_.data());
    png_read_end(png_, nullptr);
    return true;
  }
  static void give(png_structp png, png_bytep to, size_t n) {
    auto& self = *static_cast<GreyImage*>(png_get_io_ptr(png));
    if (n > self.bytes_.size() - self.at_) png_error(png, "it ends within the image");
    std::memcpy(to, self.bytes_.data() + self.at_, n);
    self.at_ += n;
  }
  [[noreturn]] static void fail(png_structp png, png_const_charp why) {
    static_cast<GreyImage*>(png_get_error_ptr(png))->why_ = why;
    png_longjmp(png, 1);
  }

  const std::string& bytes_;
  size_t at_ = 0;
  std::string why_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  int bits_ = 0;
  std::vector<unsigned char> pixels_;
  std::vector<png_bytep> rows_;
};

bool is_image(const std::string& path) {
  unsigned char first[8];
  return std::filesystem::is_regular_file(path) &&
         std::ifstream(path, std::ios::binary).read(reinterpret_cast<char*>(first), sizeof first) &&
         png_sig_cmp(first, 0, sizeof first) == 0;
}

}  // namespace

HeightGrid read_height_image(const std::string& path, const std::string& where, std::span<const double> size,
                             std::span<const double> range) {
  const std::string bytes = read_text_file(path, where);
  GreyImage image(bytes);
  const auto unreadable = [&] { return Error(path, fmt::format("this image cannot be read: {}", image.why())); };
  if (!image.read_head()) throw unreadable();
  if (!image.is_grey()) throw Error(path, "an image of colours or of holes", "heights are levels of grey: make it a grey PNG of 16 bits");
  const size_t nx = image.width(), ny = image.height();
  if (nx < 2 || ny < 2) throw Error(path, fmt::format("{} x {} pixels: a field has two each way at least", nx, ny));
  if (static_cast<double>(nx) * static_cast<double>(ny) > most_pixels)
    throw Error(path, fmt::format("{} x {} pixels, more than {:.3g} million in all", nx, ny, most_pixels / 1e6), "a smaller image");
  if (!image.read_pixels()) throw unreadable();
  const double spacing = std::min(size[0] / static_cast<double>(nx - 1), size[1] / static_cast<double>(ny - 1));
  if (const double level = std::abs(range[1] - range[0]) * image.at_one_level(); level > 0.01 * spacing)
    warn(where,
         fmt::format("its {} bits tell heights in steps of {:.3g} m, beside {:.3g} m from pixel to pixel: the surface has such stairs "
                     "(16 bits, or smoothed heights as CSV)",
                     image.bits(), level, spacing));
  HeightGrid grid;
  for (size_t i = 0; i < nx; ++i) grid.x.push_back(size[0] * static_cast<double>(i) / static_cast<double>(nx - 1));
  for (size_t j = 0; j < ny; ++j) grid.y.push_back(size[1] * static_cast<double>(j) / static_cast<double>(ny - 1));
  for (size_t j = ny; j-- > 0;)
    for (size_t i = 0; i < nx; ++i) grid.heights.push_back(range[0] + (range[1] - range[0]) * image.at(j, i));
  return grid;
}

HeightGrid height_grid_of(const Entry& e, const Scene& scene) {
  const std::filesystem::path file = e.text("file");
  const std::string path = (scene.folder == "." ? file : scene.folder / file).string(), where = e.where("file");
  if (is_image(path)) {
    for (const char* key : {"size", "heights"})
      if (!e.has(key))
        e.refuse("file", fmt::format("an image without `{}`", key), "size = [along x, along y], heights = [of black, of white]");
    return read_height_image(path, where, e.numbers("size"), e.numbers("heights"));
  }
  for (const char* key : {"size", "heights"})
    if (e.given(key)) e.refuse(key, fmt::format("`{}` is of a PNG image, which {} is not", key, path), "a CSV has its own numbers");
  HeightGrid grid = read_height_grid(path, where);
  for (std::vector<double>* list : {&grid.x, &grid.y, &grid.heights})
    for (double& x : *list) x *= to_si("m", scene.units);
  return grid;
}

}  // namespace hilo
