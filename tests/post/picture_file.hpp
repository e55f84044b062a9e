// SPDX-License-Identifier: GPL-3.0-or-later
// PNG files read back: pixels, and how much of a box is ink.
#pragma once
#include <vtkImageData.h>
#include <vtkPNGReader.h>
#include <vtkSmartPointer.h>

#include <array>
#include <string>

namespace hilo::test {

/// Pixels of a PNG, origin at the upper left.
class PictureFile {
 public:
  explicit PictureFile(const std::string& path) {
    const auto reader = vtkSmartPointer<vtkPNGReader>::New();
    reader->SetFileName(path.c_str());
    reader->Update();
    image_ = reader->GetOutput();
    int n[3];
    image_->GetDimensions(n);
    width = n[0], height = n[1];
  }
  std::array<int, 3> at(int x, int y) const {
    const auto* p = static_cast<const unsigned char*>(image_->GetScalarPointer(x, height - 1 - y, 0));
    return {p[0], p[1], p[2]};
  }
  /// Share of the pixels of a box that are not white.
  double ink(int x0, int y0, int x1, int y1) const {
    int n = 0;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) n += at(x, y) != std::array{255, 255, 255};
    return static_cast<double>(n) / ((x1 - x0) * (y1 - y0));
  }
  int width = 0, height = 0;

 private:
  vtkSmartPointer<vtkImageData> image_;
};

}  // namespace hilo::test
