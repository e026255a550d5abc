#include "peer/view/body_wetness.h"

#include <algorithm>
#include <cmath>

namespace slosh {
namespace {

// Lengths in spacings of particles.
constexpr float kCell = 0.6f;
constexpr float kOff = 0.5f;      // a particle's centre from the face that it lies on
constexpr float kTouches = 0.9f;  // from a face
constexpr float kWhole = 0.5f;    // from a particle's centre: wet
constexpr float kNot = 1.5f;      // not wet by it

// A scene may be a stranger's. Larger bodies have larger cells, and so have those of a scene with very many.
constexpr std::size_t kMaxCells = std::size_t{1} << 19;     // of a body
constexpr std::size_t kMaxAllCells = std::size_t{1} << 22;  // of all
constexpr double kMaxMarked = 1e8;                          // cells looked at, triangle by triangle, of all
constexpr std::size_t kMaxLooked = 131072;                  // particles times bodies of a snapshot

// A share of 64 is dry (frame.h).
constexpr int kDrySteps = 24;
constexpr int kDryStep = (255 - 64) / kDrySteps + 1;

}  // namespace

BodyWetness::BodyWetness(const Scene& scene, double spacing) : spacing_(static_cast<float>(spacing)) {
  const double most_cells = static_cast<double>(
      std::clamp(kMaxAllCells / std::max(scene.bodies.size(), std::size_t{1}), std::size_t{1}, kMaxCells));
  double looked_at = 0.0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.mesh < 0 || body.point_probe || body.material.opacity < 1.0f) continue;
    const TriangleMesh& mesh = scene.meshes[static_cast<std::size_t>(body.mesh)];
    if (mesh.positions.empty()) continue;
    glm::vec3 low = mesh.positions.front(), high = low;
    for (const glm::vec3& at : mesh.positions) {
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
    const float pad = kNot * spacing_;
    low -= pad;
    high += pad;
    Grid grid{i, low, kCell * spacing_, {}, {}, {}, glm::ivec3(0), glm::ivec3(0)};
    const auto cells = [&] {
      const glm::dvec3 size = glm::ceil(glm::dvec3(high - low) / double(grid.cell));
      return size.x * size.y * size.z;
    };
    while (cells() > most_cells) grid.cell *= 1.1f;
    grid.size = glm::max(glm::ivec3(glm::ceil((high - low) / grid.cell)), glm::ivec3(1));
    mark_faces(mesh, grid, looked_at);
    grids_.push_back(std::move(grid));
  }
}

/// `looked_at`: cells, of all bodies so far.
void BodyWetness::mark_faces(const TriangleMesh& mesh, Grid& grid, double& looked_at) const {
  const auto cells = std::size_t(grid.size.x) * std::size_t(grid.size.y) * std::size_t(grid.size.z);
  grid.near_face.assign(cells, 0);
  grid.shares.assign(cells, 0);
  // A face must not pass between the middles of large cells.
  const float touches = std::max(kTouches * spacing_, 0.87f * grid.cell);
  for (const glm::uvec3& corners : mesh.triangles) {
    const glm::vec3& a = mesh.positions[corners.x];
    const glm::vec3& b = mesh.positions[corners.y];
    const glm::vec3& c = mesh.positions[corners.z];
    const glm::vec3 across = glm::cross(b - a, c - a);
    const float twice_area = glm::length(across);
    if (!(twice_area > 0.0f)) continue;
    const glm::vec3 normal = across / twice_area;
    const glm::vec3 low = (glm::min(a, glm::min(b, c)) - touches - grid.low) / grid.cell;
    const glm::vec3 high = (glm::max(a, glm::max(b, c)) + touches - grid.low) / grid.cell;
    const glm::ivec3 first = glm::clamp(glm::ivec3(glm::floor(low)), glm::ivec3(0), grid.size - 1);
    const glm::ivec3 last = glm::clamp(glm::ivec3(glm::floor(high)), glm::ivec3(0), grid.size - 1);
    const glm::dvec3 box(last - first + 1);
    looked_at += box.x * box.y * box.z;
    if (looked_at > kMaxMarked) {  // very many large triangles: then all of the body counts as near one
      std::ranges::fill(grid.near_face, std::uint8_t{1});
      return;
    }
    for (int z = first.z; z <= last.z; ++z)
      for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
          const glm::ivec3 cell(x, y, z);
          const glm::vec3 middle = grid.low + grid.cell * (glm::vec3(cell) + 0.5f);
          if (std::abs(glm::dot(middle - a, normal)) <= touches) grid.near_face[grid.at(cell)] = 1;
        }
  }
}

void BodyWetness::forget() {
  for (Grid& grid : grids_) {
    std::ranges::fill(grid.shares, std::uint8_t{0});
    grid.wet_low = grid.wet_high = glm::ivec3(0);
    if (grid.version != 0) grid.version = ++version_;
  }
}

