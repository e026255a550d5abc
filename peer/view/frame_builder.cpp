#include "peer/view/frame_builder.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "net/text/clean.h"
#include "peer/view/cut_mesh.h"
#include "peer/view/palette.h"
#include "scenes/images/decode.h"

namespace slosh {
namespace {

constexpr float kHandRadius = 0.008f;       // m, the ball that marks a handle
constexpr double kArrowLength = 0.15;       // of the view distance, for the largest force so far
constexpr double kSmallestReference = 1.0;  // N: below it noise would be drawn large

// Pale blue, a third of it seen.
const MeshLook kGhostLook{{0.35f, 0.7f, 1.0f}, 0.0f, 0.5f, 0.3f};
constexpr double kGhostApart = 0.03;  // m from the tool, from where on it is shown like that
constexpr double kGhostTurn = 0.1;    // m that a radian counts as
constexpr float kGhostSeen = 0.02f;   // opacity

MeshLook look_of(const Material& m) {
  MeshLook look{m.base_color, m.metallic, m.roughness, m.opacity};
  look.emissive = m.emissive;
  look.alpha_cutoff = m.alpha_cutoff;
  return look;
}

}  // namespace

glm::mat4 model_matrix(const Pose& pose) {
  return glm::translate(glm::mat4(1.0f), glm::vec3(pose.position)) *
         glm::mat4_cast(glm::quat(pose.orientation));
}

TriangleMesh unit_ball() {
  constexpr int kRings = 12;
  constexpr int kSides = 20;
  TriangleMesh ball;
  ball.name = "ball";
  for (int ring = 0; ring <= kRings; ++ring) {
    const float polar = glm::pi<float>() * static_cast<float>(ring) / kRings;
    for (int side = 0; side <= kSides; ++side) {
      const float around = glm::two_pi<float>() * static_cast<float>(side) / kSides;
      ball.positions.emplace_back(std::sin(polar) * std::sin(around), std::cos(polar),
                                  std::sin(polar) * std::cos(around));
    }
  }
  ball.normals = ball.positions;
  const auto at = [](int ring, int side) { return static_cast<unsigned>(ring * (kSides + 1) + side); };
  for (int ring = 0; ring < kRings; ++ring) {
    for (int side = 0; side < kSides; ++side) {
      ball.triangles.emplace_back(at(ring, side), at(ring + 1, side), at(ring + 1, side + 1));
      ball.triangles.emplace_back(at(ring, side), at(ring + 1, side + 1), at(ring, side + 1));
    }
  }
  return ball;
}

namespace {
// The ball that has a particle's volume, spacing³: in a thin stream neighbours then meet.
constexpr double kRadiusOfSpacing = 0.6204;  // (3 / 4π)^(1/3)
}  // namespace

/// Hands textures over, each once, image by image. The scene may be a stranger's.
class FrameBuilder::Textures {
 public:
  Textures(const Scene& scene, MeshSink& sink, std::vector<Error>& left_out)
      : scene_(scene), sink_(sink), left_out_(left_out), wanted_(scene.images.size()) {}

  void want(const TextureMap& map, bool srgb, TextureHandle& handle) {
    if (map.image >= 0 && static_cast<std::size_t>(map.image) < wanted_.size())
      wanted_[static_cast<std::size_t>(map.image)].push_back({&map, srgb, &handle});
  }
  void want(const MaterialMaps& maps, MeshMaps& handles) {
    want(maps.base_color, true, handles.base_color);
    want(maps.metallic_roughness, false, handles.metallic_roughness);
    want(maps.normal, false, handles.normal);
    want(maps.occlusion, false, handles.occlusion);
    want(maps.emissive, true, handles.emissive);
    handles.normal_scale = maps.normal_scale;
    handles.occlusion_strength = maps.occlusion_strength;
  }
  /// One image's pixels are in memory at a time.
  void hand_over() {
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < wanted_.size(); ++i) {
      if (wanted_[i].empty()) continue;
      const SceneImage& image = scene_.images[i];
      const std::string name = "image '" + clean_text(image.name, 100) + "'";
      const Result<images::Facts> facts = images::look_at(image.bytes, name);
      if (facts && pixels + facts.value().pixels() > images::kMaxPixels) {
        left_out_.push_back({name,
                             "would be more than " + std::to_string(images::kMaxPixels >> 20) +
                                 " million pixels in one scene",
                             "Scale the pictures down"});
        continue;
      }
      const Result<images::Pixels> unpacked = images::decode(image.bytes, name);
      if (!unpacked) {
        left_out_.push_back(unpacked.error());
        continue;
      }
      pixels += facts.value().pixels();
      hand_over(unpacked.value(), wanted_[i]);
    }
  }

