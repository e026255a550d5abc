#include "render/passes/surface_filter.h"

#include <utility>

namespace slosh {
namespace {

/// Draws `program` from where the surface is into the other smooth texture; returns which that is.
int turn(const gl::Program& program, int from, const Targets& targets, const TileDraw& tiles) {
  const int into = from == 0 ? 1 : 0;
  const gl::Texture& source = from < 0 ? targets.front : targets.smooth[static_cast<std::size_t>(from)];
  gl::bind_textures({&source});
  glBindFramebuffer(GL_FRAMEBUFFER, targets.smooth_target[static_cast<std::size_t>(into)].name());
  glViewport(0, 0, targets.size.x, targets.size.y);
  program.use();
  tiles();
  return into;
}

/// Section 5.1 and Fig 5.
class PaperFilter : public SurfaceFilter {
 public:
  static Result<std::unique_ptr<SurfaceFilter>> create() {
    auto program = gl::Program::create("tiles.vert", "smooth.frag");
    if (!program) return program.error();
    auto filter = std::make_unique<PaperFilter>();
    filter->program_ = std::move(program.value());
    return std::unique_ptr<SurfaceFilter>(std::move(filter));
  }
  int run(const Targets& targets, const RenderOptions& options, const Frame&,
          const TileDraw& tiles) override {
    int at = -1;
    for (int i = 0; i < options.bilateral_iterations; ++i) at = turn(program_, at, targets, tiles);
    return at;
  }

 private:
  gl::Program program_;
};

/// van der Laan, Green & Sainz 2009.
class CurvatureFlow : public SurfaceFilter {
 public:
  static Result<std::unique_ptr<SurfaceFilter>> create() {
    auto program = gl::Program::create("tiles.vert", "curvature_flow.frag");
    if (!program) return program.error();
    auto filter = std::make_unique<CurvatureFlow>();
    filter->program_ = std::move(program.value());
    return std::unique_ptr<SurfaceFilter>(std::move(filter));
  }
  int run(const Targets& targets, const RenderOptions&, const Frame&, const TileDraw& tiles) override {
    program_.set("time_step", kTimeStep);
    int at = -1;
    for (int i = 0; i < kSteps; ++i) at = turn(program_, at, targets, tiles);
    return at;
  }

 private:
  static constexpr int kSteps = 60;         // as timed there
  static constexpr float kTimeStep = 0.8f;  // of the longest stable one
  gl::Program program_;
};

/// Truong & Yuksel 2018: along both axes, then 5 × 5 pixels.
class NarrowRange : public SurfaceFilter {
 public:
  static Result<std::unique_ptr<SurfaceFilter>> create(bool fast) {
    auto along = gl::Program::create("tiles.vert", "narrow_range.frag");
    if (!along) return along.error();
    auto clean = gl::Program::create("tiles.vert", "narrow_range.frag", {"CLEAN"});
    if (!clean) return clean.error();
    auto filter = std::make_unique<NarrowRange>();
    filter->along_ = std::move(along.value());
    filter->clean_ = std::move(clean.value());
    filter->most_taps_ = fast ? 6.0f : 40.0f;
    return std::unique_ptr<SurfaceFilter>(std::move(filter));
  }
  int run(const Targets& targets, const RenderOptions& options, const Frame& frame,
          const TileDraw& tiles) override {
    const float radius = options.splat_scale * frame.particle_radius;
    const glm::vec3 kernel(kReach * radius, kRange * radius, most_taps_);
    along_.set("kernel", kernel);
    clean_.set("kernel", kernel);
    along_.set("axis", glm::ivec2(1, 0));
    int at = turn(along_, -1, targets, tiles);
    along_.set("axis", glm::ivec2(0, 1));
    at = turn(along_, at, targets, tiles);
    return turn(clean_, at, targets, tiles);
  }

 private:
  // In splat radii; the best of those tried on analytic pools (render/score).
  static constexpr float kReach = 3.2f;
  static constexpr float kRange = 5.0f;
  gl::Program along_;
  gl::Program clean_;
  float most_taps_ = 0.0f;
};

}  // namespace

void TileDraw::operator()() const {
  glBindVertexArray(vertices->name());
  glDrawArrays(GL_TRIANGLES, 0, corners);
}

Result<std::unique_ptr<SurfaceFilter>> make_surface_filter(Surface surface, bool fast) {
  switch (surface) {
    case Surface::kPaper:
      return PaperFilter::create();
    case Surface::kCurvatureFlow:
      return CurvatureFlow::create();
    case Surface::kOurs:
      break;
  }
  return NarrowRange::create(fast);
}

}  // namespace slosh
