#include "scenes/make/paints.h"
#include "scenes/make/shipped.h"

namespace slosh::make {
namespace {

constexpr double kTableThickness = 0.04;

}  // namespace

nlohmann::json list(const glm::dvec3& v) {
  return nlohmann::json::array({v.x, v.y, v.z});
}

void add_table(SceneWriter& writer, double width, double depth, bool solid) {
  Paint paint{.color = {1.0, 1.0, 1.0, 1.0}, .roughness = 0.45};
  paint.base_color_map.image = writer.add_image("boards", wood_picture());
  const int wood = writer.add_material("wood", paint);
  TriangleMesh slab =
      with_normals(box({-0.5 * width, -kTableThickness, -0.5 * depth}, {0.5 * width, 0.0, 0.5 * depth}));
  lay_flat(slab, kWoodTile);
  nlohmann::json extras{{"slosh", "picture"}};
  if (solid) extras = {{"slosh", "body"}, {"motion", "fixed"}, {"viscosity_pa_s", 0.0}, {"friction", 0.5}};
  writer.add_node("table", writer.add_mesh("table", slab, wood), {}, extras);
}

}  // namespace slosh::make
