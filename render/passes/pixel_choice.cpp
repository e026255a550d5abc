#include "render/passes/pixel_choice.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "render/gl/pixel_program.h"
#include "render/passes/frame_block.h"
#include "render/passes/pass_timer.h"

namespace slosh {
namespace {

/// By which compute shaders must be quicker. On a processor meshes by tiles take many times as long as by
/// fragments: a pause at the wrong moment must not choose them.
constexpr float kMargin = 1.3f;
constexpr float kMarginOnCpu = 3.0f;
constexpr int kTries = 5;  // the first of which compiles
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

/// One of the filter's passes in one of the ways.
class Trial {
 public:
  Trial(bool compute, int side) : size_(side) {
    auto made = gl::PixelProgram::create("narrow_range.frag", compute);
    if (!made) return;
    program_ = std::move(made.value());
    std::vector<float> depths(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (std::size_t i = 0; i < depths.size(); ++i)
      depths[i] = 1.0f + 0.5f * kRadius * std::sin(0.7f * static_cast<float>(i));
    source_ = gl::make_texture(size_, GL_R32F, GL_NEAREST);
    into_ = gl::make_texture(size_, GL_R32F, GL_NEAREST);
    target_ = gl::make_framebuffer({&into_});
    glTextureSubImage2D(source_.name(), 0, 0, 0, side, side, GL_RED, GL_FLOAT, depths.data());
    program_.program().set("axis", glm::ivec2(1, 0));
    program_.program().set("kernel", glm::vec3(4.0f * kRadius, 5.0f * kRadius, 40.0f));
  }

  void run(PassTimer& timer) {
    if (!target_) return;
    gl::bind_textures({&source_});
    timer.begin("try");
    program_.run({into_, target_, size_, GL_R32F});
    timer.end();
    fastest_ = std::min(fastest_, timer.take().front().milliseconds);
  }
  /// ms; as good as never where the driver refuses it.
  double fastest() const { return fastest_; }

 private:
  glm::ivec2 size_;
  gl::PixelProgram program_;
  gl::Texture source_;
  gl::Texture into_;
  gl::Framebuffer target_;
  double fastest_ = 1e30;
};

}  // namespace

bool compute_is_quicker(const Context& context) {
  static std::mutex mutex;
  static std::map<std::string, bool> known;
  const std::lock_guard lock(mutex);
  if (const auto found = known.find(context.description()); found != known.end()) return found->second;
  const int side = context.is_software() ? 128 : 1024;
  FrameUniforms uniforms;
  uniforms.upload(block_for(glm::ivec2(side)));
  Trial fragments(false, side);
  Trial compute(true, side);
  PassTimer timer(context.is_software());
  for (int i = 0; i < kTries; ++i) {  // by turns, so that what else the machine does falls on both
    fragments.run(timer);
    compute.run(timer);
  }
  const float margin = context.is_software() ? kMarginOnCpu : kMargin;
  const bool quicker = compute.fastest() * margin < fragments.fastest();
  known.emplace(context.description(), quicker);
  return quicker;
}

}  // namespace slosh
