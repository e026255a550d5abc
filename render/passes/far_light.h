// A user's or our own picture of a room as textures: what shaders/environment.glsl reads with FAR_LIGHT.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/environment.h"
#include "render/gl/objects.h"

namespace slosh {

class FarLight {
 public:
  /// Null: the studio's formula, nothing is made.
  void choose(std::shared_ptr<const Environment> environment);
  bool shows(const std::shared_ptr<const Environment>& environment) const {
    return environment_ == environment;
  }
  /// Of the programs that include environment.glsl.
  std::vector<std::string> defines() const;
  /// For the passes of a frame.
  void bind() const;

 private:
  std::shared_ptr<const Environment> environment_;
  gl::Texture sharp_;
  gl::Texture blurred_;
  gl::StreamBuffer diffuse_;
};

}  // namespace slosh
