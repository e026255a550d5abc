// slosh-es-shaders FOLDER: writes the renderer's programs in OpenGL ES 3.0's dialect (gl/es_export.h).
#include <cstdio>

#include "render/gl/es_export.h"

int main(int count, char** words) {
  if (count != 2) {
    std::fprintf(stderr, "usage: slosh-es-shaders FOLDER\n");
    return 2;
  }
  const auto written = slosh::export_es_programs(words[1]);
  if (!written) {
    std::fprintf(stderr, "slosh-es-shaders: %s\n", written.error().text().c_str());
    return 1;
  }
  std::printf("%zu programs in %s, told by programs.json\n", written.value(), words[1]);
}
