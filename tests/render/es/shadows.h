// Shadows in OpenGL ES: where the light's map lies, as passes/shadow_pass has it, and what the fluid dims.
#pragma once

#include "render/passes/frame_block.h"
#include "tests/render/es/canvas.h"
#include "tests/render/es/picture.h"

namespace slosh::es {

struct Shadows {
  ShadowView view;
  std::vector<const MeshInstance*> casters;
};

/// size: texels a side. Every mesh is taken to be convex.
Shadows shadows_of(const Frame& frame, const KeptMeshes& kept, int size);

/// What the fluid takes from the light on its way, per channel, and its top: a texture for
/// shaders/shadow.glsl.
GLuint fluid_shadow(const Frame& frame, const RenderOptions& options, const ShadowView& view, Canvas& canvas);

}  // namespace slosh::es
