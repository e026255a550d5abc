// One list of fields a message; whoever visits the list encodes, decodes, describes or damages the message.
//
// A message type has one free function, found by argument-dependent lookup:
//
//   template <class V> void visit(V& v, PoseSample& m) {
//     v.natural("device", m.device, 0, kMaxDevices - 1);
//     ...
//   }
//
// The visitors are Writer and Reader here, Describer (WIRE_FORMAT.md) in describe.h and Mutator (the tests'
// damaged messages) in mutate.h. All numbers are little-endian; counts and naturals are LEB128 varints.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "sim/math/pose.h"

namespace slosh::wire {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

/// Appends a message's bytes. Values outside a field's range are a bug of the caller: debug builds assert in
/// the caller's tests by decoding what they encode; nothing is clamped here.
class Writer {
 public:
  static constexpr bool kReads = false;
  explicit Writer(Bytes& out) : out_(out) {}

  template <class T>
  void natural(std::string_view, T& value, std::uint64_t, std::uint64_t) {
    varint(static_cast<std::uint64_t>(value));
  }
  /// Any 64 bits: hashes, stamps' bit patterns.
  void bits64(std::string_view, std::uint64_t& value) { fixed(value); }
  void stamp(std::string_view, std::int64_t& value) { fixed(value); }
  template <class T>
  void choice(std::string_view, T& value, std::uint64_t) {
    varint(static_cast<std::uint64_t>(value));
  }
  void flag(std::string_view, bool& value) { out_.push_back(value ? 1 : 0); }
  void real64(std::string_view, double& value, double, double) { fixed(value); }
  template <class T>
  void real32(std::string_view, T& value, double, double) {
    fixed(static_cast<float>(value));
  }
  /// Each component within ±limit, as three real32.
  template <class T>
  void vec3(std::string_view, glm::vec<3, T>& value, double) {
    for (int i = 0; i < 3; ++i) fixed(static_cast<float>(value[i]));
  }
  /// A rotation, as four real32 (w, x, y, z); read back at unit length.
  void rotation(std::string_view, glm::dquat& q) {
    for (const double part : {q.w, q.x, q.y, q.z}) fixed(static_cast<float>(part));
  }
  /// UTF-8 without control characters.
  void text(std::string_view, std::string& value, std::size_t) {
    varint(value.size());
    out_.insert(out_.end(), value.begin(), value.end());
  }
  void bytes(std::string_view, Bytes& value, std::size_t, std::size_t) {
    varint(value.size());
    out_.insert(out_.end(), value.begin(), value.end());
  }
  template <std::size_t N>
  void array(std::string_view, std::array<std::uint8_t, N>& value) {
    out_.insert(out_.end(), value.begin(), value.end());
  }
  /// `each(visitor, element)` visits one element.
  template <class T, class Each>
  void list(std::string_view, std::vector<T>& values, std::size_t, Each&& each) {
    varint(values.size());
    for (T& value : values) each(*this, value);
  }

 private:
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
};

/// What is wrong with received bytes; `problem` is empty while all is well.
struct Fault {
  std::string field;    ///< e.g. "poses.device"
  std::string problem;  ///< "70 is above 63", "ends too early"
  explicit operator bool() const { return !problem.empty(); }
  std::string text() const { return field + ": " + problem; }
};

/// Reads a message's bytes. The first fault stops it: what follows stays as it was, and fault() tells.
class Reader {
 public:
  static constexpr bool kReads = true;
  explicit Reader(ByteView in) : in_(in) {}

  bool ok() const { return !fault_; }
  const Fault& fault() const { return fault_; }
  std::size_t left() const { return in_.size() - at_; }

