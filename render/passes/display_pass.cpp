#include "render/passes/display_pass.h"

#include "render/color/display_transform.h"
#include "render/passes/edges_on_cpu.h"

namespace slosh {

namespace {

/// Of OpenColorIO's text: a pixel of the table takes as long (llvmpipe: 1048 characters 2.9 ms, 12 283 12.4
/// ms, the table 4.3 ms).
constexpr std::size_t kMaxText = 2500;  // characters

/// The program with OpenColorIO's own text; none where the table is the smaller one, or a driver refuses the
/// text.
std::optional<gl::PixelProgram> by_its_text(const DisplayPass::Wish& wish) {
  if (wish.by == DisplayBy::kTable) return std::nullopt;
  const auto text = display_shader(wish.display, wish.color);
  if (!text || !text.value()) return std::nullopt;
  if (wish.by == DisplayBy::kSmaller && text.value()->size() > kMaxText) return std::nullopt;
  auto program =
      gl::PixelProgram::create("display.frag", wish.compute, false, {"BY_TEXT", "EACH 4"}, *text.value());
  if (!program) return std::nullopt;
  return std::move(program.value());
}

}  // namespace

Result<DisplayPass> DisplayPass::create(const Wish& wish) {
  DisplayPass pass;
  pass.wish_ = wish;
  if (wish.compute) {
    auto edges = gl::PixelProgram::create("edges.frag", true);
    if (!edges) return edges.error();
    pass.edges_ = std::move(edges.value());
  }
  if (auto program = by_its_text(wish)) {
    // What a configuration lacks is told in either way.
    const glm::vec3 one(0.18f);
    if (const auto shown = display_colors(wish.display, {&one, 1}, wish.color); !shown) return shown.error();
    pass.program_ = std::move(*program);
    return pass;
  }
  auto table = make_display_table(wish.display, wish.color);
  if (!table) return table.error();
  auto program = gl::PixelProgram::create("display.frag", wish.compute, false, {"EACH 4"});
  if (!program) return program.error();
  pass.program_ = std::move(program.value());
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

void DisplayPass::start(const Targets& targets, float exposure, bool dither, bool edges_follow) {
  gl::bind_textures({&targets.color});
  if (!by_text()) glBindTextureUnit(1, table_.name());
  program_.program().set("exposure", exposure);
  program_.program().set("dither", dither ? 1.0f / 255.0f : 0.0f);
  const gl::Texture& into = edges_follow ? targets.sharp : targets.display;
  program_.start(
      {into, edges_follow ? targets.sharp_target : targets.display_target, targets.size, GL_RGBA8});
}

void DisplayPass::smooth_edges(const Targets& targets, const std::optional<PixelBox>& part) {
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
}

void DisplayPass::start_edges(const Targets& targets) {
  gl::bind_textures({&targets.sharp});
  edges_.start({targets.display, targets.display_target, targets.size, GL_RGBA8});
}

}  // namespace slosh
