// Particles of a world on the GPU, drawn from where CUDA has them and from main memory: the pictures are
// bitwise identical, frame by frame while the world goes on; what cannot be opened is said and drawn all the
// same. With times. Usage: cross_picture [PARTICLES]: of a pool, 30000 unless said. Exits 1 when a picture
// differs, 77 where there is no GPU.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "render/renderer.h"
#include "tests/cross/compare.h"
#include "tests/cross/worlds.h"
#include "tests/render/scene_kit.h"

namespace {

using namespace slosh;
using namespace slosh::testing;

double now_ms() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double, std::milli>(now).count();
}

Frame frame_of(const Snapshot& snapshot, double spacing, const RenderOptions& options) {
  Frame frame;
  frame.particles = snapshot.positions;
  frame.particle_fluid = snapshot.fluid_index;
  frame.fluids = {kit::water()};
  frame.particle_radius = 0.62f * static_cast<float>(spacing);
  glm::vec3 low(1e30f), high(-1e30f);
  for (std::size_t i = 0; i < snapshot.positions.size(); ++i) {
    if (snapshot.fluid_index[i] == 255) continue;
    low = glm::min(low, snapshot.positions[i]);
    high = glm::max(high, snapshot.positions[i]);
  }
  const glm::vec3 middle = 0.5f * (low + high);
  const float size = glm::length(high - low);
  frame.view =
      kit::make_view(middle + size * glm::vec3(0.3f, 0.5f, 0.8f), middle, options.width, options.height);
  return frame;
}

struct Drawn {
  std::unique_ptr<Renderer> renderer;
  std::map<std::string, std::vector<double>> gpu_ms, thread_ms;
  std::vector<double> whole;

  Image draw(const Frame& frame) {
    renderer->set_timing(true);
    renderer->draw(frame);
    double sum = 0.0, busy = 0.0;
    for (const PassTime& pass : renderer->pass_times()) {
      gpu_ms[pass.pass].push_back(pass.milliseconds);
      thread_ms[pass.pass].push_back(pass.cpu_milliseconds);
      sum += pass.milliseconds;
      busy += pass.cpu_milliseconds;
    }
    gpu_ms["all passes"].push_back(sum);
    thread_ms["all passes"].push_back(busy);
    renderer->set_timing(false);
    return renderer->read_back();
  }
  void time_row(const Frame& frame) {
    const double begin = now_ms();
    for (int i = 0; i < 20; ++i) renderer->draw(frame);
    (void)renderer->read_buffer(Buffer::kBackDepth);  // the smallest: waits for all
    whole.push_back((now_ms() - begin) / 20.0);
  }
};

double middle(std::vector<double> values) {
  std::ranges::sort(values);
  return values.empty() ? 0.0 : values[values.size() / 2];
}

void print(const char* what, const Drawn& a, const Drawn& b) {
  const auto row = [&](const std::string& pass) {
    std::printf("  %-22s %9.3f %9.3f   %9.3f %9.3f\n", pass.c_str(), middle(a.gpu_ms.at(pass)),
                middle(b.gpu_ms.at(pass)), middle(a.thread_ms.at(pass)), middle(b.thread_ms.at(pass)));
  };
  std::printf("%s, ms, medians\n  %-22s %9s %9s   %9s %9s\n", what, "", "main", "on GPU", "thread", "thread");
  for (const char* pass : {"shadow map", "particles", "all passes"}) row(pass);
  std::printf("  %-22s %9.3f %9.3f\n", "a picture in a row", middle(a.whole), middle(b.whole));
}

