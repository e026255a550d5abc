#include "tests/lab/picture/reference/path_tracer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <thread>
#include <vector>

#include "render/passes/frame_block.h"
#include "render/shader_math.h"
#include "tests/lab/picture/reference/fluid_mesh.h"
#include "tests/lab/picture/reference/focused_light.h"
#include "tests/lab/picture/reference/ray_scene.h"
#include "tests/lab/picture/reference/ray_texture.h"
#include "tests/lab/picture/reference/sampling.h"

namespace slosh::reference {
namespace {

constexpr int kMaxPathTurns = 96;    // of one path
constexpr float kLightSize = 0.99f;  // cosine of the light's half angle as a mirror shows it

/// Single-scattering albedo of a medium whose deep layers send `back` of the light back (Chiang, Kutz &
/// Burley 2016).
glm::vec3 scattering_albedo(const glm::vec3& back) {
  const glm::vec3 a = glm::clamp(back, 0.0f, 0.999f);
  return 1.0f - glm::exp(-5.09406f * a + 2.61188f * a * a - 4.31805f * a * a * a);
}

class Tracer {
 public:
  Tracer(const RayScene& scene, const Frame& frame, const std::vector<RayTexture>& textures,
         const Studio& studio, const Environment* environment)
      : scene_(scene), frame_(frame), textures_(textures), key_(studio.key_light), environment_(environment) {
    room_ = {studio.sky, studio.horizon, studio.ground, studio.softbox, direction_to_light(frame)};
    for (const FluidLook& fluid : frame.fluids)
      albedo_.push_back(scattering_albedo(fluid.color * fluid.scattering));
  }

  /// What bodies get of the key light by way of a fluid's surface comes so from now on, not straight.
  void focus(FocusedLight light) { focused_ = std::move(light); }
  glm::vec3 to_light() const { return room_.to_light; }
  /// Share of the key light that arrives at a point in the air.
  glm::vec3 arriving(const glm::vec3& at) const { return light_to(at, -1); }

  glm::vec3 path(glm::vec3 from, glm::vec3 way, Random& random) const {
    glm::vec3 light(0.0f), share(1.0f);
    int fluid = -1;            // that the path is in
    bool scattered = false;    // in it
    bool mirror_chain = true;  // from the eye on: the light itself is to be seen
    for (int turn = 0; turn < kMaxPathTurns; ++turn) {
      const Hit hit = scene_.nearest(from, way);
      if (fluid >= 0) {
        const float distance = walk(fluid, hit.distance, share, random);
        if (distance < hit.distance) {
          from += way * distance;
          share *= albedo_[static_cast<std::size_t>(fluid)];
          light += share * key_ * light_to(from, fluid) / (4.0f * glm::pi<float>());
          way = around(glm::vec3(0, 1, 0), 2.0f * random() - 1.0f, random());
          scattered = true;
          mirror_chain = false;
          if (!survives(share, turn, random)) break;
          continue;
        }
      }
      if (!hit.there()) return light + share * seen_far(way, mirror_chain);
      from += way * hit.distance;
      if (hit.fluid >= 0) {
        cross_surface(hit, way, fluid, scattered, random);
      } else if (const SurfaceLook surface = look_at(hit, textures_); surface.look.opacity < 1.0f) {
        cross_pane(hit, surface.look, way, share, random);
      } else if (!surface.hole) {
        glm::vec3 normal = glm::dot(hit.normal, way) > 0.0f ? -surface.normal : surface.normal;
        // A bent normal that faces away from the eye is turned to it as far as it must be.
        const float away = glm::dot(normal, way);
        if (away > -1e-3f) normal = glm::normalize(normal - way * (away + 1e-3f));
        light += share * (surface.look.emissive + lit_body(surface.look, from, normal, way, fluid));
        bounce(surface, normal, way, share, random);
        mirror_chain = false;
      }
      from += way * kApart;
      if (!survives(share, turn, random)) break;
    }
    return light;
  }

 private:
  static constexpr float kApart = 2e-5f;  // m that a new ray starts off a surface

  static bool survives(glm::vec3& share, int turn, Random& random) {
    const float most = std::max({share.x, share.y, share.z});
    if (!(most > 0.0f)) return false;
    if (turn < 6) return true;
    const float chance = std::min(most, 0.95f);
    if (random() >= chance) return false;
    share /= chance;
    return true;
  }

