// The immutable description of a world, and its discretisation at one particle spacing.
// Plain data: no parsing, no simulation. SI units, right-handed, y up (as glTF). scenes/FIELDS.md has the
// glTF fields each of these comes from.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/body.h"
#include "scenes/task.h"
#include "sim/math/distance_field.h"
#include "sim/math/pose.h"
#include "sim/math/result.h"

namespace slosh {

/// Triangles with any scale already applied, in the frame of the node that carries them.
struct TriangleMesh {
  std::string name;
  std::vector<glm::vec3> positions;   ///< m
  std::vector<glm::vec3> normals;     ///< unit, one a position (smooth or flat as the file has them)
  std::vector<glm::uvec3> triangles;  ///< counter-clockwise seen from outside
  std::vector<glm::vec2> texcoords;   ///< one a position, v downward (as glTF); empty where no texture is
};

/// Fluid::scattering where nothing is said of it: what hides all that is a centimetre down (1/m) was given a
/// colour to be seen in it.
inline float usual_scattering(const glm::vec3& extinction) {
  return extinction.x + extinction.y + extinction.z >= 3.0f * 100.0f ? 1.0f : 0.2f;
}

/// What warms, thickens and sets. Only a scene in which temperatures differ, or something sets, has the pass
/// that uses it (sim/passes/heat).
struct Heat {
  double temperature = 20.0;  ///< °C, at the start
  double capacity = 4180.0;   ///< J/(kg·K), > 0
  double conductivity = 0.6;  ///< W/(m·K), >= 0
  /// Viscosity by temperature: °C, rising, and times Fluid::dynamic_viscosity, which is that of the start.
  /// In between its logarithm is linear in the temperature; beyond the ends it stays. Empty: it stays.
  struct Point {
    double temperature, times;
    bool operator==(const Point&) const = default;
  };
  std::vector<Point> viscosity;
  /// It sets where it is at least as warm, or at most: from 0 to 1 within `sets_in` s.
  double sets_above = std::numeric_limits<double>::infinity();   ///< °C
  double sets_below = -std::numeric_limits<double>::infinity();  ///< °C
  double sets_in = 0.0;                                          ///< s
  double melts_above =
      std::numeric_limits<double>::infinity();  ///< °C: there it goes back, within `melts_in`
  double melts_in = 0.0;                        ///< s
  double modulus = 0.0;    ///< Pa, Young's, of what has set wholly (passes/bonds); 0: it is only thicker
  double tears_at = 0.5;   ///< strain above which it is torn for good
  double set_times = 1.0;  ///< what has set wholly has so many times the viscosity; its logarithm is linear
  bool starts_set = false;

  bool sets() const { return sets_in > 0.0 || melts_in > 0.0; }
  bool operator==(const Heat&) const = default;
};
inline constexpr std::size_t kMaxViscosityPoints = 8;
inline constexpr double kColdest = -273.15, kHottest = 5000.0;  ///< °C

struct Fluid {
  std::string name;
  double rest_density = 1000.0;             ///< kg/m³, > 0 (Eq 7's ρ⁰)
  double dynamic_viscosity = 0.001;         ///< Pa·s, >= 0 (Eq 6's μ)
  glm::vec3 color{0.10f, 0.35f, 0.55f};     ///< F_c of Eq 15
  glm::vec3 extinction{12.0f, 4.0f, 2.5f};  ///< F_e of Eq 15, 1/m
  float gloss = 1.0f;                       ///< 0–1: share of a clean surface's reflection
  float refraction = 1.33f;                 ///< refractive index, 1–3
  float scattering = 0.2f;  ///< 0–1: share of the light that F_e takes which comes back as F_c; else absorbed
  float roughness = 0.05f;  ///< 0–1, of the surface, as glTF has it
  Heat heat{};

