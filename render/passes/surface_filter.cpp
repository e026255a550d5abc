#include "render/passes/surface_filter.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "render/passes/narrow_range_on_cpu.h"

namespace slosh {
namespace {

/// Turn `i` of a filter.
void start(const gl::PixelProgram& program, int i, const Targets& targets, const gl::TileDraw& tiles) {
  const auto into = static_cast<std::size_t>(i % 2);
  gl::bind_textures({i == 0 ? &targets.front : &targets.smooth[1 - into]});
  program.start({targets.smooth[into], targets.smooth_target[into], targets.size, GL_R32F}, &tiles);
}

/// Section 5.1 and Fig 5.
class PaperFilter : public SurfaceFilter {
 public:
  explicit PaperFilter(gl::PixelProgram program) : program_(std::move(program)) {}
  int turns(const RenderOptions& options) const override { return options.bilateral_iterations; }
  void start_turn(int i, const Targets& targets, const RenderOptions&, const Frame&,
                  const gl::TileDraw& tiles) override {
    start(program_, i, targets, tiles);
  }

 private:
  gl::PixelProgram program_;
};

/// van der Laan, Green & Sainz 2009.
class CurvatureFlow : public SurfaceFilter {
 public:
  explicit CurvatureFlow(gl::PixelProgram program) : program_(std::move(program)) {}
  int turns(const RenderOptions&) const override { return kSteps; }
  void start_turn(int i, const Targets& targets, const RenderOptions&, const Frame&,
                  const gl::TileDraw& tiles) override {
    program_.program().set("time_step", kTimeStep);
    start(program_, i, targets, tiles);
  }

 private:
  static constexpr int kSteps = 60;         // as timed there
  static constexpr float kTimeStep = 0.8f;  // of the longest stable one
  gl::PixelProgram program_;
};

// Of Truong & Yuksel's, in splat radii; the best of those tried on analytic pools (tests/lab/picture/score).
constexpr float kReach = 3.8f;
constexpr float kRange = 5.0f;
constexpr int kTaps = 20;  // to a side

/// Truong & Yuksel 2018: along both axes, then 5 × 5 pixels. For compute.
class NarrowRange : public SurfaceFilter {
 public:
  /// One program a turn.
  explicit NarrowRange(std::array<gl::PixelProgram, 3> programs) : programs_(std::move(programs)) {}
  int turns(const RenderOptions&) const override { return 3; }
  void start_turn(int i, const Targets& targets, const RenderOptions& options, const Frame& frame,
                  const gl::TileDraw& tiles) override {
    const gl::PixelProgram& program = programs_[static_cast<std::size_t>(i)];
    const float radius = options.splat_scale * frame.particle_radius;
    program.program().set("kernel", glm::vec3(kReach * radius, kRange * radius, float{kTaps}));
    if (i < 2) program.program().set("axis", glm::ivec2(1 - i, i));
    if (i == 0) glBindTextureUnit(1, targets.scene_depth.name());
    start(program, i, targets, tiles);
  }

 private:
  std::array<gl::PixelProgram, 3> programs_;
};

/// The same in main memory.
class NarrowRangeBesideGl : public SurfaceFilter {
 public:
  explicit NarrowRangeBesideGl(bool fast)
      : taps_(fast ? kFewTaps : kTaps), beside_(fast ? 2 * kFewTaps : kTaps) {}
  void fetch(const Targets& targets) override {
    for (const auto& [values, from] :
         {std::pair{&front_, &targets.front}, std::pair{&bodies_, &targets.scene_depth}}) {
      values->resize(static_cast<std::size_t>(targets.size.x) * static_cast<std::size_t>(targets.size.y));
      glGetTextureImage(from->name(), 0, GL_RED, GL_FLOAT,
                        static_cast<GLsizei>(values->size() * sizeof(float)), values->data());
    }
  }
  int run(const Targets& targets, const RenderOptions& options, const Frame& frame,
          const gl::TileDraw&) override {
    const float radius = options.splat_scale * frame.particle_radius;
    const float pixels = 0.5f * frame.view.projection[1][1] * static_cast<float>(targets.size.y);
    const std::span<const float> surface = filter_.run(
        front_, bodies_, targets.size, {kReach * radius, kRange * radius, taps_, beside_, pixels, radius});
    glTextureSubImage2D(targets.smooth[0].name(), 0, 0, 0, targets.size.x, targets.size.y, GL_RED, GL_FLOAT,
                        surface.data());
    return 0;
  }
  bool writes_tiles() const override { return false; }

 private:
  static constexpr int kFewTaps = 6;
  int taps_;
  int beside_;  ///< what bodies hide
  NarrowRangeOnCpu filter_;
  std::vector<float> front_;
  std::vector<float> bodies_;
};

}  // namespace

void SurfaceFilter::start_turn(int, const Targets&, const RenderOptions&, const Frame&, const gl::TileDraw&) {
}

int SurfaceFilter::run(const Targets& targets, const RenderOptions& options, const Frame& frame,
                       const gl::TileDraw& tiles) {
  const int count = turns(options);
  for (int i = 0; i < count; ++i) start_turn(i, targets, options, frame, tiles);
  return count == 0 ? -1 : (count - 1) % 2;
}

Result<std::unique_ptr<SurfaceFilter>> make_surface_filter(Surface surface, bool fast, bool compute) {
  using Made = Result<std::unique_ptr<SurfaceFilter>>;
  if (surface == Surface::kOurs && !compute) return Made(std::make_unique<NarrowRangeBesideGl>(fast));
  if (surface == Surface::kOurs) {
    std::array<gl::PixelProgram, 3> turns;
    const std::vector<std::string> defines[] = {{"FIRST"}, {}, {"CLEAN"}};
    for (std::size_t i = 0; i < turns.size(); ++i) {
      auto turn = gl::PixelProgram::create("narrow_range.frag", true, false, defines[i]);
      if (!turn) return turn.error();
      turns[i] = std::move(turn.value());
    }
    return Made(std::make_unique<NarrowRange>(std::move(turns)));
  }
  const char* file = surface == Surface::kPaper ? "smooth.frag" : "curvature_flow.frag";
  auto program = gl::PixelProgram::create(file, compute, true);
  if (!program) return program.error();
  if (surface == Surface::kPaper) return Made(std::make_unique<PaperFilter>(std::move(program.value())));
  return Made(std::make_unique<CurvatureFlow>(std::move(program.value())));
}

}  // namespace slosh
