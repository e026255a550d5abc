// The bytes behind a glTF's accessors, taken out and put in.
#pragma once

#include <cstring>

#include "foreign_kit.h"

namespace slosh::test {

inline constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

inline std::string decoded(const std::string& uri) {
  std::string out;
  std::uint32_t bits = 0;
  int count = 0;
  for (std::size_t i = uri.find(',') + 1; i < uri.size() && uri[i] != '='; ++i) {
    bits = bits << 6 | static_cast<std::uint32_t>(std::strchr(kDigits, uri[i]) - kDigits);
    if ((count += 6) < 8) continue;
    out += static_cast<char>(bits >> (count -= 8) & 0xff);
  }
  return out;
}

inline std::string encoded(const std::string& bytes) {
  std::string out = "data:application/octet-stream;base64,";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
  }
  return out;
}

/// New bytes of a file: a buffer of their own, with a view and an accessor on them.
template <class T>
std::size_t add_accessor(nlohmann::json& j, const std::vector<T>& numbers, int component_type,
                         const char* type, std::size_t count) {
  std::string bytes(numbers.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  j["buffers"].push_back({{"byteLength", bytes.size()}, {"uri", encoded(bytes)}});
  j["bufferViews"].push_back({{"buffer", j["buffers"].size() - 1}, {"byteLength", bytes.size()}});
  j["accessors"].push_back({{"bufferView", j["bufferViews"].size() - 1},
                            {"componentType", component_type},
                            {"count", count},
                            {"type", type}});
  return j["accessors"].size() - 1;
}

inline std::string bytes_of(const nlohmann::json& j, const nlohmann::json& accessor) {
  const nlohmann::json& view = j["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  const std::size_t from =
      view.value("byteOffset", std::size_t{0}) + accessor.value("byteOffset", std::size_t{0});
  return decoded(j["buffers"][view["buffer"].get<std::size_t>()]["uri"].get<std::string>()).substr(from);
}

inline std::vector<float> positions_of(nlohmann::json& j, const std::string& node) {
  const nlohmann::json& accessor = accessor_of(j, node, "POSITION");
  std::vector<float> out(3 * accessor["count"].get<std::size_t>());
  std::memcpy(out.data(), bytes_of(j, accessor).data(), 4 * out.size());
  return out;
}

inline std::vector<std::uint32_t> indices_of(nlohmann::json& j, const std::string& node) {
  const nlohmann::json& accessor = accessor_of(j, node, "indices");
  const std::string bytes = bytes_of(j, accessor);
  std::vector<std::uint32_t> out(accessor["count"].get<std::size_t>());
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (accessor["componentType"] == 5125)
      std::memcpy(&out[i], bytes.data() + 4 * i, 4);
    else if (accessor["componentType"] == 5123)
      out[i] = static_cast<unsigned char>(bytes[2 * i]) | static_cast<unsigned char>(bytes[2 * i + 1]) << 8;
    else
      out[i] = static_cast<unsigned char>(bytes[i]);
  }
  return out;
}

}  // namespace slosh::test
