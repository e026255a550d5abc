#include "scenes/gltf/animation.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "scenes/gltf/accessor.h"

namespace slosh::gltf {
namespace {

/// One sampler: `width` numbers a key; CUBICSPLINE has in-tangent, value, out-tangent a key.
struct Curve {
  std::vector<double> times;
  std::vector<double> values;
  int width = 3;
  bool step = false;
  bool cubic = false;

  const double* key(std::size_t i, int part) const {
    return values.data() + (cubic ? 3 * i + part : i) * static_cast<std::size_t>(width);
  }
  const double* value(std::size_t i) const { return key(i, cubic ? 1 : 0); }
};

Result<Curve> read_curve(const Document& document, const tinygltf::AnimationSampler& sampler, int width,
                         const std::string& where) {
  auto times = read_numbers(document.model, sampler.input, 1, Integers::kNone, where + ": input");
  if (!times) return times.error();
  auto values = read_numbers(document.model, sampler.output, width,
                             width == 4 ? Integers::kNormalized : Integers::kNone, where + ": output");
  if (!values) return values.error();
  Curve curve{std::move(times.value()), std::move(values.value()), width, false, false};
  curve.step = sampler.interpolation == "STEP";
  curve.cubic = sampler.interpolation == "CUBICSPLINE";
  if (!curve.step && !curve.cubic && sampler.interpolation != "LINEAR") {
    return Error{where, "interpolation '" + sampler.interpolation + "' is not known",
                 "Use LINEAR, STEP or CUBICSPLINE"};
  }
  const std::size_t parts = curve.cubic ? 3 : 1;
  if (curve.values.size() != curve.times.size() * parts * static_cast<std::size_t>(width)) {
    return Error{where,
                 std::to_string(curve.times.size()) + " times and " +
                     std::to_string(curve.values.size() / width) + " values do not match",
                 "Export the file again"};
  }
  for (std::size_t i = 0; i < curve.times.size(); ++i) {
    if (curve.times[i] < 0.0 || (i > 0 && curve.times[i] <= curve.times[i - 1])) {
      return Error{where, "the times of its keys do not rise", "Export the file again"};
    }
  }
  if (curve.times.back() > kLongestAnimation) {
    return Error{where, "lasts " + std::to_string(curve.times.back()) + " s", "Keep it under an hour"};
  }
  return curve;
}

glm::dquat to_quat(const double* v) {
  return {v[3], v[0], v[1], v[2]};
}

/// glTF 2.0, appendix C: interpolation modes. Outside the keys the nearest one holds.
void evaluate(const Curve& curve, double time, double* out) {
  const auto above = std::upper_bound(curve.times.begin(), curve.times.end(), time);
  const std::size_t next = static_cast<std::size_t>(above - curve.times.begin());
  const std::size_t last = curve.times.size() - 1;
  if (next == 0 || next > last) {
    std::copy_n(curve.value(next == 0 ? 0 : last), curve.width, out);
    return;
  }
  const std::size_t k = next - 1;
  const double span = curve.times[next] - curve.times[k];
  const double u = (time - curve.times[k]) / span;
  if (curve.step) {
    std::copy_n(curve.value(k), curve.width, out);
  } else if (curve.cubic) {
    const double u2 = u * u;
    const double u3 = u2 * u;
    for (int i = 0; i < curve.width; ++i) {
      out[i] = (2 * u3 - 3 * u2 + 1) * curve.value(k)[i] + span * (u3 - 2 * u2 + u) * curve.key(k, 2)[i] +
               (-2 * u3 + 3 * u2) * curve.value(next)[i] + span * (u3 - u2) * curve.key(next, 0)[i];
    }
  } else if (curve.width == 4) {
    const glm::dquat turned = glm::slerp(to_quat(curve.value(k)), to_quat(curve.value(next)), u);
    out[0] = turned.x, out[1] = turned.y, out[2] = turned.z, out[3] = turned.w;
  } else {
    for (int i = 0; i < curve.width; ++i) out[i] = (1.0 - u) * curve.value(k)[i] + u * curve.value(next)[i];
  }
}

std::vector<double> key_times(const std::optional<Curve>& a, const std::optional<Curve>& b) {
  std::vector<double> marks{0.0};
  for (const auto* curve : {&a, &b}) {
    if (*curve) marks.insert(marks.end(), (*curve)->times.begin(), (*curve)->times.end());
  }
  std::sort(marks.begin(), marks.end());
  std::vector<double> times;
  for (const double mark : marks) {
    if (times.empty()) {
      times.push_back(mark);
      continue;
    }
    const double from = times.back();
    if (mark - from < 1e-6) continue;
    // A hair of slack, or keys at 60 Hz in single precision would be split in two.
    const int pieces = static_cast<int>(std::ceil((mark - from) / kLongestKeyStep - 1e-3));
    for (int i = 1; i <= pieces; ++i) times.push_back(from + (mark - from) * i / pieces);
  }
  return times;
}

}  // namespace

bool is_animated(const Document& document, int node) {
  return document.animated[static_cast<std::size_t>(node)];
}

Result<std::vector<PoseKey>> read_motion(const Document& document, int node) {
  const std::string owner = document.owner(node);
  std::optional<Curve> translation;
  std::optional<Curve> rotation;
  for (const tinygltf::Animation& animation : document.model.animations) {
    for (const tinygltf::AnimationChannel& channel : animation.channels) {
      if (channel.target_node != node) continue;
      const std::string where = owner + ": animation '" + animation.name + "': " + channel.target_path;
      const bool moves = channel.target_path == "translation";
      if (!moves && channel.target_path != "rotation") {
        if (channel.target_path == "scale") continue;  // exporters bake it along; sizes stay
        return Error{where, "it cannot be animated by this", "Animate location and rotation only"};
      }
      std::optional<Curve>& curve = moves ? translation : rotation;
      if (curve) {
        return Error{where, "is animated twice", "Keep one action for this object, and export only that"};
      }
      auto read = read_curve(document, animation.samplers[channel.sampler], moves ? 3 : 4, where);
      if (!read) return read.error();
      curve = std::move(read.value());
    }
  }
  for (int up = document.parent[node]; up >= 0; up = document.parent[up]) {
    if (is_animated(document, up)) {
      return Error{owner, "its parent '" + document.name(up) + "' is animated",
                   "Animate the one itself, without parent"};
    }
  }
  const int parent = document.parent[node];
  const glm::dmat4 above = parent < 0 ? glm::dmat4(1.0) : document.world[parent];
  // The node's own pose, for the path that no channel sets.
  const glm::dmat4 local = glm::inverse(above) * document.world[node];
  glm::dquat turn;
  glm::dquat local_turn;
  glm::dmat3 rest;
  if (!split_rotation(glm::dmat3(above), turn, rest) ||
      !split_rotation(glm::dmat3(local), local_turn, rest)) {
    return Error{owner, "a scale of zero", "Give it, and what it hangs on, a scale of 1"};
  }
  std::vector<PoseKey> keys;
  for (const double time : key_times(translation, rotation)) {
    glm::dvec3 position(local[3]);
    glm::dquat orientation = local_turn;
    if (translation) evaluate(*translation, time, &position.x);
    if (rotation) {
      double q[4];
      evaluate(*rotation, time, q);
      orientation = to_quat(q);
      if (!(glm::length(orientation) > 1e-6)) {
        return Error{owner, "its animation has a rotation of length zero", "Export the file again"};
      }
      orientation = glm::normalize(orientation);
    }
    keys.push_back(
        {time, {glm::dvec3(above * glm::dvec4(position, 1.0)), glm::normalize(turn * orientation)}});
  }
  return keys;
}

}  // namespace slosh::gltf
