#include "peer/settings/settings.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "net/text/clean.h"
#include "net/text/nearest.h"
#include "peer/settings/key_bindings.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr std::size_t kMaxBytes = 1 << 20;
constexpr const char* kMendFile = "Mend that line, or move the file away; it is only read, never written";

const char* in_words(SettingKind kind) {
  switch (kind) {
    case SettingKind::kText:
      return "a text in quotes";
    case SettingKind::kPath:
      return "a path in quotes";
    case SettingKind::kNumber:
      return "a number";
    case SettingKind::kSwitch:
      return "true or false";
    case SettingKind::kTexts:
      return "a text in quotes, or several in brackets";
    case SettingKind::kKeys:
      return "a table of what a key does, each a key in quotes or several in brackets";
  }
  return "";
}

std::string home() {
  const char* const folder = std::getenv("HOME");
  return folder ? folder : "";
}

std::string with_home(const std::string& path) {
  return path == "~" || path.starts_with("~/") ? home() + path.substr(1) : path;
}

/// A value as the command line would have it; nothing where it is of another kind.
std::optional<std::vector<std::string>> words_of(const toml::node& node, SettingKind kind) {
  if (kind == SettingKind::kKeys) return std::nullopt;  // a table: read_keys()
  if (kind == SettingKind::kSwitch) {
    if (const auto* truth = node.as_boolean())
      return std::vector<std::string>{truth->get() ? "true" : "false"};
    return std::nullopt;
  }
  if (kind == SettingKind::kNumber) {
    if (const auto* whole = node.as_integer()) return std::vector{std::to_string(whole->get())};
    if (const auto* number = node.as_floating_point()) return std::vector{format("%.17g", number->get())};
    return std::nullopt;
  }
  if (const auto* text = node.as_string()) {
    const std::string clean = clean_text(text->get(), kMaxTextBytes);
    return std::vector{kind == SettingKind::kPath ? with_home(clean) : clean};
  }
  if (kind != SettingKind::kTexts || !node.is_array() || node.as_array()->empty()) return std::nullopt;
  std::vector<std::string> words;
  for (const toml::node& each : *node.as_array()) {
    if (!each.is_string()) return std::nullopt;
    words.push_back(clean_text(each.as_string()->get(), kMaxTextBytes));
  }
  return words;
}

/// [keys]: each entry with its own line, and together no key twice.
void read_keys(const toml::table& table, const SettingKey& key, int line, SettingsFile& file) {
  std::vector<std::string> choices;
  std::vector<int> lines;
  bool wrong = false;
  for (const auto& [name, node] : table) {
    const int at = static_cast<int>(node.source().begin.line);
    std::string choice = std::string(name.str()) + "=";
    bool texts = node.is_string();
    if (texts) choice += node.as_string()->get();
    if (const toml::array* const several = node.as_array()) {
      texts = true;
      for (const toml::node& each : *several) {
        texts = texts && each.is_string();
        if (texts) choice += (choice.ends_with('=') ? "" : "+") + each.as_string()->get();
      }
    }
    const Result<KeyChoice> parsed =
        texts ? parse_key_choice(choice)
              : Result<KeyChoice>(Error{"",
                                        "keys." + clean_text(std::string(name.str()), kMaxTextBytes) +
                                            " is a key in quotes, or several in brackets",
                                        "For example pause = \"Space\""});
    if (!parsed) {
      wrong = true;
      file.errors.push_back(settings_error(file.path, at, parsed.error().what, parsed.error().mend));
      continue;
    }
    choices.push_back(choice);
    lines.push_back(at);
  }
  if (wrong) return;
  if (const Result<KeyBindings> made = KeyBindings::make(choices); !made) {
    int at = line;  // of the entry that the error names
    for (std::size_t i = 0; i < choices.size(); ++i)
      if (("keys." + choices[i]).starts_with(made.error().where + "=")) at = lines[i];
    file.errors.push_back(
        settings_error(file.path, at, made.error().where + ": " + made.error().what, made.error().mend));
    return;
  }
  if (!choices.empty()) file.values.push_back({&key, std::move(choices), line});
}

void read_entry(const std::string& name, const toml::node& node, SettingsFile& file) {
  const int line = static_cast<int>(node.source().begin.line);
  const SettingKey* found = nullptr;
  std::vector<std::string> names;
  for (const SettingKey& key : setting_keys()) {
    if (name == key.key) found = &key;
    names.emplace_back(key.key);
  }
  const std::string shown = clean_text(name, kMaxTextBytes);
  if (found == nullptr) {
    const std::string near = nearest_word(name, names);
    file.errors.push_back(settings_error(file.path, line, "there is no setting '" + shown + "'",
                                         near.empty()
                                             ? "`slosh settings` lists those that there are"
                                             : "The nearest is " + near + "; `slosh settings` lists all"));
    return;
  }
  if (found->kind == SettingKind::kKeys && node.is_table())
    return read_keys(*node.as_table(), *found, line, file);
  std::optional<std::vector<std::string>> words = words_of(node, found->kind);
  if (!words) {
    file.errors.push_back(settings_error(file.path, line, shown + " is " + in_words(found->kind),
                                         std::string("For example ") + found->key + " = " + found->example));
    return;
  }
  file.values.push_back({found, std::move(*words), line});
}

}  // namespace

