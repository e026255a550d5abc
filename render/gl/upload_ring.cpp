#include "render/gl/upload_ring.h"

#include <algorithm>
#include <cstring>

namespace slosh::gl {
namespace {

/// Storage buffers may be asked to begin at a multiple of at most this.
constexpr std::size_t kAlignment = 256;

}  // namespace

void Fence::set() {
  if (sync_) glDeleteSync(sync_);
  sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
}

void Fence::wait() {
  if (!sync_) return;
  constexpr GLuint64 kSecond = 1'000'000'000;
  while (glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, kSecond) == GL_TIMEOUT_EXPIRED) {
  }
  glDeleteSync(std::exchange(sync_, nullptr));
}

bool Fence::passed() {
  if (!sync_) return true;
  const GLenum now = glClientWaitSync(sync_, 0, 0);
  if (now != GL_ALREADY_SIGNALED && now != GL_CONDITION_SATISFIED) return false;
  glDeleteSync(std::exchange(sync_, nullptr));
  return true;
}

void UploadRing::upload(std::span<const std::byte> bytes) {
  used_ = std::max<std::size_t>(bytes.size(), 4);
  if (used_ > slot_bytes_) {
    for (Fence& fence : fences_) fence.wait();
    slot_bytes_ = (used_ + used_ / 2 + kAlignment - 1) / kAlignment * kAlignment;
    buffer_ = make_buffer();
    constexpr GLbitfield kHow = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    const auto size = static_cast<GLsizeiptr>(kSlots * slot_bytes_);
    glNamedBufferStorage(buffer_.name(), size, nullptr, kHow | GL_CLIENT_STORAGE_BIT);
    mapped_ = static_cast<std::byte*>(glMapNamedBufferRange(buffer_.name(), 0, size, kHow));
  }
  slot_ = (slot_ + 1) % kSlots;
  fences_[slot_].wait();
  if (mapped_ && !bytes.empty()) std::memcpy(mapped_ + slot_ * slot_bytes_, bytes.data(), bytes.size());
}

void UploadRing::bind(GLuint storage_binding) const {
  const std::size_t whole = (used_ + 3) / 4 * 4;
  glBindBufferRange(GL_SHADER_STORAGE_BUFFER, storage_binding, buffer_.name(),
                    static_cast<GLintptr>(slot_ * slot_bytes_), static_cast<GLsizeiptr>(whole));
}

}  // namespace slosh::gl
