// What each node is, where it stands, and its mesh.
#include <cmath>
#include <cstdio>

#include "scenes/gltf/meshes.h"
#include "scenes/mesh/closed.h"
#include "scenes/mesh/tree.h"
#include "scenes/reading/reading.h"
#include "sim/math/limits.h"

namespace slosh::reading {
namespace {

constexpr const char* kKinds[] = {"picture", "body",  "fluid",  "grip", "hand",
                                  "probe",   "gauge", "region", "joint"};

/// In the words of who modelled it: world, z up (glTF's y is up).
std::string point_text(const glm::dvec3& p) {
  char text[96];
  std::snprintf(text, sizeof(text), "(%.4g, %.4g, %.4g) m in Blender's world, z up", p.x + 0.0, 0.0 - p.z,
                p.y + 0.0);
  return text;
}

std::string defects_text(const mesh::Defects& d) {
  std::string text;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  };
  add(d.open_edges, "boundary edges (holes)");
  add(d.crowded_edges, "edges with more than two faces");
  add(d.flipped_edges, "edges whose faces look opposite ways");
  return text;
}

Problem check_parts(const mesh::WeldedMesh& welded, const mesh::Components& parts, const std::string& where,
                    const Pose& pose) {
  const char* const mend = "In Blender: Edit Mode, select all, Mesh > Normals > Recalculate Outside";
  const mesh::VolumeIntegrals whole = mesh::integrate_volume(welded, parts);
  if (!(whole.volume > 1e-12)) {
    return Error{where,
                 whole.volume < 0.0
                     ? "its faces look inward (volume " + gltf::short_number(whole.volume) + " m³)"
                     : "it encloses no volume",
                 mend};
  }
  if (parts.count == 1) return std::nullopt;
  // A part that faces inward is a cavity when it lies inside another part, and a mistake otherwise. Inside
  // the cavity's own faces the whole winds to 0, so the test point is moved out to where the other part is.
  for (int part = 0; part < parts.count; ++part) {
    if (mesh::integrate_volume(welded, parts, part).volume > 0.0) continue;
    TriangleMesh others;
    others.positions.assign(welded.points.begin(), welded.points.end());
    glm::dvec3 point(0.0);
    for (std::size_t t = 0; t < welded.triangles.size(); ++t) {
      if (parts.of_triangle[t] == part)
        point = welded.points[welded.triangles[t].x];
      else
        others.triangles.push_back(welded.triangles[t]);
    }
    if (!mesh::MeshTree(others).inside(glm::vec3(point))) {
      return Error{where,
                   "the faces of the part at " + point_text(transform_point(pose, point)) + " look inward",
                   mend};
    }
  }
  return std::nullopt;
}

Problem check_closed(TriangleMesh& triangles, const std::string& where, const Pose& pose) {
  mesh::WeldedMesh welded = mesh::weld(triangles);
  if (mesh::drop_inner_faces(triangles, welded)) welded = mesh::weld(triangles);
  mesh::Components parts;
  const mesh::Defects defects = mesh::find_defects(welded, &parts);
  if (defects.any()) {
    return Error{where,
                 "is not closed: " + defects_text(defects) + ", the first at " +
                     point_text(transform_point(pose, defects.where)),
                 "Where a Solidify modifier gives the wall: export with Data > Mesh > Apply Modifiers. Else "
                 "in Blender: Edit Mode, "
                 "select all, Mesh > Merge > By Distance, Mesh > Clean Up > Fill Holes, Mesh > Normals > "
                 "Recalculate Outside"};
  }
  return check_parts(welded, parts, where, pose);
}

}  // namespace

Problem read_kind(Reading& reading, int node) {
  const gltf::Document& document = reading.document;
  const bool has_mesh = document.model.nodes[node].mesh >= 0;
  gltf::Extras extras(document.extras[node], document.owner(node));
  if (!extras.has("slosh")) {
    if (has_mesh) reading.kinds[node] = NodeKind::kPicture;
    return std::nullopt;
  }
  const std::string kind = extras.choice(
      "slosh", "",
      {kKinds[0], kKinds[1], kKinds[2], kKinds[3], kKinds[4], kKinds[5], kKinds[6], kKinds[7], kKinds[8]});
  constexpr NodeKind kOrder[] = {NodeKind::kPicture, NodeKind::kBody,   NodeKind::kFluid,
                                 NodeKind::kGrip,    NodeKind::kHand,   NodeKind::kProbe,
                                 NodeKind::kGauge,   NodeKind::kRegion, NodeKind::kJoint};
  for (std::size_t i = 0; i < std::size(kKinds); ++i) {
    if (kind == kKinds[i]) reading.kinds[node] = kOrder[i];
  }
  if (reading.kinds[node] == NodeKind::kNone) return extras.error();
  if (kind == "picture" && !has_mesh) {
    reading.kinds[node] = NodeKind::kNone;
    reading.notes.push_back({"picture",
                             {document.owner(node), "is to be looked at, and has no mesh that can be drawn",
                              "Put the property on a mesh object, or take it out"}});
    return std::nullopt;
  }
  const bool needs_mesh = kind == "body" || kind == "fluid" || kind == "region";
  if (needs_mesh && !has_mesh) {
    reading.kinds[node] = NodeKind::kNone;
    extras.fail("slosh", "is \"" + kind + "\", but the node has no mesh",
                "Put the property on the mesh object");
    return extras.error();
  }
  if (kind != "picture" && !reading.names.emplace(document.name(node), node).second) {
    reading.kinds[node] = NodeKind::kNone;
    return Error{
        document.owner(node), "another node has this name too",
        "Give every node its own name. In Blender a collection instance repeats the names of what it holds: "
        "Object > Apply > Make Instances Real, then name what came of it"};
  }
  return std::nullopt;
}

