// An OpenGL ES 3.0 context for tests, and the few calls that draw there.
#pragma once

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/context.h"
#include "render/gl/es_programs.h"
#include "render/gl/es_source.h"

namespace slosh::es {

/// An ES 3.0 context, current while it lives; `before`, which was current, is so again after.
class EsContext {
 public:
  /// Why there is none; nothing if there is.
  static std::optional<std::string> make(std::unique_ptr<EsContext>& out, Context& before);
  ~EsContext();

 private:
  EsContext(EGLDisplay display, EGLContext context, Context& before);
  EGLDisplay display_;
  EGLContext context_;
  Context& before_;
};

/// A shader; what the driver says against it is appended to `log`.
GLuint compiled(GLenum kind, const std::string& text, std::string& log);

/// A linked program, in use, with its textures and blocks bound; 0 with why in `log`.
GLuint es_program(const EsProgram& wish, std::string& log);

/// A texture of one level with clamped edges.
GLuint make_texture(glm::ivec2 size, GLenum format, GLenum filter = GL_NEAREST);
void bind_texture(int unit, GLuint texture, GLenum kind = GL_TEXTURE_2D);
/// vec4s as EsBuffer has them.
GLuint texture_of_items(const std::vector<glm::vec4>& texels);
/// A framebuffer of colour textures in order; 0: this context does not draw into such.
GLuint make_target(const std::vector<GLuint>& colors, GLuint depth = 0);

/// A uniform block's contents.
template <class Block>
void block_at(GLuint binding, const Block& block) {
  GLuint name = 0;
  glGenBuffers(1, &name);
  glBindBuffer(GL_UNIFORM_BUFFER, name);
  glBufferData(GL_UNIFORM_BUFFER, sizeof block, &block, GL_STATIC_DRAW);
  glBindBufferBase(GL_UNIFORM_BUFFER, binding, name);
}

}  // namespace slosh::es
