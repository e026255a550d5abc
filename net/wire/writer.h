// The visitor that encodes.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <string_view>

#include "net/wire/capabilities.h"
#include "net/wire/fault.h"
#include "net/wire/text.h"

namespace slosh::wire {

/// ns: sums of two differences of stamps do not overflow.
constexpr std::int64_t kMaxStamp = (std::int64_t{1} << 61) - 1;

/// How far a rotation's or a direction's length may be from 1.
constexpr double kUnitTolerance = 0.01;
/// The same for one that is used as it came.
constexpr double kExactUnitTolerance = 1e-6;

/// Appends a message's bytes. What it writes, a Reader takes: a value outside its field's range is brought to
/// the nearest allowed one (a choice to the first, a list cut), and the first such value is kept in fault().
/// Texts are cut and cleaned (clean_text) without a fault: whoever writes sentences need not count bytes.
/// Only a broken index or rule between fields is written as it is; fault() tells then, too.
class Writer {
 public:
  static constexpr bool kReads = false;
  explicit Writer(Bytes& out, Capabilities agreed = kAllCapabilities) : out_(out), agreed_(agreed) {}
  bool agreed(Capabilities bits) const { return (agreed_ & bits) == bits; }

  const Fault& fault() const { return fault_; }

  template <class T>
  void natural(std::string_view name, T& value, std::uint64_t least, std::uint64_t most) {
    const auto raw = static_cast<std::uint64_t>(value);
    if (raw < least || raw > most) note(name, std::to_string(raw) + " is out of range");
    varint(std::clamp(raw, least, most));
  }
  template <class T>
  void below(std::string_view name, T& value, std::uint64_t most, std::string_view of, std::uint64_t bound) {
    const auto raw = static_cast<std::uint64_t>(value);
    if (raw > most || raw >= bound) note(name, std::to_string(raw) + " is not below " + std::string(of));
    varint(raw);
  }
  void index(std::string_view name, int& value, std::string_view of, std::size_t count, bool optional) {
    const bool fine = value < 0 ? optional : static_cast<std::size_t>(value) < count;
    if (!fine) note(name, std::to_string(value) + " is none of the " + std::string(of));
    varint(value < 0 ? 0 : static_cast<std::uint64_t>(value) + 1);
  }
  void rule(std::string_view name, bool holds, std::string_view problem) {
    if (!holds) note(name, std::string(problem));
  }
  void bits64(std::string_view, std::uint64_t& value) { fixed(value); }
  void stamp(std::string_view name, std::int64_t& value) {
    if (value < -kMaxStamp || value > kMaxStamp) note(name, std::to_string(value) + " is out of range");
    fixed(std::clamp(value, -kMaxStamp, kMaxStamp));
  }
  template <class T>
  void choice(std::string_view name, T& value, std::uint64_t count) {
    const auto raw = static_cast<std::uint64_t>(value);
    if (raw >= count) note(name, std::to_string(raw) + " is no choice");
    varint(raw < count ? raw : 0);
  }
  template <class T, std::size_t N>
  void choice(std::string_view name, T& value, const std::array<const char*, N>&) {
    choice(name, value, N);
  }
  template <class T, std::size_t N>
  void choice_from(std::string_view name, T& value, T first, const std::array<const char*, N>&,
                   std::string_view) {
    const auto raw = static_cast<std::uint64_t>(value), least = static_cast<std::uint64_t>(first);
    const bool fine = raw >= least && raw < least + N;
    if (!fine) note(name, std::to_string(raw) + " is no choice");
    varint(fine ? raw : least);
  }
  void flag(std::string_view, bool& value) { out_.push_back(value ? 1 : 0); }
  void real64(std::string_view name, double& value, double least, double most) {
    fixed(in_range(name, value, least, most));
  }
  template <class T>
  void real32(std::string_view name, T& value, double least, double most) {
    fixed(narrow(name, static_cast<double>(value), least, most));
  }
  template <class T>
  void vec3(std::string_view name, glm::vec<3, T>& value, double limit) {
    for (int i = 0; i < 3; ++i) fixed(narrow(name, static_cast<double>(value[i]), -limit, limit));
  }
  void vec3_exact(std::string_view name, glm::dvec3& value, double limit) {
    for (int i = 0; i < 3; ++i) fixed(in_range(name, value[i], -limit, limit));
  }
  void direction(std::string_view name, glm::vec3& value) {
    const float length = glm::length(value);
    const bool fine = std::abs(length - 1.0f) <= static_cast<float>(kUnitTolerance);
    if (!fine) note(name, "is not of unit length");
    const glm::vec3 written = fine ? value : glm::vec3(0.0f, 1.0f, 0.0f);
    for (int i = 0; i < 3; ++i) fixed(written[i]);
  }
  void rotation(std::string_view name, glm::dquat& q) {
    // Less than a Reader allows: single precision changes the length.
    const glm::dquat written = unit(name, q, 0.5 * kUnitTolerance);
    for (const double part : {written.w, written.x, written.y, written.z}) fixed(static_cast<float>(part));
  }
  void rotation_exact(std::string_view name, glm::dquat& q) {
    const glm::dquat written = unit(name, q, kExactUnitTolerance);
    for (const double part : {written.w, written.x, written.y, written.z}) fixed(part);
  }
  void text(std::string_view, std::string& value, std::size_t most) {
    const std::string clean = clean_text(value, most);
    varint(clean.size());
    out_.insert(out_.end(), clean.begin(), clean.end());
  }
  void bytes(std::string_view name, Bytes& value, std::size_t least, std::size_t most) {
    const std::size_t count = std::clamp(value.size(), least, most);
    if (count != value.size()) note(name, std::to_string(value.size()) + " bytes are too few or too many");
    varint(count);
    const std::size_t copied = std::min(count, value.size());
    out_.insert(out_.end(), value.begin(), value.begin() + static_cast<std::ptrdiff_t>(copied));
    out_.resize(out_.size() + (count - copied));
  }
  template <std::size_t N>
  void array(std::string_view, std::array<std::uint8_t, N>& value) {
    out_.insert(out_.end(), value.begin(), value.end());
  }
  template <class T, class Each>
  void list(std::string_view name, std::vector<T>& values, std::size_t most, Each&& each) {
    if (values.size() > most) note(name, std::to_string(values.size()) + " entries are too many");
    const std::size_t count = std::min(values.size(), most);
    varint(count);
    elements(name, values, count, each);
  }
  template <class T, class Each>
  void list_as_long(std::string_view name, std::vector<T>& values, std::string_view of, std::size_t count,
                    Each&& each) {
    if (values.size() != count) {
      note(name, std::to_string(values.size()) + " entries are not as many as " + std::string(of));
      return;
    }
    elements(name, values, count, each);
  }
  template <class T, class Each>
  void each_of(std::string_view name, std::vector<T>& values, std::string_view, Each&& each) {
    elements(name, values, values.size(), each);
  }

