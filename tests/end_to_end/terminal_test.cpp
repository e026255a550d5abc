// What a person types while the program keeps a line up to date, at the host and at a peer.
#include "tests/support/terminal.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "hosted_test.h"

namespace slosh {
namespace {

using test::Outcome;
using test::Terminal;

class TerminalTest : public test::HostedTest {
 protected:
  std::unique_ptr<Terminal> at_terminal(const std::string& name, const std::vector<std::string>& with) const {
    return std::make_unique<Terminal>(command(with), folder(name));
  }
  std::unique_ptr<Terminal> host(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"host",         "probe", "--spacing", "0.01",
                                       "--threads",    "1",     "--listen",  "127.0.0.1:0",
                                       "--checkpoint", "none",  "--links",   "links.txt"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return at_terminal("host", arguments);
  }
  std::unique_ptr<Terminal> join(const std::string& verb, const std::string& name) const {
    return at_terminal(name, {verb, "--link-file", "../host/links.txt", "--name", name, "--headless",
                              "--no-render", "--out", "out", "--key", "../" + name + ".key"});
  }
};

TEST_F(TerminalTest, WhatIsTypedIsNotPaintedOver) {
  const auto host = this->host();
  ASSERT_TRUE(host->shows("nobody here yet")) << host->screen();
  EXPECT_FALSE(host->echoes()) << "the program does it";
  const std::size_t before = host->screen().size();
  host->type("statusX");
  ASSERT_TRUE(host->shows("> statusX", before)) << host->screen();
  const std::string typed = host->screen();
  // The line is kept up to date twice a second; now it must not be.
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  EXPECT_EQ(host->screen(), typed);
  host->type("\x7f\r");
  EXPECT_TRUE(host->shows("waiting for hands", typed.size())) << host->screen();
  EXPECT_NE(host->screen().find("> status\r\n"), std::string::npos)
      << "what was asked stays above its answer";
  const std::size_t answered = host->screen().size();
  EXPECT_TRUE(host->shows("nobody here yet", answered)) << "and the line is back";
  host->type("quit\n");
  EXPECT_TRUE(host->shows("the host has ended the run")) << host->screen();
  EXPECT_TRUE(host->shows("hosted")) << host->screen();
  EXPECT_EQ(host->wait(), 0);
  EXPECT_TRUE(host->echoes()) << "as it was found";
}

TEST_F(TerminalTest, APeerSetsParametersAndPausesFromItsTerminal) {
  const auto host = this->host({"--run", "Ana"});
  ASSERT_TRUE(host->shows("nobody here yet")) << host->screen();
  const auto ana = join("join", "Ana");
  ASSERT_TRUE(ana->shows("you hold grip")) << ana->screen();
  const auto eve = join("watch", "Eve");
  ASSERT_TRUE(eve->shows("looking on")) << eve->screen();

  ana->type("set gravity 0.5\r");
  EXPECT_TRUE(ana->shows("gravity is 0.5 times the scene's now")) << ana->screen();
  EXPECT_TRUE(host->shows("Ana set gravity to 0.5 times the scene's")) << host->screen();
  EXPECT_TRUE(eve->shows("Ana set gravity to 0.5 times the scene's")) << eve->screen();
  ana->type("set viscosity 1e6\r");
  EXPECT_TRUE(ana->shows("too much for the time step")) << ana->screen();
  ana->type("set stiffness 0.5\r");
  EXPECT_TRUE(ana->shows("the hold on 'probe_hand' is 0.5 times as stiff as the scene has it now"))
      << ana->screen();
  EXPECT_TRUE(eve->shows("Ana set the hold on 'probe_hand' to 0.5 times the scene's stiffness"))
      << eve->screen();
  ana->type("pause\r");
  EXPECT_TRUE(host->shows("Ana paused the world")) << host->screen();
  ana->type("status\r");
  EXPECT_TRUE(ana->shows("paused, gravity × 0.5")) << ana->screen();
  ana->type("continue\rrelease\r");
  EXPECT_TRUE(ana->shows("you let go of grip")) << ana->screen();
  const std::size_t before = ana->screen().size();
  ana->type("take\r");
  EXPECT_TRUE(ana->shows("you hold grip", before)) << ana->screen();
  eve->type("set gravity 1\r");
  EXPECT_TRUE(eve->shows("this link is for watching")) << eve->screen();
  eve->type("who\r");
  EXPECT_TRUE(eve->shows("Eve (you) looks on")) << eve->screen();
  for (const auto* one : {&ana, &eve}) {
    (*one)->type("quit\r");
    EXPECT_EQ((*one)->wait(), 0) << (*one)->screen();
    EXPECT_TRUE((*one)->echoes());
  }
}

TEST_F(TerminalTest, WhoMayOnlyHoldIsToldHowToRunTheWorldAndByWhom) {
  const auto host = this->host();
  ASSERT_TRUE(host->shows("nobody here yet")) << host->screen();
  const auto ana = join("join", "Ana");
  ASSERT_TRUE(ana->shows("you hold grip")) << ana->screen();
  ana->type("set gravity 0\rreset\r");
  ASSERT_TRUE(ana->shows("Whoever hosts gives the role by typing: role ")) << ana->screen();
  EXPECT_TRUE(host->shows("Ana may not set gravity to 0 times the scene's")) << host->screen();
  ana->type("set stiffness 0.5\r");
  EXPECT_TRUE(ana->shows("the hold on 'probe_hand' is 0.5 times as stiff")) << "her own: " << ana->screen();
  const std::string& screen = ana->screen();
  const std::string id = screen.substr(screen.find("by typing: role ") + 16, 4);
  host->type("role " + id + " run\r");
  EXPECT_TRUE(host->shows("whoever comes by " + id + " may run the world")) << host->screen();
  EXPECT_TRUE(ana->shows("Ana may run the world now")) << ana->screen();
  ana->type("set gravity 0.5\r");
  EXPECT_TRUE(ana->shows("gravity is 0.5 times the scene's now")) << ana->screen();
  const std::size_t before = ana->screen().size();
  ana->type("reset\rreset\rreset\r");
  EXPECT_TRUE(ana->shows("as one guest may for now: again in ", before)) << ana->screen();
  host->type("log\r");
  EXPECT_TRUE(host->shows("  Ana set gravity to 0.5 times the scene's")) << host->screen();
}

TEST_F(TerminalTest, TheLinkIsAskedForAndNotShown) {
  const auto host = this->host();
  ASSERT_TRUE(host->shows("nobody here yet")) << host->screen();
  const std::string text = link("hold");
  EXPECT_NE(host->screen().find(text), std::string::npos) << "a terminal shows it whole";
  EXPECT_EQ(host->screen().find("join slosh://"), std::string::npos)
      << "and leads nobody to their command line";
  const std::vector<std::string> asks{"join", "--headless", "--no-render", "--out",
                                      "out",  "--key",      "../Ana.key"};
  const auto left = at_terminal("left", asks);
  ASSERT_TRUE(left->shows("Paste or type the link")) << left->screen();
  left->type("\x03");
  EXPECT_EQ(left->wait(), 130) << left->screen();
  EXPECT_TRUE(left->echoes()) << "the terminal is as it was";

  const auto ana = at_terminal("Ana", asks);
  ASSERT_TRUE(ana->shows("Paste or type the link")) << ana->screen();
  EXPECT_FALSE(ana->echoes());
  // As a mail program broke it.
  ana->type(text.substr(0, 40) + "\r> " + text.substr(40) + "\r");
  EXPECT_TRUE(ana->shows("you hold grip")) << ana->screen();
  EXPECT_EQ(ana->screen().find(text.substr(text.size() - 20)), std::string::npos) << ana->screen();
  ana->type("quit\r");
  EXPECT_EQ(ana->wait(), 0) << ana->screen();
  EXPECT_TRUE(ana->echoes());
}

TEST_F(TerminalTest, AWorldOfOnesOwnHearsTheSameLines) {
  const auto play =
      at_terminal("play", {"play", "probe", "--spacing", "0.01", "--threads", "1", "--no-render", "--seconds",
                           "600", "--out", "out", "--record", "typed.rec"});
  ASSERT_TRUE(play->shows("real time")) << play->screen();
  play->type("set gravity 0.5\rset viscosity 1e6\rset stiffness 2\rpause\r");
  EXPECT_TRUE(play->shows("gravity is 0.5 times the scene's now")) << play->screen();
  EXPECT_TRUE(play->shows("too much for the time step")) << play->screen();
  EXPECT_TRUE(play->shows("the hold on 'probe_hand' is 2 times as stiff")) << play->screen();
  EXPECT_TRUE(play->shows("you paused the world")) << play->screen();
  play->type("status\r");
  EXPECT_TRUE(play->shows("grip 'probe_hand': stiffness × 2")) << play->screen();
  EXPECT_TRUE(play->shows("paused, gravity × 0.5")) << play->screen();
  play->type("take\r");
  EXPECT_TRUE(play->shows("'take' means nothing here")) << play->screen();
  play->type("help\r");
  EXPECT_TRUE(play->shows("set viscosity [FLUID] X")) << play->screen();
  play->type("continue\rreset\r");
  EXPECT_TRUE(play->shows("the world is back at its start")) << play->screen();
  play->type("quit\r");
  EXPECT_EQ(play->wait(), 0) << play->screen();
  EXPECT_TRUE(play->echoes());
  const Outcome again = run("play", {"replay", "typed.rec"})->wait();
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_NE(again.out.find("hashes agree"), std::string::npos) << again.out;
}

TEST_F(TerminalTest, ASlowPlanSaysItsEstimateAndAsks) {
  // From minutes to a day is asked for: this takes 50 minutes of one core, and where others have it 13 hours.
  const std::vector<std::string> slow{"play",      "pool", "--particles", "40000",     "--seconds", "600",
                                      "--threads", "1",    "--no-render", "--unpaced", "--out",     "out"};
  const auto declined = at_terminal("declined", slow);
  ASSERT_TRUE(declined->shows("Go on?")) << declined->screen();
  for (const char* part : {"slow: ", "steps of", "for the run", "real time"})
    EXPECT_TRUE(declined->shows(part)) << part << " in " << declined->screen();
  declined->type("n\r");
  EXPECT_TRUE(declined->shows("was not wanted")) << declined->screen();
  EXPECT_TRUE(declined->shows("--spacing")) << "what to do instead";
  EXPECT_NE(declined->wait(), 0);
  EXPECT_FALSE(std::filesystem::exists(folder("declined") / "out")) << "nothing was begun";

  const auto agreed = at_terminal("agreed", slow);
  ASSERT_TRUE(agreed->shows("Go on?")) << agreed->screen();
  agreed->type("y\r");
  std::this_thread::sleep_for(std::chrono::seconds(1));
  agreed->type("\x03");
  EXPECT_EQ(agreed->wait(), 130) << agreed->screen();
  EXPECT_EQ(agreed->screen().find("not wanted"), std::string::npos) << agreed->screen();

  const auto ended = at_terminal("ended", slow);
  ASSERT_TRUE(ended->shows("Go on?")) << ended->screen();
  ended->type("\x03");
  EXPECT_NE(ended->wait(), 0) << "the first Ctrl-C acts, here too: " << ended->screen();
}

TEST_F(TerminalTest, AHostMayKeepTheParametersToItself) {
  const auto host = this->host({"--lock-parameters", "--run", "Ana"});
  ASSERT_TRUE(host->shows("nobody here yet")) << host->screen();
  const auto ana = join("join", "Ana");
  ASSERT_TRUE(ana->shows("you hold grip")) << ana->screen();
  ana->type("set gravity 0.5\r");
  EXPECT_TRUE(ana->shows("here only the host sets viscosity, gravity and stiffness")) << ana->screen();
}

}  // namespace
}  // namespace slosh
