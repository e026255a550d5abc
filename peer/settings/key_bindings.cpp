#include "peer/settings/key_bindings.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "net/text/clean.h"
#include "net/text/nearest.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr WindowActionWords kActions[] = {
    {WindowAction::kEnd, "end", "Escape+Q", "end"},
    {WindowAction::kAgain, "again", "R", "start again"},
    {WindowAction::kHelp, "help", "H", "all keys"},
    {WindowAction::kCameraBack, "camera_back", "C", "the camera back to where it was"},
    {WindowAction::kPause, "pause", "Space", "pause, go on"},
    {WindowAction::kGrip, "grip", "G", "take a free grip, let go"},
    {WindowAction::kSliders, "sliders", "Tab", "sliders: viscosity, gravity, pace, surface"},
    {WindowAction::kGiveBack, "give_back", "B", "give the hands back to the script"},
    {WindowAction::kStep, "step", "N", "one step, with Shift ten (the world then stands)"},
    {WindowAction::kSlower, "slower", "Down", "slower"},
    {WindowAction::kFaster, "faster", "Up", "faster"},
    {WindowAction::kPicture, "picture", "P", "keep the picture as a file"},
    {WindowAction::kParticles, "particles", "V", "particles by speed, pressure, fluid; velocities; surface"},
    {WindowAction::kAxes, "axes", "X", "axes and a scale"},
    {WindowAction::kForces, "forces", "F", "force and torque, large: zoom, hold, save"},
    {WindowAction::kView1, "view_1", "1", "the camera as kept there; with Shift keep it"},
    {WindowAction::kView2, "view_2", "2", "another"},
    {WindowAction::kView3, "view_3", "3", "another"},
    {WindowAction::kView4, "view_4", "4", "another"},
};

struct NamedKey {
  Key key;
  const char* name;
};
constexpr NamedKey kKeys[] = {
    {Key::kEscape, "Escape"},
    {Key::kSpace, "Space"},
    {Key::kEnter, "Enter"},
    {Key::kTab, "Tab"},
    {Key::kBackspace, "Backspace"},
    {Key::kLeft, "Left"},
    {Key::kRight, "Right"},
    {Key::kUp, "Up"},
    {Key::kDown, "Down"},
    {Key::kPageUp, "PageUp"},
    {Key::kPageDown, "PageDown"},
    {Key::kHome, "Home"},
    {Key::kEnd, "End"},
};

Key after(Key first, int by) {
  return static_cast<Key>(static_cast<int>(first) + by);
}

bool same(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

std::vector<std::string> key_names() {
  std::vector<std::string> names;
  for (const NamedKey& each : kKeys) names.emplace_back(each.name);
  for (int i = 0; i < 26; ++i) names.push_back(name_of(after(Key::kA, i)));
  for (int i = 0; i < 10; ++i) names.push_back(name_of(after(Key::k0, i)));
  for (int i = 0; i < 12; ++i) names.push_back(name_of(after(Key::kF1, i)));
  return names;
}

std::string clean(const std::string& text) {
  return clean_text(text, kMaxTextBytes);
}

/// "The nearest is …" where one is near, else all of them.
std::string mend(const std::string& word, const std::vector<std::string>& names, const std::string& all) {
  const std::string near = nearest_word(word, names);
  return near.empty() ? all : "The nearest is " + near;
}

const WindowActionWords& words_of(WindowAction action) {
  return kActions[static_cast<std::size_t>(action)];
}

}  // namespace

std::span<const WindowActionWords> window_actions() {
  return kActions;
}

std::string name_of(Key key) {
  for (const NamedKey& each : kKeys)
    if (each.key == key) return each.name;
  const int at = static_cast<int>(key);
  const auto from = [at](Key first) { return at - static_cast<int>(first); };
  if (key >= Key::kA && key <= Key::kZ) return std::string(1, static_cast<char>('A' + from(Key::kA)));
  if (key >= Key::k0 && key <= Key::k9) return std::to_string(from(Key::k0));
  if (key >= Key::kF1 && key <= Key::kF12) return format("F%d", 1 + from(Key::kF1));
  return key == Key::kShift ? "Shift" : key == Key::kControl ? "Ctrl" : key == Key::kAlt ? "Alt" : "?";
}

