#include "render/passes/given_particles.h"

#include <utility>

namespace slosh {

bool GivenParticles::open(const SharedParticles& particles) {
  if (particles.allocation == tried_) return memory_.has_value();
  tried_ = particles.allocation;
  checked_ = false;
  memory_.reset();
  refused_.clear();
  auto opened = gl::SharedMemory::open(particles);
  if (opened)
    memory_ = std::move(opened.value());
  else
    refused_ = opened.error().text();
  return memory_.has_value();
}

void GivenParticles::hold(std::shared_ptr<const SharedParticles> particles) {
  // What the GPU has read goes back to its owner at once: there are few places.
  for (Held& held : held_)
    if (held.fence.passed()) held.particles.reset();
  last_ = (last_ + 1) % held_.size();
  held_[last_].fence.wait();
  held_[last_].particles = std::move(particles);
}

void GivenParticles::bind(const Frame& frame, std::size_t count, GLuint places, GLuint fluids) {
  hold(nullptr);
  const SharedParticles* on_gpu = frame.on_gpu.get();
  shared_ = on_gpu && on_gpu->count >= count && open(*on_gpu);
  if (shared_) {
    held_[last_].particles = frame.on_gpu;
    memory_->bind(places, on_gpu->positions, count * sizeof(glm::vec3));
    memory_->bind(fluids, on_gpu->fluids, count);
    return;
  }
  places_.upload(std::as_bytes(frame.particles.first(count)));
  fluids_.upload(std::as_bytes(frame.particle_fluid.first(count)));
  places_.bind(places);
  fluids_.bind(fluids);
}

void GivenParticles::done() {
  if (shared_)
    held_[last_].fence.set();
  else
    places_.done();  // which says the same of fluids_: both go round together
}

void GivenParticles::checked(bool right) {
  checked_ = true;
  if (right) return;
  memory_.reset();
  refused_ =
      "particles that lie on the GPU: OpenGL does not see there what CUDA wrote (they go through main "
      "memory)";
}

}  // namespace slosh
