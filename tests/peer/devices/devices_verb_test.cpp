// `slosh devices` on a machine that umockdev makes: what it lists, and what it says of what it may not open.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "peer/devices/falcon_usb.h"
#include "peer/devices/hardware.h"
#include "peer/devices/spacemouse_models.h"
#include "tests/peer/devices/mocked_falcon.h"
#include "tests/peer/devices/mocked_spacemouse.h"
#include "tests/peer/devices/own_folder.h"
#include "tests/support/comes.h"
#include "tests/support/process.h"

namespace slosh {
namespace {

using test::MockedMachine;
using test::MockedSpaceMouse;

/// The program inherits the made-up machine.
test::Outcome slosh(const std::vector<std::string>& arguments, const std::filesystem::path& folder) {
  std::vector<std::string> all{SLOSH_PROGRAM};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return test::Process(all, folder).wait();
}

TEST(DevicesVerb, ListsWhatIsPluggedInAndWhatToSay) {
  const test::OwnFolder folder;
  MockedMachine machine;
  MockedSpaceMouse one(machine, 0, k3DconnexionVendor, 0xc635, "ABC");
  MockedSpaceMouse two(machine, 1, kLogitechVendor, 0xc626, "");
  const test::Outcome outcome = slosh({"devices"}, folder.path());
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* words : {"SpaceMouse Compact (/dev/hidraw0, serial ABC)", "--device spacemouse:ABC",
                            "SpaceNavigator (/dev/hidraw1)", "--device spacemouse:/dev/hidraw1"})
    EXPECT_NE(outcome.out.find(words), std::string::npos) << outcome.out;
}

TEST(DevicesVerb, ShowsLiveValues) {
  const test::OwnFolder folder;
  MockedMachine machine;
  MockedSpaceMouse mouse(machine, 0, k3DconnexionVendor, 0xc635, "ABC");
  test::Process process({SLOSH_PROGRAM, "devices", "--live"}, folder.path());
  EXPECT_EQ(mouse.receive(2), (std::vector<std::uint8_t>{4, 1}));  // it is open
  mouse.say({1, 0x64, 0, 0, 0, 0, 0});
  EXPECT_TRUE(test::comes([&] {
    return test::read_text(folder.path() / "stdout.txt").find("1 reports") != std::string::npos ||
           !process.running();
  }));
  process.signal(SIGINT);
  const test::Outcome outcome = process.wait();
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  EXPECT_NE(outcome.out.find("spacemouse:ABC: at"), std::string::npos) << outcome.out;
  EXPECT_EQ(mouse.receive(2), (std::vector<std::uint8_t>{4, 0})) << "and it is let go of in order";
}

TEST(DevicesVerb, TheRuleHasEveryVendorAndGoesWhereItIsTold) {
  const test::OwnFolder folder;
  const std::filesystem::path file = folder.path() / "70-slosh.rules";
  const test::Outcome outcome =
      slosh({"devices", "--install-udev-rule", "--rule-file", file.string()}, folder.path());
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(test::read_text(file), udev_rule());
  for (const char* words : {"046d", "256f", "0403", "cb48", "uaccess", "hidraw"})
    EXPECT_NE(udev_rule().find(words), std::string::npos) << words;
  const test::Outcome refused =
      slosh({"devices", "--install-udev-rule", "--rule-file", "/nowhere/at/all.rules"}, folder.path());
  EXPECT_EQ(refused.code, 1);
  EXPECT_NE(refused.out.find("uaccess"), std::string::npos) << "the rule is shown to be put there by hand";
  EXPECT_NE(refused.err.find("udevadm"), std::string::npos) << refused.err;
}

TEST(DevicesVerb, FindsAFalconByItsUsbNumbers) {
  MockedMachine machine;
  test::FakeFalcon falcon;
  const test::MockedFalcon plugged(machine, falcon, 4);
  const std::vector<FalconFound> found = find_falcons();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].node, "/dev/bus/usb/001/004");
  EXPECT_EQ(found[0].path, "usb 1-4");
  EXPECT_EQ(found[0].serial, test::kFalconSerial);
  EXPECT_FALSE(open_falcon("another"));
  EXPECT_TRUE(open_falcon(test::kFalconSerial));
}

}  // namespace
}  // namespace slosh
