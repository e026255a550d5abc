#include "render/passes/mixing_pass.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "render/passes/frame_block.h"

namespace slosh {
namespace {

/// How far a particle counts, particle radii: some two particles to each side of a boundary.
constexpr float kMixingReach = 3.6f;
/// First texture unit of fluid_look.frag's shares.
constexpr GLuint kSharesUnit = 12;

}  // namespace

int mixing_layers(const Frame& frame, const Splats& splats) {
  if (frame.fluids.size() < 2 || splats.empty()) return 0;
  const auto [least, most] = std::ranges::minmax(splats.spheres, {}, &glm::vec4::w);
  return std::floor(least.w) == std::floor(most.w) ? 0 : 1 + static_cast<int>(most.w) / 4;
}

int mixing_layers(const Frame& frame) {
  const auto fluids = static_cast<std::uint8_t>(std::min(frame.fluids.size(), kMaxFluidLooks));
  if (fluids < 2) return 0;
  std::uint8_t least = 255;
  std::uint8_t most = 0;
  for (const std::uint8_t fluid : frame.particle_fluid) {
    const bool drawn = fluid < fluids;
    least = std::min<std::uint8_t>(least, drawn ? fluid : 255);
    most = std::max<std::uint8_t>(most, drawn ? fluid : 0);
  }
  return least >= most ? 0 : 1 + most / 4;
}

Result<MixingPass> MixingPass::create(bool compute) {
  MixingPass pass;
  pass.compute_ = compute;
  if (compute) {
    for (const Result<bool>& loaded :
         {gl::take(pass.rows_, gl::RowProgram::create("mixing.comp", false)),
          gl::take(pass.sum_, gl::PixelProgram::create("mixing_sum.frag", true))}) {
      if (!loaded) return loaded.error();
    }
  } else if (auto made = gl::take(pass.program_, gl::Program::create("mixing.vert", "mixing.frag")); !made) {
    return made.error();
  }
  pass.no_vertices_ = gl::make_vertex_array();
  return pass;
}

void MixingPass::make_shares(glm::ivec2 size, int layers) {
  if (size != size_) {
    shares_.clear();
    share_targets_.clear();
    size_ = size;
  }
  while (shares_.size() < static_cast<std::size_t>(layers)) {
    shares_.push_back(gl::make_texture(size, GL_RGBA16F, GL_NEAREST));
    share_targets_.push_back(gl::make_framebuffer({&shares_.back()}));
  }
}

void MixingPass::draw(const Frame& frame, const Targets& targets, const gl::Texture& smoothed,
                      const gl::StreamBuffer& spheres, std::size_t count, int layers) {
  const glm::ivec2 size = targets.chord_size;
  make_shares(size, layers);
  const gl::Program& program = compute_ ? rows_.of(count) : program_;
  program.set("pixels", size == targets.half_size ? 2 : 4);
  program.set("radius", kMixingReach * frame.particle_radius);
  gl::bind_textures({&smoothed});
  for (std::size_t i = 0; i < static_cast<std::size_t>(layers); ++i) {
    program.set("first", 4 * static_cast<int>(i));
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, spheres.name());
    if (compute_) {
      sums_.zero(4 * sizeof(std::uint32_t) * static_cast<std::size_t>(size.x) *
                 static_cast<std::size_t>(size.y));
      program.set("size", size);
      sum_.program().set("size", size);
      glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, sums_.name());
      rows_.start(count);
      gl::finish_compute();
      sum_.start({shares_[i], share_targets_[i], size, GL_RGBA16F});
      gl::finish_compute();
      continue;
    }
    const glm::vec4 none(0.0f);
    glClearNamedFramebufferfv(share_targets_[i].name(), GL_COLOR, 0, &none.x);
    glBindFramebuffer(GL_FRAMEBUFFER, share_targets_[i].name());
    glViewport(0, 0, size.x, size.y);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    program_.use();
    glBindVertexArray(no_vertices_.name());
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * count));
    glBlendFunc(GL_ONE, GL_ZERO);
    glDisable(GL_BLEND);
  }
}

void MixingPass::bind() const {
  for (std::size_t i = 0; i < shares_.size(); ++i)
    glBindTextureUnit(kSharesUnit + static_cast<GLuint>(i), shares_[i].name());
}

}  // namespace slosh
