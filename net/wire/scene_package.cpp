#include "net/wire/scene_package.h"

#include <zstd.h>

#include <limits>
#include <memory>
#include <utility>

#include "net/wire/sent_goals.h"

namespace slosh {
namespace {

using wire::Bytes;
using wire::ByteView;
using wire::Fault;
using wire::PackedScene;
using enum wire::SceneVersion;

// A package: its version, how the rest is coded, the rest. It has the first version that has all of the
// scene, so that programs from before later ones can read it. A peer needs the first, the fourth or the
// fifth.

/// Without what packages before the fifth version leave out.
Material plain(Material material) {
  const Material usual;
  material.emissive = usual.emissive;
  material.alpha_cutoff = usual.alpha_cutoff;
  material.maps = usual.maps;
  return material;
}

template <class Visit>
void each_map(MaterialMaps& maps, Visit&& visit) {
  for (TextureMap* map :
       {&maps.base_color, &maps.metallic_roughness, &maps.normal, &maps.occlusion, &maps.emissive})
    visit(*map);
}

/// Which images travel: in the scene's order, while they fit.
std::vector<bool> which_travel(const Scene& scene) {
  std::vector<bool> travel;
  std::size_t bytes = 0;
  for (const SceneImage& image : scene.images) {
    travel.push_back(image.bytes.size() <= wire::kMaxSentImages - bytes);
    if (travel.back()) bytes += image.bytes.size();
  }
  return travel;
}

/// Leaves the images that travel and are shown, and what belongs to them.
void keep_sent_images(Scene& scene) {
  const std::vector<bool> travel = which_travel(scene);
  std::vector<int> moved(scene.images.size(), -1);
  std::vector<SceneImage> kept;
  bool any_map = false;
  wire::each_material(scene, [&](Material& material) {
    each_map(material.maps, [&](TextureMap& map) {
      const auto from = static_cast<std::size_t>(map.image);
      if (map.image < 0 || from >= travel.size() || !travel[from]) {
        map = {};
        return;
      }
      int& to = moved[from];
      if (to < 0) {
        to = static_cast<int>(kept.size());
        kept.push_back(std::move(scene.images[from]));
      }
      map.image = to;
      any_map = true;
    });
  });
  scene.images = std::move(kept);
  if (!any_map) {
    for (TriangleMesh& mesh : scene.meshes) mesh.texcoords.clear();
  }
}

/// Without what packages before the fourth version leave out.
Fluid plain(Fluid fluid) {
  const Fluid usual;
  fluid.gloss = usual.gloss;
  fluid.refraction = usual.refraction;
  fluid.roughness = usual.roughness;
  fluid.scattering = usual_scattering(fluid.extinction);
  return fluid;
}

/// Whether anything in it comes or goes while the world runs.
bool comes_or_goes(const Scene& scene) {
  return std::ranges::any_of(scene.bodies, &Body::starts_away) ||
         std::ranges::any_of(scene.fluid_volumes,
                             [](const FluidVolume& v) { return v.starts_away || v.fillings > 1; }) ||
         std::ranges::any_of(scene.task, [](const TaskStep& step) { return !step.then.empty(); }) ||
         std::ranges::any_of(scene.joints, [](const Joint& joint) {
           return joint.kind == JointKind::kFixed || joint.changes();
         });
}

wire::SceneVersion version_of(const Scene& scene) {
  if (std::ranges::any_of(scene.bodies, [](const Body& b) { return is_cut(b) || b.blade; })) return kCutScene;
  if (comes_or_goes(scene)) return kComingScene;
  if (!scene.task.empty() || !scene.joints.empty()) return kActingScene;
  for (const Body& body : scene.bodies)
    if (body.temperature || !body.keys.empty()) return kActingScene;
  for (const Fluid& fluid : scene.fluids)
    if (fluid.heat != Heat{}) return kActingScene;
  for (const Body& body : scene.bodies)
    if (body.material != plain(body.material)) return kTexturedScene;
  for (const Picture& picture : scene.pictures)
    if (picture.material != plain(picture.material)) return kTexturedScene;
  for (const Fluid& fluid : scene.fluids)
    if (fluid != plain(fluid)) return kLookedScene;
  if (scene.settle > 0.0) return kSettledScene;
  return scene.gauges.empty() && scene.regions.empty() ? kPlainScene : kMeasuredScene;
}

/// Calls `call` with the scene in that version, and takes back what it becomes.
template <std::uint8_t Version = kPlainScene, class Call>
Fault in_version(std::uint8_t version, PackedScene& packed, Call&& call) {
  if constexpr (Version < kCutScene) {
    if (version != Version) return in_version<Version + 1>(version, packed, call);
  }
  wire::SceneAt<static_cast<wire::SceneVersion>(Version)> at{std::move(packed)};
  const Fault fault = call(at);
  packed = std::move(at.packed);
  return fault;
}

enum Coding : std::uint8_t { kStored, kZstd };
constexpr std::size_t kHead = 2;

constexpr int kZstdLevel = 9;
/// More than this is not believed: a few bytes must not make a reader fill its memory. What packs better is
/// stored as it is.
constexpr std::size_t kMaxExpansion = 32;

/// Leaves what a peer shows and holds.
void keep_seen(Scene& scene) {
  scene.source_file.clear();
  scene.fluid_volumes.clear();
  scene.settle = 0.0;
  scene.gauges.clear();
  scene.regions.clear();
  scene.task.clear();
  for (Fluid& fluid : scene.fluids) fluid.heat = {};
  scene.joints.clear();
  for (Body& body : scene.bodies) {
    body.temperature.reset();
    body.keys.clear();
    body.repeats = body.starts_away = body.blade = false;
    body.pieces = 0;
    body.piece_of = -1;
    body.cut_n_m = 0.0;
  }
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
  if (size > wire::kMaxSceneBytes || size > kMaxExpansion * packed.size())
    return damaged("it claims to be " + std::to_string(size) + " bytes unpacked");
  const std::size_t frame = ZSTD_findFrameCompressedSize(packed.data(), packed.size());
  if (ZSTD_isError(frame) || frame != packed.size()) return damaged("it ends too early or too late");
  Bytes content(static_cast<std::size_t>(size));
  const std::size_t got = ZSTD_decompress(content.data(), content.size(), packed.data(), packed.size());
  if (ZSTD_isError(got) || got != content.size()) return damaged("its compressed data are damaged");
  return content;
}

}  // namespace

std::vector<std::string> images_left_behind(const Scene& scene) {
  std::vector<std::string> told;
  const std::vector<bool> travel = which_travel(scene);
  for (std::size_t i = 0; i < travel.size(); ++i) {
    if (travel[i]) continue;
    told.push_back("image '" + scene.images[i].name + "' stays behind: with the others it is more than the " +
                   std::to_string(wire::kMaxSentImages >> 20) +
                   " MB of pictures that go to peers and into recordings");
  }
  return told;
}

Result<Bytes> pack_scene(const Scene& scene, double spacing, SceneParts parts) {
  PackedScene packed{scene, spacing};
  if (parts == SceneParts::kSeen) keep_seen(packed.scene);
  keep_sent_images(packed.scene);
  const wire::SceneVersion version = version_of(packed.scene);
  wire::send_goals(packed);
  Bytes content;
  if (const Fault fault =
          in_version(version, packed, [&](auto& fields) { return wire::encode(fields, content); })) {
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
  if (ZSTD_isError(size) || size >= content.size() || content.size() > kMaxExpansion * size) {
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
  if (package[0] < kPlainScene || package[0] > kCutScene)
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
  PackedScene packed;
  if (const Fault fault =
          in_version(package[0], packed, [&](auto& fields) { return wire::decode(content, fields); }))
    return damaged(fault.text());
  if (package[0] < kLookedScene)
    for (Fluid& fluid : packed.scene.fluids) fluid = plain(fluid);
  if (!wire::take_goals(packed)) return damaged("goals of its task do not fit its steps");
  return UnpackedScene{std::move(packed.scene), packed.spacing};
}

}  // namespace slosh
