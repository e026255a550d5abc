#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>

#include "peer/haptics/script_device.h"

namespace slosh {
namespace {

constexpr int kFields = 9;
constexpr const char* kFieldNames[kFields] = {"time_s", "device", "x_m", "y_m", "z_m",
                                              "qw",     "qx",     "qy",  "qz"};

std::string at_line(const std::filesystem::path& file, std::size_t line) {
  return file.string() + ": line " + std::to_string(line);
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.back() == '\r' || text.back() == ' ')) text.remove_suffix(1);
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  return text;
}

/// Splits a row into its numbers; the error has no `where`.
Result<bool> parse_row(std::string_view row, double (&values)[kFields]) {
  int field = 0;
  while (true) {
    const std::size_t comma = row.find(',');
    const std::string_view text = trimmed(row.substr(0, comma));
    if (field >= kFields) {
      return Error{{},
                   std::string("more than ") + std::to_string(kFields) + " fields",
                   "Keep to " + std::string(kPosesHeader)};
    }
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), values[field]);
    if (code != std::errc() || end != text.data() + text.size() || !std::isfinite(values[field])) {
      return Error{{},
                   std::string(kFieldNames[field]) + " is '" + std::string(text) + "', not a finite number",
                   "Correct the field or remove the line"};
    }
    ++field;
    if (comma == std::string_view::npos) break;
    row.remove_prefix(comma + 1);
  }
  if (field < kFields) {
    return Error{{},
                 std::to_string(field) + " fields where " + std::to_string(kFields) + " belong",
                 "Keep to " + std::string(kPosesHeader)};
  }
  return true;
}

}  // namespace

Result<std::vector<PoseKey>> read_poses(const std::filesystem::path& file, int device) {
  std::ifstream in(file);
  if (!in) {
    return Error{file.string(), "cannot be read", "Give the path of a poses.csv that `play --out` wrote"};
  }
  std::string line;
  std::getline(in, line);
  if (trimmed(line) != kPosesHeader) {
    return Error{at_line(file, 1),
                 std::string("'") + std::string(trimmed(line)).substr(0, 80) + "' is not the header",
                 "The first line must be " + std::string(kPosesHeader)};
  }
  std::vector<PoseKey> keys;
  for (std::size_t number = 2; std::getline(in, line); ++number) {
    if (trimmed(line).empty()) continue;
    double v[kFields] = {};
    const Result<bool> parsed = parse_row(line, v);
    if (!parsed) return Error{at_line(file, number), parsed.error().what, parsed.error().mend};
    if (v[1] < 0.0 || v[1] > 1e6 || v[1] != std::floor(v[1])) {
      return Error{at_line(file, number), "device is not an index from 0", "Correct the field"};
    }
    if (static_cast<int>(v[1]) != device) continue;
    const glm::dquat q(v[5], v[6], v[7], v[8]);
    if (std::abs(glm::length(q) - 1.0) > 0.01) {
      return Error{at_line(file, number), "(qw, qx, qy, qz) has length " + std::to_string(glm::length(q)),
                   "A rotation's quaternion has length 1"};
    }
    if (!keys.empty() && v[0] <= keys.back().time) {
      return Error{at_line(file, number), "time_s does not rise for device " + std::to_string(device),
                   "Sort each device's lines by time and keep one a moment"};
    }
    keys.push_back({v[0], {{v[2], v[3], v[4]}, glm::normalize(q)}});
  }
  if (keys.empty()) {
    return Error{file.string(), "has no line for device " + std::to_string(device),
                 "Replay it on the device it was recorded from, or change its device column"};
  }
  return keys;
}

}  // namespace slosh
