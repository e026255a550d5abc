// Memory of the GPU that another of its driver's interfaces (CUDA) fills, as a buffer that shaders read.
#pragma once

#include <cstdint>

#include "render/gl/objects.h"
#include "sim/math/shared_particles.h"

namespace slosh::gl {

inline void delete_memory_object(GLuint name) {
  glDeleteMemoryObjectsEXT(1, &name);
}
using MemoryObject = Object<delete_memory_object>;

class SharedMemory {
 public:
  SharedMemory() = default;
  /// Opens the allocation; its descriptor stays the owner's. Errors, in words: this OpenGL cannot, it draws
  /// on another GPU, it refuses.
  static Result<SharedMemory> open(const SharedParticles& particles);

  bool is(std::uint64_t allocation) const { return buffer_ && allocation_ == allocation; }
  /// `bytes` of it from `at` (a multiple of 256) on; to a multiple of 4, which the allocation has room for.
  void bind(GLuint storage_binding, std::size_t at, std::size_t bytes) const;

 private:
  std::uint64_t allocation_ = 0;
  MemoryObject memory_;
  Buffer buffer_;
};

}  // namespace slosh::gl
