// Bytes of a saved world as they are written, and read back with the first problem kept.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace slosh {

static_assert(std::endian::native == std::endian::little);

inline constexpr double kMaxStateReal = 1.0e9;  ///< beyond this no position, speed or force of a body is one

/// Appends.
class StateSink {
 public:
  explicit StateSink(std::vector<std::uint8_t>& out) : out_(out) {}
  static constexpr bool kReads = false;

  template <class T>
  void raw(const T& value) {
    column(std::span<const T>(&value, 1));
  }
  template <class T>
  void column(std::span<const T> values) {
    const std::size_t at = out_.size();
    out_.resize(at + values.size_bytes());
    if (!values.empty()) std::memcpy(out_.data() + at, values.data(), values.size_bytes());
  }
  void real(double value) { raw(value); }

 private:
  std::vector<std::uint8_t>& out_;
};

/// Reads as long as there is something; after the first problem everything stays as it was.
class StateSource {
 public:
  explicit StateSource(std::span<const std::uint8_t> in) : in_(in) {}
  static constexpr bool kReads = true;

  template <class T>
  void raw(T& value) {
    column(std::span<T>(&value, 1));
  }
  template <class T>
  void column(std::span<T> values) {
    if (!problem_.empty()) return;
    if (in_.size() - at_ < values.size_bytes()) return fail("it ends too early");
    if (!values.empty()) std::memcpy(values.data(), in_.data() + at_, values.size_bytes());
    at_ += values.size_bytes();
  }
  // A number of the bodies' side: finite and not absurd.
  void real(double& value) {
    double read = 0.0;
    raw(read);
    if (!problem_.empty()) return;
    if (!(std::abs(read) <= kMaxStateReal))
      return fail("it holds a number that is not finite or far too large");
    value = read;
  }
  void fail(std::string problem) {
    if (problem_.empty()) problem_ = std::move(problem);
  }
  bool ok() const { return problem_.empty(); }
  const std::string& problem() const { return problem_; }
  std::size_t left() const { return in_.size() - at_; }

 private:
  std::span<const std::uint8_t> in_;
  std::size_t at_ = 0;
  std::string problem_;
};

}  // namespace slosh
