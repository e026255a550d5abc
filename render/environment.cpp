#include "render/environment.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <sstream>

#include "render/passes/frame_block.h"
#include "render/shader_math.h"

namespace slosh {
namespace {

constexpr float kBrightest = 6.0e4f;  // a half float's range

glm::vec3 direction_of(double column, double row, int width, int height) {
  const double around = glm::two_pi<double>() * (column / width - 0.5);
  const double down = glm::pi<double>() * row / height;
  return {std::sin(down) * std::sin(around), std::cos(down), -std::sin(down) * std::cos(around)};
}

/// Share of the sphere that a pixel of this row is.
double share_of_row(int row, int width, int height) {
  const double step = glm::pi<double>() / height;
  return (std::cos(row * step) - std::cos((row + 1) * step)) / (2.0 * width);
}

template <class Radiance>
Environment filled(int width, int height, Radiance radiance) {
  Environment made{width, height, {}};
  made.radiance.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      made.radiance.push_back(radiance(direction_of(x + 0.5, y + 0.5, width, height)));
  return made;
}

glm::vec3 studio_radiance(const glm::vec3& way) {
  const Studio studio;
  return shader::room_radiance(
      {studio.sky, studio.horizon, studio.ground, studio.softbox, glm::vec3(0, 1, 0)}, way);
}

/// Means over blocks of `times` × `times` pixels.
Environment smaller(const Environment& from, int times) {
  Environment made{from.width / times, from.height / times, {}};
  for (int y = 0; y < made.height; ++y) {
    for (int x = 0; x < made.width; ++x) {
      glm::vec3 sum(0.0f);
      for (int v = 0; v < times; ++v)
        for (int u = 0; u < times; ++u)
          sum +=
              from.radiance[static_cast<std::size_t>(y * times + v) * static_cast<std::size_t>(from.width) +
                            static_cast<std::size_t>(x * times + u)];
      made.radiance.push_back(sum / static_cast<float>(times * times));
    }
  }
  return made;
}

/// As bright in the mean as the studio.
void expose(Environment& environment) {
  const auto brightness = [](const glm::vec3& c) {
    return glm::dot(c, glm::vec3(0.2126f, 0.7152f, 0.0722f));
  };
  const float now = brightness(environment.mean());
  if (!(now > 0.0f)) return;
  const float wanted = brightness(filled(64, 32, studio_radiance).mean());
  for (glm::vec3& c : environment.radiance) c = glm::min(c * (wanted / now), glm::vec3(kBrightest));
}

/// A file's bytes, one after the other.
class Bytes {
 public:
  explicit Bytes(std::istream& in) : in_(in) {}
  int next() { return in_.get(); }  // below 0 at the end

  /// One row of RGBE. Returns what is wrong, or null.
  const char* row(std::vector<std::uint8_t>& rgbe) {
    const std::size_t width = rgbe.size() / 4;
    int head[4];
    for (int& byte : head) byte = next();
    if (head[3] < 0) return kCut;
    const bool new_style = head[0] == 2 && head[1] == 2 && head[2] < 128 && width >= 8 && width < 32768;
    if (!new_style) return old_row(rgbe, head);
    if (static_cast<std::size_t>(head[2]) * 256 + static_cast<std::size_t>(head[3]) != width) return kDamaged;
    for (std::size_t channel = 0; channel < 4; ++channel) {
      for (std::size_t x = 0; x < width;) {
        const int count = next();
        if (count < 0) return kCut;
        const std::size_t length = count > 128 ? count - 128 : count;
        if (length == 0 || x + length > width) return kDamaged;
        int value = 0;
        for (std::size_t k = 0; k < length; ++k) {
          if (k == 0 || count <= 128) value = next();
          if (value < 0) return kCut;
          rgbe[4 * x++ + channel] = static_cast<std::uint8_t>(value);
        }
      }
    }
    return nullptr;
  }

  static constexpr const char* kCut = "it is cut off";
  static constexpr const char* kDamaged = "it is damaged";

