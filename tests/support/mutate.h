// The visitor that damages a message in one place, in every way that its lists' fields can be wrong.
#pragma once

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "net/wire/fields.h"

namespace slosh::wire {

/// Writes the message as a Writer does, but for the damage with the number `which`, counted in the order of
/// the fields. When there are fewer, done() stays false and the bytes are the message's own.
class Mutator {
 public:
  static constexpr bool kReads = false;
  bool agreed(Capabilities) const { return true; }
  Mutator(Bytes& out, std::size_t which) : out_(out), which_(which) {}

  bool done() const { return !field_.empty(); }
  const std::string& field() const { return field_; }    ///< what a Fault must name
  const std::string& damage() const { return damage_; }  ///< in words
  /// The message ends at the damage: a list around it may be what is found too short.
  bool cut() const { return ended_; }

  template <class T>
  void natural(std::string_view name, T& value, std::uint64_t least, std::uint64_t most) {
    if (least > 0 && here(name, "below its range")) return varint(least - 1);
    if (most < ~std::uint64_t{0} && here(name, "above its range")) return varint(most + 1);
    number(name, static_cast<std::uint64_t>(value));
  }
  template <class T>
  void below(std::string_view name, T& value, std::uint64_t most, std::string_view, std::uint64_t bound) {
    if (here(name, "at its bound")) return varint(bound);
    if (here(name, "above its range")) return varint(most + 1);
    number(name, static_cast<std::uint64_t>(value));
  }
  void index(std::string_view name, int& value, std::string_view, std::size_t count, bool optional) {
    if (!optional && here(name, "missing")) return varint(0);
    if (here(name, "behind the last")) return varint(count + 1);
    if (here(name, "huge")) return varint(~std::uint64_t{0});
    number(name, static_cast<std::uint64_t>(value + 1));
  }
  void rule(std::string_view, bool, std::string_view) {}
  void bits64(std::string_view, std::uint64_t& value) { fixed(value); }
  void stamp(std::string_view name, std::int64_t& value) {
    if (here(name, "above its range")) return fixed(kMaxStamp + 1);
    if (here(name, "below its range")) return fixed(-kMaxStamp - 1);
    if (here(name, "the lowest of all")) return fixed(std::numeric_limits<std::int64_t>::min());
    fixed(value);
  }
  template <class T>
  void choice(std::string_view name, T& value, std::uint64_t count) {
    if (here(name, "no choice")) return varint(count);
    if (here(name, "a huge choice")) return varint(~std::uint64_t{0});
    number(name, static_cast<std::uint64_t>(value));
  }
  template <class T, std::size_t N>
  void choice(std::string_view name, T& value, const std::array<const char*, N>&) {
    choice(name, value, N);
  }
  template <class T, std::size_t N>
  void choice_from(std::string_view name, T& value, T first, const std::array<const char*, N>&,
                   std::string_view) {
    const auto least = static_cast<std::uint64_t>(first);
    if (here(name, "a choice that is gone")) return varint(least - 1);
    if (here(name, "no choice")) return varint(least + N);
    if (here(name, "a huge choice")) return varint(~std::uint64_t{0});
    number(name, static_cast<std::uint64_t>(value));
  }
  void flag(std::string_view name, bool& value) {
    if (here(name, "2")) return byte(2);
    if (here(name, "255")) return byte(255);
    byte(value ? 1 : 0);
  }
  void real64(std::string_view name, double& value, double least, double most) {
    fixed(damaged_part(name, value, least, most));
  }
  template <class T>
  void real32(std::string_view name, T& value, double least, double most) {
    fixed(damaged_part(name, static_cast<float>(value), least, most));
  }
  template <class T>
  void vec3(std::string_view name, glm::vec<3, T>& value, double limit) {
    for (int i = 0; i < 3; ++i) fixed(damaged_part(name, static_cast<float>(value[i]), -limit, limit));
  }
  void vec3_exact(std::string_view name, glm::dvec3& value, double limit) {
    for (int i = 0; i < 3; ++i) fixed(damaged_part(name, value[i], -limit, limit));
  }
  void direction(std::string_view name, glm::vec3& value) {
    unit<float, 3>(name, {value.x, value.y, value.z});
  }
  void rotation(std::string_view name, glm::dquat& q) {
    unit<float, 4>(name, {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
                          static_cast<float>(q.z)});
  }
  void rotation_exact(std::string_view name, glm::dquat& q) { unit<double, 4>(name, {q.w, q.x, q.y, q.z}); }
  void text(std::string_view name, std::string& value, std::size_t most) {
    static constexpr std::string_view kBad[] = {
        "\xff",      // no UTF-8 at all
        "\x80",      // a continuation without its beginning
        "\xc0\x80",  // a long form of 0
        "\xe0\x80\x80",
        "\xf0\x80\x80\x80",
        "\xed\xa0\x80",      // half of a surrogate pair
        "\xf4\x90\x80\x80",  // above the last character
        "\xe6\xb0",          // cut off
        std::string_view("\0", 1),
        "\n",
        "\x1b",
        "\x7f",
        "\xc2\x9b",      // the one-character form of ESC [
        "\xe2\x80\xae",  // turns the direction of writing
        "\xe2\x80\xa8"   // line separator
    };
    for (const std::string_view bad : kBad) {
      if (here(name, "bad text")) {
        varint(bad.size());
        return raw(bad);
      }
    }
    if (here(name, "too long")) {
      varint(most + 1);
      return raw(std::string(most + 1, 'a'));
    }
    counted(name, value.size(), most);
    raw(value);
  }
  void bytes(std::string_view name, Bytes& value, std::size_t least, std::size_t most) {
    if (least > 0 && here(name, "too few")) {
      varint(least - 1);
      return raw(std::string(least - 1, 'a'));
    }
    if (most < (1u << 20) && here(name, "too many")) {
      varint(most + 1);
      return raw(std::string(most + 1, 'a'));
    }
    counted(name, value.size(), most);
    if (!ended_) out_.insert(out_.end(), value.begin(), value.end());
  }
  template <std::size_t N>
  void array(std::string_view name, std::array<std::uint8_t, N>& value) {
    if (here(name, "cut off")) return end();
    for (const std::uint8_t each : value) byte(each);
  }
  template <class T, class Each>
  void list(std::string_view name, std::vector<T>& values, std::size_t most, Each&& each) {
    if (here(name, "too many")) {
      varint(most + 1);
    } else if (values.size() < most && here(name, "more than follow")) {
      varint(values.size() + 1);
      elements(name, values, each);
      return end();
    } else {
      counted(name, values.size(), most);
    }
    elements(name, values, each);
  }
  template <class T, class Each>
  void list_as_long(std::string_view name, std::vector<T>& values, std::string_view, std::size_t,
                    Each&& each) {
    elements(name, values, each);
  }
  template <class T, class Each>
  void each_of(std::string_view name, std::vector<T>& values, std::string_view, Each&& each) {
    elements(name, values, each);
  }

