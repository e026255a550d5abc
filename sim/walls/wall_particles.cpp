#include "sim/walls/wall_particles.h"

#include <cmath>

#include "sim/viscosity/wall_drag.h"
#include "sim/walls/body_sheet.h"
#include "sim/walls/joined_walls.h"
#include "sim/walls/point_buckets.h"
#include "sim/walls/sheet.h"

namespace slosh {

namespace {

// The particles of the fixed bodies that touch others, and what each stands for, body by body; empty for all
// other bodies.
struct JoinedWalls {
  std::vector<std::vector<SheetParticle>> sheets;  // mesh frame
  std::vector<std::vector<float>> shares;
};

JoinedWalls joined_walls(const Scene& scene, const SampledScene& sampled, const Plan& plan, DragSheet drags) {
  JoinedWalls walls{std::vector<std::vector<SheetParticle>>(scene.bodies.size()),
                    std::vector<std::vector<float>>(scene.bodies.size())};
  if (!corrects_gradients(plan.model)) return walls;
  const float spacing = static_cast<float>(plan.spacing);
  auto [solids, body_of] = fixed_solids(scene, sampled);
  for (FixedSolid& solid : solids)
    solid.depth = sheet_depths(scene, plan, solid.surface->apart, drags).flat * spacing;
  std::vector<std::vector<SheetParticle>> sheets = joined_sheets(solids, spacing);
  std::vector<SheetParticle> all;
  for (std::size_t n = 0; n < sheets.size(); ++n)
    for (const SheetParticle& p : sheets[n]) all.push_back(moved(solids[n].pose, p));
  const std::vector<float> shares = sheet_shares(all, plan);
  auto next = shares.begin();
  for (std::size_t n = 0; n < sheets.size(); ++n) {
    const auto end = next + static_cast<std::ptrdiff_t>(sheets[n].size());
    walls.shares[body_of[n]].assign(next, end);
    walls.sheets[body_of[n]] = std::move(sheets[n]);
    next = end;
  }
  return walls;
}

// Samples of a body's surface, in its mesh frame.
struct DraggingSheet {
  std::vector<glm::vec3> positions, normals;
};

// Where the bodies whose motion is `motion` drag, body by body: the samples of their surfaces but for those
// that another fixed body hides.
std::vector<DraggingSheet> dragging_sheets(const Scene& scene, const SampledScene& sampled, const Plan& plan,
                                           BodyMotion motion) {
  std::vector<DraggingSheet> sheets(scene.bodies.size());
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    if (body.motion == motion && !body.point_probe)
      sheets[b] = {sampled.surfaces[b].positions, sampled.surfaces[b].normals};
  }
  if (motion == BodyMotion::kFree) return sheets;
  const auto [solids, body_of] = fixed_solids(scene, sampled);
  const std::vector<std::vector<std::uint32_t>> exposed =
      exposed_samples(solids, static_cast<float>(plan.spacing));
  for (std::size_t n = 0; n < exposed.size(); ++n) {
    const SurfaceSamples& all = *solids[n].surface;
    DraggingSheet& sheet = sheets[body_of[n]] = {};
    for (const std::uint32_t i : exposed[n]) {
      sheet.positions.push_back(all.positions[i]);
      sheet.normals.push_back(all.normals[i]);
    }
  }
  return sheets;
}

// The planes in which a body mirrors the fluid, one a particle of its sheet: where it is fixed and slips. A
// moving one only lets fluid slide.
std::vector<MirrorPlane> mirrors_of(const Body& body, const DraggingSheet& sheet, const Plan& plan) {
  if (body.motion != BodyMotion::kFixed || body.dynamic_viscosity != kFreeSlip) return {};
  const glm::mat3 turn(glm::mat3_cast(body.pose.orientation));
  std::vector<glm::vec3> normals;
  normals.reserve(sheet.normals.size());
  std::vector<glm::vec3> positions;
  positions.reserve(sheet.positions.size());
  for (const glm::vec3& n : sheet.normals) normals.push_back(turn * n);
  for (const glm::vec3& p : sheet.positions) positions.push_back(turn * p);
  return mirror_planes(positions, normals, static_cast<float>(plan.support_radius));
}

}  // namespace

std::vector<SurfaceParticle> surface_particles(const Scene& scene, const SampledScene& sampled,
                                               const Plan& plan, BodyMotion motion) {
  std::vector<SurfaceParticle> particles;
  if (!plan.has(PassId::kWalls)) return particles;
  const DragSheet sheet = drag_sheet(scene, plan);
  const bool apart = sheet == DragSheet::kSurface;  // what presses and what drags
  const float lattice_volume = static_cast<float>(std::pow(plan.spacing, 3));
  const WallDrag drag = wall_drag(plan.model, scene.support_ratio, sheet);
  const auto flat_drag = static_cast<float>(drag.factor(0.0));
  const auto support = static_cast<float>(plan.support_radius);
  JoinedWalls joined;
  if (motion == BodyMotion::kFixed) joined = joined_walls(scene, sampled, plan, sheet);
  std::vector<DraggingSheet> dragging;
  if (apart) dragging = dragging_sheets(scene, sampled, plan, motion);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    if (body.motion != motion || body.point_probe) continue;
    std::vector<SheetParticle> pressing;
    std::vector<float> pressures;
    if (motion == BodyMotion::kFixed && !joined.sheets[b].empty()) {
      pressing = std::move(joined.sheets[b]);
      pressures = std::move(joined.shares[b]);
    } else {
      const SurfaceSamples& surface = sampled.surfaces[b];
      pressing = body_sheet(surface, sampled.distance_fields[b].view(), sampled.solids[b].get(), plan,
                            sheet_depths(scene, plan, surface.apart, sheet));
      pressures.assign(pressing.size(), static_cast<float>(plan.body_pressure[b]));
      if (plan.model != ParticleModel::kPaper) pressures = sheet_shares(pressing, plan);
    }
    const auto add = [&](const glm::vec3& at, float pressure, float volume, float lacks = 0.0f,
                         const MirrorPlane& mirror = {}) {
      particles.push_back({at, static_cast<std::uint16_t>(b), pressure, volume,
                           static_cast<float>(body.dynamic_viscosity), support - lacks, mirror});
    };
    for (std::size_t i = 0; i < pressing.size(); ++i) {
      const float volume = plan.model == ParticleModel::kPaper
                               ? sampled.surfaces[b].particle_volume
                               : pressures[i] / kWallShare * lattice_volume * flat_drag;
      add(pressing[i].position, pressures[i], apart ? 0.0f : volume, pressing[i].lacks);
    }
    if (!apart) continue;
    const float surface_volume = sampled.surfaces[b].particle_volume;
    const std::vector<MirrorPlane> mirrors = mirrors_of(body, dragging[b], plan);
    if (!mirrors.empty()) {
      const double factor = mirror_factor(scene.support_ratio, sheet);
      const float volume = static_cast<float>(factor) * surface_volume;
      for (std::size_t i = 0; i < mirrors.size(); ++i)
        add(dragging[b].positions[i], 0.0f, volume, 0.0f, mirrors[i]);
      continue;
    }
    const SolidShape* solid = sampled.solids[b].get();
    for (std::size_t i = 0; i < dragging[b].positions.size(); ++i) {
      const glm::vec3& p = dragging[b].positions[i];
      const float bent =
          solid ? bend(*solid, p, dragging[b].normals[i], static_cast<float>(plan.spacing)) : 0.0f;
      add(p, 0.0f, static_cast<float>(drag.factor(bent)) * surface_volume);
    }
  }
  return particles;
}

}  // namespace slosh
