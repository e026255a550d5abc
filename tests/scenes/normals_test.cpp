// Normals that a file gives, as they are used and sent: of unit length, whatever the file has.
#include <algorithm>
#include <limits>

#include "scenes/make/solid.h"
#include "support.h"

namespace slosh {
namespace {

TEST(Normals, AreOfUnitLengthHoweverLongTheyWere) {
  for (const float length : {1e-3f, 5.0f, 1e25f, std::numeric_limits<float>::max()}) {
    make::SceneWriter writer = test::make_cup();
    TriangleMesh mesh;
    mesh.name = "sail";
    mesh.positions = {{0.0f, 0.0f, 0.0f}, {0.1f, 0.0f, 0.0f}, {0.0f, 0.1f, 0.0f}};
    mesh.normals.assign(3, {0.0f, length, 0.5f * length});
    mesh.triangles = {{0, 1, 2}};
    writer.add_node("sail", writer.add_mesh("sail", mesh, writer.add_material("cloth", {})), {}, {});
    const test::TempFolder folder;
    ASSERT_TRUE(writer.write(folder / "sail.glb"));
    const Result<Scene> scene = load_scene(folder / "sail.glb");
    ASSERT_TRUE(scene) << scene.error().text();
    const auto sail = std::find_if(scene.value().meshes.begin(), scene.value().meshes.end(),
                                   [](const TriangleMesh& each) { return each.name == "sail"; });
    ASSERT_NE(sail, scene.value().meshes.end());
    for (const glm::vec3& normal : sail->normals) {
      EXPECT_NEAR(glm::length(normal), 1.0, 1e-5) << length;
      EXPECT_NEAR(normal.y, 2.0 * normal.z, 1e-5) << "and point where they did";
    }
  }
}

}  // namespace
}  // namespace slosh
