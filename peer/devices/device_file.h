// Settings of one device: a file of `key = value` lines in the user's configuration folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "sim/math/result.h"

namespace slosh {

constexpr int kMaxButtons = 32;
/// Whether button `number`, from 1, is down; none is 0.
inline bool button_down(std::uint32_t buttons, int number) {
  return number > 0 && (buttons >> (number - 1) & 1u) != 0;
}

/// What stands in a file or on a command line, for an error: cleaned, cut and in quotes.
std::string in_quotes(const std::string& foreign);

/// $XDG_CONFIG_HOME/slosh/devices, else ~/.config/slosh/devices; empty where there is neither.
std::filesystem::path device_settings_folder();

/// The file of a device: `kind-SERIAL.conf` where that is there, else `kind.conf`, which need not be there.
/// What of a serial number is no letter, digit, '-' or '_' is '_' in the name.
std::filesystem::path device_settings_file(const std::string& kind, const std::string& serial);

/// A line is `key = value`, a comment begins with '#'. Ask for every key that the device knows, then check():
/// the first error is kept, and what nobody asked for is one too.
class DeviceFile {
 public:
  /// A file that is not there has no lines. Errors: it cannot be read, is longer than 64 KiB, a line without
  /// '=', a key twice; each with the line's number.
  static Result<DeviceFile> read(const std::filesystem::path& file);
  static Result<DeviceFile> parse(const std::string& text, const std::string& where);

  /// A finite number from `least` to `most`.
  double number(const std::string& key, double otherwise, double least, double most);
  /// A whole one.
  int whole(const std::string& key, int otherwise, int least, int most);
  /// One of `words`.
  std::string word(const std::string& key, const std::string& otherwise,
                   std::initializer_list<const char*> words);
  /// What stands there, apart at blanks; nothing where the key is not there.
  std::optional<std::vector<std::string>> list(const std::string& key);
  std::optional<std::string> text(const std::string& key);
  bool has(const std::string& key) const;

  /// Notes that the value of `key` cannot be used. The first error stays.
  void refuse(const std::string& key, const std::string& what, const std::string& mend);
  /// The first error, with file and line.
  Result<bool> check() const;
  bool empty() const { return lines_.empty(); }

 private:
  struct Line {
    std::string key, value;
    int number = 0;
    bool asked = false;
  };
  Line* find(const std::string& key);

  std::string where_;
  std::vector<Line> lines_;
  std::vector<std::string> known_;
  std::optional<Error> error_;
};

}  // namespace slosh