std::optional<Key> key_named(const std::string& name) {
  for (int i = 0; i < static_cast<int>(Key::kCount); ++i) {
    const Key key = static_cast<Key>(i);
    if (key == Key::kShift || key == Key::kControl || key == Key::kAlt) continue;
    if (same(name, name_of(key)) || (key == Key::kEscape && same(name, "Esc"))) return key;
  }
  return std::nullopt;
}

Result<KeyChoice> parse_key_choice(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos)
    return Error{"keys", format("'%s' is not ACTION=KEY", clean(text).c_str()),
                 "For example pause=Space, or end=Escape+Q"};
  const std::string name = text.substr(0, equals);
  KeyChoice choice{WindowAction::kCount, {}};
  std::vector<std::string> names;
  for (const WindowActionWords& each : kActions) {
    if (name == each.name) choice.action = each.action;
    names.emplace_back(each.name);
  }
  if (choice.action == WindowAction::kCount)
    return Error{"keys", "no key does '" + clean(name) + "'",
                 mend(name, names, "`slosh settings` lists what keys do")};
  std::string rest = text.substr(equals + 1);
  while (!rest.empty()) {
    const std::size_t plus = rest.find('+');
    const std::string word = rest.substr(0, plus);
    rest = plus == std::string::npos ? "" : rest.substr(plus + 1);
    const std::optional<Key> key = key_named(word);
    if (!key) {
      return Error{
          "keys." + name, "there is no key '" + clean(word) + "'",
          mend(word, key_names(),
               "There are A to Z, 0 to 9, F1 to F12, Escape, Space, Enter, Tab, Backspace, PageUp, PageDown, "
               "Home, End and the arrows Left, Right, Up, Down")};
    }
    if (std::find(choice.keys.begin(), choice.keys.end(), *key) == choice.keys.end())
      choice.keys.push_back(*key);
  }
  return choice;
}

KeyBindings::KeyBindings() {
  for (const WindowActionWords& each : kActions) {
    const Result<KeyChoice> choice = parse_key_choice(std::string(each.name) + "=" + each.keys);
    keys_[static_cast<std::size_t>(each.action)] = choice.value().keys;
  }
}

Result<KeyBindings> KeyBindings::make(const std::vector<std::string>& choices) {
  KeyBindings made;
  std::set<WindowAction> chosen;
  for (const std::string& text : choices) {
    const Result<KeyChoice> choice = parse_key_choice(text);
    if (!choice) return choice.error();
    const WindowAction action = choice.value().action;
    if (!chosen.insert(action).second)
      return Error{std::string("keys.") + words_of(action).name, "is given twice", "Keep one of the two"};
    made.keys_[static_cast<std::size_t>(action)] = choice.value().keys;
  }
  for (const WindowActionWords& first : kActions) {
    for (const Key key : made.keys_of(first.action)) {
      for (const WindowActionWords& second : kActions) {
        if (second.action <= first.action) continue;
        const std::vector<Key>& others = made.keys_of(second.action);
        if (std::find(others.begin(), others.end(), key) == others.end()) continue;
        // Of the two the one that somebody chose is where the mistake is.
        const bool of_second = chosen.contains(second.action);
        const WindowActionWords& mine = of_second ? second : first;
        const WindowActionWords& other = of_second ? first : second;
        return Error{std::string("keys.") + mine.name,
                     name_of(key) + " does '" + other.name + "' already (" + other.text + ")",
                     std::string("Choose another key, or give ") + other.name + " another one too"};
      }
    }
  }
  return made;
}

std::optional<WindowAction> KeyBindings::action_of(Key key) const {
  for (std::size_t i = 0; i < keys_.size(); ++i)
    if (std::find(keys_[i].begin(), keys_[i].end(), key) != keys_[i].end())
      return static_cast<WindowAction>(i);
  return std::nullopt;
}

std::string KeyBindings::shown(WindowAction action) const {
  std::string names;
  for (const Key key : keys_of(action))
    names += (names.empty() ? "" : ", ") + (key == Key::kEscape ? std::string("Esc") : name_of(key));
  return names.empty() ? "no key" : names;
}

}  // namespace slosh
