// The stages of reading a scene; load.cpp calls them in order.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "scenes/gltf/document.h"
#include "scenes/gltf/extras.h"
#include "scenes/scene.h"

namespace slosh::reading {

using Problem = std::optional<Error>;

/// What a node is, by its `slosh` property.
enum class NodeKind { kNone, kPicture, kBody, kFluid, kGrip, kHand, kProbe, kGauge, kRegion, kJoint };

/// A scene under way.
struct Reading {
  const gltf::Document& document;
  Scene scene;
  std::vector<NodeKind> kinds;                 ///< by node
  std::map<int, int> body_of_node;             ///< node → Scene::bodies
  std::vector<int> devices;                    ///< one a grip: its `device`, −1 when not given
  std::vector<int> grip_nodes;                 ///< one a grip
  std::map<std::string, int> declared_fluids;  ///< name → Scene::fluids, from the scene's own extras
  std::size_t triangles = 0;
  /// glTF mesh and baked matrix → Scene::meshes and whether it was found to be closed.
  struct SharedMesh {
    int mesh;
    bool checked;
  };
  std::map<std::tuple<int, std::vector<double>>, SharedMesh> shared;
  std::map<std::string, int> names;   ///< of nodes with a `slosh` property
  std::set<int> failed;               ///< nodes that could not be read
  std::vector<Error> further;         ///< of what is being read, beside the problem that is returned
  std::map<int, Material> materials;  ///< glTF material → what came of it
  std::map<int, int> images;          ///< glTF image → Scene::images, −1 where it could not be read
  std::size_t image_pixels = 0;       ///< of all of these
  std::vector<gltf::Note> notes;      ///< what is said and not done
  std::size_t work = 0;               ///< of all meshes that were read (gltf::work_of_mesh)
  std::vector<int> volume_nodes{};    ///< one a fluid volume
};

/// All stages in order. The first problem ends the reading; with `all` every one is put there instead, but
/// for those that only follow from another (a grip on a body that could not be read). A scene only where
/// there was none. `notes`, where there is one, receives what is in Scene::left_out with its kinds, also of a
/// file with problems.
std::optional<Scene> read_stages(const gltf::Document& document, std::vector<Error>& problems, bool all,
                                 std::vector<gltf::Note>* notes = nullptr);

/// What is wrong with a node: `first`, where there is one, then all that `extras` has. The first of these is
/// returned, the others go to Reading::further; properties that are somebody else's to Reading::notes.
Problem all_of(Reading& reading, Problem first, const gltf::Extras& extras);

/// Sets a node's kind. Errors: unknown `slosh`, a name used twice, a mesh missing.
Problem read_kind(Reading& reading, int node);
/// Errors: something animated that is neither a hand nor a driven body. After all kinds.
Problem check_animated(Reading& reading, int node);

/// Scene extras but the domain's defaults: spacing, gravity, fluids declared by name.
Problem read_scene_fields(Reading& reading);

Problem read_fluid_volume(Reading& reading, int node);
Problem find_carriers(Reading& reading);  ///< FluidVolume::body; after all bodies
Problem read_body(Reading& reading, int node);
Problem read_probe(Reading& reading, int node);
/// The animation of a driven body. Errors: there is none, too fast, too far, it does not meet where it
/// repeats.
Problem read_keys(Reading& reading, int node, Body& body);
/// No error: a picture that cannot be shown is left out, and told in Reading::notes.
Problem read_picture(Reading& reading, int node);
Problem read_grip(Reading& reading, int node);  ///< after all bodies
Problem order_grips(Reading& reading);          ///< after all grips: by `device`, the others behind
Problem read_hand(Reading& reading, int node);  ///< after all grips
/// Tells of keys that the run does not come to.
void note_late_keys(Reading& reading, int node, const std::vector<PoseKey>& keys);
Problem read_joint(Reading& reading, int node);   ///< after all bodies
Problem read_gauge(Reading& reading, int node);   ///< after all bodies
Problem read_region(Reading& reading, int node);  ///< after all bodies
Problem read_task(Reading& reading);              ///< after everything that has a name
Problem read_camera(Reading& reading);            ///< after everything with a size; no error, as of pictures
Problem read_domain(Reading& reading);            ///< likewise
Problem fit_spacing(Reading& reading);  ///< likewise: a coarsest spacing that was not given fits the walls

/// What the mesh is shown with: the material of its first primitive that has one. Images go to Scene::images;
/// what of them cannot be read is left out, and told in Scene::left_out.
Material read_material(Reading& reading, int mesh);

/// The node of the body that a node hangs on; −1 when it hangs on none. After all bodies.
int body_node_above(const Reading& reading, int node);
/// Rigid pose of a node, and what the pose leaves of its transform.
Problem read_pose(const Reading& reading, int node, Pose& pose, glm::dmat3& rest);

/// Errors: some corner of a mesh that takes part is farther than kFarthestPlace from the scene's origin.
Problem check_place(const Reading& reading, int node, int mesh, const Pose& pose);

/// The node's mesh as an index into Scene::meshes, shared between nodes that bake to the same triangles.
/// With `closed`, an open, non-manifold or inward-facing mesh is an error that says how to mend it.
Problem read_node_mesh(Reading& reading, int node, const glm::dmat3& rest, bool closed, int& mesh);

inline constexpr gltf::Range kTemperatures{kColdest, kHottest};

/// What read_fluid_fields reads.
inline constexpr std::array kFluidFields{"density_kg_m3",
                                         "viscosity_pa_s",
                                         "color",
                                         "extinction_per_m",
                                         "gloss",
                                         "refraction",
                                         "scattering",
                                         "roughness",
                                         "temperature_c",
                                         "conductivity_w_m_k",
                                         "heat_capacity_j_kg_k",
                                         "viscosity_at_c",
                                         "sets_above_c",
                                         "sets_below_c",
                                         "sets_in_s",
                                         "set_viscosity_pa_s",
                                         "melts_above_c",
                                         "melts_in_s",
                                         "starts_set",
                                         "set_modulus_pa",
                                         "tears_at"};

/// Fields of a fluid, from a fluid node or from the scene's `fluids`.
void read_fluid_fields(gltf::Extras& extras, Fluid& fluid);
/// Of these what warms and sets; behind the others.
void read_heat(gltf::Extras& extras, Fluid& fluid);

/// World bounds of fluid volumes and bodies.
struct Bounds {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};
};
Bounds bounds_of_scene(const Scene& scene);

}  // namespace slosh::reading
