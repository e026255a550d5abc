// Body particles placed with their bodies (Eq 14) and sorted.
#include <algorithm>

#include "sim/cpu/passes.h"
#include "sim/cpu/state.h"
#include "sim/walls/surface_motion.h"

namespace slosh {
namespace {

constexpr std::size_t kReadAhead = 64;  // particles

}  // namespace

BodySurface::BodySurface(std::vector<SurfaceParticle> particles) : local_(std::move(particles)) {
  keys_.resize(local_.size());
  from_.resize(local_.size());
  placed_.resize(local_.size());
  velocity_.resize(local_.size());
  sorted_.resize(local_.size());
  for (std::size_t i = 0; i < local_.size(); ++i) {
    if (runs_.empty() || runs_.back().body != local_[i].body) runs_.push_back({local_[i].body, i, i});
    runs_.back().end = i + 1;
  }
  const bool mirrors = std::any_of(local_.begin(), local_.end(), [](const SurfaceParticle& p) {
    return p.mirror.normal != glm::vec3(0.0f);
  });
  if (mirrors) sorted_.mirror.resize(local_.size());
}

void BodySurface::replace(std::size_t first, std::span<const SurfaceParticle> particles) {
  std::copy(particles.begin(), particles.end(), local_.begin() + static_cast<std::ptrdiff_t>(first));
}

void BodySurface::place(const PassContext& context, std::span<const RigidBody> bodies) {
  std::size_t count = 0;  // of those that are not away: no others are sorted
  for (const Run& run : runs_) {
    const RigidBody& body = bodies[run.body];
    if (body.gone && is_away(body.mesh_pose())) continue;
    const SurfaceMotion motion = surface_motion(body);
    for (std::size_t i = run.first; i < run.end; ++i) {
      if (is_nobody(local_[i])) continue;
      const glm::vec3 p = motion.place(local_[i].position);
      from_[count] = static_cast<std::uint32_t>(i);
      placed_[count] = p;
      velocity_[count] = motion.velocity_at(p);
      // Outside the domain there is no fluid to meet.
      keys_[count++] = context.grid.contains(p.x, p.y, p.z) ? context.grid.cell_of(p.x, p.y, p.z)
                                                            : context.grid.retired_key();
    }
  }
  sorter_.sort(keys_.data(), count, context.grid.retired_key());
  const std::uint32_t* order = sorter_.order();
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t from = order[i];
    const SurfaceParticle& local = local_[from_[from]];
    sorted_.x[i] = placed_[from].x;
    sorted_.y[i] = placed_[from].y;
    sorted_.z[i] = placed_[from].z;
    sorted_.vx[i] = velocity_[from].x;
    sorted_.vy[i] = velocity_[from].y;
    sorted_.vz[i] = velocity_[from].z;
    sorted_.pressure[i] = local.pressure;
    sorted_.volume[i] = local.volume;
    sorted_.viscosity[i] = local.viscosity;
    sorted_.reach[i] = local.reach;
    sorted_.body[i] = local.body;
    if (!sorted_.mirror.empty()) sorted_.mirror.set(i, local.mirror);
  }
  // What was there before must not be met by who reads a few at a time.
  for (std::size_t i = count; i < std::min(count + kReadAhead, local_.size()); ++i)
    sorted_.x[i] = sorted_.y[i] = sorted_.z[i] = kNobodysPlace;
  sorted_.index.rebuild(context.grid, keys_.data(), count);
}

void BodySurface::set_velocities(std::span<const RigidBody> bodies, std::span<const Twist> twists) {
  std::vector<SurfaceMotion> motions;
  motions.reserve(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) motions.push_back(surface_motion(bodies[b], twists[b]));
  for (std::size_t i = 0; i < sorted_.index.particles(); ++i) {
    const glm::vec3 v = motions[sorted_.body[i]].velocity_at({sorted_.x[i], sorted_.y[i], sorted_.z[i]});
    sorted_.vx[i] = v.x;
    sorted_.vy[i] = v.y;
    sorted_.vz[i] = v.z;
  }
}

namespace passes {

void place_bodies_on_cpu(CpuState& s, const PassInputs&) {
  s.moving.place(s.context, s.bodies);
}

}  // namespace passes

}  // namespace slosh
