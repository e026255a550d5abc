// `slosh devices` where devices are there and this user may not open them: what is said, and the udev rule
// that is offered, never put in place without a yes.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <umockdev.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "peer/devices/hardware.h"
#include "peer/devices/spacemouse_models.h"
#include "tests/peer/devices/mocked_falcon.h"
#include "tests/peer/devices/mocked_gamepad.h"
#include "tests/peer/devices/mocked_spacemouse.h"
#include "tests/peer/devices/own_folder.h"
#include "tests/support/contains.h"
#include "tests/support/process.h"
#include "tests/support/terminal.h"

namespace slosh {
namespace {

using test::contains;

class DeniedDevices : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(bin_);
    std::filesystem::create_directories(rules_);
    // By who owns it: nobody but with root's rights may write there.
    chmod(rules_.c_str(), 0555);
  }
  void TearDown() override { chmod(rules_.c_str(), 0755); }
  /// In the made-up machine nobody has rights to `node` from now on.
  void deny(const std::string& node) {
    gchar* const root = umockdev_testbed_get_root_dir(machine_.testbed());
    denied_ = std::string(root) + node;
    g_free(root);
    ASSERT_EQ(chmod(denied_.c_str(), 0), 0) << denied_;
  }
  /// A sudo that notes what it is asked for, and then does `script`.
  void put_sudo(const std::string& script) {
    const std::filesystem::path file = bin_ / "sudo";
    std::ofstream(file) << "#!/bin/sh\necho \"$@\" >> '" << log_.string() << "'\n" << script << "\n";
    chmod(file.c_str(), 0755);
  }
  /// As a user without root's rights: whoever runs the tests may be root, and to root no node is denied.
  std::vector<std::string> unprivileged(std::vector<std::string> arguments) const {
    std::vector<std::string> all;
    if (geteuid() == 0) all = {"/usr/bin/setpriv", "--inh-caps=-all", "--bounding-set=-all"};
    all.emplace_back(SLOSH_PROGRAM);
    for (std::string& argument : arguments) all.push_back(std::move(argument));
    return all;
  }
  std::vector<std::string> with_rule_file() const {
    return unprivileged({"devices", "--rule-file", rule_.string()});
  }
  std::string asked_of_sudo() const { return std::filesystem::exists(log_) ? test::read_text(log_) : ""; }

  void is_said(const std::string& name) {
    put_sudo("exit 0");
    const test::Outcome outcome = test::Process(unprivileged({"devices"}), folder_.path() / "o").wait();
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    EXPECT_TRUE(contains(outcome.out, name)) << outcome.out;
    EXPECT_TRUE(
        contains(outcome.out, "cannot be used: this user may not open it. Install the udev rule once"));
    EXPECT_TRUE(contains(outcome.out, kUdevRuleFile)) << outcome.out;
    EXPECT_TRUE(contains(outcome.out, udev_rule())) << outcome.out;
    EXPECT_TRUE(contains(outcome.out, SLOSH_PROGRAM " devices --install-udev-rule\n")) << outcome.out;
    EXPECT_FALSE(contains(outcome.out, "[y/N]")) << "nobody sits there who could be asked";
    EXPECT_EQ(asked_of_sudo(), "");
  }

  test::OwnFolder folder_;
  const std::filesystem::path bin_ = folder_.path() / "bin";
  const std::filesystem::path rules_ = folder_.path() / "rules.d";
  const std::filesystem::path rule_ = rules_ / "70-slosh.rules";
  const std::filesystem::path log_ = folder_.path() / "sudo.log";
  const test::SetVariable path_{"PATH", bin_};
  test::MockedMachine machine_;
  std::string denied_;
};

TEST_F(DeniedDevices, ASpaceMouseIsListedWithTheRuleThatMendsIt) {
  const test::MockedSpaceMouse mouse(machine_, 0, k3DconnexionVendor, 0xc635, "ABC");
  deny(mouse.node());
  is_said("SpaceMouse Compact (/dev/hidraw0, serial ABC)");
}

TEST_F(DeniedDevices, AGamepadIsListedWithTheRuleThatMendsIt) {
  const test::MockedGamepad pad(machine_, 3, "Test Pad", "S1");
  deny(pad.node());
  is_said("Test Pad (/dev/input/event3, serial S1)");
}

TEST_F(DeniedDevices, AFalconIsListedWithTheRuleThatMendsIt) {
  test::FakeFalcon falcon;
  const test::MockedFalcon plugged(machine_, falcon, 4);
  deny(plugged.node());
  is_said("Novint Falcon (usb 1-4, /dev/bus/usb/001/004)");
}

TEST_F(DeniedDevices, OpeningOneSaysTheRule) {
  test::FakeFalcon falcon;
  const test::MockedFalcon plugged(machine_, falcon, 4);
  const test::MockedSpaceMouse mouse(machine_, 0, k3DconnexionVendor, 0xc635, "ABC");
  const test::MockedGamepad pad(machine_, 3, "Test Pad", "S1");
  for (const auto& [node, spec] :
       {std::pair{plugged.node(), "falcon"}, {mouse.node(), "spacemouse"}, {pad.node(), "gamepad"}}) {
    deny(node);
    const test::Outcome outcome =
        test::Process(unprivileged({"devices", "--live", "--device", spec}), folder_.path() / "o").wait();
    EXPECT_EQ(outcome.code, 1) << spec;
    EXPECT_TRUE(contains(outcome.err, node)) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "--install-udev-rule")) << outcome.err;
  }
}

