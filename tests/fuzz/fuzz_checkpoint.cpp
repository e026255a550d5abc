// A checkpoint: as a file, behind its checksums, and the saved world in it.
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include "host/keep/checkpoint.h"
#include "host/keep/file.h"
#include "tests/fuzz/fixed_chunks.h"
#include "tests/fuzz/must.h"
#include "tests/fuzz/seeds.h"
#include "tests/support/stirred_tank.h"

using namespace slosh;
using namespace slosh::keep;

namespace {

enum Mode : std::uint8_t { kFile, kWorld, kFixed, kModes };
constexpr std::size_t kMagicBytes = 8;

// Few particles: what is tried is the reading.
testing::Tank small_tank() {
  testing::Tank tank = testing::stirred_tank();
  tank.sampled.fluid_positions.resize(30);
  tank.sampled.fluid_velocities.resize(30);
  tank.sampled.fluid_index.resize(30);
  return tank;
}

World small_world() {
  const testing::Tank tank = small_tank();
  return World(tank.scene, tank.sampled, make_plan(tank.scene, tank.sampled.spacing), {1, Backend::kCpu});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  Bytes bytes(data + 1, data + size);
  const auto mode = static_cast<Mode>(data[0] % kModes);
  if (mode == kFixed) test::fix_chunks(bytes, kMagicBytes);
  if (mode != kWorld) {
    const File file(fmemopen(bytes.data(), bytes.size(), "rb"));
    const Result<Checkpoint> read = read_checkpoint_file(file.get(), "input");
    test::must(read || !read.error().what.empty(), "an error has words");
    return 0;
  }
  static World world = small_world();
  const std::uint64_t before = world.hash();
  if (!world.restore(bytes)) {
    test::must(world.hash() == before, "what is refused changes nothing");
    return 0;
  }
  Bytes again;
  test::must(static_cast<bool>(world.save(again)), "what was restored can be saved");
  test::must(static_cast<bool>(world.restore(again)), "and restored");
  world.step({});
  return 0;
}

std::vector<std::vector<std::uint8_t>> slosh_fuzz_seeds() {
  const testing::Tank tank = small_tank();
  World world = small_world();
  world.step({});
  Bytes state;
  (void)world.save(state);
  std::vector<Bytes> seeds{{}, state};
  CheckpointOptions options;
  options.file = std::filesystem::temp_directory_path() / ("slosh_fuzz_seed_" + std::to_string(::getpid()));
  {
    const auto writer = CheckpointWriter::start(tank.scene, 0.01, state, world, {}, options);
    if (writer) writer.value()->flush();
  }
  if (const Result<File> file = open_to_read(options.file)) {
    for (int byte = std::fgetc(file.value().get()); byte != EOF; byte = std::fgetc(file.value().get()))
      seeds[0].push_back(static_cast<std::uint8_t>(byte));
  }
  std::filesystem::remove(options.file);
  std::filesystem::remove(previous_of(options.file));
  // Every chunk of it as it is, so that damage reaches the head, the scene and the states.
  seeds.emplace_back(seeds[0].begin(), seeds[0].begin() + kMagicBytes);
  if (const File file{fmemopen(seeds[0].data(), seeds[0].size(), "rb")}) {
    std::fseek(file.get(), kMagicBytes, SEEK_SET);
    ChunkReader reader(file.get());
    for (Chunk chunk; reader.next(chunk) == ChunkOutcome::kChunk;)
      test::append_stored(chunk.type, chunk.content, seeds[2]);
  }
  test::fix_chunks(seeds[2], kMagicBytes);
  for (std::uint8_t mode = 0; mode < kModes; ++mode) seeds[mode].insert(seeds[mode].begin(), mode);
  return seeds;
}
