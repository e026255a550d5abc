// How long each pass of a frame takes, on whatever draws here, by fragments and by compute shaders in turn:
// `bench_render --help`. By timer queries on a GPU, with a glFinish after each pass where a processor draws.
#include <imgui.h>

#include <CLI/CLI.hpp>
#include <algorithm>
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
#include "render/renderer.h"
#include "tests/bench/render_stereo.h"
#include "tests/bench/render_wishes.h"
#include "tests/cross/on_gpu.h"
#include "tests/lab/picture/reference/path_tracer.h"
#include "tests/render/scene_kit.h"

namespace {

using slosh::bench::median;
using slosh::bench::Wishes;

/// What is drawn. `spacing` of the basin is that of so many particles.
struct Load {
  std::unique_ptr<slosh::kit::DamBreak> dam;
  std::unique_ptr<slosh::kit::StillBasin> basin;
  slosh::Frame& frame() { return dam ? dam->frame : basin->frame; }
};

void choose_fluid(const Wishes& wishes, slosh::kit::DamBreak& scene) {
  if (wishes.batter) scene.frame.fluids = {slosh::kit::batter()};
  if (wishes.juice) scene.frame.fluids = {slosh::kit::cloudy_juice()};
  if (!wishes.mix) return;
  scene.frame.fluids = {slosh::kit::cloudy_juice(), slosh::kit::batter()};
  // In tongues, and particle by particle within a hand's breadth of them.
  for (std::size_t i = 0; i < scene.particles.size(); ++i) {
    const glm::vec3& at = scene.particles[i];
    const float tongue = 0.05f * std::sin(55.0f * at.z) + 0.03f * std::sin(90.0f * at.x + 20.0f * at.z);
    const float stray = 0.02f * std::sin(12.9898f * static_cast<float>(i));
    scene.fluids[i] = at.x + tongue + stray < -0.03f ? 1 : 0;
  }
}

Load make_load(const Wishes& wishes, slosh::MeshSink& meshes) {
  Load load;
  if (wishes.basin) {
    const float spacing = std::cbrt(0.8f * 0.6f * 0.06f / static_cast<float>(wishes.particles));
    load.basin = std::make_unique<slosh::kit::StillBasin>(meshes, spacing, wishes.width, wishes.height);
    return load;
  }
  load.dam = std::make_unique<slosh::kit::DamBreak>(meshes, wishes.particles, wishes.width, wishes.height);
  choose_fluid(wishes, *load.dam);
  if (wishes.bucket) load.dam->frame.meshes[3].look.opacity = 1.0f;
  return load;
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
  Load load = make_load(wishes, *tracer.value());
  reference::Options options;
  options.width = wishes.width;
  options.height = wishes.height;
  options.samples = wishes.reference;
  if (wishes.caustics) options.photons = 4'000'000;
  options.threads = std::max(wishes.threads, 1);
  const auto environment = environment_of(wishes);
  options.environment = environment.get();
  const FloatImage light = tracer.value()->draw(load.frame(), options);
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

/// One of the ways that passes over pixels are drawn in, and what was measured of it.
struct Way {
  std::string name;
  std::unique_ptr<slosh::Renderer> renderer;
  Load load;
  std::vector<std::string> order;
  std::map<std::string, std::vector<double>> times;      ///< ms, by pass
  std::map<std::string, std::vector<double>> cpu_times;  ///< of which this thread had
  std::vector<double> sums;
  std::vector<double> cpu_sums;
  std::vector<double> whole;

  bool moving = false;
  int warm = 0;

  /// Once with its passes timed and once as a whole.
  void draw(bool counts) {
    if (moving) {
      glm::mat4& ball = load.frame().meshes[2].model;
      ball[3].y = ball[3].y > 0.024f ? 0.024f : 0.025f;
    }
    for (int i = 0; i < warm; ++i) renderer->draw(load.frame());
    renderer->set_timing(true);
    renderer->draw(load.frame());
    const auto passes = renderer->pass_times();
    renderer->set_timing(false);
    const auto start = std::chrono::steady_clock::now();
    renderer->draw(load.frame());
    (void)renderer->read_back();
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    if (!counts) return;
    double together = 0.0;
    double cpu_together = 0.0;
    for (const slosh::PassTime& pass : passes) {
      together += pass.milliseconds;
      cpu_together += pass.cpu_milliseconds;
      if (!times.contains(pass.pass)) order.push_back(pass.pass);
      times[pass.pass].push_back(pass.milliseconds);
      cpu_times[pass.pass].push_back(pass.cpu_milliseconds);
    }
    sums.push_back(together);
    cpu_sums.push_back(cpu_together);
    whole.push_back(took.count());
  }
};

slosh::Result<std::unique_ptr<Way>> make_way(const char* name, const Wishes& wishes,
                                             slosh::Context& context) {
  using namespace slosh;
  RenderOptions options;
  options.width = wishes.width;
  options.height = wishes.height;
  if (wishes.paper) options = section_five(options);
  options.environment = environment_of(wishes);
  if (wishes.flow) options.surface = Surface::kCurvatureFlow;
  if (wishes.full) options.quality = Quality::kFull;
  options.caustics = wishes.caustics;
  if (wishes.srgb) options.display = Display::kSrgb;
  if (wishes.table) options.display_by = DisplayBy::kTable;
  if (wishes.text) options.display_by = DisplayBy::kText;
  if (wishes.no_bodies) options.body_reflections = false;
  if (wishes.hard) options.soft_mixing = false;
  options.pixel_passes = name == std::string("compute") ? PixelPasses::kCompute : PixelPasses::kFragments;
  options.keep_still = name == std::string("kept");  // else two pictures of one moment would be one
  auto made = Renderer::create(context, options);
  if (!made) return made.error();
  auto way = std::make_unique<Way>();
  way->name = name;
  way->renderer = std::move(made.value());
  way->load = make_load(wishes, *way->renderer);
  way->moving = wishes.moving;
  way->warm = wishes.warm;
  if (wishes.detail > 0) {
    const kit::Shape ball = kit::make_sphere(0.03f, wishes.detail, 2 * wishes.detail);
    const MeshHandle mesh = way->renderer->add_mesh(ball.positions, ball.normals, ball.triangles);
    way->load.frame().meshes.push_back(
        {mesh, glm::translate(glm::mat4(1.0f), glm::vec3(0.36f, 0.024f, -0.10f)), {}});
  }
  if (wishes.on_gpu) {
    auto put = slosh::testing::put_on_gpu(way->load.frame().particles, way->load.frame().particle_fluid);
    if (!put) return put.error();
    way->load.frame().on_gpu = std::move(put.value());
  }
  if (wishes.hud) {
    way->load.frame().arrows = {{{0.1f, 0.06f, 0.02f}, {0.1f, 0.26f, 0.02f}, {0.9f, 0.5f, 0.1f}}};
    way->load.frame().hud = [] {
      ImGui::Begin("forces");
      ImGui::Text("left hand  12.3 N");
      ImGui::Text("right hand  9.8 N");
      ImGui::End();
    };
  }
  return way;
}

/// Median and fastest of each pass, and what of it this thread was busy with, ms; a column group a way.
void print_table(const std::vector<std::unique_ptr<Way>>& ways) {
  std::printf("%-20s", "");
  for (const auto& way : ways) std::printf("  %-32s", way->name.c_str());
  std::printf("\n%-20s", "ms");
  for (std::size_t i = 0; i < ways.size(); ++i)
    std::printf("  %10s %10s %10s", "median", "fastest", "this thread");
  std::printf("\n");
  const auto row = [&](const char* name, auto&& values, auto&& cpu_values) {
    std::printf("%-20s", name);
    for (const auto& way : ways) {
      const std::vector<double>* all = values(*way);
      if (!all || all->empty()) {
        std::printf("  %10s %10s %10s", "", "", "");
        continue;
      }
      std::printf("  %10.3f %10.3f", median(*all), std::ranges::min(*all));
      const std::vector<double>* cpu = cpu_values(*way);
      if (cpu)
        std::printf(" %11.3f", median(*cpu));
      else
        std::printf(" %11s", "");
    }
    std::printf("\n");
  };
  for (const std::string& pass : ways.front()->order) {
    row(
        pass.c_str(), [&](Way& way) { return &way.times[pass]; },
        [&](Way& way) { return &way.cpu_times[pass]; });
  }
  using Values = const std::vector<double>*;
  row("all passes", [](Way& way) { return &way.sums; }, [](Way& way) { return &way.cpu_sums; });
  row("frame + read-back", [](Way& way) { return &way.whole; }, [](Way&) { return Values{nullptr}; });
}

/// By how much the two ways' pictures differ.
void print_difference(const std::vector<std::unique_ptr<Way>>& ways) {
  const slosh::Image one = ways[0]->renderer->read_back();
  const slosh::Image other = ways[1]->renderer->read_back();
  double sum = 0.0;
  int most = 0;
  std::size_t over = 0;
  for (std::size_t i = 0; i < one.rgba.size(); ++i) {
    const int off = std::abs(int{one.rgba[i]} - int{other.rgba[i]});
    sum += off;
    most = std::max(most, off);
    over += off > 2 ? 1 : 0;
  }
  const auto channels = static_cast<double>(one.rgba.size());
  std::printf(
      "the two pictures differ by %.4f of 255 in the mean, %d at most; by more than 2 in %.4f %% of "
      "channels\n",
      sum / channels, most, 100.0 * static_cast<double>(over) / channels);
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
  bench::say_options(app, wishes);
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
  std::vector<std::unique_ptr<Way>> ways;
  const std::map<std::string, std::vector<const char*>> named{{"both", {"fragments", "compute"}},
                                                              {"fragments", {"fragments"}},
                                                              {"compute", {"compute"}},
                                                              {"still", {"anew", "kept"}}};
  for (const char* name : named.at(wishes.pixels)) {
    auto way = make_way(name, wishes, *context.value());
    if (!way) return fail(way.error());
    ways.push_back(std::move(way.value()));
  }
  for (int i = 0; i < wishes.frames + 2; ++i) {
    for (const auto& way : ways) way->draw(i >= 2);  // shaders are compiled at their first use
  }
  std::printf("%s, threads %d\n%d x %d, %zu particles, %d frames\n", context.value()->description().c_str(),
              wishes.threads, wishes.width, wishes.height, ways.front()->load.frame().particles.size(),
              wishes.frames);
  if (wishes.on_gpu) {
    const slosh::Renderer& drew = *ways.back()->renderer;
    std::printf("particles are read %s\n",
                drew.reads_particles_on_gpu() ? "where CUDA has them" : drew.particles_refused().c_str());
  }
  print_table(ways);
  if (ways.size() == 2) print_difference(ways);
  if (wishes.stereo) {
    for (const auto& way : ways) {
      std::printf("%s\n", way->name.c_str());
      bench::time_stereo(*way->renderer, way->load.frame(), wishes.frames);
    }
  }
  if (!wishes.out.empty()) {
    const auto written = write_png(wishes.out, ways.back()->renderer->read_back());
    if (!written) return fail(written.error());
  }
  return 0;
}
