// The scene's own custom properties, and what is worked out when they are absent.
#include <algorithm>

#include "scenes/mesh/closed.h"
#include "scenes/reading/reading.h"
#include "scenes/sample.h"

namespace slosh::reading {

void read_fluid_fields(gltf::Extras& extras, Fluid& fluid) {
  fluid.rest_density = extras.number("density_kg_m3", fluid.rest_density, gltf::Range{0.0, 1e5, true});
  fluid.dynamic_viscosity = extras.number("viscosity_pa_s", fluid.dynamic_viscosity, gltf::Range{0.0, 1e7});
  fluid.color = glm::vec3(extras.vector("color", glm::dvec3(fluid.color), gltf::Range{0.0, 1.0}));
  fluid.extinction =
      glm::vec3(extras.vector("extinction_per_m", glm::dvec3(fluid.extinction), gltf::Range{0.0, 1e5}));
  const auto number = [&](const char* key, float otherwise, const gltf::Range& range) {
    return static_cast<float>(extras.number(key, otherwise, range));
  };
  fluid.gloss = number("gloss", fluid.gloss, {0.0, 1.0});
  fluid.refraction = number("refraction", fluid.refraction, {1.0, 3.0});
  fluid.scattering = number("scattering", usual_scattering(fluid.extinction), {0.0, 1.0});
  fluid.roughness = number("roughness", fluid.roughness, {0.0, 1.0});
  read_heat(extras, fluid);
}

Problem read_scene_fields(Reading& reading) {
  const gltf::Document& document = reading.document;
  Scene& scene = reading.scene;
  const std::string owner = document.file + ": scene";
  gltf::Extras extras(document.scene_extras, owner);
  scene.title = extras.text("title", scene.name);
  scene.gravity = extras.vector("gravity_m_s2", scene.gravity, gltf::Range{-1000.0, 1000.0});
  scene.spacing = extras.number("spacing_m", 0.0, gltf::Range{0.0, 1.0});
  scene.spacing_min = extras.number("spacing_min_m", scene.spacing_min, gltf::Range{1e-4, 1.0});
  scene.spacing_max =
      extras.number("spacing_max_m", std::max(scene.spacing_max, scene.spacing_min), gltf::Range{1e-4, 1.0});
  scene.support_ratio = extras.number("support_ratio", scene.support_ratio, gltf::Range{1.5, 2.6});
  scene.stiffness = extras.number("stiffness_m2_s2", 0.0, gltf::kNotNegative);
  scene.tension = extras.number("tension", 0.0, gltf::Range{0.0, 1.0});
  const std::string model = extras.text("model", name(scene.model));
  if (const std::optional<ParticleModel> known = model_named(model)) {
    scene.model = *known;
  } else {
    const bool gone = model == kGoneModel;
    extras.fail("model", "is '" + model + (gone ? "', a model that is no more" : "'"),
                std::string("Give \"corrected\"") + (gone ? ", which took its place" : "") +
                    ", \"incompressible\" or \"paper\" (sim/pressure/README.md compares them)");
  }
  scene.duration = extras.number("duration_s", scene.duration, gltf::Range{0.0, 86400.0, true});
  scene.still = extras.number("still_s", 0.0, gltf::Range{0.0, 86400.0});
  scene.settle = extras.number("settle_s", 0.0, gltf::Range{0.0, 60.0});
  scene.light_direction =
      glm::vec3(extras.vector("light_direction", glm::dvec3(scene.light_direction), gltf::Range{-1e3, 1e3}));
  if (glm::length(scene.light_direction) < 1e-3f) {
    extras.fail("light_direction", "has no length", "Give the direction that the light travels");
  }
  if (scene.spacing_min > scene.spacing_max) {
    extras.fail("spacing_min_m",
                "is " + gltf::short_number(scene.spacing_min) +
                    ", above spacing_max_m = " + gltf::short_number(scene.spacing_max),
                "Make it the smaller of the two");
  }
  if (scene.spacing > 0.0 && scene.spacing < 1e-4) {
    extras.fail("spacing_m", "is " + gltf::short_number(scene.spacing),
                "Give 0 (automatic) or at least 0.0001");
  }
  extras.known("task");                                              // read_task takes it up
  extras.vector("domain_min_m", glm::dvec3(0.0), gltf::kAnyNumber);  // read_domain takes them up
  extras.vector("domain_max_m", glm::dvec3(0.0), gltf::kAnyNumber);
  Problem fields_problem;
  if (const nlohmann::json* fluids = extras.object("fluids")) {
    for (const auto& [name, fields] : fluids->items()) {
      if (!fields.is_object()) {
        extras.fail("fluids." + name, "is not a group of properties",
                    "Give a group with density_kg_m3 and so on");
        break;
      }
      gltf::Extras one(fields, owner + ": extras.fluids." + name);
      Fluid fluid;
      fluid.name = name;
      read_fluid_fields(one, fluid);
      fields_problem = all_of(reading, fields_problem, one);
      reading.declared_fluids[name] = static_cast<int>(scene.fluids.size());
      scene.fluids.push_back(fluid);
    }
  }
  return all_of(reading, fields_problem, extras);
}

Bounds bounds_of_scene(const Scene& scene) {
  Bounds bounds;
  const auto take = [&](const glm::dvec3& p) {
    bounds.low = glm::min(bounds.low, p);
    bounds.high = glm::max(bounds.high, p);
  };
  const auto take_mesh = [&](int mesh, const Pose& pose) {
    if (mesh < 0) return take(pose.position);
    for (const glm::vec3& p : scene.meshes[mesh].positions) take(transform_point(pose, glm::dvec3(p)));
  };
  for (const FluidVolume& volume : scene.fluid_volumes) take_mesh(volume.mesh, volume.pose);
  for (const Body& body : scene.bodies) {
    take_mesh(body.mesh, body.pose);
    if (body.keys.empty()) continue;
    double reach = 0.0;
    for (const glm::vec3& p : scene.meshes[body.mesh].positions)
      reach = std::max(reach, static_cast<double>(glm::length(p)));
    for (const PoseKey& key : body.keys) {
      take(key.pose.position - reach);
      take(key.pose.position + reach);
    }
  }
  return bounds;
}

Problem read_domain(Reading& reading) {
  Scene& scene = reading.scene;
  const Bounds bounds = bounds_of_scene(scene);
  const glm::dvec3 margin = glm::max(glm::dvec3(0.15), 0.25 * (bounds.high - bounds.low));
  gltf::Extras extras(reading.document.scene_extras, reading.document.file + ": scene");
  scene.domain_min = extras.vector("domain_min_m", bounds.low - margin, gltf::kAnyNumber);
  scene.domain_max = extras.vector("domain_max_m", bounds.high + margin, gltf::kAnyNumber);
  for (int axis = 0; axis < 3; ++axis) {
    if (scene.domain_min[axis] < scene.domain_max[axis]) continue;
    return Error{reading.document.file + ": scene: extras.domain_min_m",
                 "is not below domain_max_m along every axis",
                 "Give the low corner in domain_min_m and the high one in domain_max_m, or neither"};
  }
  for (const FluidVolume& volume : scene.fluid_volumes) {
    for (const glm::vec3& p : scene.meshes[volume.mesh].positions) {
      const glm::dvec3 w = transform_point(volume.pose, glm::dvec3(p));
      if (glm::all(glm::greaterThanEqual(w, scene.domain_min)) &&
          glm::all(glm::lessThanEqual(w, scene.domain_max))) {
        continue;
      }
      return Error{reading.document.file + ": node '" + volume.name + "'",
                   "the fluid starts outside the domain", "Widen the scene's domain_min_m and domain_max_m"};
    }
  }
  return std::nullopt;
}

Problem fit_spacing(Reading& reading) {
  const nlohmann::json& given = reading.document.scene_extras;
  if (given.contains("spacing_max_m") || given.contains("spacing_m")) return std::nullopt;
  Scene& scene = reading.scene;
  // Through a wall thinner than the spacing fluid would feel fluid, so sampling refuses it. A hair of room
  // for what two samplings of a wall's thickness differ by.
  scene.spacing_max = std::max(scene.spacing_min, std::min(scene.spacing_max, 0.98 * thinnest_wall(scene)));
  return std::nullopt;
}

}  // namespace slosh::reading
