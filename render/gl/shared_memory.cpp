#include "render/gl/shared_memory.h"

#include <unistd.h>

#include <algorithm>
#include <array>

namespace slosh::gl {
namespace {

Error refused(const char* why) {
  return {"particles that lie on the GPU", why, "Nothing needs to be done: they go through main memory"};
}

/// One of the GPUs that this context draws on.
bool draws_on(const std::array<std::uint8_t, 16>& device) {
  GLint count = 0;
  glGetIntegerv(GL_NUM_DEVICE_UUIDS_EXT, &count);
  for (GLint i = 0; i < count; ++i) {
    std::array<GLubyte, 16> own{};
    glGetUnsignedBytei_vEXT(GL_DEVICE_UUID_EXT, static_cast<GLuint>(i), own.data());
    if (std::ranges::equal(own, device)) return true;
  }
  return false;
}

bool failed() {
  bool any = false;
  while (glGetError() != GL_NO_ERROR) any = true;
  return any;
}

}  // namespace

Result<SharedMemory> SharedMemory::open(const SharedParticles& particles) {
  if (!epoxy_has_gl_extension("GL_EXT_memory_object") || !epoxy_has_gl_extension("GL_EXT_memory_object_fd"))
    return refused("this OpenGL opens no other interface's memory (GL_EXT_memory_object_fd)");
  failed();
  if (!draws_on(particles.device)) return refused("the picture is drawn on another GPU");
  // What is opened belongs to OpenGL, which closes it.
  const int own = dup(particles.descriptor);
  if (own < 0) return refused("its descriptor is closed");
  SharedMemory out;
  out.allocation_ = particles.allocation;
  GLuint name = 0;
  glCreateMemoryObjectsEXT(1, &name);
  out.memory_ = MemoryObject(name);
  glImportMemoryFdEXT(name, particles.bytes, GL_HANDLE_TYPE_OPAQUE_FD_EXT, own);
  if (failed()) {
    close(own);
    return refused("OpenGL does not take it");
  }
  out.buffer_ = make_buffer();
  glNamedBufferStorageMemEXT(out.buffer_.name(), static_cast<GLsizeiptr>(particles.bytes), name, 0);
  if (failed()) return refused("OpenGL makes no buffer of it");
  return out;
}

void SharedMemory::bind(GLuint storage_binding, std::size_t at, std::size_t bytes) const {
  glBindBufferRange(GL_SHADER_STORAGE_BUFFER, storage_binding, buffer_.name(), static_cast<GLintptr>(at),
                    static_cast<GLsizeiptr>((bytes + 3) / 4 * 4));
}

}  // namespace slosh::gl
