#include "scenes/make/solid.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace slosh::make {
namespace {

/// A corner of less than about 25° is part of a curve already.
constexpr double kGentleTurn = -0.9;

}  // namespace

Solid lathe(const std::vector<glm::dvec2>& profile, int segments) {
  Solid out;
  const int count = static_cast<int>(profile.size());
  const bool on_axis = profile.front().x == 0.0 && profile.back().x == 0.0;
  std::vector<std::vector<std::uint32_t>> rings(count);
  for (int i = 0; i < count; ++i) {
    for (int s = 0; s < segments; ++s) {
      if (profile[i].x == 0.0 && s > 0) {
        rings[i].push_back(rings[i][0]);
        continue;
      }
      const double angle = glm::two_pi<double>() * s / segments;
      rings[i].push_back(static_cast<std::uint32_t>(out.points.size()));
      out.points.emplace_back(profile[i].x * std::cos(angle), profile[i].y, profile[i].x * std::sin(angle));
    }
  }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) out.triangles.emplace_back(a, b, c);
  };
  for (int i = 0; i + (on_axis ? 1 : 0) < count; ++i) {
    const auto& here = rings[i];
    const auto& next = rings[(i + 1) % count];
    for (int s = 0; s < segments; ++s) {
      const int t = (s + 1) % segments;
      add(here[s], next[s], next[t]);
      add(here[s], next[t], here[t]);
    }
  }
  return out;
}

std::vector<glm::dvec2> round_corners(const std::vector<glm::dvec2>& profile, double radius, int steps) {
  const std::size_t count = profile.size();
  const bool ring = !(profile.front().x == 0.0 && profile.back().x == 0.0);
  std::vector<glm::dvec2> out;
  for (std::size_t i = 0; i < count; ++i) {
    const bool end = !ring && (i == 0 || i + 1 == count);
    if (end) {
      out.push_back(profile[i]);
      continue;
    }
    const glm::dvec2 p = profile[i];
    const glm::dvec2 back = profile[(i + count - 1) % count] - p;
    const glm::dvec2 ahead = profile[(i + 1) % count] - p;
    if (glm::dot(glm::normalize(back), glm::normalize(ahead)) < kGentleTurn) {
      out.push_back(p);
      continue;
    }
    const double reach = std::min({radius, 0.45 * glm::length(back), 0.45 * glm::length(ahead)});
    const glm::dvec2 from = p + reach * glm::normalize(back);
    const glm::dvec2 to = p + reach * glm::normalize(ahead);
    for (int s = 0; s <= steps; ++s) {
      const double u = static_cast<double>(s) / steps;
      out.push_back((1 - u) * (1 - u) * from + 2 * u * (1 - u) * p + u * u * to);
    }
  }
  return out;
}

