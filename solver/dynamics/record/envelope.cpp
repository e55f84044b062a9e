// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/record/envelope.hpp"

#include <cmath>

namespace hilo {

const std::vector<std::string>& Envelope::names() {
  static const std::vector<std::string> names{"displacement", "acceleration", "von_mises"};
  return names;
}

void Envelope::archive(Archive& a, const Spread& rows) {
  for (Of& of : fields_) {
    if (of.most.empty()) of.most.assign(rows.size(), -1), of.t.assign(rows.size(), 0);  // no instant yet
    a.spread(rows, of.most, 1), a.spread(rows, of.t, 1);
  }
}

void Envelope::take(const std::string& name, const std::vector<double>& rows, size_t n, double t) {
  const auto of = std::find_if(fields_.begin(), fields_.end(), [&](const Of& field) { return field.name == name; });
  if (of == fields_.end()) return;
  if (of->most.empty()) of->most.assign(n, -1), of->t.assign(n, t);
  for (size_t i = 0; i < n; ++i) {
    const size_t width = rows.size() / n;
    double size = rows[i * width];
    if (width > 1) {
      size *= size;
      for (size_t k = 1; k < width; ++k) size += rows[i * width + k] * rows[i * width + k];
      size = std::sqrt(size);
    }
    if (size > of->most[i]) of->most[i] = size, of->t[i] = t;
  }
}

EnvelopeWriter::EnvelopeWriter(RunOutput& file, Envelope& envelope, double t, const Slabs& nodes, const Slabs& cells)
    : FieldWriter(file, Envelope::names(), nodes, cells, false), envelope_(envelope), t_(t) {}

void EnvelopeWriter::piece(const std::string& name, const std::vector<double>& rows) {
  envelope_.take(name, rows, static_cast<size_t>(node_rows().count()), t_);
}

}  // namespace hilo
