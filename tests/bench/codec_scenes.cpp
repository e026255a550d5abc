#include "tests/bench/codec_scenes.h"

#include <cmath>
#include <cstdio>
#include <fstream>

#include "sim/world.h"
#include "tests/support/stirred_tank.h"

namespace slosh::bench {

namespace {

constexpr double kTurnsPerSecond = 0.5;

double edge(const FlowOptions& o) {
  return o.side * o.spacing;
}

double stirring_radius(const FlowOptions& o) {
  return 0.28 * edge(o);
}

glm::dvec3 paddle_half(const FlowOptions& o) {
  return {0.2 * edge(o), 0.3 * edge(o), 0.5 * o.spacing};
}

/// A free paddle, a thin upright plate of two layers of particles, and the grip that drags it.
void add_paddle(testing::Tank& tank, const FlowOptions& o) {
  const glm::dvec3 half = paddle_half(o);
  Body paddle;
  paddle.name = "paddle";
  paddle.motion = BodyMotion::kFree;
  paddle.mass = {0.3, glm::dvec3(0.0), glm::dmat3(1e-3)};
  paddle.mesh = static_cast<int>(tank.scene.meshes.size());
  paddle.pose = stirring_hand(o, 0.0);
  tank.scene.meshes.push_back(testing::box_mesh(-half, half));
  tank.scene.bodies.push_back(paddle);
  SurfaceSamples samples;
  const glm::ivec2 n(glm::round(glm::dvec2(half) / o.spacing));
  for (int y = -n.y; y <= n.y; ++y) {
    for (int x = -n.x; x <= n.x; ++x) {
      for (const float side : {-1.0f, 1.0f}) {
        samples.positions.emplace_back(o.spacing * x, o.spacing * y, side * half.z);
        samples.normals.emplace_back(0.0f, 0.0f, side);
      }
    }
  }
  samples.particle_volume = static_cast<float>(std::pow(o.spacing, 3));
  tank.sampled.surfaces.push_back(samples);
  tank.sampled.distance_fields.emplace_back();
  testing::clear_box(tank.sampled, glm::vec3(paddle.pose.position), glm::vec3(half + 0.8 * o.spacing));
  Grip grip;
  grip.name = "hand";
  grip.body = 1;
  tank.scene.grips.push_back(grip);
}

std::string describe(const FlowOptions& o) {
  char text[240];
  const glm::dvec3 paddle = 2.0 * paddle_half(o);
  if (o.flow == Flow::kStirred) {
    std::snprintf(
        text, sizeof text,
        "tank %.2f x %.2f m, water %.2f m deep, paddle %.2f x %.2f m on a circle of %.2f m, %.2f m/s",
        edge(o), edge(o), edge(o), paddle.x, paddle.y, stirring_radius(o),
        2.0 * M_PI * kTurnsPerSecond * stirring_radius(o));
  } else {
    std::snprintf(text, sizeof text, "column %.2f x %.2f x %.2f m let go in a tank %.2f m long", edge(o),
                  edge(o), edge(o), 3.0 * edge(o));
  }
  return text;
}

struct CacheHeader {
  char magic[8] = {'s', 'l', 'o', 's', 'h', 'f', 'l', '2'};
  double spacing = 0.0, seconds = 0.0, rate = 0.0;
  std::int64_t flow = 0, side = 0, frames = 0, particles = 0, bodies = 0;
};

CacheHeader header_for(const FlowOptions& o) {
  CacheHeader header;
  header.spacing = o.spacing;
  header.seconds = o.seconds;
  header.rate = o.snapshot_rate;
  header.flow = static_cast<std::int64_t>(o.flow);
  header.side = o.side;
  return header;
}

template <class T>
void put(std::ostream& out, const std::vector<T>& values) {
  out.write(reinterpret_cast<const char*>(values.data()),
            static_cast<std::streamsize>(values.size() * sizeof(T)));
}
template <class T>
void get(std::istream& in, std::vector<T>& values, std::int64_t count) {
  values.resize(static_cast<std::size_t>(count));
  in.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(T)));
}

bool read_cache(const FlowOptions& o, const std::filesystem::path& file, Recorded& out) {
  std::ifstream in(file, std::ios::binary);
  CacheHeader header;
  const CacheHeader wanted = header_for(o);
  if (!in.read(reinterpret_cast<char*>(&header), sizeof header)) return false;
  if (std::string(header.magic, 8) != std::string(wanted.magic, 8) || header.spacing != wanted.spacing ||
      header.seconds != wanted.seconds || header.rate != wanted.rate || header.flow != wanted.flow ||
      header.side != wanted.side || header.frames > 100000)
    return false;
  out.frames.resize(static_cast<std::size_t>(header.frames));
  for (Snapshot& frame : out.frames) {
    in.read(reinterpret_cast<char*>(&frame.rigid.time), sizeof(double));
    get(in, frame.positions, header.particles);
    get(in, frame.fluid_index, header.particles);
    frame.rigid.bodies.resize(static_cast<std::size_t>(header.bodies));
    for (BodyState& body : frame.rigid.bodies) in.read(reinterpret_cast<char*>(&body.pose), sizeof body.pose);
  }
  return in.good();
}