Solid box(const glm::dvec3& low, const glm::dvec3& high) {
  Solid out;
  for (int i = 0; i < 8; ++i) {
    out.points.emplace_back(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
  }
  const auto quad = [&](unsigned a, unsigned b, unsigned c, unsigned d) {
    out.triangles.emplace_back(a, b, c);
    out.triangles.emplace_back(a, c, d);
  };
  quad(0, 4, 6, 2);  // −x
  quad(1, 3, 7, 5);  // +x
  quad(0, 1, 5, 4);  // −y
  quad(2, 6, 7, 3);  // +y
  quad(0, 2, 3, 1);  // −z
  quad(4, 5, 7, 6);  // +z
  return out;
}

Solid tank(const glm::dvec3& inner, double wall) {
  const glm::dvec3 half(0.5 * inner.x, 0.0, 0.5 * inner.z);
  const glm::dvec3 side(wall, 0.0, wall);
  const glm::dvec3 top(0.0, wall + inner.y, 0.0);
  Solid out = box(-half - side, half + side + top);
  Solid hollow = box(-half + glm::dvec3(0.0, wall, 0.0), half + top);
  // The hollow's faces look into it; the two lids at the top give way to a rim between them.
  const auto drop_lid = [](Solid& s) { s.triangles.erase(s.triangles.begin() + 6, s.triangles.begin() + 8); };
  drop_lid(out);
  drop_lid(hollow);
  for (glm::uvec3& t : hollow.triangles) std::swap(t.y, t.z);
  out = merged(std::move(out), hollow);
  const unsigned outer_rim[4] = {2, 6, 7, 3};
  for (int i = 0; i < 4; ++i) {
    const unsigned a = outer_rim[i];
    const unsigned b = outer_rim[(i + 1) % 4];
    out.triangles.emplace_back(a, b, b + 8);
    out.triangles.emplace_back(a, b + 8, a + 8);
  }
  return out;
}

Solid sphere(double radius, int rings, int segments) {
  return capsule(radius, 0.0, 0.0, rings, segments);
}

Solid capsule(double radius, double from, double to, int rings, int segments) {
  std::vector<glm::dvec2> profile;
  for (int i = 0; i <= rings; ++i) {
    const double angle = glm::pi<double>() * (static_cast<double>(i) / rings - 0.5);
    const double r = i == 0 || i == rings ? 0.0 : radius * std::cos(angle);
    const double y = radius * std::sin(angle);
    if (2 * i <= rings) profile.emplace_back(r, from + y);
    if (2 * i >= rings && !(2 * i == rings && from == to)) profile.emplace_back(r, to + y);
  }
  return lathe(profile, segments);
}

Solid tube(const std::vector<glm::dvec3>& path, double radius, int segments) {
  Solid out;
  const int count = static_cast<int>(path.size());
  glm::dvec3 side(0.0);
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 along = glm::normalize(path[std::min(i + 1, count - 1)] - path[std::max(i - 1, 0)]);
    if (i == 0) {
      side = std::abs(along.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(1.0, 0.0, 0.0);
    }
    side = glm::normalize(side - glm::dot(side, along) * along);  // carried along without twist
    const glm::dvec3 other = glm::cross(along, side);
    for (int s = 0; s < segments; ++s) {
      const double angle = glm::two_pi<double>() * s / segments;
      out.points.push_back(path[i] + radius * (std::cos(angle) * side + std::sin(angle) * other));
    }
  }
  const auto at = [&](int ring, int s) { return static_cast<unsigned>(ring * segments + s % segments); };
  for (int i = 0; i + 1 < count; ++i) {
    for (int s = 0; s < segments; ++s) {
      out.triangles.emplace_back(at(i, s), at(i, s + 1), at(i + 1, s + 1));
      out.triangles.emplace_back(at(i, s), at(i + 1, s + 1), at(i + 1, s));
    }
  }
  const auto first = static_cast<unsigned>(out.points.size());
  out.points.push_back(path.front());
  out.points.push_back(path.back());
  for (int s = 0; s < segments; ++s) {
    out.triangles.emplace_back(first, at(0, s + 1), at(0, s));
    out.triangles.emplace_back(first + 1, at(count - 1, s), at(count - 1, s + 1));
  }
  return out;
}

Solid transformed(Solid solid, const glm::dmat4& matrix) {
  for (glm::dvec3& p : solid.points) p = glm::dvec3(matrix * glm::dvec4(p, 1.0));
  if (glm::determinant(glm::dmat3(matrix)) < 0.0) {
    for (glm::uvec3& t : solid.triangles) std::swap(t.y, t.z);
  }
  return solid;
}

Solid merged(Solid a, const Solid& b) {
  const auto base = static_cast<unsigned>(a.points.size());
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  for (const glm::uvec3& t : b.triangles) a.triangles.push_back(t + base);
  return a;
}

TriangleMesh with_normals(const Solid& solid, double crease_deg) {
  const double least_cosine = std::cos(glm::radians(crease_deg));
  std::vector<glm::dvec3> faces;
  std::vector<std::vector<std::uint32_t>> around(solid.points.size());
  for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
    const glm::uvec3& c = solid.triangles[t];
    faces.push_back(glm::cross(solid.points[c.y] - solid.points[c.x], solid.points[c.z] - solid.points[c.x]));
    for (int i = 0; i < 3; ++i) around[c[i]].push_back(t);
  }
  TriangleMesh out;
  std::vector<std::vector<std::uint32_t>> made(solid.points.size());  // vertices of the result a point became
  for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
    glm::uvec3 corners;
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t p = solid.triangles[t][i];
      glm::dvec3 sum(0.0);
      for (const std::uint32_t other : around[p]) {
        if (glm::dot(glm::normalize(faces[other]), glm::normalize(faces[t])) > least_cosine)
          sum += faces[other];
      }
      const glm::vec3 normal(glm::normalize(sum));
      std::uint32_t vertex = ~0u;
      for (const std::uint32_t v : made[p]) {
        if (glm::distance(out.normals[v], normal) < 1e-4f) vertex = v;
      }
      if (vertex == ~0u) {
        vertex = static_cast<std::uint32_t>(out.positions.size());
        out.positions.emplace_back(solid.points[p]);
        out.normals.push_back(normal);
        made[p].push_back(vertex);
      }
      corners[i] = vertex;
    }
    out.triangles.push_back(corners);
  }
  return out;
}

}  // namespace slosh::make
