#include "peer/view/foam.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace slosh {
namespace {

constexpr double kThinnest = 0.02;  // Pa·s: thicker than this, air does not stay in it as foam
constexpr float kFoamReach = 2.5f;  // spacings: some 60 neighbours inside

// Between which values a potential goes from 0 to 1. The paper's sums over neighbours are means here, so that
// the same motion foams alike at every spacing; and its numbers are a harbour's, ours a bucket's.
constexpr float kTrapped[] = {0.15f, 0.8f};  // m/s
constexpr float kCrest[] = {0.02f, 0.1f};
constexpr float kEnergy[] = {0.18f, 1.2f};  // J/kg: 0.6 and 1.55 m/s
constexpr float kLeads = 0.6f;              // cosine of way and normal (Eq 7)
constexpr float kSurface = 0.12f;  // of the reach: how far a surface particle's neighbours lie to one side

constexpr float kMadeTrapped = 80.0f;  // a second, of a particle with all of it (k_ta)
constexpr float kMadeCrest = 80.0f;    // (k_wc)
constexpr float kFewest = 6.0f;        // neighbours: fewer is spray (their 4.3)
constexpr float kMaxOfFoam = 30.0f;    // more is a bubble; where all around is fluid there are some 60
constexpr float kLives = 0.9f;         // s
constexpr float kFlies = 1.5f;         // s
constexpr float kRises = 1.2f;         // of gravity, a bubble (k_b)
constexpr float kDragged = 12.0f;      // a second, a bubble to the fluid's velocity (k_d)
constexpr float kLongest = 0.2f;       // s between snapshots that belong together
constexpr float kDropSize = 0.2f;      // of the spacing
constexpr float kClear = 0.1f;         // of the spacing, off a wall

float share(float value, const float (&between)[2]) {
  return std::clamp((value - between[0]) / (between[1] - between[0]), 0.0f, 1.0f);
}

glm::ivec3 cell_of(const glm::vec3& at, float reach) {
  return glm::ivec3(glm::floor(glm::clamp(at / reach, glm::vec3(-1e8f), glm::vec3(1e8f))));
}
std::size_t hash(const glm::ivec3& cell, std::size_t buckets) {
  const auto mixed = static_cast<std::uint32_t>(cell.x) * 73856093u ^
                     static_cast<std::uint32_t>(cell.y) * 19349663u ^
                     static_cast<std::uint32_t>(cell.z) * 83492791u;
  return mixed & (buckets - 1);
}

}  // namespace

bool FoamPlan::any() const {
  return std::ranges::find(fluids, true) != fluids.end();
}

FoamPlan plan_foam(const Scene& scene) {
  FoamPlan plan;
  for (const Fluid& fluid : scene.fluids) {
    const float hides = (fluid.extinction.x + fluid.extinction.y + fluid.extinction.z) / 3.0f;
    plan.fluids.push_back(fluid.dynamic_viscosity < kThinnest && hides < 100.0f);
  }
  plan.reason = scene.fluids.empty() ? "there is no fluid"
                : plan.any()         ? "a fluid thinner than 0.02 Pa·s that one sees into"
                                     : "every fluid is thicker than 0.02 Pa·s or hides what is in it";
  return plan;
}

Foam::Foam(const Scene& scene, double spacing)
    : scene_(scene),
      plan_(plan_foam(scene)),
      spacing_(static_cast<float>(spacing)),
      reach_(kFoamReach * static_cast<float>(spacing)) {}

float Foam::random() {  // PCG (O'Neill 2014)
  state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
  const auto mixed = static_cast<std::uint32_t>(((state_ >> 18) ^ state_) >> 27);
  const auto turn = static_cast<std::uint32_t>(state_ >> 59);
  return static_cast<float>(((mixed >> turn) | (mixed << ((32 - turn) & 31))) >> 8) * (1.0f / 16777216.0f);
}

void Foam::sort(std::span<const glm::vec3> positions) {
  const std::size_t buckets = std::bit_ceil(std::max<std::size_t>(positions.size(), 2));
  begin_.assign(buckets + 1, 0);
  const auto counts = [&](std::size_t i) { return foams_[i] != 0; };
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (counts(i)) ++begin_[hash(cell_of(positions[i], reach_), buckets) + 1];
  for (std::size_t b = 1; b <= buckets; ++b) begin_[b] += begin_[b - 1];
  sorted_.resize(begin_.back());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (counts(i))
      sorted_[next[hash(cell_of(positions[i], reach_), buckets)]++] = static_cast<std::uint32_t>(i);
}

