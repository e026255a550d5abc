#include <gtest/gtest.h>

#include <csignal>
#include <string>

#include "peer/output/child_process.h"

namespace slosh {
namespace {

class ChildProcessTest : public ::testing::Test {
 protected:
  void SetUp() override { std::signal(SIGPIPE, SIG_IGN); }
};

TEST_F(ChildProcessTest, FeedsAChildAndSeesItEndWell) {
  Result<std::unique_ptr<ChildProcess>> child = ChildProcess::start({"sh", "-c", "test $(wc -c) -eq 200000"});
  ASSERT_TRUE(child) << child.error().text();
  const std::string text(200000, 'x');  // more than a pipe holds
  EXPECT_TRUE(child.value()->write(text.data(), text.size()));
  EXPECT_TRUE(child.value()->finish());
  EXPECT_TRUE(child.value()->finish()) << "a second time is harmless";
}

TEST_F(ChildProcessTest, AFailureCarriesTheLastThingItSaid) {
  Result<std::unique_ptr<ChildProcess>> child =
      ChildProcess::start({"sh", "-c", "echo first >&2; echo the disk is full >&2; exit 3"});
  ASSERT_TRUE(child);
  const Result<bool> ended = child.value()->finish();
  ASSERT_FALSE(ended);
  EXPECT_NE(ended.error().what.find("the disk is full"), std::string::npos) << ended.error().what;
}

TEST_F(ChildProcessTest, AMissingProgramIsAnError) {
  const Result<std::unique_ptr<ChildProcess>> child = ChildProcess::start({"slosh-no-such-program"});
  ASSERT_FALSE(child);
  EXPECT_FALSE(child.error().mend.empty());
}

TEST_F(ChildProcessTest, WritingToAChildThatIsGoneFailsAndKillsNobody) {
  Result<std::unique_ptr<ChildProcess>> child = ChildProcess::start({"true"});
  ASSERT_TRUE(child);
  const std::string text(1 << 20, 'x');
  EXPECT_FALSE(child.value()->write(text.data(), text.size()));
}

}  // namespace
}  // namespace slosh
