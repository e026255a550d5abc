// The numbers behind a plan's choices: `slosh plan`.
#pragma once

#include <string>

#include "scenes/scene.h"
#include "sim/backend.h"
#include "sim/math/result.h"
#include "sim/plan.h"

namespace slosh {

/// What the run does before its clock starts, in words: Scene::settle.
std::string start_in_words(const Scene& scene);

/// A line for each number that a choice of the plan was made by: depth and head, what the stiffness comes
/// from and what compression it lets happen, the sub-step's share of what each limit allows, particles and
/// memory. `surface`, `fluid`: particles.
std::string plan_numbers(const Scene& scene, const Plan& plan, double fluid, double surface);

/// What its pictures have beside bodies and fluid, and what they leave out, each with its reason; a line
/// each.
std::string picture_in_words(const Scene& scene);

/// Above so many particles (estimate_particles) `plan` does not sample the scene to take its steps.
constexpr double kMaxToStep = 150000.0;
constexpr double kMaxToStepOnGpu = 2e6;

/// What a step costs on this machine's kCpu (all cores) or kCuda: of the scene as it starts, its hands where
/// they are. Above kMaxToStep a stated rate. One line. Errors: those of sampling it and of making its world.
Result<std::string> step_cost_in_words(const Scene& scene, const Plan& plan, double particles,
                                       Backend backend, int gpu);

}  // namespace slosh
