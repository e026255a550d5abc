// The commands of the tutorial, from the page itself. Those of Blender: tests/blender.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "process.h"
#include "tests/scenes/support.h"
#include "tests/support/places.h"

namespace slosh {
namespace {

namespace fs = std::filesystem;

/// Lines of the page that are code and begin so.
std::vector<std::string> commands(const std::string& word) {
  std::ifstream page(test::source_dir() / "scenes/blender/README.md");
  std::vector<std::string> found;
  for (std::string line; std::getline(page, line);)
    if (line.starts_with("    " + word + " ")) found.push_back(line.substr(4));
  return found;
}

TEST(Tutorial, CommandsDoWhatThePageSays) {
  const fs::path folder = test::test_folder();
  fs::remove_all(folder);
  fs::create_directories(folder);
  // In place of Blender's export, and of the launcher.
  ASSERT_TRUE(test::make_cup().write(folder / "mug.glb"));
  std::ofstream(folder / "slosh") << "#!/bin/sh\nexec '" << test::program() << "' \"$@\"\n";
  fs::permissions(folder / "slosh", fs::perms::owner_all);
  const std::vector<std::string> page = commands("./slosh");
  EXPECT_GE(page.size(), 5u);
  for (std::string command : page) {
    SCOPED_TRACE(command);
    // A tenth of a second of each run is enough to see that it runs; without a wish for a spacing the machine
    // would be measured.
    if (command.starts_with("./slosh play")) command += " --seconds 0.1 --yes";
    if (command.find("--spacing") == std::string::npos && command.starts_with("./slosh play"))
      command += " --spacing 0.012";
    const test::Outcome outcome = test::Process({"bash", "-c", command}, folder).wait();
    EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  }
  for (const char* made : {"mug-film/view.mp4", "mug-film/wrenches.png", "mug-fine/bodies.csv",
                           "mug-fine/frames/surface_00000.vdb", "mug-fine/frames/surface_00002.vdb"})
    EXPECT_TRUE(fs::exists(folder / made)) << made;
}

TEST(Tutorial, PicturesAndScriptsThatItNamesAreThere) {
  std::ifstream in(test::source_dir() / "scenes/blender/README.md");
  std::stringstream text;
  text << in.rdbuf();
  const std::string page = text.str();
  std::size_t links = 0;
  for (std::size_t at = page.find("]("); at != std::string::npos; at = page.find("](", at + 1)) {
    const std::string target = page.substr(at + 2, page.find(')', at) - at - 2);
    EXPECT_TRUE(fs::exists(test::source_dir() / "scenes/blender" / target)) << target;
    ++links;
  }
  EXPECT_GE(links, 7u);
  EXPECT_EQ(commands("blender").size(), 2u);
}

}  // namespace
}  // namespace slosh
