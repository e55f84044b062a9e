// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/picture/picture.hpp"

#include <fmt/format.h>
#include <vtkBrush.h>
#include <vtkContext2D.h>
#include <vtkContextActor.h>
#include <vtkContextDevice2D.h>
#include <vtkContextItem.h>
#include <vtkContextScene.h>
#include <vtkImageData.h>
#include <vtkLogger.h>
#include <vtkMatrix4x4.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLContextDevice2D.h>
#include <vtkPNGWriter.h>
#include <vtkPen.h>
#include <vtkRenderWindow.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "base/error.hpp"
#include "post/files/output.hpp"
#include "post/picture/egl_window.hpp"

namespace hilo {
namespace {

void colour_of(const Rgb& c, double opacity, unsigned char out[4]) {
  const auto b = bytes(c);
  out[0] = b[0], out[1] = b[1], out[2] = b[2], out[3] = static_cast<unsigned char>(std::lround(255 * opacity));
}

/// DejaVu Sans where the machine has it (Debian installs it with fontconfig), else VTK's own letters.
const char* font_file(bool bold) {
  static const char *plain = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                    *strong = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf";
  static const bool there = std::filesystem::exists(plain) && std::filesystem::exists(strong);
  return !there ? nullptr : bold ? strong : plain;
}

std::vector<float> floats(std::span<const Vec2> points) {
  std::vector<float> f;
  f.reserve(2 * points.size());
  for (const Vec2& p : points) f.push_back(static_cast<float>(p.x())), f.push_back(static_cast<float>(p.y()));
  return f;
}

}  // namespace

void Painter::line(std::span<const Vec2> points, const Rgb& colour, double width, double opacity, bool dashed) {
  if (points.size() < 2) return;
  unsigned char c[4];
  colour_of(colour, opacity, c);
  vtkPen* pen = context_->GetPen();
  pen->SetColor(c[0], c[1], c[2], c[3]);
  pen->SetLineType(dashed ? vtkPen::DASH_LINE : vtkPen::SOLID_LINE);
  pen->SetWidth(static_cast<float>(std::max(1.0, width * scale)));
  auto f = floats(points);
  context_->DrawPoly(f.data(), static_cast<int>(points.size()));
}

void Painter::polygon(std::span<const Vec2> points, const Rgb& fill, double opacity) {
  unsigned char c[4];
  colour_of(fill, opacity, c);
  context_->GetPen()->SetLineType(vtkPen::NO_PEN);
  context_->GetBrush()->SetColor(c[0], c[1], c[2], c[3]);
  auto f = floats(points);
  context_->DrawPolygon(f.data(), static_cast<int>(points.size()));
}

void Painter::rectangle(const Box& b, const Rgb& fill, double opacity) {
  polygon(std::array{Vec2(b.x, b.y), Vec2(b.x + b.w, b.y), Vec2(b.x + b.w, b.y + b.h), Vec2(b.x, b.y + b.h)}, fill, opacity);
}

void Painter::outline(const Box& b, const Rgb& colour, double width) {
  line(std::array{Vec2(b.x, b.y), Vec2(b.x + b.w, b.y), Vec2(b.x + b.w, b.y + b.h), Vec2(b.x, b.y + b.h), Vec2(b.x, b.y)}, colour, width);
}

void Painter::disc(const Vec2& centre, double radius, const Rgb& fill) {
  std::vector<Vec2> circle;
  for (int i = 0; i < 24; ++i) circle.push_back(centre + radius * Vec2(std::cos(M_PI * i / 12), std::sin(M_PI * i / 12)));
  polygon(circle, fill);
}

void Painter::font(double size, const Rgb& colour, bool bold) {
  vtkTextProperty* p = context_->GetTextProp();
  p->SetFontFamilyToArial();
  if (const char* file = font_file(bold)) {
    p->SetFontFamily(VTK_FONT_FILE);
    p->SetFontFile(file);
  }
  p->SetFontSize(static_cast<int>(std::lround(size * scale)));
  p->SetBold(bold);
  p->SetColor(colour.r, colour.g, colour.b);
  p->SetOrientation(0);
  p->SetJustificationToLeft();
  p->SetVerticalJustificationToBottom();
}

namespace {

/// A stretch of text, plain or raised: "m/s^2" is "m/s" and a raised "2".
struct Run {
  std::string text;
  bool raised;
};

std::vector<Run> runs_of(const std::string& text) {
  std::vector<Run> runs{{"", false}};
  for (size_t i = 0; i < text.size(); ++i) {
    const auto digit = [&](size_t k) { return k < text.size() && std::isdigit(static_cast<unsigned char>(text[k])); };
    if (text[i] == '^' && (digit(i + 1) || (i + 1 < text.size() && text[i + 1] == '-' && digit(i + 2)))) {
      Run raised{std::string(1, text[++i]), true};
      while (digit(i + 1)) raised.text += text[++i];
      runs.push_back(raised);
      runs.push_back({"", false});
    } else {
      runs.back().text += text[i];
    }
  }
  std::erase_if(runs, [](const Run& r) { return r.text.empty(); });
  return runs;
}

constexpr double raised_size = 0.7, raised_by = 0.42;

}  // namespace

void Painter::text(const Vec2& at, const std::string& text, double size, Across across, Up up, const Rgb& colour, bool bold, double angle) {
  if (text.empty()) return;
  const Vec2 all = extent(text, size, bold);
  const Vec2 along(std::cos(angle * M_PI / 180), std::sin(angle * M_PI / 180)), above(-along.y(), along.x());
  Vec2 pen = at -
             (across == Across::left     ? 0
              : across == Across::centre ? 0.5
                                         : 1) *
                 all.x() * along -
             (up == Up::bottom   ? 0
              : up == Up::middle ? 0.5
                                 : 1) *
                 all.y() * above;
  for (const Run& run : runs_of(text)) {
    const double run_size = run.raised ? raised_size * size : size;
    const double wide = extent(run.text, run_size, bold).x();
    font(run_size, colour, bold);
    context_->GetTextProp()->SetOrientation(angle);
    const Vec2 corner = pen + (run.raised ? raised_by * size * scale : 0.0) * above;
    context_->DrawString(static_cast<float>(std::round(corner.x())), static_cast<float>(std::round(corner.y())), run.text.c_str());
    pen += wide * along;
  }
}

Vec2 Painter::extent(const std::string& text, double size, bool bold) {
  Vec2 sum = Vec2::Zero();
  for (const Run& run : runs_of(text)) {
    font(run.raised ? raised_size * size : size, ink, bold);
    float b[4] = {0, 0, 0, 0};
    context_->ComputeStringBounds(run.text.c_str(), b);
    sum.x() += b[2];
    if (!run.raised) sum.y() = std::max<double>(sum.y(), b[3]);
  }
  return sum;
}

void Painter::clip(const Box& b) {
  int r[4] = {static_cast<int>(std::floor(b.x)), static_cast<int>(std::floor(b.y)), static_cast<int>(std::ceil(b.w)),
              static_cast<int>(std::ceil(b.h))};
  context_->GetDevice()->SetClipping(r);
  context_->GetDevice()->EnableClipping(true);
}

void Painter::unclip() { context_->GetDevice()->EnableClipping(false); }

class Picture::Item : public vtkContextItem {
 public:
  static Item* New();
  vtkTypeMacro(Item, vtkContextItem);
  bool Paint(vtkContext2D* context) override {
    if (!paint) return false;
    // VTK lays 0.5..w-0.5 on the whole width; letters are sharp only where a unit is a pixel.
    if (auto* device = vtkOpenGLContextDevice2D::SafeDownCast(context->GetDevice())) {
      vtkMatrix4x4* projection = device->GetProjectionMatrix();
      projection->SetElement(0, 0, 2.0 / width), projection->SetElement(0, 3, -1);
      projection->SetElement(1, 1, 2.0 / height), projection->SetElement(1, 3, -1);
    }
    Painter painter(context, width, height, picture_scale(width, height));
    paint(painter);
    return true;
  }
  std::function<void(Painter&)> paint;
  int width = 0, height = 0;
};
vtkStandardNewMacro(Picture::Item);

double picture_scale(int width, int height) { return std::max(0.4, std::min(width / 1280.0, height / 720.0)); }

Picture::Picture(int width, int height) : width(width), height(height), window_(egl_window(width, height)) {
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_ERROR);  // its warnings are for programmers
  const auto paper = vtkSmartPointer<vtkRenderer>::New();
  paper->SetBackground(1, 1, 1);
  window_->AddRenderer(paper);
  top_ = vtkSmartPointer<vtkRenderer>::New();
  top_->SetLayer(1);
  window_->SetNumberOfLayers(2);
  window_->AddRenderer(top_);
  item_ = vtkSmartPointer<Item>::New();
  item_->width = width, item_->height = height;
  const auto actor = vtkSmartPointer<vtkContextActor>::New();
  actor->GetScene()->AddItem(item_);
  top_->AddActor(actor);
}

