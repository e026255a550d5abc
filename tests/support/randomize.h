// The visitor that fills a message with random valid values, for tests and fuzzers' seeds.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string_view>

#include "net/wire/fields.h"
#include "net/wire/fluid_wrench.h"

namespace slosh::wire {

/// Every value is one that a Writer writes as it is and a Reader gives back bitwise; ends of ranges come
/// up often. Rules between fields are not seen to: a message that has some is put right by its caller, or
/// drawn again.
class Randomizer {
 public:
  static constexpr bool kReads = false;
  bool agreed(Capabilities) const { return true; }
  /// Lists get `least_list` to `most_list` elements, as far as their limits allow.
  explicit Randomizer(std::uint64_t seed, std::size_t least_list = 0, std::size_t most_list = 4)
      : random_(seed), least_list_(least_list), most_list_(most_list) {}

  /// A natural from least to most: an end, or of any size with equal probability.
  std::uint64_t pick(std::uint64_t least, std::uint64_t most) {
    const std::uint64_t kind = random_() % 4;
    if (kind == 0 || least == most) return least;
    if (kind == 1) return most;
    const std::uint64_t any = random_() >> (random_() % 64);
    return most - least == ~std::uint64_t{0} ? any : least + any % (most - least + 1);
  }

  template <class T>
  void natural(std::string_view, T& value, std::uint64_t least, std::uint64_t most) {
    value = static_cast<T>(pick(least, most));
  }
  template <class T>
  void below(std::string_view, T& value, std::uint64_t most, std::string_view, std::uint64_t bound) {
    value = static_cast<T>(pick(0, std::min(most, bound > 0 ? bound - 1 : 0)));
  }
  void index(std::string_view, int& value, std::string_view, std::size_t count, bool optional) {
    const bool none = count == 0 || (optional && random_() % 4 == 0);
    value = none ? -1 : static_cast<int>(pick(0, count - 1));
  }
  void rule(std::string_view, bool, std::string_view) {}
  void bits64(std::string_view, std::uint64_t& value) { value = random_(); }
  void stamp(std::string_view, std::int64_t& value) {
    const auto size = static_cast<std::int64_t>(pick(0, static_cast<std::uint64_t>(kMaxStamp)));
    value = random_() % 2 == 0 ? size : -size;
  }
  template <class T>
  void choice(std::string_view, T& value, std::uint64_t count) {
    value = static_cast<T>(random_() % count);
  }
  template <class T, std::size_t N>
  void choice(std::string_view name, T& value, const std::array<const char*, N>&) {
    choice(name, value, N);
  }
  template <class T, std::size_t N>
  void choice_from(std::string_view, T& value, T first, const std::array<const char*, N>&, std::string_view) {
    value = static_cast<T>(static_cast<std::uint64_t>(first) + random_() % N);
  }
  void flag(std::string_view, bool& value) { value = random_() % 2 == 0; }
  void real64(std::string_view, double& value, double least, double most) { value = real(least, most); }
  template <class T>
  void real32(std::string_view, T& value, double least, double most) {
    value = static_cast<T>(narrow(least, most));
  }
  template <class T>
  void vec3(std::string_view, glm::vec<3, T>& value, double limit) {
    for (int i = 0; i < 3; ++i) value[i] = static_cast<T>(narrow(-limit, limit));
  }
  void vec3_exact(std::string_view, glm::dvec3& value, double limit) {
    for (int i = 0; i < 3; ++i) value[i] = real(-limit, limit);
  }
  void direction(std::string_view, glm::vec3& value) {
    const glm::dquat q = any_rotation();
    value = glm::vec3(q * glm::dvec3(0.0, 1.0, 0.0));
  }
  /// Single precision and back is not always the same rotation: drawn until it is.
  void rotation(std::string_view name, glm::dquat& q) {
    for (int i = 0; i < 100; ++i) {
      q = any_rotation();
      for (int again = 0; again < 4; ++again) {
        const glm::dquat read = through_wire(name, q);
        if (read.w == q.w && read.x == q.x && read.y == q.y && read.z == q.z) return;
        q = read;
      }
    }
    q = glm::dquat(1.0, 0.0, 0.0, 0.0);
  }
  void rotation_exact(std::string_view, glm::dquat& q) { q = any_rotation(); }
  void text(std::string_view, std::string& value, std::size_t most) {
    static constexpr std::string_view kPieces[] = {"a", "B", "7", " ", "-", "é", "水", "🪣", "?", "bucket"};
    value.clear();
    const std::size_t wanted = pick(0, most);
    while (true) {
      const std::string_view piece = kPieces[random_() % std::size(kPieces)];
      if (value.size() + piece.size() > wanted) return;
      value += piece;
    }
  }
  void bytes(std::string_view, Bytes& value, std::size_t least, std::size_t most) {
    value.resize(least + random_() % (std::min<std::size_t>(most - least, 64) + 1));
    for (std::uint8_t& byte : value) byte = static_cast<std::uint8_t>(random_());
  }
  template <std::size_t N>
  void array(std::string_view, std::array<std::uint8_t, N>& value) {
    for (std::uint8_t& byte : value) byte = static_cast<std::uint8_t>(random_());
  }
  template <class T, class Each>
  void list(std::string_view, std::vector<T>& values, std::size_t most, Each&& each) {
    const std::size_t least = std::min(least_list_, most);
    values.assign(pick(least, std::max(least, std::min(most_list_, most))), T{});
    for (T& value : values) each(*this, value);
  }
  template <class T, class Each>
  void list_as_long(std::string_view, std::vector<T>& values, std::string_view, std::size_t count,
                    Each&& each) {
    values.assign(count, T{});
    for (T& value : values) each(*this, value);
  }
  template <class T, class Each>
  void each_of(std::string_view, std::vector<T>& values, std::string_view, Each&& each) {
    for (T& value : values) each(*this, value);
  }