 private:
  struct Wanted {
    const TextureMap* map;
    bool srgb;
    TextureHandle* handle;
  };
  void hand_over(const images::Pixels& pixels, const std::vector<Wanted>& all) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto same = [&](const Wanted& other) {
        return other.srgb == all[i].srgb && other.map->sampling == all[i].map->sampling;
      };
      const auto before = std::find_if(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(i), same);
      *all[i].handle = before != all.begin() + static_cast<std::ptrdiff_t>(i)
                           ? *before->handle
                           : sink_.add_texture({pixels.width, pixels.height, pixels.rgba, all[i].srgb,
                                                all[i].map->sampling});
    }
  }

  const Scene& scene_;
  MeshSink& sink_;
  std::vector<Error>& left_out_;
  std::vector<std::vector<Wanted>> wanted_;  // one an image
};

FrameBuilder::FrameBuilder(const Scene& scene, double spacing, MeshSink& meshes)
    : scene_(scene),
      meshes_(meshes),
      wetness_(scene, spacing),
      particle_radius_(static_cast<float>(kRadiusOfSpacing * spacing)) {
  std::vector<MeshHandle> handles(scene.meshes.size());
  std::vector<bool> loaded(scene.meshes.size(), false);
  const auto upload = [&](int index) {
    const auto i = static_cast<std::size_t>(index);
    if (!loaded[i]) {
      const TriangleMesh& mesh = scene.meshes[i];
      handles[i] = meshes.add_mesh(mesh.positions, mesh.normals, mesh.triangles, mesh.texcoords);
      loaded[i] = true;
    }
    return handles[i];
  };
  const TriangleMesh ball = unit_ball();
  ball_ = meshes.add_mesh(ball.positions, ball.normals, ball.triangles);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.mesh < 0) continue;
    const MeshHandle mesh = upload(body.mesh);
    placed_.push_back({mesh, mesh, static_cast<int>(i), look_of(body.material), glm::mat4(1.0f)});
  }
  for (const Picture& picture : scene.pictures) {
    if (picture.mesh < 0) continue;
    const MeshHandle mesh = upload(picture.mesh);
    placed_.push_back({mesh, mesh, -1, look_of(picture.material), model_matrix(picture.pose)});
  }
  Textures textures(scene, meshes, left_out_);
  std::size_t next = 0;
  for (const Body& body : scene.bodies)
    if (body.mesh >= 0) textures.want(body.material.maps, placed_[next++].look.maps);
  for (const Picture& picture : scene.pictures)
    if (picture.mesh >= 0) textures.want(picture.material.maps, placed_[next++].look.maps);
  textures.hand_over();
  for (const Fluid& fluid : scene.fluids) {
    FluidLook look;
    look.color = fluid.color;
    look.extinction = fluid.extinction;
    look.scattering = fluid.scattering;
    look.gloss = fluid.gloss;
    look.refraction = fluid.refraction;
    look.roughness = fluid.roughness;
    fluids_.push_back(look);
  }
}

void FrameBuilder::follow_cuts(const BodyCuts* cuts) {
  for (Placed& placed : placed_) {
    if (placed.body < 0) continue;
    const auto body = static_cast<std::size_t>(placed.body);
    const std::span<const CutPlane> planes = planes_of(cuts, body);
    if (std::ranges::equal(planes, placed.planes)) continue;
    if (placed.mesh != placed.whole) meshes_.remove_mesh(placed.mesh);
    placed.mesh = placed.whole;
    placed.planes.assign(planes.begin(), planes.end());
    if (planes.empty()) continue;
    const auto whole = static_cast<std::size_t>(scene_.bodies[body].mesh);
    const TriangleMesh mesh = cut_mesh(scene_.meshes[whole], planes);
    placed.mesh = meshes_.add_mesh(mesh.positions, mesh.normals, mesh.triangles, mesh.texcoords);
  }
}

void FrameBuilder::show_ghost(const std::vector<GuidedHand>& hands) {
  ghosts_.clear();
  for (const GuidedHand& hand : hands) {
    if (hand.grip >= scene_.grips.size()) continue;
    const int body = scene_.grips[hand.grip].body;
    const auto there = std::ranges::find(placed_, body, &Placed::body);
    if (there != placed_.end())
      ghosts_.push_back({hand.grip, PoseTrack(hand.way, hand.way.front().pose), there->whole, hand.clock});
  }
}

