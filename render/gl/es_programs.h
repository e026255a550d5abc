// Which of the renderer's programs there are in OpenGL ES 3.0's dialect (es_source.h), and which there are
// not.
#pragma once

#include <string>
#include <vector>

namespace slosh {

/// es_shader_source() takes both files with these defines.
struct EsProgram {
  std::string vertex;
  std::string fragment;
  std::vector<std::string> defines;
};

/// All that a spectator's picture is made of: each pass as fragments, with what the renderer compiles in.
std::vector<EsProgram> es_programs();

struct NotInEs {
  std::string name;  ///< a file of render/shaders, or a define of one
  std::string why;
};

/// The shader files that have no form in ES 3.0; es_shader_source() refuses each.
std::vector<NotInEs> files_not_in_es();

/// Defines of files that have one, which no program of es_programs() is compiled with.
std::vector<NotInEs> defines_not_in_es();

}  // namespace slosh
