#include "render/passes/display_pass.h"

#include "render/color/display_transform.h"
#include "render/passes/edges_on_cpu.h"

namespace slosh {

Result<DisplayPass> DisplayPass::create(Display display, const ColorConfig& color, bool compute) {
  auto table = make_display_table(display, color);
  if (!table) return table.error();
  auto program = gl::PixelProgram::create("display.frag", compute);
  if (!program) return program.error();
  auto edges = gl::PixelProgram::create("edges.frag", compute);
  if (!edges) return edges.error();

  DisplayPass pass;
  pass.display_ = display;
  pass.color_ = color;
  pass.program_ = std::move(program.value());
  pass.edges_ = std::move(edges.value());
  const int n = kDisplayTableSize;
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_3D, 1, &name);
  pass.table_ = gl::Texture(name);
  glTextureStorage3D(name, 1, GL_RGBA8, n, n, n);
  glTextureSubImage3D(name, 0, 0, 0, 0, n, n, n, GL_RGB, GL_FLOAT, table.value().data());
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R}) {
    glTextureParameteri(name, wrap, GL_CLAMP_TO_EDGE);
  }
  pass.program_.program().set("table_scale", glm::vec2((n - 1.0f) / n, 0.5f / n));
  return pass;
}

void DisplayPass::draw(const Targets& targets, float exposure, bool dither, bool edges_follow) {
  gl::bind_textures({&targets.color, &table_});
  program_.program().set("exposure", exposure);
  program_.program().set("dither", dither ? 1.0f / 255.0f : 0.0f);
  const gl::Texture& into = edges_follow ? targets.sharp : targets.display;
  program_.run({into, edges_follow ? targets.sharp_target : targets.display_target, targets.size, GL_RGBA8});
}

void DisplayPass::smooth_edges(const Targets& targets, bool on_cpu, const std::optional<PixelBox>& part) {
  if (on_cpu) {
    const glm::ivec2 size = targets.size;
    const std::size_t bytes =
        std::size_t{4} * static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
    PixelBox box{glm::ivec2(0), size};
    if (part && sharp_.size() == bytes) box = *part;
    sharp_.resize(bytes);
    if (!box.empty()) {
      const std::size_t first = 4 * (static_cast<std::size_t>(box.low.y) * size.x + box.low.x);
      glPixelStorei(GL_PACK_ROW_LENGTH, size.x);
      glGetTextureSubImage(targets.sharp.name(), 0, box.low.x, box.low.y, 0, box.size().x, box.size().y, 1,
                           GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(bytes - first),
                           sharp_.data() + first);
      glPixelStorei(GL_PACK_ROW_LENGTH, 0);
      slosh::smooth_edges(sharp_, size, box, brightness_, smooth_);
    }
    glTextureSubImage2D(targets.display.name(), 0, 0, 0, size.x, size.y, GL_RGBA, GL_UNSIGNED_BYTE,
                        smooth_.data());
    glBindFramebuffer(GL_FRAMEBUFFER, targets.display_target.name());
    return;
  }
  gl::bind_textures({&targets.sharp});
  edges_.run({targets.display, targets.display_target, targets.size, GL_RGBA8});
}

}  // namespace slosh
