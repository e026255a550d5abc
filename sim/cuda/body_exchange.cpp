#include "sim/cuda/body_exchange.h"

namespace slosh::cuda {

void SentBodies::allocate(std::size_t count, CallCheck& check) {
  bodies_.allocate(count, check);
  sent_bodies_.allocate(count, check);
  twists_.allocate(count, check);
  sent_twists_.allocate(count, check);
}

void SentBodies::send(std::span<const RigidBody> bodies, CallCheck& check, cudaStream_t stream) {
  if (bodies.empty() || check.failed()) return;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    sent_bodies_[b] = {surface_motion(bodies[b]), bodies[b].position};
  check.ok(
      cudaMemcpyAsync(bodies_.data(), sent_bodies_.data(), bodies_.bytes(), cudaMemcpyHostToDevice, stream),
      "sending bodies");
}

void SentBodies::send_twists(std::span<const Twist> twists, CallCheck& check, cudaStream_t stream) {
  for (std::size_t b = 0; b < twists.size(); ++b) {
    sent_twists_[b] = sent_bodies_[b];
    sent_twists_[b].motion.velocity = glm::vec3(twists[b].linear);
    sent_twists_[b].motion.angular_velocity = glm::vec3(twists[b].angular);
  }
  check.ok(
      cudaMemcpyAsync(twists_.data(), sent_twists_.data(), twists_.bytes(), cudaMemcpyHostToDevice, stream),
      "sending twists");
}

void SentProbes::allocate(const std::vector<Probe>& probes, CallCheck& check) {
  probes_.allocate(probes.size(), check);
  sent_.allocate(probes.size(), check);
  std::vector<std::uint32_t> slots;
  for (const Probe& probe : probes) slots.push_back(probe.id);
  slots_.upload(slots, check);
}

void SentProbes::carry(const StepConstants& constants, float rest_volume, const std::vector<Probe>& probes,
                       std::span<const RigidBody> bodies, const FluidView& fluid, CallCheck& check,
                       cudaStream_t stream) {
  if (probes.empty() || check.failed()) return;
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const glm::vec3 x(bodies[probes[i].body].position);
    const glm::vec3 v(bodies[probes[i].body].velocity);
    sent_[i] = {{x.x, x.y, x.z, 0.0f}, {v.x, v.y, v.z, rest_volume}};
  }
  check.ok(cudaMemcpyAsync(probes_.data(), sent_.data(), probes_.bytes(), cudaMemcpyHostToDevice, stream),
           "sending probes");
  launch_carry_probes(constants, probes_.data(), slots_.data(), static_cast<std::uint32_t>(probes.size()),
                      fluid, stream);
  check.launched("placing probes");
}

}  // namespace slosh::cuda
