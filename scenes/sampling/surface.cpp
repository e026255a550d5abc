#include "scenes/sampling/surface.h"

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <queue>
#include <random>

#include "scenes/mesh/closed.h"
#include "sim/math/point_grid.h"

namespace slosh::sampling {
namespace {

constexpr int kCandidatesEach = 5;  // Yuksel's advice
constexpr int kRelaxations = 8;
constexpr float kSameSheet = -0.3f;   // cosine between normals above which two samples feel each other
constexpr double kMinDistance = 0.6;  // between two samples, in spacings
constexpr double kLargestGap = 0.75;  // from a point of the fine net to the nearest sample, in spacings
constexpr double kNetEach = 16.0;     // points of the fine net a spacing²
constexpr double kFewestSamples = 6.0;
constexpr double kMaxSamples = 5e6;  // sample_scene refuses long before

struct Points {
  std::vector<glm::vec3> at;
  std::vector<glm::vec3> normal;
  std::vector<std::int32_t> triangle;

  void add(const glm::vec3& p, const glm::vec3& n, std::int32_t t) {
    at.push_back(p);
    normal.push_back(n);
    triangle.push_back(t);
  }
  std::size_t size() const { return at.size(); }
};

bool same_sheet(const Points& points, std::size_t i, std::size_t j) {
  return glm::dot(points.normal[i], points.normal[j]) > kSameSheet;
}

/// Area-weighted points, evenly spread along the list of triangles, at random within each.
Points scatter(const TriangleMesh& mesh, const mesh::MeshTree& tree, double area, std::size_t count) {
  std::mt19937_64 bits(0x510544ull);
  const auto random = [&] { return static_cast<double>(bits() >> 11) * 0x1.0p-53; };
  Points out;
  const double share = area / static_cast<double>(count);
  double due = share * random();
  double walked = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const glm::dvec3 a(mesh.positions[mesh.triangles[t].x]);
    const glm::dvec3 b(mesh.positions[mesh.triangles[t].y]);
    const glm::dvec3 c(mesh.positions[mesh.triangles[t].z]);
    walked += 0.5 * glm::length(glm::cross(b - a, c - a));
    for (; due < walked; due += share) {
      const double root = std::sqrt(random());
      const double v = random();
      const glm::dvec3 p = (1.0 - root) * a + root * (1.0 - v) * b + root * v * c;
      out.add(glm::vec3(p), tree.face_normal(static_cast<int>(t)), static_cast<std::int32_t>(t));
    }
  }
  return out;
}

/// A point of the surface that lies inside another part.
bool is_buried(const mesh::MeshTree& tree, const glm::vec3& at, const glm::vec3& normal, float spacing) {
  return tree.inside(at + normal * (1e-3f * spacing));
}

/// Takes away the points inside another part; they come back in `buried`.
Points keep_exposed(const Points& points, const mesh::MeshTree& tree, float spacing,
                    std::vector<glm::vec3>& buried) {
  Points out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_buried(tree, points.at[i], points.normal[i], spacing)) {
      buried.push_back(points.at[i]);
    } else {
      out.add(points.at[i], points.normal[i], points.triangle[i]);
    }
  }
  return out;
}

/// Yuksel 2015: removes the point with the largest sum of closeness until `target` are left.
Points eliminate(const Points& points, std::size_t target, double area) {
  const double ratio = static_cast<double>(target) / static_cast<double>(points.size());
  const double r_max = std::sqrt(area / (2.0 * std::sqrt(3.0) * static_cast<double>(target)));
  const double r_min = r_max * (1.0 - std::pow(ratio, 1.5)) * 0.65;
  const auto reach = static_cast<float>(2.0 * r_max);
  const auto closeness = [&](float distance) {
    const double d = std::max(static_cast<double>(distance), 2.0 * r_min);
    const double x = std::max(0.0, 1.0 - d / (2.0 * r_max));
    const double x2 = x * x;
    return x2 * x2 * x2 * x2;
  };
  const PointGrid grid(points.at, reach);
  const auto each_neighbor = [&](std::uint32_t i, auto visit) {
    grid.each_near(points.at[i], [&](std::uint32_t j) {
      if (j == i) return;
      const float distance = glm::distance(points.at[i], points.at[j]);
      if (distance < reach && same_sheet(points, i, j)) visit(j, closeness(distance));
    });
  };
  std::vector<double> weight(points.size(), 0.0);
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry> heap;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    each_neighbor(i, [&](std::uint32_t, double w) { weight[i] += w; });
    heap.emplace(weight[i], i);
  }
  std::vector<bool> gone(points.size(), false);
  std::size_t left = points.size();
  while (left > target) {
    const auto [stored, i] = heap.top();
    heap.pop();
    if (stored > weight[i]) {  // weights only fall: an entry that is too high is old
      heap.emplace(weight[i], i);
      continue;
    }
    gone[i] = true;
    --left;
    each_neighbor(i, [&](std::uint32_t j, double w) {
      if (!gone[j]) weight[j] -= w;
    });
  }
  Points out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!gone[i]) out.add(points.at[i], points.normal[i], points.triangle[i]);
  }
  return out;
}