 private:
  /// Pixels one by one; (1, 1, 1, n) repeats the one before n times, times 256 for each such mark in a row.
  const char* old_row(std::vector<std::uint8_t>& rgbe, int (&head)[4]) {
    int shift = 0;
    for (std::size_t x = 0; 4 * x < rgbe.size();) {
      if (head[3] < 0) return kCut;
      if (head[0] == 1 && head[1] == 1 && head[2] == 1) {
        const std::size_t times = static_cast<std::size_t>(head[3]) << shift;
        if (x == 0 || shift > 16 || 4 * (x + times) > rgbe.size()) return kDamaged;
        for (std::size_t k = 0; k < times; ++k, ++x) std::copy_n(&rgbe[4 * (x - 1)], 4, &rgbe[4 * x]);
        shift += 8;
      } else {
        for (std::size_t c = 0; c < 4; ++c) rgbe[4 * x + c] = static_cast<std::uint8_t>(head[c]);
        ++x;
        shift = 0;
      }
      if (4 * x < rgbe.size())
        for (int& byte : head) byte = next();
    }
    return nullptr;
  }
  std::istream& in_;
};

glm::vec3 light_of(const std::uint8_t* rgbe) {
  if (rgbe[3] == 0) return glm::vec3(0.0f);
  const float scale = std::ldexp(1.0f, int{rgbe[3]} - (128 + 8));
  return glm::min(glm::vec3(rgbe[0], rgbe[1], rgbe[2]) * scale, glm::vec3(1.0e20f));
}

/// Real spherical harmonics of the first three bands.
std::array<float, 9> harmonics(const glm::vec3& d) {
  return {0.282095f,
          0.488603f * d.y,
          0.488603f * d.z,
          0.488603f * d.x,
          1.092548f * d.x * d.y,
          1.092548f * d.y * d.z,
          0.315392f * (3.0f * d.z * d.z - 1.0f),
          1.092548f * d.x * d.z,
          0.546274f * (d.x * d.x - d.y * d.y)};
}

glm::vec3 texel_direction(int x, int y, int size) {
  return shader::from_octahedral(glm::vec2(x, y) / static_cast<float>(size - 1) * 2.0f - 1.0f);
}

}  // namespace

glm::vec3 Environment::from(const glm::vec3& direction) const {
  const float around = std::atan2(direction.x, -direction.z) / glm::two_pi<float>() + 0.5f;
  const float down = std::acos(glm::clamp(direction.y, -1.0f, 1.0f)) / glm::pi<float>();
  const float x = around * static_cast<float>(width) - 0.5f;
  const float y = glm::clamp(down * static_cast<float>(height) - 0.5f, 0.0f, static_cast<float>(height - 1));
  const int x0 = static_cast<int>(std::floor(x));
  const int y0 = static_cast<int>(y);
  const auto at = [&](int column, int row) {
    column = (column % width + width) % width;
    row = std::min(row, height - 1);
    return radiance[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                    static_cast<std::size_t>(column)];
  };
  const float u = x - static_cast<float>(x0);
  const float v = y - static_cast<float>(y0);
  return glm::mix(glm::mix(at(x0, y0), at(x0 + 1, y0), u), glm::mix(at(x0, y0 + 1), at(x0 + 1, y0 + 1), u),
                  v);
}

glm::vec3 Environment::mean() const {
  glm::dvec3 sum(0.0);
  for (int y = 0; y < height; ++y) {
    const double share = share_of_row(y, width, height);
    for (int x = 0; x < width; ++x)
      sum += share * glm::dvec3(radiance[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                         static_cast<std::size_t>(x)]);
  }
  return glm::vec3(sum);
}

Result<std::shared_ptr<const Environment>> read_environment(const std::filesystem::path& file) {
  const auto wrong = [&](const std::string& what, const std::string& mend) {
    return Error{"environment " + file.string(), what, mend};
  };
  const std::string want = "Give a Radiance picture (.hdr) of a room, twice as wide as high";
  std::error_code trouble;
  if (!std::filesystem::is_regular_file(file, trouble))
    return wrong("there is no such file", "Look at its name");
  std::ifstream in(file, std::ios::binary);
  if (!in) return wrong("it cannot be opened", "Look at its permissions");
  std::string line;
  const auto next_line = [&] {
    line.clear();
    for (int c = in.get(); c >= 0 && c != '\n' && line.size() < 1000; c = in.get())
      line.push_back(static_cast<char>(c));
    return !in.fail();
  };
  if (!next_line() || !(line.starts_with("#?RADIANCE") || line.starts_with("#?RGBE")))
    return wrong("it is no Radiance picture", want);
  bool rgbe_format = false;
  for (int lines = 0; next_line() && !line.empty(); ++lines) {
    rgbe_format |= line == "FORMAT=32-bit_rle_rgbe";
    if (lines > 1000) return wrong("its head does not end", want);
  }
  if (!rgbe_format) return wrong("its head names no format that is read (32-bit_rle_rgbe)", want);
  next_line();
  long height = 0;
  long width = 0;
  if (std::sscanf(line.c_str(), "-Y %9ld +X %9ld", &height, &width) != 2 || height < 1 || width < 2)
    return wrong("its size is not told as \"-Y height +X width\"", want);
  if (width > 32767 || height * width > kMaxEnvironmentPixels)
    return wrong("it is " + std::to_string(width) + " x " + std::to_string(height) + " pixels",
                 "Give one of 8192 x 4096 or less");
  auto made = std::make_shared<Environment>();
  // Rows are averaged as they come, so that no more than what is kept is ever in memory.
  const int times = static_cast<int>((width + kKeptEnvironmentWidth - 1) / kKeptEnvironmentWidth);
  made->width = static_cast<int>(width) / times;
  made->height = static_cast<int>(height) / times;
  if (made->width < 2 || made->height < 1) return wrong("it is too small", want);
  made->radiance.assign(static_cast<std::size_t>(made->width) * static_cast<std::size_t>(made->height),
                        glm::vec3(0.0f));
  Bytes bytes(in);
  std::vector<std::uint8_t> row(4 * static_cast<std::size_t>(width));
  const float share = 1.0f / static_cast<float>(times * times);
  for (int y = 0; y < made->height * times; ++y) {
    if (const char* what = bytes.row(row))
      return wrong(std::string(what) + " in row " + std::to_string(y + 1) + " of " + std::to_string(height),
                   "Fetch it again");
    glm::vec3* into =
        &made->radiance[static_cast<std::size_t>(y / times) * static_cast<std::size_t>(made->width)];
    for (int x = 0; x < made->width * times; ++x)
      into[x / times] += share * light_of(&row[4 * static_cast<std::size_t>(x)]);
  }
  expose(*made);
  return std::shared_ptr<const Environment>(std::move(made));
}

std::shared_ptr<const Environment> make_studio_environment() {
  // Soft boxes: where, how wide and high (tangents of half angles), how bright.
  struct Box {
    glm::vec3 way;
    glm::vec2 half;
    glm::vec3 light;
    int panes;  // across; a window's bars
  };
  const Box boxes[] = {{{0.38f, 0.80f, 0.32f}, {0.42f, 0.30f}, {9.0f, 8.6f, 8.0f}, 1},
                       {{-0.92f, 0.30f, 0.15f}, {0.10f, 0.55f}, {5.0f, 5.4f, 6.0f}, 1},
                       {{0.25f, 0.38f, -0.90f}, {0.50f, 0.30f}, {3.2f, 3.6f, 4.2f}, 4},
                       {{0.80f, 0.22f, 0.55f}, {0.30f, 0.16f}, {2.4f, 2.2f, 1.9f}, 1}};
  auto made = std::make_shared<Environment>(filled(512, 256, [&](const glm::vec3& way) {
    glm::vec3 seen = 0.7f * studio_radiance(way);
    for (const Box& box : boxes) {
      const glm::vec3 axis = glm::normalize(box.way);
      const glm::vec3 right = glm::normalize(glm::cross(axis, glm::vec3(0, 1, 0)));
      const glm::vec3 up = glm::cross(right, axis);
      const float ahead = glm::dot(way, axis);
      if (ahead <= 0.05f) continue;
      const glm::vec2 at = glm::vec2(glm::dot(way, right), glm::dot(way, up)) / ahead;
      const glm::vec2 inside = 1.0f - glm::smoothstep(box.half * 0.92f, box.half * 1.06f, glm::abs(at));
      float bars = 1.0f;
      if (box.panes > 1) {
        const glm::vec2 pane =
            glm::fract((at / box.half * 0.5f + 0.5f) * glm::vec2(box.panes, box.panes / 2));
        const glm::vec2 open =
            glm::smoothstep(glm::vec2(0.02f), glm::vec2(0.07f), glm::min(pane, 1.0f - pane));
        bars = open.x * open.y;
      }
      seen += box.light * (inside.x * inside.y * bars);
    }
    return seen;
  }));
  expose(*made);
  return made;
}

LightProbe make_light_probe(const Environment& environment) {
  LightProbe probe;
  probe.sharp.reserve(std::size_t{LightProbe::kSharp} * LightProbe::kSharp);
  for (int y = 0; y < LightProbe::kSharp; ++y)
    for (int x = 0; x < LightProbe::kSharp; ++x)
      probe.sharp.push_back(environment.from(texel_direction(x, y, LightProbe::kSharp)));

  // What is blurred needs no more pixels than the blur leaves.
  const Environment coarse =
      environment.width > 256 ? smaller(environment, (environment.width + 255) / 256) : environment;
  const Environment coarser = coarse.width > 64 ? smaller(coarse, (coarse.width + 63) / 64) : coarse;
  struct Source {
    glm::vec3 way;
    glm::vec3 light;  // times its share of the sphere
    float share;
  };
  const auto sources_of = [](const Environment& from) {
    std::vector<Source> sources;
    for (int y = 0; y < from.height; ++y) {
      const auto share = static_cast<float>(share_of_row(y, from.width, from.height));
      for (int x = 0; x < from.width; ++x)
        sources.push_back(
            {direction_of(x + 0.5, y + 0.5, from.width, from.height),
             share * from.radiance[static_cast<std::size_t>(y) * static_cast<std::size_t>(from.width) +
                                   static_cast<std::size_t>(x)],
             share});
    }
    return sources;
  };
  const std::vector<Source> fine = sources_of(coarse);
  const std::vector<Source> few = sources_of(coarser);
  for (const Source& source : few) {
    const std::array<float, 9> basis = harmonics(source.way);
    // Cosine lobes over π: 1, 2/3, 1/4 a band; 4π of the sphere's share.
    constexpr float kBand[9] = {1.0f, 2.0f / 3, 2.0f / 3, 2.0f / 3, 0.25f, 0.25f, 0.25f, 0.25f, 0.25f};
    for (std::size_t k = 0; k < 9; ++k)
      probe.diffuse[k] += source.light * (basis[k] * kBand[k] * 4.0f * glm::pi<float>());
  }
  for (int layer = 0; layer < LightProbe::kLayers; ++layer) {
    const float roughness = 0.2f * static_cast<float>(layer + 1);
    const float a2 = std::pow(roughness, 4.0f);
    // The narrowest lobe needs the finer pixels; beyond this cosine it has nothing.
    const std::vector<Source>& sources = layer == 0 ? fine : few;
    const float least = layer == 0 ? 0.9f : 0.0f;
    for (int y = 0; y < LightProbe::kBlurred; ++y) {
      for (int x = 0; x < LightProbe::kBlurred; ++x) {
        const glm::vec3 way = texel_direction(x, y, LightProbe::kBlurred);
        glm::vec3 sum(0.0f);
        float weights = 1e-12f;
        for (const Source& source : sources) {
          const float n_l = glm::dot(way, source.way);
          if (n_l <= least) continue;
          const float n_h2 = 0.5f * (1.0f + n_l);
          const float f = n_h2 * (a2 - 1.0f) + 1.0f;
          const float weight = n_l * a2 / (f * f);
          sum += source.light * weight;
          weights += source.share * weight;
        }
        probe.blurred.push_back(sum / weights);
      }
    }
  }
  return probe;
}

}  // namespace slosh
