// The field lists of a scene. Numbers keep every bit: a host that carries on from a recording must step the
// same world. The limits are those of scenes/FIELDS.md, or a network's (limits.h) where these are tighter.
#pragma once

#include "net/wire/cuts.h"
#include "net/wire/messages.h"
#include "scenes/scene.h"

namespace slosh::wire {

constexpr std::size_t kMaxMeshes = 4096;
constexpr std::size_t kMaxMeshVertices = 6'000'000;
constexpr std::size_t kMaxMeshTriangles = 2'000'000;
constexpr std::size_t kMaxPictures = 4096;
constexpr std::size_t kMaxInstruments = 1000;  // of each kind
constexpr std::size_t kMaxPoseKeys = 1'000'000;
constexpr std::size_t kMaxSentImages = 16u
                                       << 20;  ///< bytes of all that travel; pack_scene leaves others behind
constexpr double kMaxDomain = 1e9;             ///< m
constexpr double kMaxSettle = 60.0;            ///< s

constexpr std::array kBodyMotionNames{"fixed", "free", "driven"};

template <class V>
void visit_exact(V& v, Pose& m) {
  v.vec3_exact("position", m.position, kMaxPosition);
  v.rotation_exact("orientation", m.orientation);
}

template <class V>
void visit(V& v, TriangleMesh& m) {
  v.text("name", m.name, kMaxText);
  v.list("positions", m.positions, kMaxMeshVertices,
         [](auto& each, glm::vec3& p) { each.vec3("position", p, kMaxPosition); });
  const std::size_t count = m.positions.size();
  v.list_as_long("normals", m.normals, "positions", count,
                 [](auto& each, glm::vec3& n) { each.direction("normal", n); });
  v.list("triangles", m.triangles, kMaxMeshTriangles, [count](auto& each, glm::uvec3& t) {
    each.below("a", t.x, kMaxMeshVertices - 1, "positions", count);
    each.below("b", t.y, kMaxMeshVertices - 1, "positions", count);
    each.below("c", t.z, kMaxMeshVertices - 1, "positions", count);
  });
}

template <class V>
void visit(V& v, Material& m) {
  v.real32("red", m.base_color.x, 0.0, 1.0);
  v.real32("green", m.base_color.y, 0.0, 1.0);
  v.real32("blue", m.base_color.z, 0.0, 1.0);
  v.real32("metallic", m.metallic, 0.0, 1.0);
  v.real32("roughness", m.roughness, 0.0, 1.0);
  v.real32("opacity", m.opacity, 0.0, 1.0);
}

template <class V>
void visit(V& v, Fluid& m) {
  v.text("name", m.name, kMaxText);
  v.real64("rest_density", m.rest_density, 1e-6, 1e6);
  v.real64("dynamic_viscosity", m.dynamic_viscosity, 0.0, kMaxViscosity);
  v.real32("red", m.color.x, 0.0, 1.0);
  v.real32("green", m.color.y, 0.0, 1.0);
  v.real32("blue", m.color.z, 0.0, 1.0);
  v.real32("extinction_red", m.extinction.x, 0.0, 1e5);
  v.real32("extinction_green", m.extinction.y, 0.0, 1e5);
  v.real32("extinction_blue", m.extinction.z, 0.0, 1e5);
}

template <class V>
void visit(V& v, Body& m, std::size_t meshes) {
  v.text("name", m.name, kMaxText);
  v.index("mesh", m.mesh, "meshes", meshes, true);
  v.choice("motion", m.motion, kBodyMotionNames);
  v.flag("point_probe", m.point_probe);
  v.rule("mesh", m.mesh >= 0 || m.point_probe, "is missing");
  visit_exact(v, m.pose);
  v.vec3_exact("linear", m.twist.linear, kMaxSpeed);
  v.vec3_exact("angular", m.twist.angular, kMaxSpeed);
  visit(v, m.mass);
  v.rule("mass", m.motion != BodyMotion::kFree || m.mass.mass > 0.0, "is 0 on a free body");
  v.rule("inertia_x", m.motion != BodyMotion::kFree || can_turn(m.mass.inertia),
         "is not the inertia of a solid");
  v.real64("particle_density", m.particle_density, 0.0, 1e6);
  v.real64("dynamic_viscosity", m.dynamic_viscosity, kFreeSlip, kMaxViscosity);
  v.rule("dynamic_viscosity",
         m.dynamic_viscosity >= 0.0 || m.dynamic_viscosity == kFluidsViscosity ||
             m.dynamic_viscosity == kFreeSlip,
         "is below 0 and neither -1 nor -2");
  v.real64("friction", m.friction, 0.0, 10.0);
  v.real64("restitution", m.restitution, 0.0, 1.0);
  v.flag("measured", m.measured);
  visit(v, m.material);
}

template <class V>
void visit_keys(V& v, const char* name, std::vector<PoseKey>& keys) {
  double before = -1.0;
  v.list(name, keys, kMaxPoseKeys, [&before](auto& each, PoseKey& key) {
    each.real64("time", key.time, 0.0, kMaxTime);
    each.rule("time", key.time > before, "does not rise");
    before = key.time;
    visit_exact(each, key.pose);
  });
}

template <class V>
void visit(V& v, Grip& m, const std::vector<Body>& bodies) {
  v.text("name", m.name, kMaxText);
  v.index("body", m.body, "bodies", bodies.size(), false);
  const bool there = m.body >= 0 && static_cast<std::size_t>(m.body) < bodies.size();
  v.rule("body", there && bodies[static_cast<std::size_t>(m.body)].motion == BodyMotion::kFree,
         "is not free");
  visit_exact(v, m.pose);
  v.real64("stiffness", m.stiffness, 0.0, 1e6);
  v.real64("damping", m.damping, 0.0, 1e4);
  v.real64("rotational_stiffness", m.rotational_stiffness, 0.0, 1e4);
  v.real64("rotational_damping", m.rotational_damping, 0.0, 1e3);
  visit_keys(v, "hand_motion", m.hand_motion);
}

template <class V>
void visit(V& v, Camera& m) {
  v.vec3_exact("eye", m.eye, kMaxDomain);
  v.vec3_exact("target", m.target, kMaxDomain);
  v.rule("target", glm::length(m.target - m.eye) > 1e-9, "is where the eye is");
  v.real64("vertical_fov_deg", m.vertical_fov_deg, 1.0, 150.0);
}

template <class V>
void visit(V& v, Scene& m) {
  v.text("name", m.name, kMaxText);
  v.text("title", m.title, kMaxText);
  v.text("source_file", m.source_file, kMaxText);
  v.list("meshes", m.meshes, kMaxMeshes, [](auto& each, TriangleMesh& mesh) { visit(each, mesh); });
  v.list("fluids", m.fluids, kMaxFluids, [](auto& each, Fluid& fluid) { visit(each, fluid); });
  const std::size_t meshes = m.meshes.size();
  const std::size_t fluids = m.fluids.size();
  v.list("fluid_volumes", m.fluid_volumes, kMaxFluidVolumes, [&](auto& each, FluidVolume& volume) {
    each.text("name", volume.name, kMaxText);
    each.index("mesh", volume.mesh, "meshes", meshes, false);
    each.index("fluid", volume.fluid, "fluids", fluids, false);
    visit_exact(each, volume.pose);
    each.vec3_exact("velocity", volume.velocity, kMaxSpeed);
  });
  v.list("bodies", m.bodies, kMaxBodies, [&](auto& each, Body& body) { visit(each, body, meshes); });
  v.list("pictures", m.pictures, kMaxPictures, [&](auto& each, Picture& picture) {
    each.text("name", picture.name, kMaxText);
    each.index("mesh", picture.mesh, "meshes", meshes, false);
    visit_exact(each, picture.pose);
    visit(each, picture.material);
  });
  v.list("grips", m.grips, kMaxGrips, [&](auto& each, Grip& grip) { visit(each, grip, m.bodies); });
  visit(v, m.camera);
  v.vec3("light_direction", m.light_direction, 1e3);
  v.rule("light_direction", glm::length(m.light_direction) >= 1e-3f, "has no length");
  v.vec3_exact("gravity", m.gravity, 1e4);
  v.real64("spacing", m.spacing, 0.0, 10.0);
  v.real64("spacing_min", m.spacing_min, 1e-5, 10.0);
  v.real64("spacing_max", m.spacing_max, 1e-5, 10.0);
  v.rule("spacing_min", m.spacing_min <= m.spacing_max, "is above spacing_max");
  v.real64("support_ratio", m.support_ratio, 1.5, 4.0);
  v.choice_from("model", m.model, kFirstParticleModel, kParticleModelNames,
                "is the model `consistent`, which is no more: `corrected` took its place");
  v.real64("stiffness", m.stiffness, 0.0, 1e12);
  v.real64("tension", m.tension, 0.0, 1.0);
  v.real64("duration", m.duration, 1e-6, kMaxTime);
  v.vec3_exact("domain_min", m.domain_min, kMaxDomain);
  v.vec3_exact("domain_max", m.domain_max, kMaxDomain);
  v.rule("domain_min", glm::all(glm::lessThan(m.domain_min, m.domain_max)), "is not below domain_max");
}

template <class V>
void visit_instruments(V& v, Scene& scene) {
  const std::size_t bodies = scene.bodies.size();
  const std::size_t meshes = scene.meshes.size();
  v.list("gauges", scene.gauges, kMaxInstruments, [bodies](auto& each, Gauge& gauge) {
    each.text("name", gauge.name, kMaxText);
    each.index("body", gauge.body, "bodies", bodies, true);
    each.vec3_exact("position", gauge.position, kMaxPosition);
  });
  v.list("regions", scene.regions, kMaxInstruments, [bodies, meshes](auto& each, Region& region) {
    each.text("name", region.name, kMaxText);
    each.index("mesh", region.mesh, "meshes", meshes, false);
    each.index("body", region.body, "bodies", bodies, true);
    visit_exact(each, region.pose);
  });
}

/// How fluids look beyond their colour.
template <class V>
void visit_looks(V& v, Scene& scene) {
  v.each_of("looks", scene.fluids, "fluids", [](auto& each, Fluid& fluid) {
    each.real32("gloss", fluid.gloss, 0.0, 1.0);
    each.real32("refraction", fluid.refraction, 1.0, 3.0);
    each.real32("scattering", fluid.scattering, 0.0, 1.0);
    each.real32("roughness", fluid.roughness, 0.0, 1.0);
  });
}

inline constexpr std::array kWrapNames{"repeat", "mirror", "clamp"};
inline constexpr std::array kShrinkNames{
    "nearest",          "linear", "nearest_mip_nearest", "linear_mip_nearest", "nearest_mip_linear",
    "linear_mip_linear"};

template <class V>
void visit(V& v, TextureMap& m, std::size_t images) {
  v.index("image", m.image, "images", images, true);
  v.choice("wrap_u", m.sampling.wrap_u, kWrapNames);
  v.choice("wrap_v", m.sampling.wrap_v, kWrapNames);
  v.choice("shrink", m.sampling.shrink, kShrinkNames);
  v.flag("nearest", m.sampling.nearest);
}

/// Of the bodies, then of the pictures.
template <class Visit>
void each_material(Scene& scene, Visit&& visit) {
  for (Body& body : scene.bodies) visit(body.material);
  for (Picture& picture : scene.pictures) visit(picture.material);
}

/// What of a material is not in its body's or picture's own list.
template <class V>
void visit_more(V& v, Material& m, std::size_t images) {
  for (float* channel : {&m.emissive.x, &m.emissive.y, &m.emissive.z})
    v.real32("emissive", *channel, 0.0, 100.0);
  v.real32("alpha_cutoff", m.alpha_cutoff, 0.0, 1.0);
  visit(v, m.maps.base_color, images);
  visit(v, m.maps.metallic_roughness, images);
  visit(v, m.maps.normal, images);
  visit(v, m.maps.occlusion, images);
  visit(v, m.maps.emissive, images);
  v.real32("normal_scale", m.maps.normal_scale, -10.0, 10.0);
  v.real32("occlusion_strength", m.maps.occlusion_strength, 0.0, 1.0);
}

template <class V>
void visit_textures(V& v, Scene& scene) {
  v.list("images", scene.images, kMaxImages, [](auto& each, SceneImage& image) {
    each.text("name", image.name, kMaxText);
    each.bytes("bytes", image.bytes, 0, kMaxSentImages);
  });
  v.each_of("texcoords", scene.meshes, "meshes", [](auto& each, TriangleMesh& mesh) {
    each.list("of_mesh", mesh.texcoords, kMaxMeshVertices, [](auto& of, glm::vec2& t) {
      of.real32("u", t.x, -1e4, 1e4);
      of.real32("v", t.y, -1e4, 1e4);
    });
    each.rule("of_mesh", mesh.texcoords.empty() || mesh.texcoords.size() == mesh.positions.size(),
              "is not one for each position");
  });
  std::vector<Material> materials;
  each_material(scene, [&](const Material& material) { materials.push_back(material); });
  const std::size_t images = scene.images.size();
  v.each_of("materials", materials, "bodies and pictures",
            [images](auto& each, Material& material) { visit_more(each, material, images); });
  auto read = materials.begin();
  each_material(scene, [&](Material& material) { material = *read++; });
}

}  // namespace slosh::wire
