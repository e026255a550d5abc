#include "render/passes/smooth_centers.h"

#include <array>
#include <cmath>

#include "render/shader_math.h"

namespace slosh {
namespace {

// Neighbours side by side: loops over them are plain, so that the compiler makes them wide.
constexpr int kTileWide = ParticleCells::kReadOn;
using TileLanes = std::array<float, kTileWide>;

float total(TileLanes lanes) {
  for (int half = kTileWide / 2; half > 0; half /= 2) {
    for (int i = 0; i < half; ++i) lanes[i] += lanes[i + half];
  }
  return lanes[0];
}

/// Of all in `runs` that lie within reach of `at`. Up to kTileWide - 1 places behind a run are read.
shader::Neighbourhood neighbourhood_of(const std::array<std::vector<float>, 3>& places,
                                       const ParticleCells::Runs& runs, const glm::vec3& at, float reach) {
  const float inverse = 1.0f / reach;
  const float squared_reach = reach * reach;
  TileLanes w{}, x{}, y{}, z{}, xx{}, yy{}, zz{}, xy{}, yz{}, zx{};
  for (const ParticleCells::Run& run : runs) {
    for (std::uint32_t k = run.first; k < run.end; k += kTileWide) {
      const float* px = &places[0][k];
      const float* py = &places[1][k];
      const float* pz = &places[2][k];
      const int here = static_cast<int>(run.end - k);
      for (int i = 0; i < kTileWide; ++i) {
        const float dx = px[i] - at.x;
        const float dy = py[i] - at.y;
        const float dz = pz[i] - at.z;
        const float squared = dx * dx + dy * dy + dz * dz;
        const float share = std::sqrt(squared) * inverse;
        const float whole = shader::neighbour_weight(share);
        const float weight = (i < here) & (squared < squared_reach) ? whole : 0.0f;
        const float wx = weight * dx;
        const float wy = weight * dy;
        const float wz = weight * dz;
        w[i] += weight;
        x[i] += wx;
        y[i] += wy;
        z[i] += wz;
        xx[i] += wx * dx;
        yy[i] += wy * dy;
        zz[i] += wz * dz;
        xy[i] += wx * dy;
        yz[i] += wy * dz;
        zx[i] += wz * dx;
      }
    }
  }
  return {total(w),
          {total(x), total(y), total(z)},
          {total(xx), total(yy), total(zz)},
          {total(xy), total(yz), total(zx)}};
}

}  // namespace

void SmoothCenters::sort(const Frame& frame) {
  cells_.sort(frame, reach(frame.particle_radius));
  smoothed_.resize(frame.particles.size());
  known_.assign(frame.particles.size(), 0);
}

SmoothCenters::Smoothed SmoothCenters::smooth(const glm::vec3& at, const Frame& frame) const {
  const float reach = cells_.reach();
  const float radius = frame.particle_radius;
  const shader::Neighbourhood around = neighbourhood_of(cells_.places(), cells_.around(at), at, reach);
  Smoothed smoothed{at + shader::smoothing_step(around, reach),
                    shader::smoothing_ellipsoid(around, reach, radius)};
  if (!frame.wall || around.weights >= shader::kLyingMany) return smoothed;
  const std::optional<WallPoint> wall = frame.wall(at, shader::kLyingFar * radius);
  if (!wall) return smoothed;
  const float share = shader::lying_share(around.weights, shader::neighbours_mean(around), wall->normal,
                                          glm::distance(at, wall->at), radius);
  const glm::mat3 lying = shader::lying_ellipsoid(around.weights, wall->normal, radius);
  // The fluid's surface stays beside its neighbours': along the wall the step is theirs.
  const float off = glm::dot(smoothed.center - wall->at, wall->normal);
  smoothed.center -= share * off * wall->normal;
  smoothed.ellipsoid += share * (lying - smoothed.ellipsoid);
  return smoothed;
}

void SmoothCenters::move(const Frame& frame, Splats& splats) {
  splats.shapes.resize(splats.spheres.size());
  const glm::mat3 turn(frame.view.view);
  for (std::size_t i = 0; i < splats.spheres.size(); ++i) {
    const std::uint32_t particle = splats.particles[i];
    Smoothed& smoothed = smoothed_[particle];
    if (!known_[particle]) {
      smoothed = smooth(frame.particles[particle], frame);
      known_[particle] = 1;
    }
    glm::vec4& sphere = splats.spheres[i];
    sphere = glm::vec4(glm::vec3(frame.view.view * glm::vec4(smoothed.center, 1.0f)), sphere.w);
    splats.shapes[i] = shape_of(turn * smoothed.ellipsoid * glm::transpose(turn), glm::vec3(sphere));
  }
}

}  // namespace slosh