Problem check_animated(Reading& reading, int node) {
  const NodeKind kind = reading.kinds[node];
  if (kind == NodeKind::kNone || kind == NodeKind::kPicture || kind == NodeKind::kHand) return std::nullopt;
  if (!reading.document.animated[static_cast<std::size_t>(node)]) return std::nullopt;
  const nlohmann::json& extras = reading.document.extras[node];
  if (kind == NodeKind::kBody && extras.contains("motion") && extras["motion"] == "driven")
    return std::nullopt;
  for (const tinygltf::Animation& animation : reading.document.model.animations) {
    for (const tinygltf::AnimationChannel& channel : animation.channels) {
      if (channel.target_node != node) continue;
      return Error{
          reading.document.owner(node) + ": animation '" + animation.name + "'",
          "only a hand can be animated, or a body that is driven; other bodies and fluids move by physics, "
          "gauges, regions and joints with a body",
          "Give the body motion = \"driven\"; or animate an empty with slosh = \"hand\" and grip = \"<grip's "
          "name>\" instead"};
    }
  }
  return std::nullopt;
}

Problem read_pose(const Reading& reading, int node, Pose& pose, glm::dmat3& rest) {
  const glm::dmat4& world = reading.document.world[node];
  pose.position = glm::dvec3(world[3]);
  if (glm::any(glm::greaterThan(glm::abs(pose.position), glm::dvec3(gltf::kFarthest))))
    return Error{reading.document.owner(node) + ": translation",
                 "puts it further than 10 km from the scene's origin", "Work in metres, near the origin"};
  if (gltf::split_rotation(glm::dmat3(world), pose.orientation, rest)) return std::nullopt;
  return Error{reading.document.owner(node) + ": scale", "is zero along some axis, or far too large",
               "Give it a scale other than 0"};
}

Problem check_place(const Reading& reading, int node, int mesh, const Pose& pose) {
  const auto check = [&](const glm::dvec3& place) -> Problem {
    if (!glm::any(glm::greaterThan(glm::abs(place), glm::dvec3(kFarthestPlace)))) return std::nullopt;
    return Error{reading.document.owner(node),
                 "reaches to " + point_text(place) + ", farther than " + gltf::short_number(kFarthestPlace) +
                     " m from the scene's origin: places there are too coarse to simulate",
                 "Move everything near the origin; sizes are in metres (is the file in millimetres?)"};
  };
  if (mesh < 0) return check(pose.position);
  for (const glm::vec3& p : reading.scene.meshes[static_cast<std::size_t>(mesh)].positions)
    if (Problem problem = check(transform_point(pose, glm::dvec3(p)))) return problem;
  return std::nullopt;
}

Problem read_node_mesh(Reading& reading, int node, const glm::dmat3& rest, bool closed, int& mesh) {
  const gltf::Document& document = reading.document;
  const int source = document.model.nodes[node].mesh;
  std::vector<double> matrix;
  for (int c = 0; c < 3; ++c) {
    // Rounded: two poses of one mesh differ in the last digits of their rest.
    for (int r = 0; r < 3; ++r) matrix.push_back(std::round(rest[c][r] * 1e9) * 1e-9 + 0.0);
  }
  const std::string where = document.owner(node);
  const auto key = std::make_tuple(source, matrix);
  auto found = reading.shared.find(key);
  if (found == reading.shared.end()) {
    reading.work += gltf::work_of_mesh(document, source);
    if (reading.work > gltf::kMaxNumbersRead) {
      return Error{where,
                   "the meshes up to here have more than " +
                       std::to_string(gltf::kMaxNumbersRead / 1'000'000) +
                       " million vertices and indices, each counted as often as a mesh asks for it",
                   "Use fewer meshes, or reduce them, in Blender with the Decimate modifier"};
    }
    Result<TriangleMesh> read = gltf::read_mesh(document, source, rest, where);
    if (!read) return read.error();
    reading.triangles += read.value().triangles.size();
    if (reading.triangles > gltf::kMaxTriangles) {
      return Error{where, "the scene has more than " + std::to_string(gltf::kMaxTriangles) + " triangles",
                   "Reduce the meshes, in Blender with the Decimate modifier"};
    }
    reading.scene.meshes.push_back(std::move(read.value()));
    found = reading.shared
                .emplace(key, Reading::SharedMesh{static_cast<int>(reading.scene.meshes.size()) - 1, false})
                .first;
  }
  mesh = found->second.mesh;
  if (closed && !found->second.checked) {
    TriangleMesh& triangles = reading.scene.meshes[mesh];
    Pose pose;
    glm::dmat3 unused;
    if (Problem problem = read_pose(reading, node, pose, unused)) return problem;
    if (Problem problem = check_closed(triangles, where + ": mesh '" + triangles.name + "'", pose))
      return problem;
    found->second.checked = true;
  }
  return std::nullopt;
}

}  // namespace slosh::reading
