#include "render/passes/caustics_pass.h"

#include <utility>

namespace slosh {
namespace {

/// Texture unit of shaders/caustic_light.glsl.
constexpr GLuint kCausticsUnit = 6;

}  // namespace

Result<CausticsPass> CausticsPass::create() {
  auto program = gl::Program::create("caustics.vert", "caustics.frag");
  if (!program) return program.error();
  CausticsPass pass;
  pass.program_ = std::move(program.value());
  pass.no_vertices_ = gl::make_vertex_array();
  return pass;
}

void CausticsPass::draw(const Frame& frame, const Targets& targets, const gl::Texture& smoothed) {
  if (size_ != targets.half_size) {
    size_ = targets.half_size;
    sums_ = gl::make_texture(size_, GL_RG32F, GL_LINEAR);
    target_ = gl::make_framebuffer({&sums_});
  }
  const glm::vec4 none(0.0f);
  glClearNamedFramebufferfv(target_.name(), GL_COLOR, 0, &none.x);
  gl::bind_textures({&smoothed, &targets.scene_depth});
  program_.set("size", size_);
  program_.set("refraction", frame.fluids.empty() ? 1.33f : frame.fluids.front().refraction);
  glBindFramebuffer(GL_FRAMEBUFFER, target_.name());
  glViewport(0, 0, size_.x, size_.y);
  glEnable(GL_PROGRAM_POINT_SIZE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  program_.use();
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_POINTS, 0, 2 * size_.x * size_.y);
  glBlendFunc(GL_ONE, GL_ZERO);
  glDisable(GL_BLEND);
  glDisable(GL_PROGRAM_POINT_SIZE);
  glBindTextureUnit(kCausticsUnit, sums_.name());
}

}  // namespace slosh
