// The visitor that decodes and refuses.
#pragma once

#include <array>
#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <string_view>

#include "net/wire/fault.h"
#include "net/wire/writer.h"

namespace slosh::wire {

/// Reads a message's bytes. The first fault stops it: what follows stays as it was, and fault() tells.
class Reader {
 public:
  static constexpr bool kReads = true;
  explicit Reader(ByteView in, Capabilities agreed = kAllCapabilities) : in_(in), agreed_(agreed) {}
  bool agreed(Capabilities bits) const { return (agreed_ & bits) == bits; }

  bool ok() const { return !fault_; }
  const Fault& fault() const { return fault_; }
  std::size_t left() const { return in_.size() - at_; }

  template <class T>
  void natural(std::string_view name, T& value, std::uint64_t least, std::uint64_t most) {
    std::uint64_t raw = 0;
    if (varint(name, raw) && in_range(name, raw, least, most)) value = static_cast<T>(raw);
  }
  template <class T>
  void below(std::string_view name, T& value, std::uint64_t most, std::string_view of, std::uint64_t bound) {
    std::uint64_t raw = 0;
    if (!varint(name, raw) || !in_range(name, raw, 0, most)) return;
    if (raw < bound)
      value = static_cast<T>(raw);
    else
      fail(name, not_below(raw, of, bound));
  }
  void index(std::string_view name, int& value, std::string_view of, std::size_t count, bool optional) {
    std::uint64_t raw = 0;
    if (!varint(name, raw)) return;
    if (raw == 0 && !optional) return fail(name, "is missing");
    if (raw > count) return fail(name, not_below(raw - 1, of, count));
    value = static_cast<int>(raw) - 1;
  }
  void rule(std::string_view name, bool holds, std::string_view problem) {
    if (ok() && !holds) fail(name, std::string(problem));
  }
  void bits64(std::string_view name, std::uint64_t& value) { fixed(name, value); }
  void stamp(std::string_view name, std::int64_t& value) {
    std::int64_t raw = 0;
    if (!fixed(name, raw)) return;
    if (raw < -kMaxStamp || raw > kMaxStamp) return fail(name, std::to_string(raw) + " ns is out of range");
    value = raw;
  }
  template <class T>
  void choice(std::string_view name, T& value, std::uint64_t count) {
    std::uint64_t raw = 0;
    if (!varint(name, raw)) return;
    if (raw < count)
      value = static_cast<T>(raw);
    else
      fail(name, no_choice(raw, count));
  }
  template <class T, std::size_t N>
  void choice(std::string_view name, T& value, const std::array<const char*, N>&) {
    choice(name, value, N);
  }
  template <class T, std::size_t N>
  void choice_from(std::string_view name, T& value, T first, const std::array<const char*, N>& names,
                   std::string_view gone) {
    const auto least = static_cast<std::uint64_t>(first);
    std::uint64_t raw = 0;
    if (!varint(name, raw)) return;
    if (raw < least) {
      std::string problem = std::to_string(raw) + " " + std::string(gone) + "; there are ";
      for (std::size_t i = 0; i < N; ++i) problem += (i == 0 ? "" : ", ") + std::string(names[i]);
      return fail(name, std::move(problem));
    }
    if (raw >= least + N) return fail(name, no_choice(raw, N));
    value = static_cast<T>(raw);
  }
  void flag(std::string_view name, bool& value) {
    std::uint8_t raw = 0;
    if (!fixed(name, raw)) return;
    if (raw > 1) return fail(name, std::to_string(raw) + " is neither 0 nor 1");
    value = raw == 1;
  }
  void real64(std::string_view name, double& value, double least, double most) {
    double raw = 0.0;
    if (fixed(name, raw) && in_range(name, raw, least, most)) value = raw;
  }
  template <class T>
  void real32(std::string_view name, T& value, double least, double most) {
    float raw = 0.0f;
    if (fixed(name, raw) && in_range(name, static_cast<double>(raw), least, most))
      value = static_cast<T>(raw);
  }
  template <class T>
  void vec3(std::string_view name, glm::vec<3, T>& value, double limit) {
    std::array<float, 3> raw{};
    if (parts(name, raw, limit))
      value = {static_cast<T>(raw[0]), static_cast<T>(raw[1]), static_cast<T>(raw[2])};
  }
  void vec3_exact(std::string_view name, glm::dvec3& value, double limit) {
    std::array<double, 3> raw{};
    if (parts(name, raw, limit)) value = {raw[0], raw[1], raw[2]};
  }
  void direction(std::string_view name, glm::vec3& value) {
    std::array<float, 3> raw{};
    if (!parts(name, raw, 1.0 + kUnitTolerance)) return;
    const glm::vec3 read(raw[0], raw[1], raw[2]);
    if (std::abs(glm::length(read) - 1.0f) > static_cast<float>(kUnitTolerance))
      return fail(name, "is not of unit length");
    value = read;
  }
  void rotation(std::string_view name, glm::dquat& q) {
    std::array<float, 4> raw{};
    if (!parts(name, raw, 1.0 + kUnitTolerance)) return;
    const glm::dquat read(raw[0], raw[1], raw[2], raw[3]);
    if (is_unit(name, read, kUnitTolerance)) q = read / glm::length(read);
  }
  void rotation_exact(std::string_view name, glm::dquat& q) {
    std::array<double, 4> raw{};
    if (!parts(name, raw, 1.0 + kUnitTolerance)) return;
    const glm::dquat read(raw[0], raw[1], raw[2], raw[3]);
    if (is_unit(name, read, kExactUnitTolerance)) q = read;
  }
  void text(std::string_view name, std::string& value, std::size_t most);
  void bytes(std::string_view name, Bytes& value, std::size_t least, std::size_t most);
  template <std::size_t N>
  void array(std::string_view name, std::array<std::uint8_t, N>& value) {
    fixed(name, value);
  }
  template <class T, class Each>
  void list(std::string_view name, std::vector<T>& values, std::size_t most, Each&& each) {
    std::uint64_t count = 0;
    if (!varint(name, count)) return;
    if (count > most) return fail(name, std::to_string(count) + " entries are above " + std::to_string(most));
    // An element takes at least a byte.
    if (count > left()) return fail(name, "ends too early");
    elements(name, values, count, each);
  }
  template <class T, class Each>
  void list_as_long(std::string_view name, std::vector<T>& values, std::string_view, std::size_t count,
                    Each&& each) {
    if (!ok()) return;
    if (count > left()) return fail(name, "ends too early");
    elements(name, values, count, each);
  }
  template <class T, class Each>
  void each_of(std::string_view name, std::vector<T>& values, std::string_view, Each&& each) {
    if (!ok()) return;
    if (values.size() > left()) return fail(name, "ends too early");
    const std::size_t outer = path_.size();
    path_.append(name).push_back('.');
    for (std::size_t i = 0; i < values.size() && ok(); ++i) each(*this, values[i]);
    path_.resize(outer);
  }
  /// A message must use up its bytes.
  void finish() {
    if (ok() && left() > 0) fail("end", std::to_string(left()) + " bytes follow");
  }
  void fail(std::string_view name, std::string problem) {
    if (!fault_) fault_ = {path_ + std::string(name), std::move(problem)};
  }