  bool operator==(const Fluid&) const = default;
};

/// A closed mesh that starts full of fluid, or is filled while the world runs (World::appear).
struct FluidVolume {
  std::string name;
  int mesh = -1;  ///< index into Scene::meshes
  int fluid = 0;  ///< index into Scene::fluids
  Pose pose;
  glm::dvec3 velocity{0.0};  ///< initial, m/s
  bool starts_away = false;  ///< empty at the start
  int fillings = 1;          ///< 1–kMaxFillings: so many times its particles there is room for
  int body = -1;             ///< index into Scene::bodies: it is filled where that is by then; −1 = as here
};
inline constexpr int kMaxFillings = 1000;

/// Which particle model a scene runs. sim/pressure/README.md compares them.
/// The numbers are the wire's. 0 was `consistent`, which `corrected` took the place of.
enum class ParticleModel : std::uint8_t {
  kPaper = 1,      ///< Eq 2 with poly6 and without body particles, Eq 5 as printed, constant body pressure
  kCorrected = 2,  ///< density and pressure from one kernel, walls counted in both, gradients corrected for
                   ///< uneven neighbours (Bonet & Lok 1999): the default
  kIncompressible = 3,  ///< corrected, with pressure projection in place of Eq 7
};

/// Whether a model presses by corrected gradients.
constexpr bool corrects_gradients(ParticleModel model) {
  return model != ParticleModel::kPaper;
}

inline constexpr ParticleModel kFirstParticleModel = ParticleModel::kPaper;
/// Their names in scene files and on the wire, in the order of the values from kFirstParticleModel on.
inline constexpr std::array kParticleModelNames{"paper", "corrected", "incompressible"};
inline const char* name(ParticleModel model) {
  return kParticleModelNames[static_cast<std::size_t>(model) - static_cast<std::size_t>(kFirstParticleModel)];
}
/// None where no model is called so.
inline std::optional<ParticleModel> model_named(std::string_view name) {
  for (std::size_t i = 0; i < kParticleModelNames.size(); ++i) {
    if (name == kParticleModelNames[i])
      return static_cast<ParticleModel>(static_cast<std::size_t>(kFirstParticleModel) + i);
  }
  return std::nullopt;
}
/// What the model was called that is no more.
inline constexpr std::string_view kGoneModel = "consistent";

/// A mesh that is only looked at.
struct Picture {
  std::string name;
  int mesh = -1;
  Pose pose;
  Material material;
};

/// A point at which the fluid's level is read.
struct Gauge {
  std::string name;
  int body = -1;             ///< index into Scene::bodies: it moves with that; −1 = it stands still
  glm::dvec3 position{0.0};  ///< m, in the body's mesh frame, else world
};

/// A closed mesh in which the fluid is weighed.
struct Region {
  std::string name;
  int mesh = -1;  ///< index into Scene::meshes
  int body = -1;  ///< as a Gauge's
  Pose pose;      ///< in the body's mesh frame, else world
};

/// Where one haptic handle takes hold of one body: a virtual coupling (section 4.4). The order of
/// Scene::grips is the order of the devices. Ranges are those at which the step was tested.
struct Grip {
  std::string name;
  int body = -1;                       ///< index into Scene::bodies, free
  Pose pose;                           ///< in the body's mesh frame
  double stiffness = 1000.0;           ///< N/m, 0–10⁶
  double damping = 20.0;               ///< N·s/m, 0–10⁴
  double rotational_stiffness = 10.0;  ///< N·m/rad, 0–10⁴; 0 for a 3-DoF device
  double rotational_damping = 0.2;     ///< N·m·s/rad, 0–10³
  std::vector<PoseKey> hand_motion;    ///< scripted handle pose (glTF animation of the hand); may be empty
};

enum class JointKind : std::uint8_t { kHinge, kSlider, kFixed };
/// Their names in scene files, in the order of the values.
inline constexpr std::array kJointKindNames{"hinge", "slider", "fixed"};

/// Joint::lower and upper where nothing stops it.
inline constexpr double kNoStop = 1e9;
/// In one scene: all are solved together.
inline constexpr std::size_t kMaxJoints = 128;

/// Two bodies, of which at least one is free and none a probe, that turn about one axis of each other
/// (hinge), slide along it (slider) or are one (fixed). They do not touch each other while it holds. The
/// coordinate is an angle (rad, whole turns counted) or a way (m) of `body` against `other`, along the axis,
/// from the poses of the scene; of a fixed one how far its two frames are apart.
struct Joint {
  std::string name;
  JointKind kind = JointKind::kHinge;
  int body = -1;             ///< index into Scene::bodies
  int other = -1;            ///< likewise; −1 = the world
  Pose pose;                 ///< in the mesh frame of `body`; its y is the axis
  double lower = -kNoStop;   ///< rad or m, −kNoStop to 0
  double upper = kNoStop;    ///< rad or m, 0 to kNoStop
  double damping = 0.0;      ///< N·m·s/rad or N·s/m, 0–10⁶
  double motor_speed = 0.0;  ///< rad/s or m/s that the motor goes for, ±1000
  double motor_limit = 0.0;  ///< N·m or N that it has at most, 0–10⁶; 0 = no motor
  /// Above these its reaction, the mean over a step, makes it let go; 0 = it never does. 0–10⁶.
  double breaks_force{};   ///< N
  double breaks_torque{};  ///< N·m
  /// A fixed one that is open closes where its two frames come within these of each other from farther off,
  /// and holds them as they are then.
  double joins_within{};  ///< m, 0–10; 0 = never
  double joins_turn{};    ///< rad, 0–π
  bool starts_apart{};    ///< it is open at first; needs `joins_within`
  /// The frame on `other`, in its mesh frame (world axes where that is the world); none: where it lies in the
  /// scene's poses.
  std::optional<Pose> meets{};

