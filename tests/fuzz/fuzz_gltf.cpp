// A scene's file from anywhere: .gltf, .glb, and a .glb whose lengths fit whatever its JSON and its buffer
// have become.
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "net/text/clean.h"
#include "net/wire/scene_package.h"
#include "scenes/load.h"
#include "tests/fuzz/must.h"
#include "tests/fuzz/seeds.h"
#include "tests/scenes/support.h"

using namespace slosh;

namespace {

using Bytes = std::vector<std::uint8_t>;
enum Mode : std::uint8_t { kText, kBinary, kParts, kModes };

void put(Bytes& out, std::size_t number) {
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
}

/// `parts`: JSON up to the first zero byte, then the buffer.
Bytes joined(const Bytes& parts) {
  const auto zero = std::find(parts.begin(), parts.end(), 0);
  Bytes json(parts.begin(), zero);
  Bytes buffer(zero == parts.end() ? zero : zero + 1, parts.end());
  while (json.size() % 4 != 0) json.push_back(' ');
  while (buffer.size() % 4 != 0) buffer.push_back(0);
  Bytes out{'g', 'l', 'T', 'F'};
  put(out, 2);
  put(out, 12 + 8 + json.size() + 8 + buffer.size());
  put(out, json.size());
  put(out, 0x4E4F534A);
  out.insert(out.end(), json.begin(), json.end());
  put(out, buffer.size());
  put(out, 0x004E4942);
  out.insert(out.end(), buffer.begin(), buffer.end());
  return out;
}

Bytes read_all(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  static const test::TempFolder folder;
  const Bytes rest(data + 1, data + size);
  const auto mode = static_cast<Mode>(data[0] % kModes);
  const Bytes bytes = mode == kParts ? joined(rest) : rest;
  const std::filesystem::path file = folder / (mode == kText ? "input.gltf" : "input.glb");
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  const Result<Scene> scene = load_scene(file);
  if (!scene) {
    test::must(clean_lines(scene.error().text(), 8000) == scene.error().text(), "an error can be told");
    return 0;
  }
  const Result<wire::Bytes> package = pack_scene(scene.value(), 0.01, SceneParts::kAll);
  test::must(static_cast<bool>(package), "what is read can be sent");
  const Result<UnpackedScene> again = unpack_scene(package.value());
  test::must(static_cast<bool>(again), "and read again");
  return 0;
}

std::vector<std::vector<std::uint8_t>> slosh_fuzz_seeds() {
  const test::TempFolder folder;
  std::vector<Bytes> seeds;
  for (const char* name : {"cup.gltf", "cup.glb"}) {
    make::SceneWriter writer = test::make_cup();
    if (!writer.write(folder / name)) return {};
    seeds.push_back(read_all(folder / name));
  }
  // The same as parts: behind 20 bytes of head the JSON, behind 8 more the buffer.
  const Bytes& whole = seeds[1];
  const std::size_t json = whole[12] | whole[13] << 8 | whole[14] << 16;
  Bytes parts(whole.begin() + 20, whole.begin() + 20 + static_cast<std::ptrdiff_t>(json));
  parts.push_back(0);
  parts.insert(parts.end(), whole.begin() + 28 + static_cast<std::ptrdiff_t>(json), whole.end());
  seeds.push_back(parts);
  for (std::uint8_t mode = 0; mode < kModes; ++mode) seeds[mode].insert(seeds[mode].begin(), mode);
  return seeds;
}
