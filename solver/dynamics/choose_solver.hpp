// Which linear solver a run takes.
#pragma once
#include <memory>

#include "linear/kkt.hpp"
#include "model/scene.hpp"
#include "system/system.hpp"

namespace hilo {

/// The linear solver for the scene, its pattern set: the light one while a factor fits, CG with incomplete factors for what no factor
/// holds; on several ranks that share few nodes BDDC, in a third of the time of MUMPS and two thirds of its memory (docs/solvers.md).
std::unique_ptr<KktSolver> choose_solver(const Scene& scene, const System& system, bool talk);

}  // namespace hilo
