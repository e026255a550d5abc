#include "tests/bench/codec_mask.h"

#include <algorithm>

#include "render/renderer.h"
#include "tests/render/scene_kit.h"

namespace slosh::bench {

namespace {

FloatImage draw(Renderer& renderer, const DecodedFrame& picture, double spacing) {
  Frame frame;
  frame.view = kit::make_view({0.5f, 0.6f, 1.3f}, {0.0f, 0.12f, 0.0f}, renderer.options().width,
                              renderer.options().height);
  frame.particles = picture.positions;
  frame.particle_fluid = picture.fluid_index;
  frame.fluids = {kit::water()};
  frame.particle_radius = static_cast<float>(0.5 * spacing);
  renderer.draw(frame);
  return renderer.read_buffer(Buffer::kFluidIndex);
}

}  // namespace

Result<std::vector<double>> compare_masks(const std::vector<DecodedFrame>& all,
                                          const std::vector<DecodedFrame>& shell, double spacing) {
  auto context = make_headless_context({});
  if (!context) return context.error();
  RenderOptions options;
  options.width = 640;
  options.height = 480;
  auto renderer = Renderer::create(*context.value(), options);
  if (!renderer) return renderer.error();
  std::vector<double> percent;
  for (std::size_t f = 0; f < std::min(all.size(), shell.size()); ++f) {
    const FloatImage full = draw(*renderer.value(), all[f], spacing);
    const FloatImage part = draw(*renderer.value(), shell[f], spacing);
    double fluid = 0.0, differing = 0.0;
    for (std::size_t i = 0; i < full.values.size(); ++i) {
      fluid += full.values[i] >= 0.0f;
      differing += (full.values[i] >= 0.0f) != (part.values[i] >= 0.0f);
    }
    percent.push_back(100.0 * differing / std::max(fluid, 1.0));
  }
  return percent;
}

}  // namespace slosh::bench