template <class Visit>
void Foam::each_neighbour(const glm::vec3& at, Visit&& visit) const {
  const std::size_t buckets = begin_.size() - 1;
  const glm::ivec3 middle = cell_of(at, reach_);
  std::size_t seen[27];
  std::size_t count = 0;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const std::size_t bucket = hash(middle + glm::ivec3(x, y, z), buckets);
        if (std::find(seen, seen + count, bucket) != seen + count) continue;  // two cells in one bucket
        seen[count++] = bucket;
        for (std::uint32_t k = begin_[bucket]; k < begin_[bucket + 1]; ++k) visit(sorted_[k]);
      }
}

FoamPotential Foam::look_around(std::size_t i, std::span<const glm::vec3> positions,
                                std::span<const glm::vec3> velocities) const {
  const glm::vec3& at = positions[i];
  const glm::vec3& velocity = velocities[i];
  // Where the neighbours' mean lies tells which way is out.
  const auto normal_at = [&](const glm::vec3& place, std::uint32_t self) {
    glm::vec3 sum(0.0f);
    float weights = 0.0f;
    each_neighbour(place, [&](std::uint32_t j) {
      const glm::vec3 way = positions[j] - place;
      const float length = glm::length(way);
      if (j == self || length >= reach_) return;
      const float weight = 1.0f - length / reach_;
      sum -= way * weight;
      weights += weight;
    });
    const float off = weights > 0.0f ? glm::length(sum) / (weights * reach_) : 0.0f;
    return off > kSurface ? glm::normalize(sum) : glm::vec3(0.0f);
  };
  const float speed = glm::length(velocity);
  const auto self = static_cast<std::uint32_t>(i);
  const glm::vec3 normal = normal_at(at, self);
  const bool leads =
      normal != glm::vec3(0.0f) && speed > 0.0f && glm::dot(velocity / speed, normal) >= kLeads;
  float trapped = 0.0f, bent = 0.0f, weights = 0.0f, surface_weights = 0.0f;
  each_neighbour(at, [&](std::uint32_t j) {
    if (j == self) return;
    const glm::vec3 way = at - positions[j];
    const float length = glm::length(way);
    if (length >= reach_ || length < 1e-9f) return;
    const float weight = 1.0f - length / reach_;
    const glm::vec3 relative = velocity - velocities[j];
    const float difference = glm::length(relative);
    if (difference > 0.0f)
      trapped += difference * (1.0f - glm::dot(relative / difference, way / length)) * weight;
    weights += weight;
    if (!leads) return;
    const glm::vec3 other = normal_at(positions[j], j);
    if (other == glm::vec3(0.0f)) return;
    surface_weights += weight;
    // Eq 5: only where the surface falls away from here.
    if (glm::dot(-way, normal) < 0.0f) bent += (1.0f - glm::dot(normal, other)) * weight;
  });
  FoamPotential found;
  found.energy = share(0.5f * speed * speed, kEnergy);
  if (weights > 0.0f) found.trapped_air = share(0.5f * trapped / weights, kTrapped);
  if (surface_weights > 0.0f) found.wave_crest = share(bent / surface_weights, kCrest);
  return found;
}

FoamPotential Foam::potential(std::size_t i, std::span<const glm::vec3> positions,
                              std::span<const glm::vec3> velocities) {
  foams_.assign(positions.size(), 1);
  sort(positions);
  return look_around(i, positions, velocities);
}

void Foam::record(const Snapshot& snapshot) {
  looked_at_ = 0;
  if (!plan_.any()) return;
  const double passed = snapshot.rigid.time - time_;
  if (time_ >= 0.0 && passed == 0.0) return;
  const bool follows =
      time_ >= 0.0 && passed > 0.0 && passed <= kLongest && before_.size() == snapshot.positions.size();
  const std::span<const glm::vec3> positions = snapshot.positions;
  if (follows) {
    velocities_.resize(before_.size());
    foams_.resize(before_.size());
    fast_.clear();
    for (std::size_t i = 0; i < before_.size(); ++i) {
      const std::uint8_t fluid = snapshot.fluid_index[i];
      velocities_[i] = (positions[i] - before_[i]) / static_cast<float>(passed);
      const float speed2 = glm::dot(velocities_[i], velocities_[i]);
      foams_[i] = fluid < plan_.fluids.size() && plan_.fluids[fluid] && speed2 < 1e4f;
      if (foams_[i] && 0.5f * speed2 > kEnergy[0]) fast_.push_back(static_cast<std::uint32_t>(i));
    }
    // Still water has no foam and costs a look at its speeds.
    const bool violent = !fast_.empty() || !drops_.empty();
    if (violent && !walls_) walls_.emplace(scene_, kClear * spacing_);
    if (walls_) walls_->move(snapshot.rigid);
    if (violent) {
      sort(positions);
      move(static_cast<float>(passed), positions);
      make(static_cast<float>(passed), positions);
    }
  } else {
    if (walls_) walls_->move(snapshot.rigid);
    drops_.clear();
  }
  before_ = snapshot.positions;
  time_ = snapshot.rigid.time;
  show();
}

