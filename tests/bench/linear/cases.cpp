// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases.hpp"

#include "../../linear/problem.hpp"
#include "system/system.hpp"

namespace hilo::bench {
namespace {

/// A system at rest in the drawn position.
struct SceneAtRest {
  LocalMesh mesh;
  std::unique_ptr<System> system;
  Config zero, mid;
  Stage stage{};
  Residual residual;
  std::vector<double> lambda;

  SceneAtRest(const std::string& scene, const std::string& mesh_path, double h, double t, const Comm& comm)
      : mesh(read_local_mesh(mesh_path, comm)), system(build_system(Scene::load(scene, {}), &mesh, comm)) {
    zero = mid = system->start;
    for (auto* list : {&zero.x, &zero.c})
      for (Vec3& x : *list) x.setZero();
    for (Mat3& R : zero.R) R.setZero();
    lambda.assign(3 * static_cast<size_t>(system->n_joint_blocks()), 0.0);
    Stage& s = stage;
    s.e0 = s.w0 = s.e1 = s.w1 = s.end = &system->start, s.left = &mid;
    s.a = s.v = &zero, s.v0 = &zero;
    s.h = s.elapsed = h, s.mass_slope = 2 / (h * h), s.alpha_slope = 1 / h;
    s.t0 = s.t1 = s.t_end = t;
  }
  SceneAtRest(const SceneAtRest&) = delete;
};

struct SharedProblem {
  test::Problem problem;
  test::Share share;
};

}  // namespace

Case scene_case(const std::string& scene, const std::string& mesh, double h, double t, const Comm& comm) {
  const auto data = std::make_shared<SceneAtRest>(scene, mesh, h, t, comm);
  Case out;
  out.cliques = &data->system->layout.cliques, out.map = &data->system->layout.map;
  out.fill = [data](KktSolver& K) { data->system->evaluate(data->stage, data->lambda, data->residual, &K); };
  data->system->evaluate(data->stage, data->lambda, data->residual, nullptr);
  out.b = data->residual.r;
  for (double& v : out.b) v = -v;
  out.keeps = data;
  return out;
}

Case block_case(int n, double cfl, double jump, int regions, const Comm& comm) {
  test::Problem p = test::elastic_bar(n, n, n, cfl);
  if (jump != 1) {
    test::scattered(p, regions);
    const auto matrix = p.matrix;
    const auto region = p.rank;
    p.matrix = [=](int e) { return test::Matrix((matrix(e).rows() >= 12 && region[e] % 2 ? jump : 1) * matrix(e)); };
  }
  test::scattered(p, comm.size);
  const test::Share share(p, comm.rank, comm.size);
  const auto data = std::make_shared<SharedProblem>(SharedProblem{std::move(p), share});
  Case out;
  out.cliques = &data->share.cliques, out.map = &data->share.map;
  out.fill = [data, &comm](KktSolver& K) { data->share.fill(data->problem, K, comm.rank, comm.size); };
  out.b = data->share.of(test::random_vector(data->problem.size(), 3));
  out.keeps = data;
  return out;
}

}  // namespace hilo::bench
