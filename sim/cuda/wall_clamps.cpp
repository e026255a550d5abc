#include "sim/cuda/wall_clamps.h"

namespace slosh::cuda {

void WallClamps::plan(const RunConstants& constants, const ParticleStart& start, std::size_t body_count,
                      CallCheck& check) {
  impulses_.allocate(no_impulses(body_count).size(), check);
  if (!constants.plan.clamps_penetration()) return;
  std::vector<float> values;
  for (const DistanceField& field : start.clamp_fields)
    values.insert(values.end(), field.distance.begin(), field.distance.end());
  fields_.upload(values, check);
  const float* at = fields_.data();
  for (const DistanceField& field : start.clamp_fields) {
    solids_.push_back(clamp_solid(field, {field.origin, field.cell, field.size, at}));
    at += field.distance.size();
  }
  clamps_.allocate(solids_.size(), check);
  sent_.allocate(solids_.size(), check);
}

void WallClamps::reshape(std::size_t body, const DistanceField& field, CallCheck& check,
                         cudaStream_t stream) {
  if (body >= solids_.size() || solids_[body].field.size.x == 0) return;
  const DistanceFieldView there = solids_[body].field;
  fields_.write_from(static_cast<std::size_t>(there.distance - fields_.data()), field.distance, check,
                     stream);
  solids_[body] = clamp_solid(field, there);
  places_.clear();  // what was sent has the ball of the solid before
}

bool WallClamps::goes_as_sent(std::span<const RigidBody> before, std::span<const RigidBody> after) {
  bool same = places_.size() == 2 * after.size();
  places_.resize(2 * after.size());
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const RigidBody& body = i < after.size() ? before[i] : after[i - after.size()];
    const Place place{body.position, body.orientation, body.velocity, body.angular_velocity};
    same = same && places_[i] == place;
    places_[i] = place;
  }
  return same;
}

void WallClamps::send(const Plan& plan, std::span<const RigidBody> before, std::span<const RigidBody> after,
                      CallCheck& check, cudaStream_t stream) {
  if (clamps_.size() == 0 || check.failed()) return;
  if (goes_as_sent(before, after)) return;
  place_clamp_bodies(solids_, plan, before, after, clamped_);
  any_fast_ = false;
  for (std::size_t i = 0; i < clamped_.bodies.size(); ++i) {
    const std::uint32_t number = clamped_.numbers[i];
    sent_[i] = {clamped_.bodies[i], clamped_.spheres[i], after[number].position, number};
    any_fast_ |= clamped_.bodies[i].fast;
  }
  if (clamped_.bodies.empty()) return;
  check.ok(cudaMemcpyAsync(clamps_.data(), sent_.data(), clamped_.bodies.size() * sizeof(DeviceClamp),
                           cudaMemcpyHostToDevice, stream),
           "sending walls");
}

ClampView WallClamps::view(const ImpulseUnits& units) const {
  return {static_cast<std::uint32_t>(clamped_.bodies.size()),
          static_cast<std::uint32_t>(clamps_.size()),
          any_fast_ ? 1u : 0u,
          clamps_.data(),
          reinterpret_cast<unsigned long long*>(impulses_.data()),
          units};
}

void WallClamps::hand_over(unsigned char* out, CallCheck& check, cudaStream_t stream) const {
  if (clamps_.size() == 0 || check.failed()) return;
  launch_hand_over(impulses_.data(), reinterpret_cast<std::int64_t*>(out), clamps_.size() * kImpulseWords,
                   stream);
  check.launched("handing impulses over");
}

}  // namespace slosh::cuda