  glm::vec3 seen_far(const glm::vec3& way, bool light_too) const {
    glm::vec3 seen = environment_ ? environment_->from(way) : shader::room_radiance(room_, way);
    // As bright as gives the light's irradiance on what faces it.
    if (light_too && glm::dot(way, room_.to_light) > kLightSize)
      seen += key_ / (glm::two_pi<float>() * (1.0f - kLightSize) * 0.5f * (1.0f + kLightSize));
    return seen;
  }

  /// How far light gets in the fluid, up to `most`; takes what is absorbed off `share`. Distances are drawn
  /// for one of the three channels, each as often as it matters, and weighed by all.
  float walk(int fluid, float most, glm::vec3& share, Random& random) const {
    const glm::vec3& extinction = frame_.fluids[static_cast<std::size_t>(fluid)].extinction;
    const glm::vec3& albedo = albedo_[static_cast<std::size_t>(fluid)];
    most = std::min(most, 1e3f);
    if (std::max({albedo.x, albedo.y, albedo.z}) < 1e-4f) {
      share *= glm::exp(-extinction * most);
      return std::numeric_limits<float>::infinity();
    }
    const float sum = share.x + share.y + share.z;
    const glm::vec3 chance = share / sum;
    const float pick = random();
    const int channel = pick < chance.x ? 0 : pick < chance.x + chance.y ? 1 : 2;
    const float drawn = -std::log(std::max(1.0f - random(), 1e-12f)) / std::max(extinction[channel], 1e-6f);
    if (drawn < most) {
      const glm::vec3 density = extinction * glm::exp(-extinction * drawn);
      share *= density / std::max(glm::dot(chance, density), 1e-20f);
      return drawn;
    }
    const glm::vec3 left = glm::exp(-extinction * most);
    share *= left / std::max(glm::dot(chance, left), 1e-20f);
    return std::numeric_limits<float>::infinity();
  }

  void cross_surface(const Hit& hit, glm::vec3& way, int& fluid, bool& scattered, Random& random) const {
    const bool entering = glm::dot(hit.face, way) < 0.0f;
    if (!cross_fluid(hit, frame_.fluids[static_cast<std::size_t>(hit.fluid)], !entering && scattered, way,
                     random))
      return;
    fluid = entering ? hit.fluid : -1;
    scattered = false;
  }

  void cross_pane(const Hit& hit, const MeshLook& look, glm::vec3& way, glm::vec3& share,
                  Random& random) const {
    const glm::vec3 normal = glm::dot(hit.normal, way) > 0.0f ? -hit.normal : hit.normal;
    const float facing = std::max(-glm::dot(normal, way), 1e-3f);
    if (random() < shader::pane_reflectance(shader::schlick(0.04f, facing)))
      way = glm::reflect(way, normal);
    else
      share *= pane_tint(look, facing);
  }

  glm::vec3 lit_body(const MeshLook& look, const glm::vec3& at, const glm::vec3& normal, const glm::vec3& way,
                     int fluid) const {
    const glm::vec3 albedo = look.base_color * (1.0f - look.metallic);
    const glm::vec3 focused =
        focused_.empty() ? glm::vec3(0.0f) : key_ * albedo / glm::pi<float>() * focused_.at(at, normal);
    const float n_l = glm::dot(normal, room_.to_light);
    if (n_l <= 0.0f) return focused;
    const glm::vec3 half_way = glm::normalize(room_.to_light - way);
    const glm::vec3 f0 = glm::mix(glm::vec3(0.04f), look.base_color, look.metallic);
    const glm::vec3 fresnel = f0 + (1.0f - f0) * shader::schlick(0.0f, glm::dot(half_way, -way));
    const float lobe = shader::ggx(std::max(glm::dot(normal, half_way), 0.0f), n_l,
                                   std::max(-glm::dot(normal, way), 1e-3f), std::max(look.roughness, 0.05f));
    return focused + key_ * n_l * (albedo / glm::pi<float>() + fresnel * lobe) *
                         light_to(at + normal * kApart, fluid, focused_.empty());
  }

  void bounce(const SurfaceLook& surface, const glm::vec3& normal, glm::vec3& way, glm::vec3& share,
              Random& random) const {
    const MeshLook& look = surface.look;
    share *= surface.open;
    const glm::vec3 f0 = glm::mix(glm::vec3(0.04f), look.base_color, look.metallic);
    const float facing = std::max(-glm::dot(normal, way), 1e-3f);
    const glm::vec3 mirrored =
        f0 + (glm::max(glm::vec3(1.0f - look.roughness), f0) - f0) * shader::schlick(0.0f, facing);
    const glm::vec3 albedo = look.base_color * (1.0f - look.metallic);
    const float m = mirrored.x + mirrored.y + mirrored.z;
    const float chance = m / (m + albedo.x + albedo.y + albedo.z);
    if (random() < chance) {
      way = glm::reflect(way, rough_normal(normal, look.roughness, random));
      if (glm::dot(way, normal) <= 0.0f) way = glm::reflect(way, normal);
      share *= mirrored / chance;
    } else {
      way = around(normal, std::sqrt(random()), random());
      share *= albedo / (1.0f - chance);
    }
  }

