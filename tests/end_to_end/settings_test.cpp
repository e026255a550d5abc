// The settings file as a person has it.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "process.h"

namespace slosh {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using test::read_text;

class SettingsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(test::test_folder());
    fs::create_directories(test::test_folder());
  }
  static fs::path at(const std::string& name) { return test::test_folder() / name; }
  static void write(const std::string& text) { std::ofstream(at("settings.toml")) << text; }
  /// The program with that file, or with XDG_CONFIG_HOME in place of it.
  static Outcome slosh(const std::vector<std::string>& arguments, const std::string& variable = "") {
    std::vector<std::string> all{"env", "-u", "SLOSH_SETTINGS",
                                 variable.empty() ? "SLOSH_SETTINGS=settings.toml" : variable,
                                 test::program()};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return test::Process(all, test::test_folder()).wait();
  }
};

TEST_F(SettingsTest, AreDefaultsAndTheCommandLineWins) {
  write("spacing = 0.012\nthreads = 1\nheadless = true\nruns = \"films\"\nplot = \"svg\"\nfont_scale = 2\n");
  const std::vector<std::string> run{"play", "probe", "--no-render", "--unpaced", "--seconds", "0.05"};
  Outcome outcome = slosh(run);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto summary = [](const std::string& folder) {
    return nlohmann::json::parse(read_text(at(folder) / "summary.json"));
  };
  EXPECT_EQ(summary("films/probe")["spacing_m"], 0.012);
  EXPECT_TRUE(fs::exists(at("films/probe/wrenches.svg")));
  std::vector<std::string> other = run;
  other.insert(other.end(), {"--spacing", "0.0135", "--plot", "png"});
  outcome = slosh(other);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(summary("films/probe-2")["spacing_m"], 0.0135);
  EXPECT_TRUE(fs::exists(at("films/probe-2/wrenches.png")));
}

TEST_F(SettingsTest, AKeyThatWouldDoTwoThingsIsRefusedBeforeAnythingIsBegun) {
  write("[keys]\npause = \"P\"\n");
  Outcome outcome = slosh({"play", "probe", "--headless"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("settings.toml:2: keys.pause: P does 'picture' already"), std::string::npos)
      << outcome.err;
  write("[keys]\npause = \"K\"\n");
  outcome = slosh({"settings"});
  EXPECT_NE(outcome.out.find("pause        K  "), std::string::npos) << outcome.out;
}

TEST_F(SettingsTest, AreShownWithTheirLinesAndInHelp) {
  write("\n\nname = \"Ana\"\ndevice = [\"script\", \"mouse\"]\n");
  Outcome outcome = slosh({"settings"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("settings.toml"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("line 3"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("[script,mouse]"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("join, watch --name"), std::string::npos) << outcome.out;
  outcome = slosh({"join", "--help"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.out.find("{name}"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("Ana"), std::string::npos) << outcome.out;
}

TEST_F(SettingsTest, ThatAreWrongStopEverythingAtOnceAndLoseNothing) {
  const std::string wrong = "nmae = \"Ana\"\nfps = 1000\nplot = \"gif\"\n";
  write(wrong);
  Outcome outcome = slosh({"play", "probe", "--headless"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("settings.toml:1: there is no setting 'nmae'. The nearest is name;"),
            std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("settings.toml:2: fps: '1000' is not a number from 1 to 240"), std::string::npos)
      << "all at once: " << outcome.err;
  EXPECT_FALSE(fs::exists(at("out"))) << "nothing was begun";
  EXPECT_EQ(read_text(at("settings.toml")), wrong);
  EXPECT_EQ(slosh({"settings"}).code, 1);
  EXPECT_EQ(slosh({"play", "--help"}).code, 0);

  write("fps = 1000\nplot = \"gif\"\nspacing = 50\n");
  outcome = slosh({"scenes"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("settings.toml:1: fps: '1000' is not a number from 1 to 240"), std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("settings.toml:2: plot: "), std::string::npos) << outcome.err;
  EXPECT_EQ(slosh({"scenes"}, "SLOSH_SETTINGS=none").code, 0);
}

TEST_F(SettingsTest, AreMadeOnceAndNeverReplaced) {
  const std::string variable = "XDG_CONFIG_HOME=" + at("config").string();
  Outcome outcome = slosh({"settings"}, variable);
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.out.find("not there yet"), std::string::npos) << outcome.out;
  outcome = slosh({"settings", "--new"}, variable);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const std::string made = read_text(at("config/slosh/settings.toml"));
  EXPECT_NE(made.find("# name = \"Ana\""), std::string::npos) << made;
  outcome = slosh({"settings", "--new"}, variable);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("is there already"), std::string::npos) << outcome.err;
  EXPECT_EQ(read_text(at("config/slosh/settings.toml")), made);
}

}  // namespace
}  // namespace slosh
