// Rows of joints beyond plain measures: sums of measures and angles.
#pragma once
#include <vector>

#include "physics/connector.hpp"
#include "physics/turn.hpp"

namespace hilo {

/// The first `n_plain` rows are the first measures themselves; each further row is a weighted sum of measures and of angles, an angle
/// being given by two measures that follow each other, its sine and its cosine.
class SumRows final : public RowLaw {
 public:
  struct Part {
    double weight;
    int measure;  // or of the sine
    bool angle = false;
  };
  SumRows(int n_plain, std::vector<std::vector<Part>> sums);
  int n_rows() const override { return n_plain_ + static_cast<int>(sums_.size()); }
  void values(const Values& e, double* g) const override;
  void gradient(const Values& e0, const Values& e1, Gradient& out) const override;
  void commit(const Values& e) override;

 private:
  int n_plain_;
  std::vector<std::vector<Part>> sums_;
  std::array<Turn, max_measures> turn_;  // of the angle whose sine is measure i
};

}  // namespace hilo
