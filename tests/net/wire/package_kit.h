// Packages of scenes made and looked into, for the tests of what travels.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "net/wire/scene_package.h"

namespace slosh::test {

inline wire::Bytes packed(const Scene& scene, SceneParts parts = SceneParts::kAll) {
  const Result<wire::Bytes> bytes = pack_scene(scene, 0.01, parts);
  EXPECT_TRUE(static_cast<bool>(bytes)) << bytes.error().text();
  return bytes ? bytes.value() : wire::Bytes{};
}

/// A package whose content is stored as it is, so that its bytes can be chosen.
inline wire::Bytes stored(const wire::Bytes& content) {
  wire::Bytes package{1, 0};
  package.insert(package.end(), content.begin(), content.end());
  return package;
}

inline std::string package_error(wire::ByteView package) {
  const Result<UnpackedScene> scene = unpack_scene(package);
  return scene ? "" : scene.error().text();
}

}  // namespace slosh::test