int fail(const Error& error) {
  std::fprintf(stderr, "%s\n", error.text().c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  const CudaDevice device = find_cuda_device();
  if (!device.available) {
    std::printf("no GPU here (%s): compiled, not run\n", device.reason.c_str());
    return 77;
  }
  auto context = make_headless_context();
  if (!context) return fail(context.error());
  std::printf("%s; %s\n", device.name.c_str(), context.value()->description().c_str());
  const Tank tank = shaken(pool(argc > 1 ? std::atof(argv[1]) : 30000.0));
  World world = world_on(Backend::kCuda, tank);
  Snapshot before;
  world.fill(before);
  expect_true("nothing is shared that nobody asked for", before.on_gpu == nullptr);
  const Result<bool> shared = world.share_particles();
  if (!shared) return fail(shared.error());

  RenderOptions options;
  options.width = 1920;
  options.height = 1080;
  options.quality = Quality::kFull;
  options.pixel_passes = PixelPasses::kCompute;
  Drawn by_main, by_gpu;
  for (Drawn* drawn : {&by_main, &by_gpu}) {
    auto made = Renderer::create(*context.value(), options);
    if (!made) return fail(made.error());
    drawn->renderer = std::move(made.value());
  }
  std::size_t off = 0, all_there = 0;
  const int kFrames = 24;
  double filled = 0.0;
  for (int i = 0; i < kFrames; ++i) {
    for (int k = 0; k < 5; ++k) world.step({});
    Snapshot snapshot;
    const double begin = now_ms();
    world.fill(snapshot);
    filled += now_ms() - begin;
    all_there += snapshot.on_gpu ? 1 : 0;
    Frame frame = frame_of(snapshot, tank.sampled.spacing, options);
    frame.on_gpu = nullptr;
    const Image one = by_main.draw(frame);
    frame.on_gpu = snapshot.on_gpu;
    const Image other = by_gpu.draw(frame);
    off += one.rgba != other.rgba ? 1 : 0;
    if (i % 6 != 0) continue;
    by_gpu.time_row(frame);
    frame.on_gpu = nullptr;
    by_main.time_row(frame);
  }
  std::printf("%zu particles, %d pictures, %zu of them shared, fill %.3f ms\n", world.fluid_count(), kFrames,
              all_there, filled / kFrames);
  expect_true("each moment had a place on the GPU", all_there == static_cast<std::size_t>(kFrames));
  expect_true("they were read there", by_gpu.renderer->reads_particles_on_gpu());
  expect_true("and nothing was refused", by_gpu.renderer->particles_refused().empty());
  expect_true("the other read main memory", !by_main.renderer->reads_particles_on_gpu());
  expect_at_most("pictures that differ", static_cast<double>(off), 0.0);
  print("pictures of 1920 x 1080", by_main, by_gpu);

  // Places run out, and come back.
  std::vector<Snapshot> kept(8);
  for (Snapshot& snapshot : kept) world.fill(snapshot);
  const auto with = std::ranges::count_if(kept, [](const Snapshot& s) { return s.on_gpu != nullptr; });
  std::printf("  of 8 kept snapshots %td have one\n", with);
  expect_true("six at most have a place, the renderer's one among them", with == 5 || with == 6);
  kept.clear();
  Snapshot last;
  world.fill(last);
  expect_true("what is let go has one again", last.on_gpu != nullptr);

  // What cannot be opened is said, and the picture is the same.
  Frame frame = frame_of(last, tank.sampled.spacing, options);
  const Image wanted = by_main.draw(frame_of(last, tank.sampled.spacing, options));
  struct Spoilt {
    const char* name;
    void (*spoil)(SharedParticles&);
  };
  const Spoilt all[] = {{"another GPU's", [](SharedParticles& p) { p.device[3] ^= 0x5a; }},
                        {"a closed descriptor's", [](SharedParticles& p) { p.descriptor = -1; }},
                        {"one that is no memory's", [](SharedParticles& p) { p.descriptor = 0; }}};
  std::uint64_t number = 1000;
  for (const Spoilt& spoilt : all) {
    SharedParticles particles = *last.on_gpu;
    particles.allocation = ++number;
    spoilt.spoil(particles);
    frame.on_gpu = std::make_shared<const SharedParticles>(particles);
    const Image drawn = by_gpu.draw(frame);
    std::printf("  %s: %s\n", spoilt.name, by_gpu.renderer->particles_refused().c_str());
    expect_true("is refused in words", !by_gpu.renderer->particles_refused().empty());
    expect_true("and drawn the same", drawn.rgba == wanted.rgba);
  }
  // Others' numbers in its place: seen before it is drawn.
  SharedParticles moved = *last.on_gpu;
  moved.allocation = ++number;
  moved.positions += 256;
  frame.on_gpu = std::make_shared<const SharedParticles>(moved);
  expect_true("wrong numbers are not drawn", by_gpu.draw(frame).rgba == wanted.rgba);
  std::printf("  wrong numbers: %s\n", by_gpu.renderer->particles_refused().c_str());
  expect_true("and said", !by_gpu.renderer->particles_refused().empty());
  frame.on_gpu = last.on_gpu;
  expect_true("and the next that is right is read",
              by_gpu.draw(frame).rgba == wanted.rgba && by_gpu.renderer->reads_particles_on_gpu());
  // A snapshot outlives its world.
  Snapshot orphan;
  {
    World other = world_on(Backend::kCuda, tank);
    expect_true("another world shares, too", static_cast<bool>(other.share_particles()));
    other.step({});
    other.fill(orphan);
  }
  Frame of_orphan = frame_of(orphan, tank.sampled.spacing, options);
  of_orphan.on_gpu = nullptr;
  const Image as_copied = by_main.draw(of_orphan);
  of_orphan.on_gpu = orphan.on_gpu;
  expect_true("a snapshot is drawn after its world's end",
              by_gpu.draw(of_orphan).rgba == as_copied.rgba && by_gpu.renderer->reads_particles_on_gpu());
  std::printf(failures() ? "%d comparison(s) FAILED\n" : "all agree (%d failures)\n", failures());
  return failures() ? 1 : 0;
}
