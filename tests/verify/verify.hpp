// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a scene of tests/verify as a user would, and reads what it wrote with a reader that shares nothing with the integrator.
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "model/store.hpp"
#include "succeeded.hpp"
#include "verify/block_mesh.hpp"

namespace hilo::test {

/// Histories and fields of a run.
class Results {
 public:
  explicit Results(const std::string& path) : file_(Store::open(path)) {
    const auto times = history("t");
    t_ = times.col(0);
  }
  const Store& file() const { return file_; }
  const Eigen::VectorXd& t() const { return t_; }
  bool complete() const { return file_.number_attribute("/", "complete").value_or(-1) == 1; }

  /// Rows over time of /history/<name>.
  Eigen::MatrixXd history(const std::string& name) const { return table("/history/" + name); }
  /// The row of a history at an instant that was recorded.
  Eigen::VectorXd at(const std::string& name, double time) const { return history(name).row(index(time)).transpose(); }
  Eigen::Index index(double time) const {
    Eigen::Index i = 0;
    (t_.array() - time).abs().minCoeff(&i);
    if (std::abs(t_[i] - time) > 1e-9 * std::max(1.0, std::abs(time))) throw std::runtime_error("no row at t = " + std::to_string(time));
    return i;
  }
  Eigen::MatrixXd table(const std::string& path) const {
    const auto shape = file_.shape(path);
    const auto values = file_.read<double>(path);
    const Eigen::Index rows = shape.empty() ? 1 : shape[0], cols = rows ? static_cast<Eigen::Index>(values.size()) / rows : 0;
    return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(values.data(), rows, cols);
  }
  /// Nodal fields in the order they were written; "" the last one.
  std::vector<std::string> steps() const { return file_.list("/field"); }
  std::vector<Vec3> field(const std::string& name, std::string step = "") const {
    if (step.empty()) step = steps().back();
    const auto m = table("/field/" + step + "/" + name);
    std::vector<Vec3> out;
    for (Eigen::Index i = 0; i < m.rows(); ++i) out.emplace_back(m(i, 0), m(i, 1), m(i, 2));
    return out;
  }
  double field_time(const std::string& step) const { return file_.number_attribute("/field/" + step, "t").value(); }
  /// Largest magnitude of a history's columns [first, first + count).
  double peak(const std::string& name, Eigen::Index first, Eigen::Index count) const {
    return history(name).middleCols(first, count).rowwise().norm().maxCoeff();
  }

 private:
  Store file_;
  Eigen::VectorXd t_;
};

/// Largest changes of energy and momenta from an instant on, by their sizes there, and the largest share of strain energy.
struct Drift {
  double energy, momentum, angular, strained;
};
inline Drift drift(const Results& r, double from) {
  const Eigen::MatrixXd E = r.history("energy"), p = r.history("momentum");
  Eigen::Index first = 0;
  while (r.t()[first] < from) ++first;
  const Eigen::Index n = E.rows() - first;
  const Eigen::VectorXd sum = E.bottomRows(n).leftCols(3).rowwise().sum();
  const auto change = [&](Eigen::Index column) {
    const Eigen::MatrixXd part = p.bottomRows(n).middleCols(column, 3);
    return (part.rowwise() - part.row(0)).rowwise().norm().maxCoeff() / std::max(part.row(0).norm(), 1e-300);
  };
  return {(sum.array() - sum[0]).abs().maxCoeff() / sum[0], change(0), change(3), E.bottomRows(n).col(1).maxCoeff() / sum[0]};
}

/// A number of the JSON report of the last run in a folder; NaN where it is not there.
inline double reported_in(const Workplace& place, const std::string& key) {
  const std::string text = text_of(place / "run.json");
  const auto at = text.find("\"" + key + "\": ");
  return at == std::string::npos ? std::nan("") : std::stod(text.substr(at + key.size() + 4));
}

/// A scene of the test, on a mesh or on none.
class ScenePlace : public testing::Test {
 protected:
  void use(const Mesh& m, const std::vector<Fidelity>& fidelity = {}) {
    write_mesh(work / "mesh.h5", m, {"test"});
    mesh = "mesh.h5";
    if (fidelity.empty()) return;
    write_tags(work / "tags.h5", work / "mesh.h5", fidelity, {"test"});
    mesh = "tags.h5";
  }
  Results solved(const std::string& scene, const std::string& options = "") {
    work.write("scene.toml", scene);
    ran = succeeded(work.run("hilo-solve --quiet scene.toml " + mesh + " -o run.h5 " + options));
    return Results(work / "run.h5");
  }
  /// Natural frequencies [Hz]; below zero: growth.
  Eigen::VectorXd frequencies(const std::string& scene, int n, const std::string& more = "") {
    const Eigen::MatrixXd all = solved(scene + fmt::format("[time]\nanalysis = \"modes\"\nmodes = {}\n{}\n", n, more)).history("mode");
    return all.col(0).tail(all.rows() - 1);
  }
  Workplace work;
  std::string mesh;
  Ran ran;
};

/// A case: the folder tests/verify/<name> and a place to run it in.
class Case : public Workplace {
 public:
  explicit Case(const std::string& name) : folder_(std::string(HILO_SOURCE) + "/tests/verify/" + name) {}
  /// A file of the case; one that the test has written comes first.
  std::string source(const std::string& file) const { return std::filesystem::exists(*this / file) ? *this / file : folder_ + "/" + file; }
  /// hilo-solve on `scene`.toml of the case, with options such as --set time.step=1e-3; expects exit code `expected`.
  Ran solve(const std::string& options = "", const std::string& output = "run.h5", int expected = 0,
            const std::string& scene = "scene") const {
    const Ran ran =
        run("hilo-solve '" + source(scene + ".toml") + "' " + (mesh_.empty() ? "" : "'" + mesh_ + "' ") + options + " -o " + output);
    EXPECT_EQ(ran.exit, expected) << options << "\n" << ran.err;
    return ran;
  }
  Results results(const std::string& output = "run.h5") const { return Results(*this / output); }
  double reported(const std::string& key) const { return reported_in(*this, key); }
  /// With this change of its scene the case is refused, with these words.
  void expect_mistake(const std::string& change, const std::string& words, const std::string& scene = "scene") const {
    const Ran ran = solve("--quiet --set " + change, "bad.h5", 2, scene);
    EXPECT_NE(ran.err.find(words), std::string::npos) << ran.err;
  }
  /// Run and read.
  Results solved(const std::string& options = "", const std::string& output = "run.h5", const std::string& scene = "scene") const {
    const Ran ran = solve("--quiet " + options, output, 0, scene);
    if (ran.exit != 0) throw std::runtime_error("hilo-solve: " + ran.err);
    return results(output);
  }
  /// Write a mesh, untagged or with a fidelity per region, for the runs that follow.
  void use(const Mesh& mesh, const std::vector<Fidelity>& fidelity = {}) {
    write_mesh(*this / "mesh.h5", mesh, {"test"});
    mesh_ = *this / "mesh.h5";
    if (fidelity.empty()) return;
    write_tags(*this / "tags.h5", mesh_, fidelity, {"test"});
    mesh_ = *this / "tags.h5";
  }

 private:
  std::string folder_, mesh_;
};

/// A case whose scene the test makes.
struct SceneCase : Case {
  explicit SceneCase(const std::string& scene) : Case(".") { write("scene.toml", scene); }
};

}  // namespace hilo::test
