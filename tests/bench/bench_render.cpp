// How long each pass of a frame takes, on whatever draws here: `bench_render --help`. Medians over the
// frames: by timer queries on a GPU, with a glFinish after each pass where a processor draws.
#include <imgui.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <string>
#include <vector>

#include "render/color/display_transform.h"
#include "render/reference/path_tracer.h"
#include "render/renderer.h"
#include "tests/render/scene_kit.h"

namespace {

struct Wishes {
  int width = 640;
  int height = 480;
  int particles = 5000;
  int frames = 30;
  int threads = 1;
  bool batter = false;
  bool juice = false;
  bool paper = false;
  bool full = false;
  bool flow = false;
  bool hud = false;
  bool stereo = false;
  int reference = 0;
  std::string environment;
  std::string out;
};

void say_options(CLI::App& app, Wishes& wishes) {
  app.add_option("--width", wishes.width, "pixels")->check(CLI::Range(16, 8192))->capture_default_str();
  app.add_option("--height", wishes.height, "pixels")->check(CLI::Range(16, 8192))->capture_default_str();
  app.add_option("--particles", wishes.particles, "in a broken dam, about")
      ->check(CLI::Range(1, 4'000'000))
      ->capture_default_str();
  app.add_option("--frames", wishes.frames, "measured, after two that are not")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  app.add_option("--threads", wishes.threads, "of a processor that draws")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  app.add_flag("--batter", wishes.batter, "an opaque fluid instead of water");
  app.add_flag("--juice", wishes.juice, "a cloudy one");
  app.add_flag("--paper", wishes.paper, "the paper's section 5");
  app.add_flag("--flow", wishes.flow, "curvature flow");
  app.add_flag("--full", wishes.full, "full quality: what a film has");
  app.add_flag("--hud", wishes.hud, "arrows and a panel over it");
  app.add_flag("--stereo", wishes.stereo, "both eyes against one as well, each of that size, with the HUD");
  app.add_option("--environment", wishes.environment, "the room: FILE.hdr or studio");
  app.add_option("--out", wishes.out, "the picture, FILE.png");
  app.add_option("--reference", wishes.reference,
                 "no times: the picture by this many paths a pixel, into --out")
      ->check(CLI::Range(1, 100'000))
      ->needs("--out");
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

/// Both eyes of a frame, the HUD on a panel of its own every sixth time, as a headset at 60 Hz has it;
/// against one eye with the HUD over it. By turns, so that what else the machine does falls on both.
void time_stereo(slosh::Renderer& renderer, const slosh::Frame& frame, int frames) {
  using namespace slosh;
  std::array<View, 2> eyes{frame.view, frame.view};
  for (std::size_t eye = 0; eye < 2; ++eye) {
    const float aside = eye == 0 ? 0.032f : -0.032f;
    eyes[eye].view = glm::translate(glm::mat4(1.0f), glm::vec3(aside, 0.0f, 0.0f)) * frame.view.view;
  }
  const auto time = [](auto&& draw) {
    const auto start = std::chrono::steady_clock::now();
    draw();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  };
  std::vector<double> mono;
  std::vector<double> stereo;
  for (int i = 0; i < frames + 2; ++i) {
    const double one = time([&] {
      renderer.draw(frame);
      (void)renderer.read_back();
    });
    const double two = time([&] {
      renderer.prepare(frame, eyes);
      for (const View& eye : eyes) {
        renderer.draw(eye);
        (void)renderer.read_back();
      }
      if (i % 6 == 0) renderer.draw_hud();
      renderer.present();
    });
    if (i < 2) continue;
    mono.push_back(one);
    stereo.push_back(two);
  }
  std::printf("%-20s %10.2f %10.2f\n%-20s %10.2f %10.2f\n%-20s %10.2f %10.2f\n", "one eye", median(mono),
              std::ranges::min(mono), "both eyes", median(stereo), std::ranges::min(stereo), "both / one",
              median(stereo) / median(mono), std::ranges::min(stereo) / std::ranges::min(mono));
}

void choose_fluid(const Wishes& wishes, slosh::Frame& frame) {
  if (wishes.batter) frame.fluids = {slosh::kit::batter()};
  if (wishes.juice) frame.fluids = {slosh::kit::cloudy_juice()};
}

/// A file, "studio", or none.
std::shared_ptr<const slosh::Environment> environment_of(const Wishes& wishes) {
  if (wishes.environment.empty()) return nullptr;
  if (wishes.environment == "studio") return slosh::make_studio_environment();
  auto read = slosh::read_environment(wishes.environment);
  if (read) return read.value();
  std::fprintf(stderr, "%s\n", read.error().text().c_str());
  return nullptr;
}

/// The picture by path tracing.
slosh::Result<bool> write_reference(const Wishes& wishes) {
  using namespace slosh;
  auto tracer = reference::PathTracer::create();
  if (!tracer) return tracer.error();
  kit::DamBreak scene(*tracer.value(), wishes.particles, wishes.width, wishes.height);
  choose_fluid(wishes, scene.frame);
  reference::Options options;
  options.width = wishes.width;
  options.height = wishes.height;
  options.samples = wishes.reference;
  options.threads = std::max(wishes.threads, 1);
  const auto environment = environment_of(wishes);
  options.environment = environment.get();
  const FloatImage light = tracer.value()->draw(scene.frame, options);
  std::vector<glm::vec3> linear(light.values.size() / 3);
  for (std::size_t i = 0; i < linear.size(); ++i)
    linear[i] = {light.values[3 * i], light.values[3 * i + 1], light.values[3 * i + 2]};
  const auto shown = display_colors(Display::kAces, linear);
  if (!shown) return shown.error();
  Image image{wishes.width, wishes.height, {}};
  for (const glm::vec3& color : shown.value()) {
    for (int c = 0; c < 3; ++c)
      image.rgba.push_back(static_cast<std::uint8_t>(std::lround(255.0f * color[c])));
    image.rgba.push_back(255);
  }
  const auto written = write_png(wishes.out, image);
  if (!written) return written.error();
  return true;
}

int fail(const slosh::Error& error) {
  std::fprintf(stderr, "%s\n", error.text().c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace slosh;
  Wishes wishes;
  CLI::App app{"Times each pass of a frame of a broken dam, on the GPU or the processor that draws here."};
  say_options(app, wishes);
  CLI11_PARSE(app, argc, argv);
  wishes.hud = wishes.hud || wishes.stereo;
  if (wishes.reference > 0) {
    const auto written = write_reference(wishes);
    return written ? 0 : fail(written.error());
  }
  HeadlessOptions headless;
  headless.software_threads = wishes.threads;
  auto context = make_headless_context(headless);
  if (!context) return fail(context.error());
  RenderOptions options;
  options.width = wishes.width;
  options.height = wishes.height;
  if (wishes.paper) options = section_five(options);
  options.environment = environment_of(wishes);
  if (wishes.flow) options.surface = Surface::kCurvatureFlow;
  if (wishes.full) options.quality = Quality::kFull;
  auto made = Renderer::create(*context.value(), options);
  if (!made) return fail(made.error());
  Renderer& renderer = *made.value();
  kit::DamBreak scene(renderer, wishes.particles, wishes.width, wishes.height);
  choose_fluid(wishes, scene.frame);
  if (wishes.hud) {
    scene.frame.arrows = {{{0.1f, 0.06f, 0.02f}, {0.1f, 0.26f, 0.02f}, {0.9f, 0.5f, 0.1f}}};
    scene.frame.hud = [] {
      ImGui::Begin("forces");
      ImGui::Text("left hand  12.3 N");
      ImGui::Text("right hand  9.8 N");
      ImGui::End();
    };
  }

  std::map<std::string, std::vector<double>> times;
  std::vector<std::string> order;
  std::vector<double> sums;
  std::vector<double> whole;
  for (int i = 0; i < wishes.frames + 2; ++i) {
    renderer.set_timing(true);
    renderer.draw(scene.frame);
    const auto passes = renderer.pass_times();
    renderer.set_timing(false);
    const auto start = std::chrono::steady_clock::now();
    renderer.draw(scene.frame);
    (void)renderer.read_back();
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    if (i < 2) continue;  // shaders are compiled at their first use
    double together = 0.0;
    for (const PassTime& pass : passes) {
      together += pass.milliseconds;
      if (!times.contains(pass.pass)) order.push_back(pass.pass);
      times[pass.pass].push_back(pass.milliseconds);
    }
    sums.push_back(together);
    whole.push_back(took.count());
  }
  std::printf("%s, threads %d\n%d x %d, %zu particles, median of %d frames\n",
              context.value()->description().c_str(), wishes.threads, wishes.width, wishes.height,
              scene.particles.size(), wishes.frames);
  std::printf("%-20s %10s %10s\n", "pass", "median ms", "fastest ms");
  for (const std::string& pass : order) {
    std::printf("%-20s %10.3f %10.3f\n", pass.c_str(), median(times[pass]), std::ranges::min(times[pass]));
  }
  std::printf("%-20s %10.3f %10.3f\n", "all passes", median(sums), std::ranges::min(sums));
  std::printf("%-20s %10.3f %10.3f\n", "frame + read-back", median(whole), std::ranges::min(whole));
  if (wishes.stereo) time_stereo(renderer, scene.frame, wishes.frames);
  if (!wishes.out.empty()) {
    const auto written = write_png(wishes.out, renderer.read_back());
    if (!written) return fail(written.error());
  }
  return 0;
}
