#include "tests/lab/verbs/report_picture_stand.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>

#include "render/color/display_transform.h"
#include "scenes/load.h"
#include "tests/lab/report/passes.h"

namespace slosh {

RenderOptions report_options(Surface surface, int width, int height) {
  RenderOptions options;
  if (surface == Surface::kPaper) options = section_five(options);
  options.surface = surface;
  options.width = width;
  options.height = height;
  options.keep_still = false;  // a picture's time is that of all of it
  return options;
}

Result<Image> shown_image(const FloatImage& light) {
  std::vector<glm::vec3> linear(light.values.size() / 3);
  for (std::size_t i = 0; i < linear.size(); ++i)
    linear[i] = {light.values[3 * i], light.values[3 * i + 1], light.values[3 * i + 2]};
  const auto shown = display_colors(Display::kAces, linear);
  if (!shown) return shown.error();
  Image image{light.width, light.height, {}};
  for (const glm::vec3& color : shown.value()) {
    for (int c = 0; c < 3; ++c)
      image.rgba.push_back(static_cast<std::uint8_t>(std::lround(255.0f * color[c])));
    image.rgba.push_back(255);
  }
  return image;
}

Image empty_sheet(int width, int height) {
  return {width, height,
          std::vector<std::uint8_t>(std::size_t{4} * static_cast<std::size_t>(width) *
                                    static_cast<std::size_t>(height))};
}

void put(const Image& picture, int left, int top, Image& sheet) {
  const auto at = [](const Image& image, int x, int y) {
    return std::size_t{4} * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                             static_cast<std::size_t>(x));
  };
  for (int y = 0; y < picture.height; ++y)
    std::copy_n(picture.rgba.data() + at(picture, 0, y), at(picture, picture.width, 0),
                sheet.rgba.data() + at(sheet, left, top + y));
}

Stand::Stand(std::unique_ptr<Renderer> renderer, const Scene& scene, double spacing, double aspect)
    : renderer_(std::move(renderer)),
      builder_(scene, spacing, *renderer_),
      camera_(scene.camera),
      aspect_(aspect) {}

Result<std::unique_ptr<Stand>> Stand::create(Context& context, Surface surface, const Scene& scene,
                                             double spacing, bool keep_still, glm::ivec2 size) {
  RenderOptions options = report_options(surface, size.x, size.y);
  options.keep_still = keep_still;
  auto made = Renderer::create(context, options);
  if (!made) return made.error();
  return std::unique_ptr<Stand>(
      new Stand(std::move(made.value()), scene, spacing, static_cast<double>(size.x) / size.y));
}

const Image& Stand::draw(const Snapshot& snapshot) {
  frame_ = builder_.build(snapshot, camera_.distance());
  frame_.view = camera_.view(aspect_);
  renderer_->draw(frame_);
  return image_ = renderer_->read_back();
}

std::pair<double, double> Stand::times(int frames) {
  std::vector<double> filter, whole;
  renderer_->set_timing(true);
  for (int i = 0; i < frames + 2; ++i) {
    renderer_->draw(frame_);
    if (i < 2) continue;  // shaders are compiled at their first use
    double sum = 0.0;
    for (const PassTime& pass : renderer_->pass_times()) {
      sum += pass.milliseconds;
      // By compute shaders with the thickness beside it.
      if (pass.pass.starts_with("surface filter")) filter.push_back(pass.milliseconds);
    }
    whole.push_back(sum);
  }
  renderer_->set_timing(false);
  return {report::percentile(filter, 0.5), report::percentile(whole, 0.5)};
}

Result<BucketTimes> bucket_times(Context& context, report::Setting setting, int pictures) {
  const auto file = find_scene("bucket");
  if (!file) return file.error();
  const auto scene = load_scene(file.value());
  if (!scene) return scene.error();
  setting.spacing = kBucketSpacing;
  report::Cost cost;
  report::Trial trial(scene.value(), setting, cost);
  std::array<std::unique_ptr<Stand>, 2> stands;
  for (std::size_t way = 0; way < 2; ++way) {
    auto made = Stand::create(context, Surface::kOurs, scene.value(), setting.spacing, way == 1);
    if (!made) return made.error();
    stands[way] = std::move(made.value());
  }
  std::array<std::vector<double>, 2> processor;
  std::array<std::vector<double>, 2> wall;
  for (int i = 0; i < pictures + 2; ++i) {
    trial.run(1.0 / 30.0);
    const Snapshot now = trial.picture();
    for (std::size_t way = 0; way < 2; ++way) {
      const auto began = std::chrono::steady_clock::now();
      const std::clock_t start = std::clock();
      stands[way]->draw(now);
      if (i < 2) continue;  // shaders are compiled at their first use
      processor[way].push_back(1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
      const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - began;
      wall[way].push_back(took.count());
    }
  }
  const auto time_of = [&](std::size_t way) {
    return PictureTime{report::percentile(processor[way], 0.5), std::ranges::min(wall[way])};
  };
  return BucketTimes{time_of(0), time_of(1)};
}

}  // namespace slosh