 private:
  /// Whether the damage that is wanted is this one.
  bool here(std::string_view name, const char* damage) {
    if (seen_++ != which_) return false;
    field_ = path_ + std::string(name);
    damage_ = damage;
    return true;
  }
  template <class T, class Each>
  void elements(std::string_view name, std::vector<T>& values, Each& each) {
    const std::size_t outer = path_.size();
    path_.append(name).push_back('.');
    for (T& value : values) each(*this, value);
    path_.resize(outer);
  }
  void number(std::string_view name, std::uint64_t value) {
    if (here(name, "a number written too long")) return long_form(value);
    if (here(name, "a number above 64 bits")) return raw("\xff\xff\xff\xff\xff\xff\xff\xff\xff\x7f");
    varint(value);
  }
  /// The count before `count` bytes or elements.
  void counted(std::string_view name, std::uint64_t count, std::uint64_t most) {
    if (here(name, "a count of all 64 bits")) return varint(~std::uint64_t{0});
    if (count < most && here(name, "a count of what is not there")) {
      varint(count + 1);
      return end();
    }
    number(name, count);
  }
  template <class T>
  T damaged_part(std::string_view name, T value, double least, double most) {
    constexpr T kInfinite = std::numeric_limits<T>::infinity();
    if (here(name, "not a number")) return std::numeric_limits<T>::quiet_NaN();
    if (here(name, "infinite")) return kInfinite;
    if (here(name, "minus infinite")) return -kInfinite;
    if (here(name, "above its range")) return outside(static_cast<T>(most), most, kInfinite);
    if (here(name, "below its range")) return outside(static_cast<T>(least), least, -kInfinite);
    return value;
  }
  template <class T>
  static T outside(T end, double limit, T towards) {
    while (towards > 0 ? static_cast<double>(end) <= limit : static_cast<double>(end) >= limit)
      end = std::nextafter(end, towards);
    return end;
  }
  template <class T, std::size_t N>
  void unit(std::string_view name, std::array<T, N> parts) {
    const auto scaled = [&](T by) {
      for (T& part : parts) part *= by;
    };
    for (std::size_t i = 0; i < N; ++i) {
      if (here(name, "not a number")) parts[i] = std::numeric_limits<T>::quiet_NaN();
      if (here(name, "infinite")) parts[i] = std::numeric_limits<T>::infinity();
    }
    if (here(name, "of no length")) scaled(0);
    // A real64 is a rotation that is read as it is.
    constexpr double kOff = sizeof(T) == 8 ? 3.0 * kExactUnitTolerance : 2.0 * kUnitTolerance;
    if (here(name, "too short")) scaled(static_cast<T>(1.0 - kOff));
    if (here(name, "too long")) scaled(static_cast<T>(1.0 + kOff));
    for (const T part : parts) fixed(part);
  }
  void long_form(std::uint64_t value) {
    do {
      byte(static_cast<std::uint8_t>(value | 0x80));
      value >>= 7;
    } while (value > 0);
    byte(0);
  }
  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) byte(static_cast<std::uint8_t>(value | 0x80));
    byte(static_cast<std::uint8_t>(value));
  }
  template <class T>
  void fixed(T value) {
    std::array<std::uint8_t, sizeof(T)> parts{};
    std::memcpy(parts.data(), &value, sizeof(T));
    for (const std::uint8_t part : parts) byte(part);
  }
  void raw(std::string_view text) {
    for (const char c : text) byte(static_cast<std::uint8_t>(c));
  }
  void byte(std::uint8_t value) {
    if (!ended_) out_.push_back(value);
  }
  void end() { ended_ = true; }  // nothing follows

  Bytes& out_;
  std::size_t which_;
  std::size_t seen_ = 0;
  bool ended_ = false;
  std::string path_;
  std::string field_;
  std::string damage_;
};

/// The message with its damage number `which`; `field` is empty when there are no more.
struct Damaged {
  Bytes bytes;
  std::string field;
  std::string damage;
  bool cut = false;  ///< Mutator::cut
};
template <class M>
Damaged damaged_message(const M& message, std::size_t which) {
  Damaged out;
  Mutator mutator(out.bytes, which);
  visit(mutator, const_cast<M&>(message));  // a Mutator reads only
  out.field = mutator.field();
  out.damage = mutator.damage();
  out.cut = mutator.cut();
  return out;
}

}  // namespace slosh::wire
