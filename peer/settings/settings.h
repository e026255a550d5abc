// What a person sets once instead of typing it each time: settings.toml, a key an option of the command line.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/math/result.h"

namespace slosh {

enum class SettingKind { kText, kNumber, kSwitch, kPath, kTexts, kKeys };

/// One key of the file. Its value goes to the option --KEY (with "-" for "_") of `verbs`, and is checked as
/// that option's is.
struct SettingKey {
  const char* key;
  SettingKind kind;
  std::vector<std::string_view> verbs;
  const char* example;  ///< as the file has it
  const char* text;     ///< what it is, a few words
};

/// All keys, in the order in which they are shown.
const std::vector<SettingKey>& setting_keys();
/// "--font-scale" of "font_scale".
std::string option_of(const SettingKey& key);

/// One value of a file.
struct Setting {
  const SettingKey* key = nullptr;
  std::vector<std::string> words;  ///< one, or several of kTexts; paths with ~ replaced
  int line = 0;                    ///< from 1
};

struct SettingsFile {
  std::filesystem::path path;  ///< empty where there is none to be read
  bool there = false;
  std::vector<Setting> values;
  std::vector<Error> errors;  ///< everything that is wrong with it; then nothing of it is to be used
};

/// $SLOSH_SETTINGS ("none": no file), else $XDG_CONFIG_HOME/slosh/settings.toml, else
/// ~/.config/slosh/settings.toml; empty where neither is known.
std::filesystem::path settings_path();

/// Reads a file, which may be missing. Never writes.
SettingsFile read_settings(const std::filesystem::path& path);
/// The same of a text; `path` is for errors.
SettingsFile parse_settings(std::string_view text, const std::filesystem::path& path);

/// A file with every key in it, each behind a #.
std::string settings_example();

/// A finding about a line of a file: "FILE:LINE: what. mend."
Error settings_error(const std::filesystem::path& path, int line, const std::string& what,
                     const std::string& mend);

}  // namespace slosh
