// The machines in one that the tests over a network stand on.
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>

#include "process.h"
#include "tests/lab/coupling/network_sites.h"

namespace slosh {
namespace {

using test::Outcome;
using test::Process;
using Sites = NetworkSites;

Outcome run(const Sites& sites, const std::string& site, const std::string& command) {
  return Process(sites.at(site, {"sh", "-c", command}), test::test_folder()).wait();
}

TEST(Sites, AreApartAndSeeEachOtherThroughTheWireAlone) {
  const Sites sites({"a", "b"});
  if (!sites.problem().empty()) GTEST_SKIP() << "no network namespaces here: " << sites.problem();
  const std::string here = std::filesystem::read_symlink("/proc/self/ns/net").string();
  std::string spaces = here;
  for (const char* site : {"wire", "a", "b"}) {
    const std::string space = run(sites, site, "readlink /proc/self/ns/net").out;
    EXPECT_EQ(space.find("net:["), 0u) << space;
    EXPECT_EQ(spaces.find(space.substr(0, space.find('\n'))), std::string::npos) << "one of its own";
    spaces += space;
  }
  EXPECT_NE(run(sites, "a", "ip -o addr show eth0").out.find(sites.address("a")), std::string::npos);
  EXPECT_NE(run(sites, "wire", "ip -o addr").out.find(sites.wire_address("b")), std::string::npos);
  // A signal reaches the program itself, and what it writes is this user's.
  Process waiting(sites.at("a", {"sleep", "600"}), test::test_folder());
  waiting.signal(SIGTERM);
  EXPECT_EQ(waiting.wait().code, 128 + SIGTERM);
  EXPECT_EQ(run(sites, "a", "rm -f mine && touch mine").code, 0);
  EXPECT_TRUE(std::filesystem::exists(test::test_folder() / "mine"));
}

TEST(Sites, NothingOfThemStays) {
  pid_t inside = -1;
  {
    const Sites sites({"a"});
    if (!sites.problem().empty()) GTEST_SKIP() << "no network namespaces here: " << sites.problem();
    inside = std::stoi(sites.at("a", {}).at(2));
    EXPECT_EQ(kill(inside, 0), 0);
  }
  EXPECT_NE(kill(inside, 0), 0);
}

}  // namespace
}  // namespace slosh