void Foam::move(float passed, std::span<const glm::vec3> positions) {
  const glm::vec3 gravity(scene_.gravity);
  for (Drop& drop : drops_) {
    glm::vec3 flow(0.0f);
    float weights = 0.0f, neighbours = 0.0f;
    each_neighbour(drop.at, [&](std::uint32_t j) {
      const float length = glm::distance(drop.at, positions[j]);
      if (length >= reach_) return;
      const float weight = 1.0f - length / reach_;
      flow += velocities_[j] * weight;
      weights += weight;
      neighbours += 1.0f;
    });
    if (weights > 0.0f) flow /= weights;
    drop.kind = neighbours < kFewest ? Kind::kSpray : neighbours <= kMaxOfFoam ? Kind::kFoam : Kind::kBubble;
    if (drop.kind == Kind::kSpray) {
      drop.velocity += gravity * passed;
      drop.life -= passed * (kLives / kFlies);
    } else if (drop.kind == Kind::kFoam) {
      drop.velocity = flow;
      drop.life -= passed;
    } else {
      const float dragged = 1.0f - std::exp(-kDragged * passed);
      drop.velocity += (flow - drop.velocity) * dragged - gravity * (kRises * passed);
      drop.life -= 0.5f * passed;
    }
    // What flew off alone would hang about the room.
    if (neighbours == 0.0f) drop.life = 0.0f;
    const glm::vec3 to = drop.at + drop.velocity * passed;
    if (const auto stopped = walls_->stop(drop.at, to)) {
      drop.velocity = (*stopped - drop.at) / passed;
      drop.at = *stopped;
    } else {
      drop.at = to;
    }
  }
  const glm::vec3 low(scene_.domain_min), high(scene_.domain_max);
  std::erase_if(drops_, [&](const Drop& drop) {
    return !(drop.life > 0.0f) || glm::any(glm::lessThan(drop.at, low)) ||
           glm::any(glm::greaterThan(drop.at, high));
  });
}

void Foam::make(float passed, std::span<const glm::vec3> positions) {
  // A bounded number of looks, in turn among all where there are more.
  const std::size_t each = fast_.size() / kMaxLooked + 1;
  const std::size_t first = each > 1 ? static_cast<std::size_t>(random() * static_cast<float>(each)) : 0;
  for (std::size_t k = std::min(first, each - 1); k < fast_.size() && looked_at_ < kMaxLooked; k += each) {
    if (drops_.size() >= kMax) return;
    ++looked_at_;
    const std::uint32_t i = fast_[k];
    const FoamPotential p = look_around(i, positions, velocities_);
    const float wanted = p.energy * (kMadeTrapped * p.trapped_air + kMadeCrest * p.wave_crest) * passed *
                         static_cast<float>(each);
    auto count = static_cast<int>(wanted + random());
    const float speed = glm::length(velocities_[i]);
    const glm::vec3 way = velocities_[i] / speed;
    const glm::vec3 other = std::abs(way.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 u = glm::normalize(glm::cross(other, way));
    const glm::vec3 v = glm::cross(way, u);
    for (; count > 0 && drops_.size() < kMax; --count) {
      // Anywhere in the cylinder that the particle came through (their Fig 5).
      const float radius = 0.5f * spacing_ * std::sqrt(random());
      const float angle = glm::two_pi<float>() * random();
      const glm::vec3 aside = radius * (std::cos(angle) * u + std::sin(angle) * v);
      const glm::vec3 at = positions[i] + aside - random() * passed * velocities_[i];
      if (walls_->stop_now(positions[i], at)) continue;  // its way began on a wall's other side
      drops_.push_back({at, velocities_[i] + aside * (0.2f * speed / spacing_),
                        kLives * (0.4f + 0.6f * random()), Kind::kFoam});
    }
  }
}

void Foam::show() {
  points_.clear();
  for (const Drop& drop : drops_) {
    const float fades = std::min(drop.life / (0.35f * kLives), 1.0f);
    const float size = drop.kind == Kind::kFoam ? 1.25f : drop.kind == Kind::kBubble ? 0.8f : 1.0f;
    points_.push_back({drop.at, kDropSize * spacing_ * size, fades});
  }
}

}  // namespace slosh