/// Points near a buried part of the surface stay where they are: moving they could slip under it.
std::vector<bool> find_frozen(const Points& points, const std::vector<glm::vec3>& buried, float radius) {
  std::vector<bool> frozen(points.size(), false);
  if (buried.empty()) return frozen;
  const PointGrid grid(buried, radius);
  for (std::size_t i = 0; i < points.size(); ++i) {
    grid.each_near(points.at[i], [&](std::uint32_t j) {
      if (glm::distance(points.at[i], buried[j]) < radius) frozen[i] = true;
    });
  }
  return frozen;
}

/// Pushes points apart and puts them back on the surface.
void relax(Points& points, const mesh::MeshTree& tree, const std::vector<bool>& frozen, float even_distance) {
  const float reach = 1.6f * even_distance;
  const float longest_move = 0.15f * even_distance;
  std::vector<glm::vec3> moves(points.size());
  for (int round = 0; round < kRelaxations; ++round) {
    const PointGrid grid(points.at, reach);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      glm::vec3 push(0.0f);
      grid.each_near(points.at[i], [&](std::uint32_t j) {
        if (j == i || !same_sheet(points, i, j)) return;
        const glm::vec3 way = points.at[i] - points.at[j];
        const float distance = glm::length(way);
        if (distance >= reach || distance <= 0.0f) return;
        const float near = 1.0f - distance / reach;
        push += way * (near * near / distance);
      });
      push *= 0.5f * even_distance;
      push -= points.normal[i] * glm::dot(push, points.normal[i]);
      const float length = glm::length(push);
      moves[i] = length > longest_move ? push * (longest_move / length) : push;
    }
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      if (frozen[i]) continue;
      const mesh::NearestPoint near = tree.nearest(points.at[i] + moves[i], INFINITY, points.triangle[i]);
      const glm::vec3 normal = tree.face_normal(near.triangle);
      if (glm::dot(normal, points.normal[i]) <= kSameSheet) continue;
      points.at[i] = near.point;
      points.normal[i] = normal;
      points.triangle[i] = near.triangle;
    }
  }
}

/// Takes away the later of two points that came too close: round a sharp edge, or between points that stay.
Points thin_out(const Points& points, float least_distance) {
  const PointGrid grid(points.at, least_distance);
  std::vector<bool> gone(points.size(), false);
  Points out;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    grid.each_near(points.at[i], [&](std::uint32_t j) {
      if (j >= i || gone[j] || !same_sheet(points, i, j)) return;
      if (glm::distance(points.at[i], points.at[j]) < least_distance) gone[i] = true;
    });
    if (!gone[i]) out.add(points.at[i], points.normal[i], points.triangle[i]);
  }
  return out;
}

