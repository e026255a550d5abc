// The shader files in the dialect of OpenGL ES 3.0, which browsers speak (WebGL 2).
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/gl/es_lowering.h"
#include "render/gl/shader_source.h"

namespace slosh {

/// What ES 3.0 has no words for in the text: the program's owner sets it by glUniform1i or
/// glUniformBlockBinding.
struct EsBinding {
  std::string name;
  int at = 0;
  bool operator==(const EsBinding&) const = default;
};

struct EsShader {
  std::string text;
  std::vector<EsBinding> textures;  ///< samplers and their units; of an array `name[0]` and on
  std::vector<EsBinding> blocks;    ///< uniform blocks and their binding points
  std::vector<EsBuffer> buffers;    ///< storage buffers that have become textures, and their units
};

/// shader_source() of a vertex or fragment shader in ES 3.0's dialect; es_programs.h lists which. Of the two
/// outputs of one blend the first, or with kSecondOutput among `defines` the second: what blends by both is
/// drawn twice. Errors: an unknown file; one that needs what ES 3.0 lacks, by name (compute shaders, images,
/// buffers that are written).
Result<EsShader> es_shader_source(std::string_view name, std::span<const std::string> defines = {},
                                  std::span<const EmbeddedShader> files = embedded_shaders());

}  // namespace slosh
