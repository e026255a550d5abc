#include "scenes/make/shipped.h"

namespace slosh::make {

nlohmann::json list(const glm::dvec3& v) {
  return nlohmann::json::array({v.x, v.y, v.z});
}

void add_table(SceneWriter& writer, double width, double depth, double thickness) {
  const int wood = writer.add_material("wood", {{0.32, 0.18, 0.09, 1.0}, 0.0, 0.55});
  const Solid slab = box({-0.5 * width, -thickness, -0.5 * depth}, {0.5 * width, 0.0, 0.5 * depth});
  writer.add_node("table", writer.add_mesh("table", slab, wood), {},
                  {{"slosh", "body"}, {"motion", "fixed"}, {"viscosity_pa_s", 0.0}, {"friction", 0.5}});
}

}  // namespace slosh::make
