// Reading a scene from glTF, and finding the shipped ones.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "sim/math/result.h"

namespace slosh {

struct SceneEntry {
  std::string name;   ///< what the user types
  std::string title;  ///< one line
  std::filesystem::path file;
};

/// The shipped scenes, in the order they are listed to the user. Reads only titles, not meshes.
/// The folder: $SLOSH_SCENES; else scenes or ../share/slosh/scenes beside this program or library; else the
/// build's.
std::vector<SceneEntry> shipped_scenes();

/// Resolves a shipped name, or a path to a .gltf or .glb, to a file. An unknown name lists the known ones.
Result<std::filesystem::path> find_scene(const std::string& name_or_path);

/// Reads and validates a scene: every accessor's bounds, every value's range, every mesh closed and outward
/// where it must be, mass properties filled in. Never throws, never asserts on a file's content.
Result<Scene> load_scene(const std::filesystem::path& file);

}  // namespace slosh
