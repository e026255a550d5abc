// What a settings file says, and how what is wrong in it is told.
#include "peer/settings/settings.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "peer/settings/key_bindings.h"

namespace slosh {
namespace {

SettingsFile parse(std::string_view text) {
  return parse_settings(text, "settings.toml");
}

TEST(Settings, AreReadWithTheirLines) {
  setenv("HOME", "/home/ana", 1);
  const SettingsFile file = parse(
      "# mine\n"
      "name = \"Ana\"\n"
      "\n"
      "font_scale = 1.5\n"
      "device = [\"spacemouse\", \"mouse\"]\n"
      "threads = 2\n"
      "headless = true\n"
      "runs = \"~/films\"\n");
  ASSERT_TRUE(file.errors.empty()) << file.errors[0].text();
  ASSERT_EQ(file.values.size(), 6u);
  EXPECT_STREQ(file.values[0].key->key, "name");
  EXPECT_EQ(file.values[0].words, std::vector<std::string>{"Ana"});
  EXPECT_EQ(file.values[0].line, 2);
  EXPECT_EQ(file.values[1].words, std::vector<std::string>{"1.5"});
  EXPECT_EQ(file.values[1].line, 4);
  EXPECT_EQ(file.values[2].words, (std::vector<std::string>{"spacemouse", "mouse"}));
  EXPECT_EQ(file.values[3].words, std::vector<std::string>{"2"});
  EXPECT_EQ(file.values[4].words, std::vector<std::string>{"true"});
  EXPECT_EQ(file.values[5].words, std::vector<std::string>{"/home/ana/films"});
}

TEST(Settings, ThatAreWrongAreAllToldWithLineAndMend) {
  const SettingsFile file =
      parse("nmae = \"Ana\"\nfont-scale = 2\nfps = \"many\"\nplot = \"svg\"\n[window]\nsize = 1\n");
  ASSERT_EQ(file.errors.size(), 4u);
  std::string all;
  for (const Error& error : file.errors) all += error.text() + "\n";
  EXPECT_NE(all.find("settings.toml:1: there is no setting 'nmae'. The nearest is name;"), std::string::npos)
      << all;
  EXPECT_NE(all.find("settings.toml:2: there is no setting 'font-scale'. The nearest is font_scale;"),
            std::string::npos)
      << all;
  EXPECT_NE(all.find("settings.toml:3: fps is a number. For example fps = 60"), std::string::npos) << all;
  EXPECT_NE(all.find("settings.toml:5: there is no setting 'window'. `slosh settings` lists"),
            std::string::npos)
      << all;
}

TEST(Settings, KeysAreChosenInATable) {
  const SettingsFile file = parse("fps = 60\n[keys]\npause = \"k\"\nend = [\"Esc\", \"F10\"]\naxes = []\n");
  ASSERT_TRUE(file.errors.empty()) << file.errors[0].text();
  ASSERT_EQ(file.values.size(), 2u);
  const Result<KeyBindings> keys = KeyBindings::make(file.values[1].words);
  ASSERT_TRUE(keys) << keys.error().text();
  EXPECT_EQ(keys.value().action_of(Key::kK), WindowAction::kPause);
  EXPECT_EQ(keys.value().action_of(Key::kSpace), std::nullopt) << "it is free now";
  EXPECT_EQ(keys.value().action_of(Key::kF10), WindowAction::kEnd);
  EXPECT_EQ(keys.value().action_of(Key::kQ), std::nullopt);
  EXPECT_EQ(keys.value().shown(WindowAction::kEnd), "Esc, F10");
  EXPECT_EQ(keys.value().shown(WindowAction::kAxes), "no key");
  EXPECT_EQ(keys.value().action_of(Key::kR), WindowAction::kAgain) << "what is not named stays";
}

TEST(Settings, KeysThatAreWrongAreToldWithTheirLine) {
  const auto said = [](std::string_view text) {
    const SettingsFile file = parse(text);
    std::string all;
    for (const Error& error : file.errors) all += error.text() + "\n";
    EXPECT_TRUE(file.values.empty()) << all;
    return all;
  };
  EXPECT_EQ(
      said("[keys]\npuase = \"K\"\nend = \"Escap\"\nhelp = 3\n"),
      "settings.toml:3: there is no key 'Escap'. The nearest is Escape\n"
      "settings.toml:4: keys.help is a key in quotes, or several in brackets. For example pause = \"Space\"\n"
      "settings.toml:2: no key does 'puase'. The nearest is pause\n");
  EXPECT_EQ(said("[keys]\npause = \"Shift\"\n").substr(0, 50),
            "settings.toml:2: there is no key 'Shift'. There ar");
  // Two of one's own, and one of one's own against one that was there.
  EXPECT_NE(
      said("[keys]\npause = \"K\"\nstep = \"K\"\n")
          .find("settings.toml:3: keys.step: K does 'pause' already (pause, go on). Choose another key"),
      std::string::npos);
  EXPECT_NE(said("[keys]\n\npause = \"P\"\n").find("settings.toml:3: keys.pause: P does 'picture' already"),
            std::string::npos);
  EXPECT_EQ(said("keys = \"pause\"\n").substr(0, 39), "settings.toml:1: keys is a table of wha");
}

TEST(Settings, EveryKeyHasANameThatIsReadAgainAndEveryActionOneOfItsOwn) {
  int keys = 0;
  for (int i = 0; i < static_cast<int>(Key::kCount); ++i) {
    const Key key = static_cast<Key>(i);
    if (const std::optional<Key> read = key_named(name_of(key))) {
      EXPECT_EQ(*read, key) << name_of(key);
      ++keys;
    }
  }
  EXPECT_EQ(keys, static_cast<int>(Key::kCount) - 3) << "all but Shift, Ctrl and Alt";
  EXPECT_TRUE(KeyBindings::make({})) << "by default no key does two things";
  std::size_t i = 0;
  for (const WindowActionWords& each : window_actions()) {
    EXPECT_EQ(static_cast<std::size_t>(each.action), i++) << "the table is in the order of the actions";
    ASSERT_FALSE(KeyBindings().keys_of(each.action).empty()) << each.name;
  }
  EXPECT_EQ(i, static_cast<std::size_t>(WindowAction::kCount));
  EXPECT_FALSE(KeyBindings::make({"pause=K", "pause=L"}));
}

TEST(Settings, ThatAreNoTomlAreToldWithTheLine) {
  for (const char* broken : {"name = \"Ana\"\ndevice = spacemouse\n", "name = \"Ana\"\nname = \"Ben\"\n",
                             "name = \"Ana\"\nkey = \"\x1b[31m\n"}) {
    const SettingsFile file = parse(broken);
    ASSERT_EQ(file.errors.size(), 1u) << broken;
    EXPECT_TRUE(file.values.empty());
    EXPECT_EQ(file.errors[0].where, "settings.toml:2") << file.errors[0].text();
    EXPECT_EQ(file.errors[0].text().find('\x1b'), std::string::npos);
  }
}

TEST(Settings, OfOtherBytesAreOneError) {
  EXPECT_EQ(parse("name = \"Ana\"\n\xff\xfe = 1\n").errors.size(), 1u);
}

TEST(Settings, ExampleHasEveryKeyAndIsSoundOnceItsLinesAreFree) {
  const std::string example = settings_example();
  EXPECT_TRUE(parse(example).values.empty()) << "as it is made, it sets nothing";
  EXPECT_TRUE(parse(example).errors.empty());
  std::string free;
  for (std::size_t at = 0; at < example.size();) {
    const std::size_t end = example.find('\n', at);
    const std::string line = example.substr(at, end - at);
    if (line.find(" = ") != std::string::npos) free += line.substr(2) + "\n";
    at = end + 1;
  }
  const SettingsFile file = parse(free);
  EXPECT_TRUE(file.errors.empty()) << file.errors[0].text();
  EXPECT_EQ(file.values.size(), setting_keys().size());
}

TEST(Settings, LieWhereTheSystemKeepsThem) {
  unsetenv("SLOSH_SETTINGS");
  setenv("HOME", "/home/ana", 1);
  setenv("XDG_CONFIG_HOME", "/elsewhere", 1);
  EXPECT_EQ(settings_path(), "/elsewhere/slosh/settings.toml");
  unsetenv("XDG_CONFIG_HOME");
  EXPECT_EQ(settings_path(), "/home/ana/.config/slosh/settings.toml");
  setenv("SLOSH_SETTINGS", "none", 1);
  EXPECT_TRUE(settings_path().empty());
  setenv("SLOSH_SETTINGS", "mine.toml", 1);
  EXPECT_EQ(settings_path(), "mine.toml");
  EXPECT_FALSE(read_settings("/nowhere/settings.toml").there);
  EXPECT_TRUE(read_settings("/nowhere/settings.toml").errors.empty()) << "none is no error";
  EXPECT_FALSE(read_settings("/").errors.empty());
}

}  // namespace
}  // namespace slosh