  bool changes() const { return breaks_force > 0.0 || breaks_torque > 0.0 || joins_within > 0.0; }
};

struct Camera {
  glm::dvec3 eye{0.6, 0.5, 0.9};
  glm::dvec3 target{0.0};
  double vertical_fov_deg = 40.0;
};

struct Scene {
  std::string name;         ///< e.g. "bucket"
  std::string title;        ///< one line for `slosh scenes`
  std::string source_file;  ///< where it was read from, for errors
  std::vector<TriangleMesh> meshes;
  std::vector<SceneImage> images;  ///< of textures
  std::vector<Error> left_out;     ///< what of the file's looks cannot be shown; the scene runs without it
  std::vector<Fluid> fluids;
  std::vector<FluidVolume> fluid_volumes;
  std::vector<Body> bodies;
  std::vector<Picture> pictures;
  std::vector<Grip> grips;
  std::vector<Joint> joints;
  std::vector<Gauge> gauges;  ///< these two change nothing that moves
  std::vector<Region> regions;
  std::vector<TaskStep> task;  ///< may be empty
  Camera camera;
  glm::vec3 light_direction{-0.4f, -1.0f, -0.35f};  ///< the way the light travels

  glm::dvec3 gravity{0.0, -9.81, 0.0};  ///< m/s²
  double spacing = 0.0;                 ///< m between particles; 0 = auto within [spacing_min, spacing_max]
  double spacing_min = 0.004;           ///< m
  double spacing_max = 0.02;            ///< m; below the thinnest wall
  double support_ratio = 2.0;           ///< support radius (W = 0, the paper's h) over spacing, 1.5–2.6
  ParticleModel model = ParticleModel::kCorrected;
  double stiffness = 0.0;  ///< Eq 7's k = c², m²/s²; 0 = chosen by the plan from depth and gravity
  double tension = 0.0;    ///< share of Eq 7's negative pressure that is kept, 0–1 (sim/pressure/README.md)
  double duration = 10.0;  ///< s, of the scripted motion
  double still = 0.0;      ///< s at which a film's final.png is taken; 0 = at its end. Not sent
  /// s of damped rest before the run (World::settle), 0–60; 0 = it starts as it is here.
  double settle = 0.0;
  /// s: above `settle` it goes on at most so long, until what hands feel is steady. Not sent: peers settle
  /// nothing.
  double settle_longest = 0.0;
  glm::dvec3 domain_min{0.0};  ///< m; particles that leave the domain are retired
  glm::dvec3 domain_max{0.0};
};

/// Particles of a body's surface, in its mesh frame.
struct SurfaceSamples {
  std::vector<glm::vec3> positions;  ///< m
  std::vector<glm::vec3> normals;    ///< unit, outward
  float particle_volume = 0.0f;      ///< m³, the same for every particle (area · spacing / count)
  float apart = 0.0f;                ///< m, between neighbours (boundary_spacing)
};

struct DistanceField {
  glm::vec3 origin{0.0f};
  float cell = 0.0f;
  glm::ivec3 size{0};
  std::vector<float> distance;

  DistanceFieldView view() const { return {origin, cell, size, distance.data()}; }
};

/// The particles of one fluid volume: one filling's, and as many more as later fillings have room for.
struct FillingIds {
  std::uint32_t first = 0, count = 0;
  std::uint32_t spare_first = 0, spare_count = 0;  ///< behind all volumes' own; none is there at the start

  bool has(std::uint32_t id) const { return id - first < count || id - spare_first < spare_count; }
};

/// A scene at one particle spacing.
struct SampledScene {
  double spacing = 0.0;                        ///< m
  std::vector<SurfaceSamples> surfaces;        ///< one a body
  std::vector<DistanceField> distance_fields;  ///< one a body; empty (size 0) for a point probe
  std::vector<DistanceField> region_fields;    ///< one a region
  std::vector<glm::vec3> fluid_positions;      ///< m, world
  std::vector<glm::vec3> fluid_velocities;     ///< m/s
  std::vector<std::uint8_t> fluid_index;       ///< into Scene::fluids, one a particle
  std::vector<FillingIds> fillings;            ///< one a fluid volume; may be empty where none comes later
};

/// What may come and go while a world runs, by number: the bodies, then the fluid volumes.
inline std::size_t thing_count(const Scene& scene) {
  return scene.bodies.size() + scene.fluid_volumes.size();
}
inline const std::string& thing_name(const Scene& scene, std::size_t thing) {
  const std::size_t bodies = scene.bodies.size();
  return thing < bodies ? scene.bodies[thing].name : scene.fluid_volumes[thing - bodies].name;
}
/// The first of that name; thing_count() where there is none.
inline std::size_t find_thing(const Scene& scene, std::string_view name) {
  std::size_t thing = 0;
  while (thing < thing_count(scene) && thing_name(scene, thing) != name) ++thing;
  return thing;
}

}  // namespace slosh