  /// Share of the key light that arrives at a point in `fluid` (−1: in air), straight; `through`: also
  /// through fluid.
  glm::vec3 light_to(glm::vec3 at, int fluid, bool through = true) const {
    glm::vec3 share(1.0f);
    for (int turn = 0; turn < 32; ++turn) {
      const Hit hit = scene_.nearest(at, room_.to_light);
      if (!through && (fluid >= 0 || hit.fluid >= 0)) return glm::vec3(0.0f);
      if (fluid >= 0 && hit.there())
        share *= glm::exp(-frame_.fluids[static_cast<std::size_t>(fluid)].extinction * hit.distance);
      if (!hit.there() || share.x + share.y + share.z < 1e-5f) return share;
      const float facing = std::max(std::abs(glm::dot(hit.normal, room_.to_light)), 1e-3f);
      if (hit.fluid >= 0) {
        const FluidLook& look = frame_.fluids[static_cast<std::size_t>(hit.fluid)];
        const bool leaving = glm::dot(hit.face, room_.to_light) > 0.0f;
        // Light falls onto the surface from above, whichever way the ray goes.
        if (leaving) share *= 1.0f - look.gloss * dielectric(facing, look.refraction);
        fluid = leaving ? -1 : hit.fluid;
      } else if (const SurfaceLook surface = look_at(hit, textures_); surface.look.opacity < 1.0f) {
        share *= pane_tint(surface.look, facing) *
                 (1.0f - shader::pane_reflectance(shader::schlick(0.04f, facing)));
      } else if (!surface.hole) {
        return glm::vec3(0.0f);
      }
      at += room_.to_light * (hit.distance + kApart);
    }
    return glm::vec3(0.0f);
  }

  const RayScene& scene_;
  const Frame& frame_;
  const std::vector<RayTexture>& textures_;
  glm::vec3 key_;
  const Environment* environment_;
  shader::Room room_;
  std::vector<glm::vec3> albedo_;  // one a fluid
  FocusedLight focused_;
};

class EmbreeTracer : public PathTracer {
 public:
  MeshHandle add_mesh(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                      std::span<const glm::uvec3> triangles, std::span<const glm::vec2> texcoords) override {
    meshes_.push_back({{positions.begin(), positions.end()},
                       {normals.begin(), normals.end()},
                       {triangles.begin(), triangles.end()},
                       {texcoords.begin(), texcoords.end()}});
    Triangles& mesh = meshes_.back();
    if (mesh.texcoords.size() < mesh.positions.size()) mesh.texcoords.clear();
    mesh.normals.resize(mesh.positions.size(), glm::vec3(0.0f, 1.0f, 0.0f));
    std::erase_if(mesh.triangles,
                  [&](const glm::uvec3& t) { return std::max({t.x, t.y, t.z}) >= mesh.positions.size(); });
    return static_cast<MeshHandle>(meshes_.size() - 1);
  }

  void remove_mesh(MeshHandle mesh) override {
    if (mesh < meshes_.size()) meshes_[mesh] = {};
  }

