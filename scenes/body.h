// One rigid body of a scene. scenes/FIELDS.md has the glTF fields.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scenes/material.h"
#include "sim/math/mass_properties.h"
#include "sim/math/pose.h"

namespace slosh {

/// A body's viscosity where it is that of whatever fluid touches it, so that Eq 9's mean is the fluid's own
/// and the fluid sticks to the body.
inline constexpr double kFluidsViscosity = -1.0;
/// A body's viscosity where nothing drags at it: fluid slides along it freely, in every model. (0 is one side
/// of Eq 9's mean, and halves the shear.)
inline constexpr double kFreeSlip = -2.0;

/// A driven body goes where Body::keys say, whatever acts on it.
enum class BodyMotion : std::uint8_t { kFixed, kFree, kDriven };
constexpr bool moves(BodyMotion motion) {
  return motion != BodyMotion::kFixed;
}

struct PoseKey {
  double time = 0.0;  ///< s, rising
  Pose pose;          ///< world
};

/// A rigid body made of particles on its surface (paper, section 4.1), or one particle (section 3).
struct Body {
  std::string name;
  int mesh =
      -1;  ///< index into Scene::meshes, closed and outward-facing; of a point probe only its look, or −1
  BodyMotion motion = BodyMotion::kFixed;
  bool point_probe = false;  ///< one particle that behaves as fluid (Eq 8), without rotation
  Pose pose;                 ///< initial pose of the mesh frame
  Twist twist;               ///< initial twist of the centre of mass
  MassProperties mass;       ///< meaningful when free
  double particle_density =
      0.0;  ///< kg/m³: the constant density of its particles (section 4.1); 0 = chosen by the plan
  double dynamic_viscosity =
      0.0;                ///< Pa·s, >= 0: its side of Eq 9's (μᵢ + μⱼ)/2; or kFluidsViscosity, or kFreeSlip
  double friction = 0.4;  ///< Coulomb, with the smaller of two touching bodies' values used
  double restitution = 0.0;  ///< 0–1
  bool measured = false;     ///< report the fluid's wrench on it even though it is fixed
  Material material;
  std::optional<double> temperature{};  ///< °C, kept by all of it whatever it touches; none: no heat passes
  std::vector<PoseKey> keys;  ///< of the mesh frame when driven, the first at 0 s; after the last it stands
  bool repeats = false;       ///< the keys begin again after the last, which is where the first is
  bool starts_away = false;   ///< it moves, and is not in the world before World::appear
  int pieces{};               ///< 2–kMaxPieces: by cuts it may become so many bodies; 0 = nothing cuts it
  int piece_of{-1};           ///< index into Scene::bodies: by a cut it comes off that one; −1 = no piece
  double cut_n_m{};           ///< N/m, 0–10⁶: a blade moves on in it from this for each metre inside it
  bool blade{};               ///< it cuts with its edge (sim/bodies/blades.h), which is along x of its mesh
                              ///< at the lowest y, in the plane z = 0, towards −y
};
inline constexpr int kMaxPieces = 16;
/// Whether cuts make anything of it: it may be cut, or comes off one that may.
inline bool is_cut(const Body& body) {
  return body.pieces > 1 || body.piece_of >= 0;
}

}  // namespace slosh
