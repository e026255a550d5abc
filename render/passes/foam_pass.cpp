#include "render/passes/foam_pass.h"

#include <cmath>
#include <cstddef>

namespace slosh {

Result<FoamPass> FoamPass::create(const std::vector<std::string>& defines) {
  std::vector<std::string> all = defines;
  all.emplace_back("FAST");  // two shadow taps: a drop is a few pixels
  auto program = gl::Program::create("foam.vert", "foam.frag", all);
  if (!program) return program.error();
  FoamPass pass;
  pass.program_ = std::move(program.value());
  pass.array_ = gl::make_vertex_array();
  const GLuint array = pass.array_.name();
  for (GLuint attribute = 0; attribute < 2; ++attribute) {
    glEnableVertexArrayAttrib(array, attribute);
    glVertexArrayAttribBinding(array, attribute, 0);
  }
  glVertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, offsetof(FoamPoint, position));
  glVertexArrayAttribFormat(array, 1, 2, GL_FLOAT, GL_FALSE, offsetof(FoamPoint, radius));
  return pass;
}

void FoamPass::draw(const Frame& frame, const Targets& targets, const gl::Texture* fluid) {
  points_.clear();
  for (const FoamPoint& p : frame.foam) {
    if (std::isfinite(p.position.x + p.position.y + p.position.z + p.radius + p.opacity))
      points_.push_back(p);
  }
  if (points_.empty()) return;
  buffer_.upload(std::span<const FoamPoint>(points_));
  glVertexArrayVertexBuffer(array_.name(), 0, buffer_.name(), 0, sizeof(FoamPoint));
  program_.use();
  program_.set("has_fluid", fluid ? 1 : 0);
  gl::bind_textures({fluid ? fluid : &targets.scene_depth, &targets.scene_depth});
  glBindFramebuffer(GL_FRAMEBUFFER, targets.color_target.name());
  glViewport(0, 0, targets.size.x, targets.size.y);
  glEnable(GL_PROGRAM_POINT_SIZE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glBindVertexArray(array_.name());
  glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(points_.size()));
  glDisable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ZERO);
  glDisable(GL_PROGRAM_POINT_SIZE);
}

}  // namespace slosh
