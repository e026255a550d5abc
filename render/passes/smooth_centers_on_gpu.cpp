#include "render/passes/smooth_centers_on_gpu.h"

#include <utility>

#include "render/gl/pixel_program.h"

namespace slosh {

Result<SmoothCentersOnGpu> SmoothCentersOnGpu::create() {
  auto program = gl::Program::create_compute("smooth_centers.comp");
  if (!program) return program.error();
  SmoothCentersOnGpu out;
  out.program_ = std::move(program.value());
  return out;
}

void SmoothCentersOnGpu::upload(const SmoothCenters& centers) {
  const SmoothCenters::Cells cells = centers.cells();
  columns_.clear();
  for (const std::vector<float>& column : cells.at)
    columns_.insert(columns_.end(), column.begin(), column.end());
  places_.upload(std::span<const float>(columns_));
  begins_.upload(cells.begin);
}

void SmoothCentersOnGpu::move(const SmoothCenters& centers, float particle_radius,
                              const gl::StreamBuffer& spheres, gl::StreamBuffer& shapes,
                              std::size_t count) const {
  const SmoothCenters::Cells cells = centers.cells();
  shapes.reserve(count * sizeof(SplatShape));
  program_.set("column", static_cast<int>(cells.at[0].size()));
  program_.set("lowest", cells.lowest);
  program_.set("cells", cells.count);
  program_.set("lengths", glm::vec2(cells.reach, particle_radius));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, spheres.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, shapes.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, places_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, begins_.name());
  gl::run_each(program_, count);
}

}  // namespace slosh