void FrameBuilder::add_ghosts(const BodySnapshot& rigid, Frame& frame) {
  for (Ghost& ghost : ghosts_) {
    const Grip& grip = scene_.grips[ghost.grip];
    const auto body = static_cast<std::size_t>(grip.body);
    if (ghost.grip >= rigid.grips.size() || body >= rigid.bodies.size() || rigid.bodies[body].away())
      continue;
    const Pose handle = ghost.way.at(ghost.clock->at(rigid.time)).pose;
    // Where hand and ghost are one there is nothing to show: both drawn would only colour the tool.
    const Pose& held = rigid.grips[ghost.grip].pose;
    const double apart = glm::distance(handle.position, held.position) +
                         kGhostTurn * glm::length(rotation_between(held.orientation, handle.orientation));
    MeshLook look = kGhostLook;
    look.opacity *= static_cast<float>(std::min(1.0, apart / kGhostApart));
    if (look.opacity < kGhostSeen) continue;
    frame.meshes.push_back({ghost.mesh, model_matrix(compose(handle, inverse(grip.pose))), look});
  }
}

Frame FrameBuilder::build(const Snapshot& snapshot, double view_distance) {
  Frame frame;
  frame.light_direction = scene_.light_direction;
  frame.particles = snapshot.positions;
  frame.particle_fluid = snapshot.fluid_index;
  frame.on_gpu = snapshot.on_gpu;
  frame.fluids = fluids_;
  frame.particle_radius = particle_radius_;

  const BodySnapshot& rigid = snapshot.rigid;
  if (rigid.cuts != cuts_) follow_cuts(rigid.cuts.get());
  cuts_ = rigid.cuts;
  if (walls_) walls_->move(rigid);
  frame.wall = [this, &rigid](const glm::vec3& at, float reach) {
    if (!walls_) {
      walls_.emplace(scene_, 0.0f);
      walls_->move(rigid);
    }
    return walls_->nearest(at, reach);
  };
  wetness_.record(snapshot);
  for (const Placed& placed : placed_) {
    const auto body = static_cast<std::size_t>(placed.body);
    const bool moves = placed.body >= 0 && body < rigid.bodies.size();
    if (moves && rigid.bodies[body].away()) continue;
    frame.meshes.push_back({placed.mesh, moves ? model_matrix(rigid.bodies[body].pose) : placed.model,
                            placed.look, moves ? wetness_.of(body) : Wetness{}});
  }
  for (std::size_t i = 0; i < scene_.bodies.size() && i < rigid.bodies.size(); ++i) {
    if (scene_.bodies[i].mesh >= 0) continue;  // a point probe: as large as a particle
    const glm::mat4 size = glm::scale(glm::mat4(1.0f), glm::vec3(particle_radius_));
    frame.meshes.push_back(
        {ball_, model_matrix(rigid.bodies[i].pose) * size, look_of(scene_.bodies[i].material)});
  }
  add_ghosts(rigid, frame);
  for (const GripState& grip : rigid.grips) {
    reference_force_ = std::max({reference_force_, kSmallestReference, glm::length(grip.on_hand.force)});
  }
  for (std::size_t i = 0; i < rigid.grips.size(); ++i) {
    const GripState& grip = rigid.grips[i];
    if (is_away(grip.pose)) continue;
    const glm::vec3 color = linear_color(device_color(i));
    const glm::mat4 size = glm::scale(glm::mat4(1.0f), glm::vec3(kHandRadius));
    frame.meshes.push_back({ball_, model_matrix(grip.handle) * size, {color, 0.0f, 0.45f, 1.0f}});
    const glm::dvec3 arrow = grip.on_hand.force * (kArrowLength * view_distance / reference_force_);
    if (glm::length(arrow) < 0.01 * view_distance) continue;
    frame.arrows.push_back({glm::vec3(grip.handle.position), glm::vec3(grip.handle.position + arrow), color});
  }
  return frame;
}

void FrameBuilder::add_controller(const Pose& pose, double scale, Frame& frame) const {
  // A stick that lies in the fist, thicker where the thumb is.
  const glm::mat4 grip = model_matrix(pose);
  const auto ball = [&](const glm::vec3& at, const glm::vec3& radii) {
    const glm::mat4 placed = glm::translate(grip, static_cast<float>(scale) * at);
    frame.meshes.push_back(
        {ball_, glm::scale(placed, static_cast<float>(scale) * radii), {glm::vec3(0.18f), 0.0f, 0.5f, 1.0f}});
  };
  ball({0.0f, 0.0f, 0.02f}, {0.013f, 0.013f, 0.06f});
  ball({0.0f, 0.0f, -0.035f}, {0.02f, 0.02f, 0.02f});
}

}  // namespace slosh