 private:
  template <class T, class Each>
  void elements(std::string_view name, std::vector<T>& values, std::size_t count, Each& each) {
    const std::size_t outer = path_.size();
    path_.append(name).push_back('.');
    for (std::size_t i = 0; i < count; ++i) each(*this, values[i]);
    path_.resize(outer);
  }
  void note(std::string_view name, std::string problem) {
    if (!fault_) fault_ = {path_ + std::string(name), std::move(problem)};
  }
  double in_range(std::string_view name, double value, double least, double most) {
    if (value >= least && value <= most) return value;
    note(name, std::isnan(value) ? "is not a finite number" : std::to_string(value) + " is out of range");
    if (std::isnan(value)) return std::clamp(0.0, least, most);
    return std::clamp(value, least, most);
  }
  /// In range also after it was rounded to single precision.
  float narrow(std::string_view name, double value, double least, double most) {
    const auto rounded = static_cast<float>(in_range(name, value, least, most));
    if (rounded > most) return std::nextafter(rounded, -std::numeric_limits<float>::infinity());
    if (rounded < least) return std::nextafter(rounded, std::numeric_limits<float>::infinity());
    return rounded;
  }
  glm::dquat unit(std::string_view name, const glm::dquat& q, double tolerance) {
    const double length = glm::length(q);
    if (std::abs(length - 1.0) <= tolerance) return q;
    note(name, "is not of unit length");
    return length > 1e-9 && length < 1e9 ? q / length : glm::dquat(1.0, 0.0, 0.0, 0.0);
  }
  void varint(std::uint64_t value) {
    while (value >= 0x80) {
      out_.push_back(static_cast<std::uint8_t>(value | 0x80));
      value >>= 7;
    }
    out_.push_back(static_cast<std::uint8_t>(value));
  }
  template <class T>
  void fixed(T value) {
    static_assert(std::endian::native == std::endian::little);
    std::uint8_t raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    out_.insert(out_.end(), raw, raw + sizeof(T));
  }

  Bytes& out_;
  Capabilities agreed_;
  std::string path_;
  Fault fault_;
};

}  // namespace slosh::wire