/// A finer, more regular net of points than the candidates: a low-discrepancy sequence (Roberts' R2) in every
/// triangle, and its corners. Where it shows no gap there is none much larger.
Points fine_net(const TriangleMesh& mesh, const mesh::MeshTree& tree, double spacing) {
  Points out;
  const double share = spacing * spacing / kNetEach;
  double due = 0.5 * share;
  double walked = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const glm::vec3& a = mesh.positions[mesh.triangles[t].x];
    const glm::vec3& b = mesh.positions[mesh.triangles[t].y];
    const glm::vec3& c = mesh.positions[mesh.triangles[t].z];
    const glm::vec3 normal = tree.face_normal(static_cast<int>(t));
    const auto index = static_cast<std::int32_t>(t);
    const glm::vec3 middle = (a + b + c) / 3.0f;
    for (const glm::vec3& corner : {a, b, c}) out.add(glm::mix(corner, middle, 1e-3f), normal, index);
    walked += 0.5 * glm::length(glm::cross(glm::dvec3(b - a), glm::dvec3(c - a)));
    for (double n = 1.0; due < walked; due += share, n += 1.0) {
      double u = std::fmod(0.5 + 0.7548776662466927 * n, 1.0);
      double v = std::fmod(0.5 + 0.5698402909980532 * n, 1.0);
      if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
      out.add(a + static_cast<float>(u) * (b - a) + static_cast<float>(v) * (c - a), normal, index);
    }
  }
  return out;
}

/// Adds those candidates that lie too far from every sample, so that fluid finds no gap. `buried` tells of a
/// candidate that must not come in.
template <class Buried>
void plug_gaps(Points& points, const Points& candidates, float largest_gap, Buried buried) {
  const PointGrid grid(points.at, largest_gap);
  const std::size_t before = points.size();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const auto near = [&](std::size_t j) {
      return glm::distance(points.at[j], candidates.at[i]) < largest_gap &&
             glm::dot(points.normal[j], candidates.normal[i]) > kSameSheet;
    };
    bool covered = false;
    grid.each_near(candidates.at[i], [&](std::uint32_t j) { covered = covered || near(j); });
    // Those just added are few and not in the grid.
    for (std::size_t j = before; j < points.size() && !covered; ++j) covered = near(j);
    if (!covered && !buried(candidates.at[i], candidates.normal[i])) {
      points.add(candidates.at[i], candidates.normal[i], candidates.triangle[i]);
    }
  }
}

}  // namespace

SurfaceSamples sample_surface(const TriangleMesh& mesh, const mesh::MeshTree& tree, int parts, double spacing,
                              const std::function<void(double)>& tell) {
  // Shares of the time that they take on a large mesh.
  constexpr double kScattered = 0.05, kEliminated = 0.45, kRelaxed = 0.75;
  const auto done = [&](double share) {
    if (tell) tell(share);
  };
  const double area = mesh::surface_area(mesh);
  const double wanted = std::clamp(area / (spacing * spacing), kFewestSamples, kMaxSamples);
  const auto candidates = static_cast<std::size_t>(std::ceil(kCandidatesEach * wanted));
  Points points = scatter(mesh, tree, area, candidates);
  done(kScattered);
  std::vector<glm::vec3> buried;
  const std::size_t all = points.size();
  if (parts > 1) points = keep_exposed(points, tree, static_cast<float>(spacing), buried);
  const double exposed_share = static_cast<double>(points.size()) / static_cast<double>(all);
  const double exposed_area = area * exposed_share;
  const auto target = static_cast<std::size_t>(std::lround(std::max(wanted * exposed_share, 1.0)));
  points = eliminate(points, target, exposed_area);
  done(kEliminated);
  const double even = std::sqrt(2.0 / std::sqrt(3.0) * exposed_area / static_cast<double>(target));
  relax(points, tree, find_frozen(points, buried, static_cast<float>(spacing)), static_cast<float>(even));
  done(kRelaxed);
  points = thin_out(points, static_cast<float>(kMinDistance * spacing));
  const auto gap = static_cast<float>(kLargestGap * spacing);
  plug_gaps(points, fine_net(mesh, tree, spacing), gap, [&](const glm::vec3& at, const glm::vec3& normal) {
    return parts > 1 && is_buried(tree, at, normal, static_cast<float>(spacing));
  });
  SurfaceSamples out;
  out.positions = std::move(points.at);
  out.normals = std::move(points.normal);
  out.apart = static_cast<float>(spacing);
  out.particle_volume =
      static_cast<float>(exposed_area * spacing / static_cast<double>(out.positions.size()));
  return out;
}

}  // namespace slosh::sampling
