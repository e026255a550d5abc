#include "net/wire/scene_package.h"

#include <zstd.h>

#include <limits>
#include <memory>
#include <utility>

#include "net/wire/scene_fields.h"

namespace slosh {
namespace {

using wire::Bytes;
using wire::ByteView;

// A package: its version, how the rest is coded, the rest. A scene whose fluids say how they look has the
// fourth version, else one that settles before its run the third, else one with gauges or regions the second;
// any other the first, which programs from before these can read. A peer needs the first or the fourth.
constexpr std::uint8_t kVersion = 1;
constexpr std::uint8_t kMeasured = 2;
constexpr std::uint8_t kSettled = 3;
constexpr std::uint8_t kLooked = 4;

/// Without what packages before the fourth version leave out.
Fluid plain(Fluid fluid) {
  const Fluid usual;
  fluid.gloss = usual.gloss;
  fluid.refraction = usual.refraction;
  fluid.roughness = usual.roughness;
  fluid.scattering = usual_scattering(fluid.extinction);
  return fluid;
}

std::uint8_t version_of(const Scene& scene) {
  for (const Fluid& fluid : scene.fluids)
    if (fluid != plain(fluid)) return kLooked;
  if (scene.settle > 0.0) return kSettled;
  return scene.gauges.empty() && scene.regions.empty() ? kVersion : kMeasured;
}

// What a version has, of a scene of the last one.
template <class F>
wire::Fault with_version(std::uint8_t version, wire::LookedScene& whole, F&& f) {
  if (version == kLooked) return f(whole);
  if (version == kSettled) return f(whole.settled);
  if (version == kMeasured) return f(whole.settled.measured);
  return f(whole.settled.measured.packed);
}
enum Coding : std::uint8_t { kStored, kZstd };
constexpr std::size_t kHead = 2;

constexpr int kZstdLevel = 9;
/// More than this is not believed: a few bytes must not make a reader fill its memory. What packs better is
/// stored as it is.
constexpr std::size_t kMostExpansion = 32;

/// Leaves what a peer shows and holds.
void keep_seen(Scene& scene) {
  scene.source_file.clear();
  scene.fluid_volumes.clear();
  scene.settle = 0.0;
  scene.gauges.clear();
  scene.regions.clear();
  std::vector<int> moved(scene.meshes.size(), -1);
  std::vector<TriangleMesh> kept;
  const auto keep = [&](int& mesh) {
    if (mesh < 0 || static_cast<std::size_t>(mesh) >= moved.size()) return;
    int& to = moved[static_cast<std::size_t>(mesh)];
    if (to < 0) {
      to = static_cast<int>(kept.size());
      kept.push_back(std::move(scene.meshes[static_cast<std::size_t>(mesh)]));
    }
    mesh = to;
  };
  for (Body& body : scene.bodies) keep(body.mesh);
  for (Picture& picture : scene.pictures) keep(picture.mesh);
  scene.meshes = std::move(kept);
}

Error damaged(const std::string& what) {
  return {"scene package", what,
          "It was damaged on the way or on disk, or comes from another version of slosh"};
}

Result<Bytes> decompressed(ByteView packed) {
  const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN)
    return damaged("it does not begin as zstd does, or does not tell its size");
  if (size > wire::kMaxSceneBytes || size > kMostExpansion * packed.size())
    return damaged("it claims to be " + std::to_string(size) + " bytes unpacked");
  const std::size_t frame = ZSTD_findFrameCompressedSize(packed.data(), packed.size());
  if (ZSTD_isError(frame) || frame != packed.size()) return damaged("it ends too early or too late");
  Bytes content(static_cast<std::size_t>(size));
  const std::size_t got = ZSTD_decompress(content.data(), content.size(), packed.data(), packed.size());
  if (ZSTD_isError(got) || got != content.size()) return damaged("its compressed data are damaged");
  return content;
}

}  // namespace

Result<Bytes> pack_scene(const Scene& scene, double spacing, SceneParts parts) {
  wire::LookedScene whole{{{{scene, spacing}}}, scene.fluids};
  Scene& sent = whole.settled.measured.packed.scene;
  if (parts == SceneParts::kSeen) keep_seen(sent);
  const std::uint8_t version = version_of(sent);
  Bytes content;
  if (const wire::Fault fault =
          with_version(version, whole, [&](auto& fields) { return wire::encode(fields, content); })) {
    return Error{"scene '" + scene.name + "'", "cannot be sent or recorded: " + fault.text(),
                 "net/WIRE_FORMAT.md has the limits"};
  }
  if (content.size() > wire::kMaxSceneBytes) {
    return Error{"scene '" + scene.name + "'",
                 "is " + std::to_string(content.size() >> 20) + " MB, more than " +
                     std::to_string(wire::kMaxSceneBytes >> 20) + " MB",
                 "Reduce its meshes, in Blender with the Decimate modifier"};
  }
  Bytes out(kHead + ZSTD_compressBound(content.size()));
  out[0] = version;
  out[1] = kZstd;
  const std::size_t size =
      ZSTD_compress(out.data() + kHead, out.size() - kHead, content.data(), content.size(), kZstdLevel);
  if (ZSTD_isError(size) || size >= content.size() || content.size() > kMostExpansion * size) {
    out.resize(kHead);
    out[1] = kStored;
    out.insert(out.end(), content.begin(), content.end());
  } else {
    out.resize(kHead + size);
  }
  return out;
}

Result<UnpackedScene> unpack_scene(ByteView package) {
  if (package.size() < kHead) return damaged("it is empty");
  if (package.size() > wire::kMaxSceneBytes + kHead) return damaged("it is too large");
  if (package[0] < kVersion || package[0] > kLooked)
    return damaged("its version is " + std::to_string(package[0]));
  if (package[1] > kZstd) return damaged("its coding is " + std::to_string(package[1]));
  ByteView content = package.subspan(kHead);
  Bytes unpacked;
  if (package[1] == kZstd) {
    Result<Bytes> result = decompressed(content);
    if (!result) return result.error();
    unpacked = std::move(result.value());
    content = unpacked;
  }
  wire::LookedScene whole;
  if (const wire::Fault fault =
          with_version(package[0], whole, [&](auto& fields) { return wire::decode(content, fields); })) {
    return damaged(fault.text());
  }
  wire::PackedScene& packed = whole.settled.measured.packed;
  for (std::size_t i = 0; i < packed.scene.fluids.size(); ++i) {
    Fluid& fluid = packed.scene.fluids[i];
    const Fluid look = package[0] == kLooked ? whole.looks[i] : plain(fluid);
    fluid.gloss = look.gloss;
    fluid.refraction = look.refraction;
    fluid.scattering = look.scattering;
    fluid.roughness = look.roughness;
  }
  return UnpackedScene{std::move(packed.scene), packed.spacing};
}

}  // namespace slosh
