#include "peer/devices/device_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "net/text/clean.h"

namespace slosh {
namespace {

constexpr std::size_t kMaxBytes = 64 * 1024;
constexpr const char* kBlanks = " \t\r";

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string shown(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

std::string at_line(const std::string& where, int line) {
  return where + ":" + std::to_string(line);
}

std::filesystem::path from_environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && value[0] == '/' ? std::filesystem::path(value) : std::filesystem::path();
}

}  // namespace

std::string in_quotes(const std::string& foreign) {
  std::string text(1, '\'');
  text += clean_text(foreign, 60);
  text += '\'';
  return text;
}

std::filesystem::path device_settings_folder() {
  std::filesystem::path base = from_environment("XDG_CONFIG_HOME");
  if (base.empty()) {
    base = from_environment("HOME");
    if (base.empty()) return {};
    base /= ".config";
  }
  return base / "slosh" / "devices";
}

std::filesystem::path device_settings_file(const std::string& kind, const std::string& serial) {
  const std::filesystem::path folder = device_settings_folder();
  if (folder.empty()) return {};
  if (!serial.empty()) {
    std::string name = serial;
    std::replace_if(
        name.begin(), name.end(),
        [](unsigned char c) { return c >= 0x80 || (std::isalnum(c) == 0 && c != '-' && c != '_'); }, '_');
    const std::filesystem::path own = folder / (kind + "-" + name + ".conf");
    std::error_code code;
    if (std::filesystem::exists(own, code)) return own;
  }
  return folder / (kind + ".conf");
}

Result<DeviceFile> DeviceFile::read(const std::filesystem::path& file) {
  std::error_code code;
  if (file.empty() || !std::filesystem::exists(file, code)) return DeviceFile{};
  std::ifstream in(file, std::ios::binary);
  std::string text(kMaxBytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad() || (!in.eof() && in.fail()) || std::filesystem::is_directory(file, code)) {
    return Error{file.string(), "cannot be read", "Make it readable, or remove it to use the defaults"};
  }
  if (text.size() > kMaxBytes) {
    return Error{file.string(), "is longer than 64 KiB, which no settings of a device are",
                 "Remove it to use the defaults"};
  }
  return parse(text, file.string());
}

Result<DeviceFile> DeviceFile::parse(const std::string& text, const std::string& where) {
  DeviceFile file;
  file.where_ = where;
  std::istringstream in(text);
  std::string raw;
  for (int number = 1; std::getline(in, raw); ++number) {
    const std::string line = trimmed(raw.substr(0, raw.find('#')));
    if (line.empty()) continue;
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos) {
      return Error{at_line(where, number), in_quotes(line) + " has no '='",
                   "Write it as `key = value`, or put a '#' in front"};
    }
    Line entry{trimmed(line.substr(0, equals)), trimmed(line.substr(equals + 1)), number, false};
    if (const Line* before = file.find(entry.key)) {
      return Error{at_line(where, number),
                   in_quotes(entry.key) + " stands in line " + std::to_string(before->number) + " already",
                   "Keep one of the two"};
    }
    file.lines_.push_back(std::move(entry));
  }
  return file;
}

DeviceFile::Line* DeviceFile::find(const std::string& key) {
  const auto at = std::find_if(lines_.begin(), lines_.end(), [&](const Line& l) { return l.key == key; });
  return at == lines_.end() ? nullptr : &*at;
}

bool DeviceFile::has(const std::string& key) const {
  return std::any_of(lines_.begin(), lines_.end(), [&](const Line& line) { return line.key == key; });
}

void DeviceFile::refuse(const std::string& key, const std::string& what, const std::string& mend) {
  if (error_) return;
  const Line* line = find(key);
  error_ = Error{line != nullptr ? at_line(where_, line->number) : where_, what, mend};
}

std::optional<std::string> DeviceFile::text(const std::string& key) {
  known_.push_back(key);
  Line* line = find(key);
  if (line == nullptr) return std::nullopt;
  line->asked = true;
  return line->value;
}

double DeviceFile::number(const std::string& key, double otherwise, double least, double most) {
  const std::optional<std::string> value = text(key);
  if (!value) return otherwise;
  double read = 0.0;
  const char* const end = value->data() + value->size();
  const auto [stopped, code] = std::from_chars(value->data(), end, read);
  if (code == std::errc() && stopped == end && read >= least && read <= most) return read;
  refuse(key, key + " is " + in_quotes(*value), "Give a number from " + shown(least) + " to " + shown(most));
  return otherwise;
}

int DeviceFile::whole(const std::string& key, int otherwise, int least, int most) {
  const double value = number(key, otherwise, least, most);
  if (value == std::floor(value)) return static_cast<int>(value);
  refuse(key, key + " is " + shown(value), "Give a whole number from " + shown(least) + " to " + shown(most));
  return otherwise;
}

std::string DeviceFile::word(const std::string& key, const std::string& otherwise,
                             std::initializer_list<const char*> words) {
  const std::optional<std::string> value = text(key);
  if (!value) return otherwise;
  std::string all;
  for (const char* const each : words) {
    if (*value == each) return *value;
    all += (all.empty() ? "" : ", ") + std::string(each);
  }
  refuse(key, key + " is " + in_quotes(*value), "Give one of: " + all);
  return otherwise;
}

std::optional<std::vector<std::string>> DeviceFile::list(const std::string& key) {
  const std::optional<std::string> value = text(key);
  if (!value) return std::nullopt;
  std::istringstream in(*value);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

Result<bool> DeviceFile::check() const {
  if (error_) return *error_;
  for (const Line& line : lines_) {
    if (line.asked) continue;
    std::string all;
    for (const std::string& each : known_) all += (all.empty() ? "" : ", ") + each;
    return Error{at_line(where_, line.number), in_quotes(line.key) + " is no setting of this device",
                 "There are: " + all};
  }
  return true;
}

}  // namespace slosh