  template <class T>
  void natural(std::string_view name, T& value, std::uint64_t least, std::uint64_t most) {
    std::uint64_t raw = 0;
    if (!varint(name, raw)) return;
    if (raw < least) return fail(name, std::to_string(raw) + " is below " + std::to_string(least));
    if (raw > most) return fail(name, std::to_string(raw) + " is above " + std::to_string(most));
    value = static_cast<T>(raw);
  }
  void bits64(std::string_view name, std::uint64_t& value) { fixed(name, value); }
  void stamp(std::string_view name, std::int64_t& value) { fixed(name, value); }
  template <class T>
  void choice(std::string_view name, T& value, std::uint64_t count) {
    std::uint64_t raw = 0;
    if (!varint(name, raw)) return;
    if (raw >= count)
      return fail(name, std::to_string(raw) + " is none of the " + std::to_string(count) + " choices");
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
    if (fixed(name, raw) && in_range(name, raw, least, most)) value = static_cast<T>(raw);
  }
  template <class T>
  void vec3(std::string_view name, glm::vec<3, T>& value, double limit) {
    float raw[3] = {};
    for (float& part : raw) {
      if (!fixed(name, part) || !in_range(name, part, -limit, limit)) return;
    }
    value = {static_cast<T>(raw[0]), static_cast<T>(raw[1]), static_cast<T>(raw[2])};
  }
  void rotation(std::string_view name, glm::dquat& q) {
    float raw[4] = {};
    for (float& part : raw) {
      if (!fixed(name, part) || !in_range(name, part, -1.01, 1.01)) return;
    }
    const glm::dquat read(raw[0], raw[1], raw[2], raw[3]);
    const double length = glm::length(read);
    if (std::abs(length - 1.0) > 0.01) return fail(name, "is not of unit length");
    q = read / length;
  }
  void text(std::string_view name, std::string& value, std::size_t most);
  void bytes(std::string_view name, Bytes& value, std::size_t least, std::size_t most) {
    std::uint64_t count = 0;
    if (!varint(name, count)) return;
    if (count < least || count > most)
      return fail(name, std::to_string(count) + " bytes are too few or too many");
    if (count > left()) return fail(name, "ends too early");
    value.assign(in_.begin() + static_cast<std::ptrdiff_t>(at_),
                 in_.begin() + static_cast<std::ptrdiff_t>(at_ + count));
    at_ += count;
  }
  template <std::size_t N>
  void array(std::string_view name, std::array<std::uint8_t, N>& value) {
    if (!ok()) return;
    if (left() < N) return fail(name, "ends too early");
    std::memcpy(value.data(), in_.data() + at_, N);
    at_ += N;
  }
  template <class T, class Each>
  void list(std::string_view name, std::vector<T>& values, std::size_t most, Each&& each) {
    std::uint64_t count = 0;
    if (!varint(name, count)) return;
    if (count > most) return fail(name, std::to_string(count) + " entries are above " + std::to_string(most));
    // An element takes at least a byte: a count cannot make us allocate more than was sent.
    if (count > left()) return fail(name, "ends too early");
    values.clear();
    const std::string outer = path_;
    path_ += std::string(name) + ".";
    for (std::uint64_t i = 0; i < count && ok(); ++i) {
      values.emplace_back();
      each(*this, values.back());
    }
    path_ = outer;
  }
  /// A message must use up its bytes.
  void finish() {
    if (ok() && left() > 0) fail("end", std::to_string(left()) + " bytes follow");
  }
  void fail(std::string_view name, std::string problem) {
    if (!fault_) fault_ = {path_ + std::string(name), std::move(problem)};
  }

 private:
  bool varint(std::string_view name, std::uint64_t& value) {
    if (!ok()) return false;
    std::uint64_t result = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      if (at_ >= in_.size()) return fail(name, "ends too early"), false;
      const std::uint8_t byte = in_[at_++];
      if (shift == 63 && byte > 1) break;
      result |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
      if (byte < 0x80) {
        if (byte == 0 && shift > 0) return fail(name, "is a number written too long"), false;
        value = result;
        return true;
      }
    }
    return fail(name, "is a number too long for 64 bits"), false;
  }
  template <class T>
  bool fixed(std::string_view name, T& value) {
    if (!ok()) return false;
    if (left() < sizeof(T)) return fail(name, "ends too early"), false;
    std::memcpy(&value, in_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return true;
  }
  bool in_range(std::string_view name, double value, double least, double most) {
    if (value >= least && value <= most) return true;  // false for a NaN
    return fail(name,
                std::isfinite(value) ? std::to_string(value) + " is out of range" : "is not a finite number"),
           false;
  }

  ByteView in_;
  std::size_t at_ = 0;
  std::string path_;
  Fault fault_;
};

/// Appends a message to `out`.
template <class M>
void encode(const M& message, Bytes& out) {
  Writer writer(out);
  visit(writer, const_cast<M&>(message));  // a Writer reads only
}
template <class M>
Bytes encoded(const M& message) {
  Bytes out;
  encode(message, out);
  return out;
}

/// Reads a whole message; on a fault `message` is half read and must not be used.
template <class M>
Fault decode(ByteView in, M& message) {
  Reader reader(in);
  visit(reader, message);
  reader.finish();
  return reader.fault();
}

}  // namespace slosh::wire
