// A frame's particles where compute shaders read them: in memory of the GPU that somebody else filled, where
// that works, else in the frame's own, which the GPU reads across the bus.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "render/frame.h"
#include "render/gl/shared_memory.h"
#include "render/gl/upload_ring.h"

namespace slosh {

class GivenParticles {
 public:
  /// Binds the first `count` places and fluids of the frame (shaders/particles.comp). done() after they are
  /// read.
  void bind(const Frame& frame, std::size_t count, GLuint places, GLuint fluids);
  void done();

  /// The last bind() was of memory that the frame shares.
  bool shared() const { return shared_; }
  /// Why memory that was offered is not read, in words; empty where it is, or none was.
  const std::string& refused() const { return refused_; }

  /// Once an allocation, after bind(): whether what a shader made of it is to be looked at, and what came of
  /// that.
  bool to_be_checked() const { return shared_ && !checked_; }
  void checked(bool right);

 private:
  bool open(const SharedParticles& particles);
  void hold(std::shared_ptr<const SharedParticles> particles);

  gl::UploadRing places_;
  gl::UploadRing fluids_;
  std::optional<gl::SharedMemory> memory_;
  std::uint64_t tried_ = 0;  ///< the allocation that was opened last, or refused
  bool checked_ = false;
  bool shared_ = false;
  std::string refused_;
  /// What the GPU may still read of others' memory.
  struct Held {
    gl::Fence fence;
    std::shared_ptr<const SharedParticles> particles;
  };
  std::array<Held, 3> held_;
  std::size_t last_ = 0;
};

}  // namespace slosh