  TextureHandle add_texture(const TextureImage& image) override {
    if (image.width < 1 || image.height < 1 ||
        image.rgba.size() <
            std::size_t{4} * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
      return kNoTexture;
    textures_.emplace_back(image);
    return static_cast<TextureHandle>(textures_.size() - 1);
  }

  score::Exact first_seen(const Frame& frame, const Options& options) override {
    RayScene scene;
    fill(scene, frame, options.cell);
    score::Exact seen = score::nothing_seen(options.width, options.height);
    const glm::mat4 world_from_eye = glm::inverse(frame.view.view);
    for (std::size_t i = 0; i < seen.depth.values.size(); ++i) {
      const auto x = static_cast<float>(i % static_cast<std::size_t>(options.width));
      const auto y = static_cast<float>(i / static_cast<std::size_t>(options.width));
      const glm::vec3 eye = eye_way(frame.view.projection, options, x + 0.5f, y + 0.5f);
      const glm::vec3 way = glm::normalize(glm::mat3(world_from_eye) * eye);
      glm::vec3 from(world_from_eye[3]);
      float gone = 0.0f;
      Hit hit = scene.nearest(from, way);
      while (hit.there() && hit.fluid < 0 && hit.look->opacity < 1.0f) {
        gone += hit.distance + kPastGlass;
        hit = scene.nearest(from + gone * way, way);
      }
      if (hit.fluid < 0) continue;
      const glm::vec3 normal = glm::mat3(frame.view.view) * hit.normal;
      seen.depth.values[i] = (gone + hit.distance) / glm::length(eye);
      for (int c = 0; c < 3; ++c) seen.normal.values[3 * i + static_cast<std::size_t>(c)] = normal[c];
    }
    return seen;
  }

  FloatImage draw(const Frame& frame, const Options& options) override {
    RayScene scene;
    FocusedLight::Source source;
    source.fluids = fill(scene, frame, options.cell);
    Tracer tracer(scene, frame, textures_, Studio{}, options.environment);
    if (options.photons > 0) {
      source.to_light = tracer.to_light();
      source.photons = options.photons;
      source.threads = options.threads;
      source.arriving = [&tracer](const glm::vec3& at) { return tracer.arriving(at); };
      tracer.focus({scene, frame.fluids, textures_, source});
    }
    FloatImage image{options.width, options.height, 3,
                     std::vector<float>(std::size_t{3} * options.width * options.height)};
    const glm::mat4 world_from_eye = glm::inverse(frame.view.view);
    const glm::mat4& p = frame.view.projection;
    std::atomic<int> next_row{0};
    const auto work = [&] {
      for (int y = next_row++; y < options.height; y = next_row++) {
        for (int x = 0; x < options.width; ++x) {
          const std::size_t pixel = static_cast<std::size_t>(y) * options.width + x;
          glm::vec3 sum(0.0f);
          for (int s = 0; s < options.samples; ++s) {
            Random random(pixel, static_cast<std::uint64_t>(s));
            const float across = static_cast<float>(x) + random();
            const glm::vec3 eye = eye_way(p, options, across, static_cast<float>(y) + random());
            const glm::vec3 light = tracer.path(glm::vec3(world_from_eye[3]),
                                                glm::normalize(glm::mat3(world_from_eye) * eye), random);
            // A rare bright path must not become a spot: what it has beyond this is lost.
            sum += glm::min(light, glm::vec3(40.0f));
          }
          for (int c = 0; c < 3; ++c)
            image.values[3 * pixel + static_cast<std::size_t>(c)] =
                sum[c] / static_cast<float>(options.samples);
        }
      }
    };
    std::vector<std::thread> threads;
    for (int i = 1; i < options.threads; ++i) threads.emplace_back(work);
    work();
    for (std::thread& thread : threads) thread.join();
    return image;
  }

 private:
  static constexpr float kPastGlass = 2e-5f;  // m

  /// Pixels from the top left; its length is that of a unit of depth.
  static glm::vec3 eye_way(const glm::mat4& projection, const Options& options, float x, float y) {
    const glm::vec2 ndc(2.0f * x / static_cast<float>(options.width) - 1.0f,
                        1.0f - 2.0f * y / static_cast<float>(options.height));
    return {(ndc.x + projection[2][0]) / projection[0][0], (ndc.y + projection[2][1]) / projection[1][1],
            -1.0f};
  }

  /// What holds the fluids.
  Bounds fill(RayScene& scene, const Frame& frame, float cell) const {
    Bounds fluids;
    for (const MeshInstance& instance : frame.meshes) {
      if (instance.mesh < meshes_.size())
        scene.add(meshes_[instance.mesh], instance.model, &instance.look, -1);
    }
    for (FluidMesh& fluid : mesh_fluids(frame, cell)) {
      for (const glm::vec3& p : fluid.positions) fluids.add(p);
      scene.add({std::move(fluid.positions), std::move(fluid.normals), std::move(fluid.triangles), {}},
                glm::mat4(1.0f), nullptr, static_cast<int>(fluid.fluid));
    }
    scene.finish();
    return fluids;
  }

  std::vector<Triangles> meshes_;
  std::vector<RayTexture> textures_;
};

}  // namespace

Result<std::unique_ptr<PathTracer>> PathTracer::create() {
  if (auto started = RayScene::available(); !started) return started.error();
  return std::unique_ptr<PathTracer>(std::make_unique<EmbreeTracer>());
}

}  // namespace slosh::reference
