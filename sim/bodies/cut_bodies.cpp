#include "sim/bodies/cut_bodies.h"

#include <algorithm>

#include "sim/math/convex.h"

namespace slosh {

std::optional<Error> check_cut_bodies(const Scene& scene) {
  for (const Body& body : scene.bodies) {
    if (body.pieces == 0) continue;
    const TriangleMesh& mesh = scene.meshes[static_cast<std::size_t>(body.mesh)];
    if (mesh.triangles.size() > kMaxCutTriangles || !is_convex<glm::vec3>(mesh.positions, mesh.triangles))
      return Error{"'" + body.name + "'", "may be cut, and is not convex or has too many triangles", ""};
  }
  return std::nullopt;
}

CutBodies::CutBodies(const Scene& scene, const SampledScene& sampled) : spacing_(sampled.spacing) {
  if (std::ranges::none_of(scene.bodies, is_cut)) return;
  family_of_.assign(scene.bodies.size(), -1);
  states_.resize(scene.bodies.size());
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    if (!is_cut(body)) continue;
    if (body.piece_of >= 0) {
      const int family = family_of_[static_cast<std::size_t>(body.piece_of)];
      family_of_[b] = family;
      families_[static_cast<std::size_t>(family)].members.push_back(static_cast<int>(b));
    } else {
      family_of_[b] = static_cast<int>(families_.size());
      Family& family = families_.emplace_back();
      family.name = body.name;
      family.members = {static_cast<int>(b)};
      family.resistance = body.cut_n_m;
      family.mass = body.mass;
      family.solid = convex_solid(scene.meshes[static_cast<std::size_t>(body.mesh)]);
      family.density = body.mass.mass / integrate(family.solid).volume;
      family.surface = sampled.surfaces[b];
      family.field = sampled.distance_fields[b];
    }
    states_[b] = {{}, of(static_cast<int>(b)).solid, of(static_cast<int>(b)).mass};
  }
}

std::vector<std::vector<CutPlane>> CutBodies::all_planes() const {
  std::vector<std::vector<CutPlane>> all;
  for (const State& state : states_) all.push_back(state.planes);
  return all;
}

std::shared_ptr<const BodyCuts> CutBodies::told(std::uint64_t since) const {
  if (std::ranges::all_of(states_, [](const State& state) { return state.planes.empty(); })) return nullptr;
  const auto cuts = std::make_shared<BodyCuts>();
  cuts->since = since;
  for (const State& state : states_) cuts->bodies.push_back({state.planes, state.mass});
  return cuts;
}

Result<PieceShape> CutBodies::shape(int body, std::vector<CutPlane> planes) const {
  const Family& family = of(body);
  const std::string where = "'" + family.name + "'";
  PieceShape shape;
  if (planes.empty()) {
    shape.solid = family.solid;
    shape.mass = family.mass;
    shape.surface = family.surface;
    shape.field = family.field;
    return shape;
  }
  shape.solid = clipped(family.solid, planes);
  // Those that later cuts took all of bound nothing any more.
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const auto is_of = [&](const ConvexSolid::Face& face) { return face.plane == static_cast<int>(i); };
    if (std::ranges::any_of(shape.solid.faces, is_of)) shape.planes.push_back(planes[i]);
  }
  if (shape.planes.size() != planes.size()) shape.solid = clipped(family.solid, shape.planes);
  if (shape.planes.size() > kMaxCutPlanes)
    return Error{where, "would have more than 8 cut faces in one piece", "Cut another piece"};
  for (const CutPlane& plane : shape.planes)
    if (!(extent_along(shape.solid, plane.normal).length() >= spacing_))
      return Error{where, "would have a piece thinner than particles are apart", "Cut farther from its end"};
  const SolidIntegrals solid = integrate(shape.solid);
  if (!(solid.volume > 0.0)) return Error{where, "would have a piece without volume", ""};
  shape.mass = {family.density * solid.volume, solid.center, family.density * solid.inertia};
  shape.surface = samples_within(family.surface, shape.planes, shape.solid);
  shape.field = field_within(family.field, shape.planes);
  return shape;
}

void CutBodies::set(int body, const PieceShape& shape) {
  states_[static_cast<std::size_t>(body)] = {shape.planes, shape.solid, shape.mass};
}

}  // namespace slosh