const std::vector<SettingKey>& setting_keys() {
  using Kind = SettingKind;
  static const std::vector<SettingKey> keys{
      {"name", Kind::kText, {"join", "watch"}, "\"Ana\"", "how others see you"},
      {"key",
       Kind::kPath,
       {"join", "watch"},
       "\"~/keys/ana\"",
       "the file with the key that hosts know you by"},
      {"device", Kind::kTexts, {"play", "join"}, "\"spacemouse\"", "what you hold, or a list, one a hand"},
      {"coupling", Kind::kText, {"join"}, "\"replica\"", "what a device that is felt is coupled to"},
      {"listen", Kind::kText, {"host"}, "\"0.0.0.0:4433\"", "where a host is reached"},
      {"backend", Kind::kText, {"play", "host", "replay"}, "\"cpu\"", "what the simulation runs on"},
      {"threads", Kind::kNumber, {"play", "host", "replay"}, "2", "cores for the simulation"},
      {"spacing", Kind::kNumber, {"play", "host"}, "0.01", "m between particles, for every scene"},
      {"runs",
       Kind::kPath,
       {"play", "join", "watch"},
       "\"~/slosh\"",
       "where runs get their numbered folders"},
      {"headless", Kind::kSwitch, {"play", "join", "watch"}, "true", "films in place of windows"},
      {"size",
       Kind::kText,
       {"play", "join", "watch", "replay"},
       "\"1280x720\"",
       "pixels of windows and films"},
      {"fps", Kind::kNumber, {"play", "join", "watch", "replay"}, "60", "pictures a second of a film"},
      {"surface",
       Kind::kText,
       {"play", "join", "watch", "replay"},
       "\"ours\"",
       "how particles become a surface"},
      {"ocio",
       Kind::kPath,
       {"play", "join", "watch", "replay"},
       "\"~/aces/config.ocio\"",
       "OpenColorIO configuration"},
      {"display",
       Kind::kText,
       {"play", "join", "watch", "replay"},
       "\"sRGB\"",
       "display of that configuration"},
      {"view", Kind::kText, {"play", "join", "watch", "replay"}, "\"Film\"", "view of that display"},
      {"environment",
       Kind::kPath,
       {"play", "join", "watch", "replay"},
       "\"~/rooms/kitchen.hdr\"",
       "room that lights the scene and is mirrored"},
      {"font_scale",
       Kind::kNumber,
       {"play", "join", "watch", "replay"},
       "1.5",
       "letters of the HUD, times their size"},
      {"keys",
       Kind::kKeys,
       {"play", "join", "watch"},
       "{ pause = \"Space\", end = [\"Escape\", \"Q\"] }",
       "what keys do in the window"},
      {"plot", Kind::kText, {"play", "join", "watch", "replay"}, "\"pdf\"", "format of the sheet of forces"},
  };
  return keys;
}

std::string option_of(const SettingKey& key) {
  std::string option = std::string("--") + key.key;
  for (char& c : option) c = c == '_' ? '-' : c;
  return option;
}

std::filesystem::path settings_path() {
  const char* const named = std::getenv("SLOSH_SETTINGS");
  if (named && *named) return std::string_view(named) == "none" ? "" : named;
  const char* const config = std::getenv("XDG_CONFIG_HOME");
  if (config && *config == '/') return std::filesystem::path(config) / "slosh" / "settings.toml";
  const std::string folder = home();
  return folder.starts_with('/') ? std::filesystem::path(folder) / ".config/slosh/settings.toml"
                                 : std::filesystem::path();
}

Error settings_error(const std::filesystem::path& path, int line, const std::string& what,
                     const std::string& mend) {
  return {clean_text(path.string(), kMaxTextBytes) + ":" + std::to_string(line), what, mend};
}

SettingsFile parse_settings(std::string_view text, const std::filesystem::path& path) {
  SettingsFile file;
  file.path = path;
  file.there = true;
  try {
    const toml::table table = toml::parse(text);
    for (const auto& [name, node] : table) read_entry(std::string(name.str()), node, file);
  } catch (const toml::parse_error& error) {
    file.values.clear();
    file.errors.push_back(settings_error(path, static_cast<int>(error.source().begin.line),
                                         clean_text(error.description(), kMaxTextBytes), kMendFile));
  }
  // A table of toml++ is sorted by name.
  const auto by_line = [](const Setting& a, const Setting& b) { return a.line < b.line; };
  std::sort(file.values.begin(), file.values.end(), by_line);
  return file;
}

SettingsFile read_settings(const std::filesystem::path& path) {
  SettingsFile file;
  file.path = path;
  std::error_code code;
  if (path.empty() || !std::filesystem::exists(path, code)) return file;
  std::ifstream in(path, std::ios::binary);
  std::string text(kMaxBytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  if (!in.is_open() || in.bad() || std::filesystem::is_directory(path, code)) {
    file.there = true;
    file.errors.push_back(
        {path.string(), "cannot be read", "Let yourself read it, or set SLOSH_SETTINGS=none"});
    return file;
  }
  if (text.size() > kMaxBytes) {
    file.there = true;
    file.errors.push_back({path.string(), "is larger than any settings are", "Move it away"});
    return file;
  }
  return parse_settings(text, path);
}

std::string settings_example() {
  std::string out =
      "# What slosh takes where the command line says nothing. The command line wins.\n"
      "# Take the # away from what you want. `slosh settings` shows what is in force, and why.\n\n";
  for (const SettingKey& key : setting_keys()) {
    std::string verbs;
    for (const std::string_view verb : key.verbs) verbs += (verbs.empty() ? "" : ", ") + std::string(verb);
    out += format("# %s = %s", key.key, key.example);
    out += "    # " + std::string(key.text) + " (" + verbs + " " + option_of(key) + ")\n";
  }
  return out;
}

}  // namespace slosh