Picture::~Picture() = default;

vtkRenderer* Picture::layer(const Box& b) {
  const auto renderer = vtkSmartPointer<vtkRenderer>::New();
  renderer->SetBackground(1, 1, 1);
  renderer->SetViewport(b.x / width, b.y / height, (b.x + b.w) / width, (b.y + b.h) / height);
  const int n = window_->GetNumberOfLayers();
  renderer->SetLayer(n - 1);
  window_->SetNumberOfLayers(n + 1);
  top_->SetLayer(n);
  window_->AddRenderer(renderer);
  return renderer;
}

void Picture::paint(std::function<void(Painter&)> paint) {
  item_->paint = std::move(paint);
  item_->Modified();
}

vtkSmartPointer<vtkWindowToImageFilter> Picture::grab() {
  window_->Render();
  auto grab = vtkSmartPointer<vtkWindowToImageFilter>::New();
  grab->SetInput(window_);
  grab->ReadFrontBufferOff();
  grab->ShouldRerenderOff();
  return grab;
}

std::string Picture::png() {
  const auto image = grab();
  const auto png = vtkSmartPointer<vtkPNGWriter>::New();
  png->SetInputConnection(image->GetOutputPort());
  png->WriteToMemoryOn();
  png->Write();
  vtkUnsignedCharArray* data = png->GetResult();
  if (!data || data->GetNumberOfTuples() == 0) throw Error("picture", "could not be encoded", "", Exit::fault);
  return {reinterpret_cast<const char*>(data->GetPointer(0)), static_cast<size_t>(data->GetNumberOfTuples())};
}

std::string Picture::pixels() {
  const auto image = grab();
  image->Update();
  vtkImageData* data = image->GetOutput();
  const size_t row = 3 * static_cast<size_t>(width);
  std::string rows(row * static_cast<size_t>(height), '\0');
  for (int y = 0; y < height; ++y)
    std::memcpy(rows.data() + static_cast<size_t>(height - 1 - y) * row, data->GetScalarPointer(0, y, 0), row);
  return rows;
}

void Picture::write(const std::string& path) { write_out(path, png()); }

std::pair<int, int> parse_size(const std::string& text) {
  int w = 0, h = 0;
  char x = 0, rest = 0;
  if (std::sscanf(text.c_str(), "%d%c%d%c", &w, &x, &h, &rest) != 3 || x != 'x' || w < 160 || h < 120 || w > 16384 || h > 16384)
    throw Error("--size", fmt::format("\"{}\" is no picture size", text), "write WIDTHxHEIGHT in pixels, such as 1280x720", Exit::usage);
  return {w, h};
}

}  // namespace hilo
