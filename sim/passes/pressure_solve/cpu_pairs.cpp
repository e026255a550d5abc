// Where the pressure projection meets bodies.
#include "sim/model.h"
#include "sim/passes/pressure_solve/cpu.h"

namespace slosh {

namespace {

constexpr std::size_t kRunsPerChunk = 16;

using Kernel = ModelParts<ParticleModel::kIncompressible>::ForceKernel;

}  // namespace

// What 1 Pa of each fluid particle puts on the bodies around it. The second layer of a wall's pressure bears
// on the body where the fluid is (passes/pressure_force/pair_force.h).
void PressureSolver::find_touches(const Work& work) {
  const FluidParticles& fluid = work.sides.fluid;
  const BoundaryParticles& moving = work.sides.moving;
  const std::vector<CellRun>& runs = fluid.index.runs();
  const double beyond = 1.0 - work.context.correction.wall_layer;
  found_touches_.resize(chunk_count(runs.size(), kRunsPerChunk));
  const bool any = moving.index.particles() > 0;
  work.team.run(any ? runs.size() : 0, kRunsPerChunk, [&](std::size_t begin, std::size_t end) {
    std::vector<Touch>& found = found_touches_[begin / kRunsPerChunk];
    found.clear();
    for (std::size_t r = begin; r < end; ++r) {
      const RowList rows = moving.index.rows(work.context.grid, runs[r].cell);
      for (std::uint32_t p = runs[r].particles.begin; p < runs[r].particles.end && rows.count > 0; ++p) {
        const glm::vec3 x(fluid.x[p], fluid.y[p], fluid.z[p]);
        const Symmetric<float> push{fluid.pxx[p], fluid.pxy[p], fluid.pxz[p],
                                    fluid.pyy[p], fluid.pyz[p], fluid.pzz[p]};
        const std::size_t first = found.size();
        for (int row = 0; row < rows.count; ++row) {
          for (std::uint32_t i = rows.rows[row].begin; i < rows.rows[row].end; ++i) {
            const glm::vec3 surface(moving.x[i], moving.y[i], moving.z[i]);
            const glm::vec3 d = x - surface;
            const float r_squared = glm::dot(d, d), h = moving.reach[i];
            if (r_squared >= h * h || moving.pressure[i] == 0.0f) continue;
            const float slope = Kernel::pair(r_squared, h, 1.0f).slope_over_r;
            const Vector3<float> pushed = times(push, slope * d.x, slope * d.y, slope * d.z);
            const glm::vec3 on_fluid =
                work.context.force_scale * moving.pressure[i] * glm::vec3(pushed.x, pushed.y, pushed.z);
            const int body = moving.body[i];
            std::size_t at = first;
            while (at < found.size() && found[at].body != body) ++at;
            if (at == found.size()) found.push_back({p, body, {}});
            const glm::dvec3 force(-on_fluid);
            const glm::dvec3 arm = glm::dvec3(surface) - work.sides.bodies[body].position;
            const glm::dvec3 torque = glm::cross(arm + beyond * glm::dvec3(d), force);
            for (int k = 0; k < 3; ++k) {
              found[at].push[k] += force[k];
              found[at].push[k + 3] += torque[k];
            }
          }
        }
      }
    }
  });
  touches_.clear();
  if (any) {
    for (const std::vector<Touch>& found : found_touches_)
      touches_.insert(touches_.end(), found.begin(), found.end());
  }
  first_touch_.assign(work.fluid + 1, 0);
  for (const Touch& touch : touches_) ++first_touch_[touch.particle + 1];
  for (std::size_t p = 0; p < work.fluid; ++p) first_touch_[p + 1] += first_touch_[p];
}

}  // namespace slosh
