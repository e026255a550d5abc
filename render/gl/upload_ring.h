// Memory that the program writes and the GPU reads where it lies: nothing is copied by the driver, and nobody
// waits, as three uploads may be on their way at once.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>

#include "render/gl/objects.h"

namespace slosh::gl {

/// Owns a fence.
class Fence {
 public:
  Fence() = default;
  Fence(Fence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}
  Fence& operator=(Fence&& other) noexcept {
    std::swap(sync_, other.sync_);
    return *this;
  }
  ~Fence() {
    if (sync_) glDeleteSync(sync_);
  }
  /// After the commands issued so far.
  void set();
  /// Until they are done; at once where none is set.
  void wait();
  /// Whether they are; true where none is set.
  bool passed();

 private:
  GLsync sync_ = nullptr;
};

class UploadRing {
 public:
  /// Puts `bytes` where bind() shows them. Once a picture at most, and done() after those who read them were
  /// started.
  void upload(std::span<const std::byte> bytes);
  void bind(GLuint storage_binding) const;
  void done() { fences_[slot_].set(); }

 private:
  static constexpr std::size_t kSlots = 3;
  Buffer buffer_;
  std::byte* mapped_ = nullptr;
  std::size_t slot_bytes_ = 0;
  std::size_t slot_ = 0;
  std::size_t used_ = 0;  ///< bytes of the slot
  std::array<Fence, kSlots> fences_;
};

}  // namespace slosh::gl
