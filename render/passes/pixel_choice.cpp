#include "render/passes/pixel_choice.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "render/gl/pixel_program.h"
#include "render/passes/frame_block.h"
#include "render/passes/pass_timer.h"

namespace slosh {
namespace {

constexpr float kMargin = 1.3f;  // by which compute shaders must be quicker
constexpr int kTries = 4;        // the first of which compiles
constexpr float kRadius = 0.005f;

/// A view straight ahead, one metre from what it sees.
FrameBlock block_for(glm::ivec2 size) {
  Frame frame;
  frame.particle_radius = kRadius;
  frame.view.projection = glm::mat4(0.0f);
  frame.view.projection[0][0] = frame.view.projection[1][1] = 2.0f;
  frame.view.projection[2][2] = frame.view.projection[2][3] = -1.0f;
  frame.view.projection[3][2] = -0.04f;
  RenderOptions options;
  options.width = size.x;
  options.height = size.y;
  return make_frame_block(frame, options, {}, false);
}

/// The fastest of kTries, ms; < 0: the driver refuses it.
double fastest(bool compute, const Context& context, int side) {
  const glm::ivec2 size(side);
  auto made = gl::PixelProgram::create("narrow_range.frag", compute);
  if (!made) return -1.0;
  FrameUniforms uniforms;
  uniforms.upload(block_for(size));
  std::vector<float> depths(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  for (std::size_t i = 0; i < depths.size(); ++i)
    depths[i] = 1.0f + 0.5f * kRadius * std::sin(0.7f * static_cast<float>(i));
  const gl::Texture source = gl::make_texture(size, GL_R32F, GL_NEAREST);
  const gl::Texture into = gl::make_texture(size, GL_R32F, GL_NEAREST);
  const gl::Framebuffer target = gl::make_framebuffer({&into});
  glTextureSubImage2D(source.name(), 0, 0, 0, side, side, GL_RED, GL_FLOAT, depths.data());
  made.value().program().set("axis", glm::ivec2(1, 0));
  made.value().program().set("kernel", glm::vec3(4.0f * kRadius, 5.0f * kRadius, 40.0f));
  gl::bind_textures({&source});
  PassTimer timer(context.is_software());
  double least = 1e30;
  for (int i = 0; i < kTries; ++i) {
    timer.begin("try");
    made.value().run({into, target, size, GL_R32F});
    timer.end();
    least = std::min(least, timer.take().front().milliseconds);
  }
  return least;
}

}  // namespace

bool compute_is_quicker(const Context& context) {
  static std::mutex mutex;
  static std::map<std::string, bool> known;
  const std::lock_guard lock(mutex);
  if (const auto found = known.find(context.description()); found != known.end()) return found->second;
  const int side = context.is_software() ? 128 : 1024;
  const double fragments = fastest(false, context, side);
  const double compute = fastest(true, context, side);
  const bool quicker = compute >= 0.0 && fragments >= 0.0 && compute * kMargin < fragments;
  known.emplace(context.description(), quicker);
  return quicker;
}

}  // namespace slosh
