// What it costs to keep a world: copying it, a checkpoint, a hash, a recording. CSV on standard output.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "host/keep/checkpoint.h"
#include "host/keep/recording.h"
#include "net/clock.h"
#include "tests/support/tank.h"

namespace {

using namespace slosh;

template <class F>
double median_ms(int times, F&& what) {
  std::vector<double> all;
  for (int i = 0; i < times; ++i) {
    const std::int64_t begin_ns = steady_now_ns();
    what();
    all.push_back(1e3 * to_seconds(steady_now_ns() - begin_ns));
  }
  std::nth_element(all.begin(), all.begin() + times / 2, all.end());
  return all[static_cast<std::size_t>(times / 2)];
}

void line(const char* what, double value, const char* unit) {
  std::printf("%s,%.4g,%s\n", what, value, unit);
}

}  // namespace

int main() {
  const testing::Tank tank = testing::make_tank({.inner = {0.32, 0.4, 0.32}, .fill = 0.32});
  Result<World> made = make_world(tank.scene, tank.sampled, make_plan(tank.scene, tank.sampled.spacing),
                                  WorldOptions{1, Backend::kCpu});
  World& world = made.value();
  for (int i = 0; i < 60; ++i) world.step({});
  std::puts("what,value,unit");
  line("particles", static_cast<double>(world.fluid_count()), "");
  std::vector<std::uint8_t> bytes;
  line("save into a used buffer",
       median_ms(50,
                 [&] {
                   bytes.clear();
                   (void)world.save(bytes);
                 }),
       "ms");
  line("save", static_cast<double>(bytes.size()), "bytes");
  line("restore", median_ms(20, [&] { (void)world.restore(bytes); }), "ms");
  line("hash", median_ms(20, [&] { (void)world.hash(); }), "ms");

  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  keep::CheckpointOptions options;
  options.file = folder / "slosh_bench_checkpoint";
  options.interval = 0.0;
  {
    auto writer = keep::CheckpointWriter::start(tank.scene, tank.sampled.spacing, bytes, world, {}, options);
    if (!writer) {
      std::fprintf(stderr, "%s\n", writer.error().text().c_str());
      return 1;
    }
    line("checkpoint: pack and bring to the disk",
         median_ms(15,
                   [&] {
                     writer.value()->after_step(world);
                     writer.value()->flush();
                   }),
         "ms");
    line("checkpoint: longest copy on the host's thread", writer.value()->report().copy_ms, "ms");
    line("checkpoint", static_cast<double>(writer.value()->report().bytes), "bytes");
  }
  line("checkpoint: read", median_ms(5, [&] { (void)keep::read_checkpoint(options.file); }), "ms");
  std::filesystem::remove(options.file);
  std::filesystem::remove(keep::previous_of(options.file));
  return 0;
}
