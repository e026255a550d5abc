// FNV-1a over raw bytes: a run's fingerprint.
#pragma once

#include <cstddef>
#include <cstdint>

namespace slosh {

class Fingerprint {
 public:
  /// Adds the bytes of a value without padding (numbers and arrays of them).
  template <class T>
  void add(const T& value) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(&value);
    for (std::size_t i = 0; i < sizeof(T); ++i) hash_ = (hash_ ^ bytes[i]) * 0x100000001b3ull;
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325ull;
};

}  // namespace slosh