 private:
  /// Grows as elements are read, so that a count makes us allocate only what was sent.
  template <class T, class Each>
  void elements(std::string_view name, std::vector<T>& values, std::uint64_t count, Each& each) {
    values.clear();
    const std::size_t outer = path_.size();
    path_.append(name).push_back('.');
    for (std::uint64_t i = 0; i < count && ok(); ++i) each(*this, values.emplace_back());
    path_.resize(outer);
  }
  bool varint(std::string_view name, std::uint64_t& value);
  template <class T>
  bool fixed(std::string_view name, T& value) {
    if (!ok()) return false;
    if (left() < sizeof(T)) return fail(name, "ends too early"), false;
    std::memcpy(&value, in_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return true;
  }
  template <class T, std::size_t N>
  bool parts(std::string_view name, std::array<T, N>& raw, double limit) {
    if (!fixed(name, raw)) return false;
    for (const T part : raw) {
      if (!in_range(name, static_cast<double>(part), -limit, limit)) return false;
    }
    return true;
  }
  bool in_range(std::string_view name, std::uint64_t raw, std::uint64_t least, std::uint64_t most) {
    if (raw >= least && raw <= most) return true;
    return out_of_range(name, raw, least, most), false;
  }
  bool in_range(std::string_view name, double raw, double least, double most) {
    if (raw >= least && raw <= most) return true;  // false for a NaN
    return out_of_range(name, raw, least, most), false;
  }
  bool is_unit(std::string_view name, const glm::dquat& q, double tolerance) {
    if (std::abs(glm::length(q) - 1.0) <= tolerance) return true;
    return fail(name, "is not of unit length"), false;
  }
  // The words, away from the hot path.
  void out_of_range(std::string_view name, std::uint64_t raw, std::uint64_t least, std::uint64_t most);
  void out_of_range(std::string_view name, double raw, double least, double most);
  static std::string not_below(std::uint64_t raw, std::string_view of, std::uint64_t bound);
  static std::string no_choice(std::uint64_t raw, std::uint64_t count) {
    return std::to_string(raw) + " is none of the " + std::to_string(count) + " choices";
  }

  ByteView in_;
  Capabilities agreed_;
  std::size_t at_ = 0;
  std::string path_;
  Fault fault_;
};

}  // namespace slosh::wire