bool write_cache(const FlowOptions& o, const std::filesystem::path& file, const Recorded& recorded) {
  std::ofstream out(file, std::ios::binary);
  CacheHeader header = header_for(o);
  header.frames = static_cast<std::int64_t>(recorded.frames.size());
  header.particles = static_cast<std::int64_t>(recorded.frames.front().positions.size());
  header.bodies = static_cast<std::int64_t>(recorded.frames.front().rigid.bodies.size());
  out.write(reinterpret_cast<const char*>(&header), sizeof header);
  for (const Snapshot& frame : recorded.frames) {
    out.write(reinterpret_cast<const char*>(&frame.rigid.time), sizeof(double));
    put(out, frame.positions);
    put(out, frame.fluid_index);
    for (const BodyState& body : frame.rigid.bodies)
      out.write(reinterpret_cast<const char*>(&body.pose), sizeof body.pose);
  }
  return out.good();
}

}  // namespace

Pose stirring_hand(const FlowOptions& o, double time) {
  const double angle = 2.0 * M_PI * kTurnsPerSecond * time;
  Pose pose;
  pose.position = {stirring_radius(o) * std::cos(angle), 0.5 * edge(o), stirring_radius(o) * std::sin(angle)};
  // The plate faces where it goes: its long side stays on the radius.
  pose.orientation = glm::angleAxis(-angle, glm::dvec3(0.0, 1.0, 0.0));
  return pose;
}

testing::Tank make_flow(const FlowOptions& o) {
  testing::TankOptions options;
  const double length = o.flow == Flow::kDamBreak ? 3.0 : 1.0;
  options.inner = {length * edge(o), 2.5 * edge(o), edge(o)};
  options.fill = o.spacing;
  options.spacing = o.spacing;
  options.viscosity = 0.001;
  testing::Tank tank = testing::make_tank(options);
  tank.scene.fluid_volumes.clear();
  tank.sampled.fluid_positions.clear();
  tank.sampled.fluid_velocities.clear();
  tank.sampled.fluid_index.clear();
  const glm::dvec3 lower(-0.5 * length * edge(o), 0.0, -0.5 * edge(o));
  // Two layers more than needed where a paddle takes room; what is too much is cut from the top.
  const int extra = o.flow == Flow::kStirred ? 2 : 0;
  testing::add_fluid_block(tank.scene, tank.sampled, 0, lower,
                           lower + glm::dvec3(edge(o), edge(o) + extra * o.spacing, edge(o)));
  if (o.flow == Flow::kStirred) add_paddle(tank, o);
  const std::size_t count = static_cast<std::size_t>(o.side) * o.side * o.side;
  tank.sampled.fluid_positions.resize(count);
  tank.sampled.fluid_velocities.resize(count);
  tank.sampled.fluid_index.resize(count);
  return tank;
}

Recorded run_flow(const FlowOptions& o) {
  const testing::Tank tank = make_flow(o);
  World world(tank.scene, tank.sampled, make_plan(tank.scene, o.spacing), WorldOptions{2, Backend::kCpu});
  std::vector<HandleInput> hands(tank.scene.grips.size());
  for (HandleInput& hand : hands) {
    hand.pose = stirring_hand(o, 0.0);
    hand.engaged = true;
  }
  if (o.flow == Flow::kStirred) world.settle(0.5, hands);
  Recorded recorded{describe(o), o.spacing, {}};
  const int frames = static_cast<int>(std::lround(o.seconds * o.snapshot_rate));
  for (int f = 0; f < frames; ++f) {
    while (world.time() < (f + 1) / o.snapshot_rate) {
      for (HandleInput& hand : hands) hand.pose = stirring_hand(o, world.time());
      world.step(hands);
    }
    world.fill(recorded.frames.emplace_back());
  }
  return recorded;
}

Result<Recorded> record_flow(const FlowOptions& o, const std::filesystem::path& cache) {
  Recorded recorded{describe(o), o.spacing, {}};
  if (!cache.empty() && read_cache(o, cache, recorded)) return recorded;
  recorded = run_flow(o);
  if (!cache.empty() && !write_cache(o, cache, recorded))
    return Error{cache.string(), "cannot be written", "give another folder"};
  return recorded;
}

}  // namespace slosh::bench
