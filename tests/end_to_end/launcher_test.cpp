// The launcher at the top of the repository. Where this is the build that it uses, through it to the program.
#include <gtest/gtest.h>

#include <sstream>

#include "process.h"
#include "tests/support/places.h"

namespace slosh {
namespace {

using test::Outcome;

const std::filesystem::path kRoot = test::source_dir();

Outcome launcher(const std::vector<std::string>& arguments) {
  std::vector<std::string> all{"env", "SLOSH_SKIP_PACKAGES=1", (kRoot / "slosh").string()};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return test::Process(all, test::test_folder()).wait();
}

#ifdef SLOSH_LAUNCHER_BUILD
constexpr bool kIsTheLaunchersBuild = true;
#else
constexpr bool kIsTheLaunchersBuild = false;
#endif

TEST(Launcher, HelpListsTheVerbs) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{}, {"help"}, {"--help"}}) {
    const Outcome outcome = launcher(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    for (const char* verb : {"play", "devices", "scenes", "check", "plan", "report", "python", "package",
                             "test", "bench", "format", "help"}) {
      EXPECT_NE(outcome.out.find(std::string("./slosh ") + verb), std::string::npos) << verb;
    }
  }
}

TEST(Launcher, AnUnknownVerbGetsTheNearest) {
  const Outcome near = launcher({"paly"});
  EXPECT_EQ(near.code, 2);
  EXPECT_NE(near.err.find("'play'"), std::string::npos) << near.err;
  const Outcome far = launcher({"xylophone"});
  EXPECT_EQ(far.code, 2);
  EXPECT_EQ(far.err.find("Did you mean"), std::string::npos) << far.err;
}

TEST(Launcher, ExplainsItsOwnVerbsWithoutBuilding) {
  for (const char* verb : {"python", "package", "test", "bench", "format"}) {
    const Outcome outcome = launcher({verb, "--help"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("Usage"), std::string::npos);
    std::istringstream lines(outcome.out);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 110u) << line;
  }
  EXPECT_EQ(launcher({"test", "--preset", "quick"}).code, 2);
}

TEST(Launcher, WorksThroughASymbolicLinkFromAnotherFolder) {
  std::filesystem::create_directories(test::test_folder());
  const std::filesystem::path link = test::test_folder() / "linked";
  std::filesystem::remove(link);
  std::filesystem::create_symlink(kRoot / "slosh", link);
  // A verb that builds only where the build is there already.
  const std::string verb = kIsTheLaunchersBuild ? "scenes" : "help";
  const Outcome outcome =
      test::Process({"env", "SLOSH_SKIP_PACKAGES=1", "./linked", verb}, test::test_folder()).wait();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find(verb == "scenes" ? "bucket" : "./slosh play"), std::string::npos) << outcome.out;
}

TEST(Launcher, PlaysAndPassesTheExitCodeOn) {
  if (!kIsTheLaunchersBuild) GTEST_SKIP() << "the launcher builds and runs build/release, which this is not";
  std::filesystem::remove_all(test::test_folder());
  const Outcome played = launcher({"play", "bucket", "--headless", "--seconds", "1", "--spacing", "0.012",
                                   "--size", "160x120", "--fps", "5", "--out", "out"});
  EXPECT_EQ(played.code, 0) << played.err;
  for (const char* file : {"wrenches.csv", "wrenches.png", "view.mp4", "final.png", "summary.json"}) {
    EXPECT_TRUE(std::filesystem::exists(test::test_folder() / "out" / file)) << file;
  }
  EXPECT_EQ(launcher({"check", "nowhere.gltf"}).code, 1);
  EXPECT_EQ(launcher({"play", "--frobnicate"}).code, 2);
}

}  // namespace
}  // namespace slosh
