// A scene as one block of bytes: over the network to a peer, which needs no files, and in recordings and
// checkpoints.
#pragma once

#include "net/wire/messages.h"
#include "scenes/scene.h"
#include "sim/math/result.h"

namespace slosh {

enum class SceneParts {
  kSeen,  ///< what a peer needs: without fluid volumes, meshes that nothing shows, and the file's name
  kAll,   ///< what a host needs to carry on: all
};

/// The scene and its particle spacing (m). Every number comes back bitwise. Names are cleaned and cut
/// (wire::clean_text). Errors: something that a peer could not take, named by its field: more than
/// wire::kMaxBodies bodies, a mesh that reaches further than 10 km, above wire::kMaxSceneBytes in all.
Result<wire::Bytes> pack_scene(const Scene& scene, double spacing, SceneParts parts);

/// The images of textures that pack_scene leaves behind, a sentence each: those that with the ones before
/// them are more than wire::kMaxSentImages bytes.
std::vector<std::string> images_left_behind(const Scene& scene);

struct UnpackedScene {
  Scene scene;
  double spacing = 0.0;  ///< m
};

/// Takes nothing on trust. What comes back is as sound as what load_scene gives, but for closedness of
/// meshes: every index in range, numbers finite and in range, as many normals (and texture coordinates, or
/// none) as positions, hand motions rising in time, free bodies with a mass and an inertia. Images are bytes
/// that nobody has looked at. Allocates a small multiple of what was sent. Errors: what is damaged, and
/// where.
Result<UnpackedScene> unpack_scene(wire::ByteView package);

}  // namespace slosh
