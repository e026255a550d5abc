// Where in a scene an error of its sampling is.
#pragma once

#include <string>

#include "scenes/scene.h"

namespace slosh::sampling {

/// `thing` behind the scene's file, where it was read from one.
inline std::string place_of(const Scene& scene, const std::string& thing) {
  return scene.source_file.empty() ? thing : scene.source_file + ": " + thing;
}

}  // namespace slosh::sampling
