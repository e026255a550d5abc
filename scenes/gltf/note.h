// What a file says and the scene that is made of it does not do.
#pragma once

#include <string>

#include "sim/math/result.h"

namespace slosh::gltf {

/// The scene loads without it.
struct Note {
  std::string kind;  ///< stays the same over versions: "shape-key", "skin", "hidden", …
  Error text;
};

}  // namespace slosh::gltf