TEST_F(DeniedDevices, AtATerminalItIsAskedForAndANoLeavesAllAsItIs) {
  put_sudo("exit 0");
  const test::MockedSpaceMouse mouse(machine_, 0, k3DconnexionVendor, 0xc635, "ABC");
  deny(mouse.node());
  for (const char* answer : {"n\n", "\n", "\x04"}) {
    test::Terminal terminal(with_rule_file(), folder_.path() / "o");
    ASSERT_TRUE(terminal.shows("sudo may ask for your password. [y/N]")) << terminal.screen();
    terminal.type(answer);
    EXPECT_EQ(terminal.wait(), 1);
  }
  EXPECT_EQ(asked_of_sudo(), "");
  EXPECT_FALSE(std::filesystem::exists(rule_));
}

TEST_F(DeniedDevices, AYesPutsItInPlaceThroughSudo) {
  const test::MockedSpaceMouse mouse(machine_, 0, k3DconnexionVendor, 0xc635, "ABC");
  deny(mouse.node());
  // What root's rights and udev would do.
  put_sudo("/bin/chmod 755 '" + rules_.string() + "' && /bin/chmod 666 '" + denied_ + "' && exec \"$@\"");
  test::Terminal terminal(with_rule_file(), folder_.path() / "o");
  ASSERT_TRUE(terminal.shows("[y/N]")) << terminal.screen();
  terminal.type("y\n");
  EXPECT_EQ(terminal.wait(), 0) << terminal.screen();
  EXPECT_EQ(asked_of_sudo(),
            SLOSH_PROGRAM " devices --install-udev-rule --rule-file " + rule_.string() + "\n");
  EXPECT_EQ(test::read_text(rule_), udev_rule());
  EXPECT_TRUE(contains(terminal.screen(), "They can be used now.")) << terminal.screen();
}

TEST_F(DeniedDevices, WhoMayWriteThereNeedsNoSudo) {
  put_sudo("exit 1");
  chmod(rules_.c_str(), 0755);
  const test::MockedSpaceMouse mouse(machine_, 0, k3DconnexionVendor, 0xc635, "ABC");
  deny(mouse.node());
  test::Terminal terminal(with_rule_file(), folder_.path() / "o");
  ASSERT_TRUE(terminal.shows("Do that now? [y/N]")) << terminal.screen();
  terminal.type("y\n");
  EXPECT_EQ(terminal.wait(), 1) << "udev, which is not there, has not let go of the device yet";
  EXPECT_TRUE(contains(terminal.screen(), "Plug them in again: then they can be used.")) << terminal.screen();
  EXPECT_EQ(test::read_text(rule_), udev_rule());
  EXPECT_EQ(asked_of_sudo(), "");
}

TEST_F(DeniedDevices, ASudoThatRefusesIsSaidWithTheWayByHand) {
  put_sudo("exit 1");
  const test::MockedSpaceMouse mouse(machine_, 0, k3DconnexionVendor, 0xc635, "ABC");
  deny(mouse.node());
  test::Terminal terminal(with_rule_file(), folder_.path() / "o");
  ASSERT_TRUE(terminal.shows("[y/N]")) << terminal.screen();
  terminal.type("y\n");
  EXPECT_EQ(terminal.wait(), 1);
  EXPECT_TRUE(contains(terminal.screen(), "it ended with 1, and the rule is not in place"))
      << terminal.screen();
  EXPECT_TRUE(contains(terminal.screen(), "As root, save the rule above as " + rule_.string()));
  EXPECT_FALSE(std::filesystem::exists(rule_));
}

TEST_F(DeniedDevices, WithoutSudoItIsSaidAndNothingAsked) {
  const test::MockedSpaceMouse mouse(machine_, 0, k3DconnexionVendor, 0xc635, "ABC");
  deny(mouse.node());
  test::Terminal terminal(with_rule_file(), folder_.path() / "o");
  EXPECT_EQ(terminal.wait(), 1);
  EXPECT_TRUE(contains(terminal.screen(), "there is no sudo here")) << terminal.screen();
  EXPECT_FALSE(contains(terminal.screen(), "[y/N]"));
}

/// Where what is wrong is no permission a rule mends nothing, and none is offered.
TEST_F(DeniedDevices, ANodeThatIsGoneIsNoMatterOfARule) {
  const test::MockedSpaceMouse mouse(machine_, 0, k3DconnexionVendor, 0xc635, "ABC");
  gchar* const root = umockdev_testbed_get_root_dir(machine_.testbed());
  std::filesystem::remove(std::string(root) + mouse.node());
  g_free(root);
  const test::Outcome outcome = test::Process(unprivileged({"devices"}), folder_.path() / "o").wait();
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(contains(outcome.out, "Plug the device in again")) << outcome.out;
  EXPECT_FALSE(contains(outcome.out, "uaccess")) << outcome.out;
}

}  // namespace
}  // namespace slosh
