// The verb `settings`, and what the settings file does to the options of the others.
#include "peer/settings/settings.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <set>
#include <string>
#include <string_view>

#include "net/text/clean.h"
#include "peer/app/verbs.h"
#include "peer/output/whole_file.h"
#include "peer/settings/key_bindings.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr const char* kSettingsFooter =
    "A key of the file is an option's name, with _ for -; its value is that option's default from then on, "
    "and the\n"
    "command line wins:\n"
    "  name = \"Ana\"\n"
    "  device = [\"spacemouse\", \"mouse\"]\n"
    "  font_scale = 1.5\n"
    "The file is $XDG_CONFIG_HOME/slosh/settings.toml, else ~/.config/slosh/settings.toml. "
    "SLOSH_SETTINGS=FILE names\n"
    "another one, SLOSH_SETTINGS=none none. Nothing is written to it but by --new.\n"
    "\n"
    "Examples:\n"
    "  slosh settings --new\n"
    "  slosh settings\n"
    "  SLOSH_SETTINGS=none slosh play";

/// As CLI11 takes the value of an option: one word, or several in brackets.
std::string value_of(const Setting& setting) {
  if (setting.words.size() == 1) return setting.words[0];
  std::string all;
  for (const std::string& word : setting.words) all += (all.empty() ? "" : ",") + word;
  return "[" + all + "]";
}

/// CLI11 says "--fps: 0 is …"; the line is said already.
std::string without_option(const std::string& text, const std::string& option) {
  return text.starts_with(option + ": ") ? text.substr(option.size() + 2) : text;
}

std::string verbs_of(const SettingKey& key) {
  std::string verbs;
  for (const std::string_view verb : key.verbs) verbs += (verbs.empty() ? "" : ", ") + std::string(verb);
  return verbs;
}

int make_new(const SettingsFile& file) {
  if (file.path.empty())
    return fail(
        {"", "it is not known where your settings are", "Set HOME, XDG_CONFIG_HOME or SLOSH_SETTINGS"});
  if (file.there) return fail({file.path.string(), "is there already and stays as it is", "Edit it"});
  std::error_code code;
  if (file.path.has_parent_path()) std::filesystem::create_directories(file.path.parent_path(), code);
  if (code)
    return fail({file.path.parent_path().string(), "cannot be made: " + code.message(),
                 "Name a file that you may write with SLOSH_SETTINGS"});
  if (const Result<bool> written = write_whole(file.path, settings_example()); !written)
    return fail(
        {written.error().where, written.error().what, "Free some space, or let yourself write there"});
  std::printf("made %s: take the # away from what you want\n",
              clean_text(file.path.string(), kMaxTextBytes).c_str());
  return kExitOk;
}

int show(const SettingsFile& file) {
  const std::string path = clean_text(file.path.string(), kMaxTextBytes);
  if (path.empty())
    std::printf("no settings file is read\n\n");
  else if (!file.there)
    std::printf("%s: not there yet; slosh settings --new makes one\n\n", path.c_str());
  else
    std::printf("%s%s\n\n", path.c_str(),
                file.errors.empty() ? "" : ": not used, as something in it is wrong");
  std::printf("%-12s %-26s %-9s %s\n", "key", "value", "from", "option");
  for (const SettingKey& key : setting_keys()) {
    std::string value = "-";
    std::string from = "default";
    for (const Setting& setting : file.values) {
      if (setting.key != &key || !file.errors.empty()) continue;
      value = value_of(setting);
      from = "line " + std::to_string(setting.line);
    }
    std::printf("%-12s %-26s %-9s %s %s: %s\n", key.key, value.c_str(), from.c_str(), verbs_of(key).c_str(),
                option_of(key).c_str(), key.text);
  }
  KeyBindings keys;
  for (const Setting& setting : file.values) {
    if (setting.key->kind != SettingKind::kKeys || !file.errors.empty()) continue;
    if (const Result<KeyBindings> made = KeyBindings::make(setting.words)) keys = made.value();
  }
  std::printf("\n%-12s %-26s %s\n", "[keys]", "now", "what it does in the window");
  for (const WindowActionWords& each : window_actions())
    std::printf("%-12s %-26s %s\n", each.name, keys.shown(each.action).c_str(), each.text);
  std::printf("\nThe command line wins over the file. sweep, report and bench take none of this.\n");
  std::fflush(stdout);
  for (const Error& error : file.errors) fail(error);
  return file.errors.empty() ? kExitOk : kExitFailed;
}

}  // namespace

void put_in_force(SettingsFile& file, CLI::App& app) {
  // slosh-lab has none of the verbs that settings are for.
  const auto verb_of = [&app](std::string_view verb) -> CLI::App* {
    const auto found =
        app.get_subcommands([&](const CLI::App* sub) { return sub->check_name(std::string(verb)); });
    return found.empty() ? nullptr : found.front();
  };
  for (const SettingKey& key : setting_keys()) {
    for (const std::string_view verb : key.verbs) {
      CLI::App* const found = verb_of(verb);
      if (found == nullptr) continue;
      CLI::Option* const option = found->get_option(option_of(key));
      option->description(option->get_description() + " {" + key.key + "}");
    }
  }
  std::set<std::string_view> verbs;
  for (const SettingKey& key : setting_keys()) verbs.insert(key.verbs.begin(), key.verbs.end());
  for (const std::string_view verb : verbs) {
    CLI::App* const found = verb_of(verb);
    if (found == nullptr) continue;
    found->footer(found->get_footer() +
                  "\n\n{name}: this can be set once for all, see slosh settings --help.");
  }
  for (const Setting& setting : file.values) {
    bool refused = false;
    for (const std::string_view verb : setting.key->verbs) {
      CLI::App* const found = verb_of(verb);
      if (found == nullptr) continue;
      CLI::Option* const option = found->get_option(option_of(*setting.key));
      try {
        option->run_callback_for_default()->default_val(value_of(setting));
      } catch (const CLI::Error& error) {
        if (refused) continue;  // the same for every verb
        refused = true;
        file.errors.push_back(settings_error(
            file.path, setting.line,
            std::string(setting.key->key) + ": " +
                without_option(clean_lines(error.what(), kMaxTextBytes), option_of(*setting.key)),
            std::string("For example ") + setting.key->key + " = " + setting.key->example));
      }
    }
  }
}

void add_settings(CLI::App& app, const SettingsFile& file, VerbRun& chosen) {
  CLI::App* verb =
      app.add_subcommand("settings", "Show what is set once for all, where it comes from, and where it goes");
  auto anew = std::make_shared<bool>(false);
  verb->add_flag("--new", *anew, "Make the file, with every key in it behind a #, where there is none")
      ->disable_flag_override();
  verb->footer(kSettingsFooter);
  verb->callback(
      [&chosen, &file, anew] { chosen = [&file, anew] { return *anew ? make_new(file) : show(file); }; });
}

}  // namespace slosh
