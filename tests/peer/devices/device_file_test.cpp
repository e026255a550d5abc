// Settings of a device: values, ranges, and errors that name the line.
#include "peer/devices/device_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "peer/devices/spacemouse_settings.h"
#include "tests/peer/devices/own_folder.h"

namespace slosh {
namespace {

Result<SpaceMouseSettings> settings(const std::string& text) {
  Result<DeviceFile> file = DeviceFile::parse(text, "f.conf");
  if (!file) return file.error();
  return read_spacemouse_settings(std::move(file.value()));
}

TEST(DeviceFile, TakesWhatItSaysAndDefaultsForTheRest) {
  const Result<SpaceMouseSettings> s = settings(
      "# mine\n mode = position   # not rate\n\nreach_m=0.2\r\naxes = x y z -rx ry rz\ngain_rz = -2\n");
  ASSERT_TRUE(s) << s.error().text();
  EXPECT_FALSE(s.value().rate);
  EXPECT_EQ(s.value().reach, 0.2);
  EXPECT_EQ(s.value().deadzone, 2);
  EXPECT_EQ(s.value().gains[5], -2.0);
  EXPECT_EQ(s.value().axes[1].axis, 1);
  EXPECT_EQ(s.value().axes[3].sign, -1.0);
}

TEST(DeviceFile, NamesTheLineAndTheMend) {
  struct Case {
    const char* text;
    const char* line;
    const char* words;
  };
  for (const Case& c :
       {Case{"mode = rate\nspeed_m_s = 9\n", "f.conf:2", "0 to 5"},
        Case{"speed_m_s = nan\n", "f.conf:1", "'nan'"}, Case{"deadzone = 2.5\n", "f.conf:1", "whole"},
        Case{"mode = fast\n", "f.conf:1", "rate, position"}, Case{"\nsped = 1\n", "f.conf:2", "speed_m_s"},
        Case{"mode rate\n", "f.conf:1", "no '='"},
        Case{"mode = rate\nmode = rate\n", "f.conf:2", "line 1 already"},
        Case{"axes = x y z\n", "f.conf:1", "3 entries"},
        Case{"axes = x y z rx ry up\n", "f.conf:1", "entry 6"}}) {
    const Result<SpaceMouseSettings> s = settings(c.text);
    ASSERT_FALSE(s) << c.text;
    EXPECT_EQ(s.error().where, c.line) << s.error().text();
    EXPECT_NE(s.error().text().find(c.words), std::string::npos) << s.error().text();
    EXPECT_FALSE(s.error().mend.empty());
  }
}

TEST(DeviceFile, AFolderOrAHugeFileIsRefusedAndNoneIsNoMistake) {
  const test::OwnFolder own;
  const std::filesystem::path& folder = own.path();
  EXPECT_FALSE(DeviceFile::read(folder));
  std::ofstream(folder / "huge.conf") << std::string(70000, '#');
  EXPECT_FALSE(DeviceFile::read(folder / "huge.conf"));
  ASSERT_TRUE(DeviceFile::read(folder / "none.conf"));
  EXPECT_TRUE(DeviceFile::read(folder / "none.conf").value().empty());
}

TEST(DeviceFile, ASerialNumberMakesNoPath) {
  const test::OwnFolder own;
  const std::filesystem::path& config = own.path();
  std::filesystem::create_directories(config / "slosh" / "devices");
  setenv("XDG_CONFIG_HOME", config.c_str(), 1);
  EXPECT_EQ(device_settings_file("falcon", "../x").filename(), "falcon.conf");
  std::ofstream(config / "slosh" / "devices" / "falcon-___x.conf") << "";
  EXPECT_EQ(device_settings_file("falcon", "../x"), config / "slosh" / "devices" / "falcon-___x.conf");
}

}  // namespace
}  // namespace slosh
