// What `slosh report picture` draws by one way to make a surface: a scene's snapshots, and the shipped bucket
// with the time it takes.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "peer/view/frame_builder.h"
#include "peer/view/orbit_camera.h"
#include "render/renderer.h"
#include "tests/lab/report/trial.h"

namespace slosh {

/// Of its pictures, pixels.
inline constexpr int kReportWidth = 640;
inline constexpr int kReportHeight = 480;
inline constexpr double kBucketSpacing = 0.012;  ///< m, the scene's coarsest

/// As play has it, or all of section 5; nothing is kept from picture to picture.
RenderOptions report_options(Surface surface, int width, int height);

/// Scene-linear light as it is shown (Display::kAces). Errors: no display transform.
Result<Image> shown_image(const FloatImage& light);

/// Of nothing, for pictures to be put on.
Image empty_sheet(int width, int height);
/// `left` and `top` in pixels; it must fit.
void put(const Image& picture, int left, int top, Image& sheet);

/// A scene's snapshots, drawn by one way.
class Stand {
 public:
  /// `size` in pixels. Errors: as Renderer::create().
  static Result<std::unique_ptr<Stand>> create(Context& context, Surface surface, const Scene& scene,
                                               double spacing, bool keep_still = false,
                                               glm::ivec2 size = {kReportWidth, kReportHeight});
  const Image& draw(const Snapshot& snapshot);
  /// Of the filter, and of the whole frame, ms: medians over `frames` of what was drawn last.
  std::pair<double, double> times(int frames);
  Renderer& renderer() { return *renderer_; }
  const View& view() const { return frame_.view; }

 private:
  Stand(std::unique_ptr<Renderer> renderer, const Scene& scene, double spacing, double aspect);
  std::unique_ptr<Renderer> renderer_;
  FrameBuilder builder_;
  OrbitCamera camera_;
  double aspect_;
  Frame frame_;
  Image image_;
};

/// Of a picture of the shipped bucket with its read-back, ms: processor time, and by the clock.
struct PictureTime {
  double processor = 0.0;  ///< median
  double wall = 0.0;       ///< fastest: what else the machine does makes the others longer
};

/// Drawn whole, and with what stands still kept, by turns, over pictures 1/30 s apart.
struct BucketTimes {
  PictureTime whole;
  PictureTime kept;
};

/// Errors: the scene is not there, or cannot be drawn.
Result<BucketTimes> bucket_times(Context& context, report::Setting setting, int pictures);

}  // namespace slosh
