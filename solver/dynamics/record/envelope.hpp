// SPDX-License-Identifier: GPL-3.0-or-later
// The largest sizes of nodal fields over all instants of a run, and when they were.
#pragma once
#include "dynamics/record/fields.hpp"

namespace hilo {

class Envelope {
 public:
  Envelope() {
    for (const std::string& name : names()) fields_.push_back({name, {}, {}});
  }
  /// Of the rows that this rank writes (Slabs): the largest size, and the first time it was reached.
  struct Of {
    std::string name;
    std::vector<double> most, t;  // (n)  [unit of the field], [s]
  };
  const std::vector<Of>& fields() const { return fields_; }
  static const std::vector<std::string>& names();
  /// A field at an instant, rows of any width.
  void take(const std::string& name, const std::vector<double>& rows, size_t n, double t);
  /// `rows` of this rank in the file.
  void archive(Archive& a, const Spread& rows);

 private:
  std::vector<Of> fields_;
};

/// Where sources put their fields for an envelope to see: nothing of it is written.
class EnvelopeWriter final : public FieldWriter {
 public:
  EnvelopeWriter(RunOutput& file, Envelope& envelope, double t, const Slabs& nodes, const Slabs& cells);
  void piece(const std::string& name, const std::vector<double>& rows) override;
  bool keeps() const override { return false; }

 private:
  Envelope& envelope_;
  double t_;
};

}  // namespace hilo