 private:
  double real(double least, double most) {
    switch (random_() % 6) {
      case 0:
        return least;
      case 1:
        return most;
      case 2:
        return std::clamp(0.0, least, most);
      case 3:
        return std::clamp(1e-30, least, most);
      default:
        return std::uniform_real_distribution<double>(least, most)(random_);
    }
  }
  float narrow(double least, double most) {
    const auto rounded = static_cast<float>(real(least, most));
    return rounded >= least && rounded <= most ? rounded : static_cast<float>(0.5 * (least + most));
  }
  glm::dquat any_rotation() {
    std::normal_distribution<double> normal;
    const glm::dquat q(normal(random_), normal(random_), normal(random_), normal(random_));
    const double length = glm::length(q);
    return length > 1e-6 ? q / length : glm::dquat(1.0, 0.0, 0.0, 0.0);
  }
  static glm::dquat through_wire(std::string_view name, glm::dquat q) {
    Bytes bytes;
    Writer(bytes).rotation(name, q);
    Reader(bytes).rotation(name, q);
    return q;
  }

  std::mt19937_64 random_;
  std::size_t least_list_;
  std::size_t most_list_;
};

/// A random semidefinite matrix of any size and rank.
inline SemidefiniteCode random_semidefinite(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const std::uint64_t rank = random() % 7;
  const double size = std::pow(10.0, std::uniform_real_distribution<double>(-6.0, 4.0)(random));
  Matrix6 matrix{};
  for (std::uint64_t r = 0; r < rank; ++r) {
    Vector6 v;
    for (double& each : v) each = size * normal(random);
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) matrix[i][j] += v[i] * v[j];
    }
  }
  return to_code(matrix);
}

/// A random message, valid but for rules between its fields; those of a matrix hold.
template <class M>
M random_message(std::uint64_t seed, std::size_t least_list = 0, std::size_t most_list = 4) {
  Randomizer random(seed, least_list, most_list);
  M message{};
  visit(random, message);
  if constexpr (std::is_same_v<M, FluidWrench>) {
    std::mt19937_64 engine(seed);
    for (SemidefiniteCode* code : {&message.stiffness, &message.damping, &message.added_mass})
      *code = random_semidefinite(engine);
  }
  return message;
}

}  // namespace slosh::wire
