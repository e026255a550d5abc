#include "peer/remote/peer_console.h"

#include <gtest/gtest.h>

#include <random>

#include "net/wire/text.h"
#include "tests/support/joined.h"

namespace slosh {
namespace {

using Kind = RemoteCommand::Kind;

class PeerConsole : public ::testing::Test, protected test::Joined {
 protected:
  PeerLine type(std::string_view line) const { return peer_line(line, status, scene, 0.02, 0); }
  /// The one thing that the line asks for.
  RemoteCommand asked(std::string_view line) const {
    const PeerLine typed = type(line);
    EXPECT_EQ(typed.commands.size(), 1u) << line << ": " << typed.text;
    EXPECT_TRUE(typed.text.empty()) << "the host answers";
    return typed.commands.empty() ? RemoteCommand{} : typed.commands[0];
  }
};

TEST_F(PeerConsole, ParametersAreAskedForAsAtTheHost) {
  const RemoteCommand honey = asked("set viscosity honey 2.5");
  EXPECT_EQ(honey.kind, Kind::kParameter);
  EXPECT_EQ(honey.parameter, wire::Parameter::kFluidViscosity);
  EXPECT_EQ(honey.index, 1u);
  EXPECT_EQ(honey.value, 2.5);
  EXPECT_EQ(asked("set viscosity 0 1e-3").index, 0u);
  const RemoteCommand gravity = asked("set gravity 0.5\n");
  EXPECT_EQ(gravity.parameter, wire::Parameter::kGravityScale);
  EXPECT_EQ(gravity.value, 0.5);
  const RemoteCommand firm = asked("set stiffness 'right hand' 2");
  EXPECT_EQ(firm.parameter, wire::Parameter::kGripStiffness);
  EXPECT_EQ(firm.index, 1u);
  EXPECT_EQ(firm.value, 2.0);
  EXPECT_EQ(type("set stiffness 2").text, "say which grip: left, right hand");
  EXPECT_NE(type("set stiffness left 5").text.find("at most 4"), std::string::npos);
  EXPECT_NE(type("set stiffness left 0").text.find("at least 0.05"), std::string::npos);
  EXPECT_EQ(type("set viscosity 3").text, "say which fluid: water, honey");
  EXPECT_EQ(type("set viscosity oil 3").text, "say which fluid: water, honey");
  EXPECT_NE(type("set gravity 3").text.find("at most 2"), std::string::npos);
  EXPECT_NE(type("set viscosity honey 1e9").text.find("too much"), std::string::npos);
  for (const char* line : {"set", "set gravity", "set gravity -1", "set gravity nan", "set gravity 1 2",
                           "set wind 3", "set viscosity honey"}) {
    EXPECT_TRUE(type(line).commands.empty()) << line;
    EXPECT_FALSE(type(line).text.empty()) << line;
  }
  scene.fluids.resize(1);
  EXPECT_EQ(asked("set viscosity 3").index, 0u) << "the only one need not be named";
}

TEST_F(PeerConsole, GripsAreTakenAndLetGo) {
  EXPECT_EQ(asked("take").kind, Kind::kFreeGrip);
  const RemoteCommand named = asked("take 'right hand'");
  EXPECT_EQ(named.kind, Kind::kGrip);
  EXPECT_EQ(named.grip, 1u);
  EXPECT_TRUE(named.take);
  EXPECT_EQ(asked("take 0").grip, 0u);
  const RemoteCommand all = asked("release");
  EXPECT_EQ(all.grip, 1u) << "what is held";
  EXPECT_FALSE(all.take);
  EXPECT_EQ(asked("release left").grip, 0u) << "that it is not held is for the host to say";
  EXPECT_EQ(type("take middle").text, "there is no grip 'middle'. There are: left, right hand");
  EXPECT_NE(type("take right hand").text.find("quotes"), std::string::npos);
  status.held = {false, false};
  EXPECT_EQ(type("release").text, "you hold nothing");
}

TEST_F(PeerConsole, TheWorldIsPausedContinuedAndReset) {
  EXPECT_EQ(asked("pause").action, wire::WorldAction::kPause);
  EXPECT_EQ(asked("continue").action, wire::WorldAction::kContinue);
  EXPECT_EQ(asked("reset").action, wire::WorldAction::kReset);
  EXPECT_EQ(asked("reset").kind, Kind::kWorld);
  EXPECT_TRUE(type("quit").quit);
}

TEST_F(PeerConsole, QuestionsAreAnsweredFromWhatIsKnown) {
  EXPECT_EQ(type("who").text, "Ana (you): right hand");
  EXPECT_NE(type("status").text.find("fluid 'honey': 5 Pa·s"), std::string::npos);
  EXPECT_NE(type("help").text.find("set viscosity"), std::string::npos);
  EXPECT_NE(type("who else").text.find("stands alone"), std::string::npos);
  EXPECT_NE(type("helo").text.find("'helo' means nothing here"), std::string::npos);
  EXPECT_TRUE(type("  \t\r\n").text.empty());
}

/// The same words at a world of one's own, but for those that need somebody else.
TEST_F(PeerConsole, AWorldOfOnesOwnHearsTheSameWords) {
  const auto own = [&](const char* line) {
    return own_world_line(line, {true, 0, 0.5, {0.001, 5.0}, {1.0, 0.25}}, 1.25, scene);
  };
  ASSERT_EQ(own("set viscosity honey 2.5").commands.size(), 1u);
  EXPECT_EQ(own("set viscosity honey 2.5").commands[0].index, 1u);
  EXPECT_EQ(own("set viscosity 3").text, type("set viscosity 3").text);
  EXPECT_EQ(own("pause").commands.at(0).action, wire::WorldAction::kPause);
  EXPECT_TRUE(own("quit").quit);
  EXPECT_EQ(
      own("status").text,
      "the world is at 1.25 s, paused, gravity × 0.5\nfluid 'water': 0.001 Pa·s\nfluid 'honey': 5 Pa·s\n"
      "grip 'right hand': stiffness × 0.25");
  for (const char* line : {"take", "release", "who", "links"})
    EXPECT_NE(own(line).text.find("means nothing here"), std::string::npos) << line;
  EXPECT_EQ(own("help").text.find("take"), std::string::npos) << own("help").text;
  EXPECT_NE(own("puase").text.find("Did you mean pause?"), std::string::npos) << own("puase").text;
}

TEST_F(PeerConsole, AnyBytesAreAnsweredInWords) {
  std::mt19937 random(7);
  for (int i = 0; i < 5000; ++i) {
    std::string line = i % 2 ? "set viscosity " : "";
    for (int n = static_cast<int>(random() % 40); n > 0; --n) line += static_cast<char>(random());
    const PeerLine typed = type(line);
    EXPECT_TRUE(wire::text_problem(typed.text).empty() || typed.text.find('\n') != std::string::npos);
  }
  EXPECT_NE(type(std::string(5000, 'x')).text.find("too long"), std::string::npos);
}

}  // namespace
}  // namespace slosh
