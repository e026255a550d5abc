// Everything that is wrong with a scene file, or not as its maker will have meant it, in one go.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "sim/math/result.h"

namespace slosh {

/// Something that a person should know of a file, in the words of who modelled it.
struct Finding {
  std::string kind;  ///< stays the same over versions: "error", "no-camera", "on-its-side", …
  Error text;        ///< where: "file: node 'cup'" (an object's name in Blender); what; mend
};

struct Inspection {
  std::vector<Finding> errors;    ///< it does not load
  std::vector<Finding> warnings;  ///< it loads, and will surprise
  std::optional<Scene> scene;     ///< where there is no error
};

/// Reads a file as load_scene does, but to its end: everything that is wrong with each object, without what
/// only follows from another error; and looks for what exports from Blender are known to lose
/// (scenes/CHECK.md lists it). What it cannot see: a modifier that was not applied leaves no trace but a mesh
/// that is open or coarse; a scene on its side is told by vessels that are open to where Blender's up went,
/// or by a camera that lies.
Inspection inspect_scene(const std::filesystem::path& file);

}  // namespace slosh
