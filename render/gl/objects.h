// Owners of GL objects, and the few calls every pass needs. Only render/ includes this.
#pragma once

#include <epoxy/gl.h>

#include <glm/glm.hpp>
#include <initializer_list>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sim/math/result.h"

namespace slosh::gl {

/// Puts what was made into `into`, or gives on why it was not. All of a list may be made before the first is
/// looked at.
template <class T>
Result<bool> take(T& into, Result<T> made) {
  if (!made) return made.error();
  into = std::move(made.value());
  return true;
}

/// Owns one GL name; `Delete` frees it on the context that is current then.
template <void (*Delete)(GLuint)>
class Object {
 public:
  Object() = default;
  explicit Object(GLuint name) : name_(name) {}
  Object(Object&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Object& operator=(Object&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~Object() {
    if (name_ != 0) Delete(name_);
  }
  GLuint name() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  GLuint name_ = 0;
};

inline void delete_texture(GLuint name) {
  glDeleteTextures(1, &name);
}
inline void delete_buffer(GLuint name) {
  glDeleteBuffers(1, &name);
}
inline void delete_framebuffer(GLuint name) {
  glDeleteFramebuffers(1, &name);
}
inline void delete_vertex_array(GLuint name) {
  glDeleteVertexArrays(1, &name);
}
inline void delete_program(GLuint name) {
  glDeleteProgram(name);
}

using Texture = Object<delete_texture>;
using Buffer = Object<delete_buffer>;
using Framebuffer = Object<delete_framebuffer>;
using VertexArray = Object<delete_vertex_array>;

/// A 2-D texture of one level with clamped edges. `filter` is GL_NEAREST or GL_LINEAR.
Texture make_texture(glm::ivec2 size, GLenum internal_format, GLenum filter);
Buffer make_buffer();
VertexArray make_vertex_array();

/// A framebuffer of colour attachments in order, and a depth attachment if not null.
Framebuffer make_framebuffer(std::initializer_list<const Texture*> colors, const Texture* depth = nullptr);

/// A linked program, of a vertex and a fragment shader or of a compute shader, and its uniforms by name.
class Program : public Object<delete_program> {
 public:
  Program() = default;

  /// From files of render/shaders. Errors carry the driver's log.
  static Result<Program> create(const char* vertex, const char* fragment,
                                std::vector<std::string> defines = {});
  /// The same with `prelude` put before the fragment file's own text (generated GLSL).
  static Result<Program> create_with(const char* vertex, const char* fragment,
                                     std::vector<std::string> defines, const std::string& prelude);

  /// A compute shader; `prelude` as above.
  static Result<Program> create_compute(const char* file, std::vector<std::string> defines = {},
                                        const std::string& prelude = {});

  void use() const { glUseProgram(name()); }
  /// Uniforms that the compiler dropped are ignored.
  void set(const char* uniform, int value) const;
  void set(const char* uniform, float value) const;
  void set(const char* uniform, const glm::vec2& value) const;
  void set(const char* uniform, const glm::ivec2& value) const;
  void set(const char* uniform, const glm::ivec3& value) const;
  void set(const char* uniform, const glm::vec3& value) const;
  void set(const char* uniform, const glm::vec4& value) const;
  void set(const char* uniform, const glm::mat4& value) const;

 private:
  explicit Program(GLuint name) : Object(name) {}
};

/// Binds textures to units 0, 1, … in order.
void bind_textures(std::initializer_list<const Texture*> textures);

/// A buffer whose contents are written anew each frame; grows as needed.
class StreamBuffer {
 public:
  /// Replaces the contents. An empty span leaves the buffer as it is.
  void upload(std::span<const std::byte> bytes);
  template <class T>
  void upload(std::span<const T> items) {
    upload(std::as_bytes(items));
  }
  /// Makes it so many bytes of anything.
  void reserve(std::size_t bytes);
  /// Makes it so many bytes of zeros, by the GPU.
  void zero(std::size_t bytes);
  GLuint name() const { return buffer_.name(); }

 private:
  Buffer buffer_;
  std::size_t capacity_ = 0;
};

}  // namespace slosh::gl