bool BodyWetness::wet(const glm::vec3& at, Grid& grid) const {
  const glm::vec3 place = (at - grid.low) / grid.cell;
  // Written so that what is not a number is not within.
  if (!(glm::all(glm::greaterThanEqual(place, glm::vec3(0.0f))) &&
        glm::all(glm::lessThan(place, glm::vec3(grid.size)))))
    return false;
  const glm::ivec3 own(place);
  const std::size_t here = grid.at(own);
  if (!grid.near_face[here] || grid.shares[here] == 255) return false;
  const float cells = spacing_ / grid.cell;
  const glm::ivec3 first = glm::max(glm::ivec3(glm::floor(place - kNot * cells)), glm::ivec3(0));
  const glm::ivec3 last = glm::min(glm::ivec3(glm::floor(place + kNot * cells)), grid.size - 1);
  for (int z = first.z; z <= last.z; ++z)
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x) {
        const glm::ivec3 cell(x, y, z);
        const float away = glm::distance(glm::vec3(cell) + 0.5f, place) / cells;
        const float share = 1.0f - glm::clamp((away - kWhole) / (kNot - kWhole), 0.0f, 1.0f);
        std::uint8_t& now = grid.shares[grid.at(cell)];
        now = std::max(now, static_cast<std::uint8_t>(255.0f * share));
      }
  grid.shares[here] = 255;
  const bool dry = grid.wet_low == grid.wet_high;
  grid.wet_low = dry ? first : glm::min(grid.wet_low, first);
  grid.wet_high = dry ? last + 1 : glm::max(grid.wet_high, last + 1);
  return true;
}

void BodyWetness::dry(Grid& grid, int by) {
  if (grid.wet_low == grid.wet_high) return;
  glm::ivec3 low = grid.size, high(0);
  for (int z = grid.wet_low.z; z < grid.wet_high.z; ++z)
    for (int y = grid.wet_low.y; y < grid.wet_high.y; ++y) {
      std::uint8_t* row = grid.shares.data() + grid.at({0, y, z});
      for (int x = grid.wet_low.x; x < grid.wet_high.x; ++x)
        row[x] = static_cast<std::uint8_t>(std::max(int(row[x]) - by, 0));
      int first = grid.wet_low.x, end = grid.wet_high.x;
      while (first < end && row[first] == 0) ++first;
      while (end > first && row[end - 1] == 0) --end;
      if (first == end) continue;
      low = glm::min(low, glm::ivec3(first, y, z));
      high = glm::max(high, glm::ivec3(end, y + 1, z + 1));
    }
  const bool gone = low.x >= high.x;
  grid.wet_low = gone ? glm::ivec3(0) : low;
  grid.wet_high = gone ? glm::ivec3(0) : high;
  grid.version = ++version_;
}

void BodyWetness::record(const Snapshot& snapshot) {
  const double time = snapshot.rigid.time;
  if (time < time_) {
    forget();
    dried_ = time;
  }
  time_ = time;
  const double steps = std::floor((time - dried_) * kDrySteps / kDriesIn);
  if (steps >= 1.0) {
    dried_ += steps * kDriesIn / kDrySteps;
    const int by = static_cast<int>(std::min(steps, double(kDrySteps) * 2.0)) * kDryStep;
    for (Grid& grid : grids_) dry(grid, by);
  }
  const std::size_t count = std::min(snapshot.positions.size(), snapshot.fluid_index.size());
  const std::size_t turns = count * grids_.size() / kMaxLooked + 1;
  turn_ = (turn_ + 1) % turns;
  for (Grid& grid : grids_) {
    if (grid.body >= snapshot.rigid.bodies.size() || snapshot.rigid.bodies[grid.body].gone ||
        snapshot.rigid.bodies[grid.body].away())
      continue;
    const Pose& pose = snapshot.rigid.bodies[grid.body].pose;
    const glm::mat3 turned = glm::transpose(glm::mat3_cast(glm::quat(pose.orientation)));
    const glm::vec3 origin(pose.position);
    bool changed = false;
    for (std::size_t i = turn_; i < count; i += turns) {
      if (snapshot.fluid_index[i] != 255) changed |= wet(turned * (snapshot.positions[i] - origin), grid);
    }
    if (changed) grid.version = ++version_;
  }
}

Wetness BodyWetness::of(std::size_t body) const {
  const auto grid = std::ranges::find(grids_, body, &Grid::body);
  if (grid == grids_.end() || grid->wet_low == grid->wet_high) return {};
  return {grid->version, grid->low,    grid->cell,    kOff * spacing_,
          grid->size,    grid->shares, grid->wet_low, grid->wet_high};
}

}  // namespace slosh
