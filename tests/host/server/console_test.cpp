#include "host/server/console.h"

#include <gtest/gtest.h>

#include <random>

namespace slosh {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

ConsoleCommand good(const std::string& line) {
  const Result<ConsoleCommand> parsed = parse_console(line);
  EXPECT_TRUE(parsed) << line << ": " << (parsed ? "" : parsed.error().text());
  return parsed ? parsed.value() : ConsoleCommand{};
}

TEST(Console, EveryCommandOfTheHelpIsUnderstood) {
  EXPECT_EQ(good("").verb, ConsoleVerb::kNothing);
  EXPECT_EQ(good("  \t ").verb, ConsoleVerb::kNothing);
  EXPECT_EQ(good("help").verb, ConsoleVerb::kHelp);
  EXPECT_EQ(good("who\n").verb, ConsoleVerb::kWho);
  EXPECT_EQ(good("links\r\n").verb, ConsoleVerb::kLinks);
  EXPECT_EQ(good("pause").verb, ConsoleVerb::kPause);
  EXPECT_EQ(good("continue").verb, ConsoleVerb::kContinue);
  EXPECT_EQ(good("reset").verb, ConsoleVerb::kReset);
  EXPECT_EQ(good("log").verb, ConsoleVerb::kLog);
  EXPECT_EQ(good("status").verb, ConsoleVerb::kStatus);
  EXPECT_EQ(good("quit").verb, ConsoleVerb::kQuit);
  EXPECT_EQ(good("revoke bako").text, "bako");
  EXPECT_EQ(good("release left").verb, ConsoleVerb::kRelease);
  EXPECT_EQ(good("kick 'Ana 2'").text, "Ana 2");
  EXPECT_EQ(good("kick \"Ana's\"").text, "Ana's");
  EXPECT_EQ(good("kick Ana").lifetime_ns, 0);
  EXPECT_EQ(good("kick 'Ana 2' for 1h").lifetime_ns, 3600 * kSecond);
  EXPECT_EQ(good("unban Ana").verb, ConsoleVerb::kUnban);
}

TEST(Console, LinksTakeANameARoleAndATime) {
  const ConsoleCommand open = good("link");
  EXPECT_TRUE(open.text.empty());
  EXPECT_EQ(open.role, LinkRole::kHold);
  EXPECT_EQ(open.lifetime_ns, 0);
  const ConsoleCommand full = good("link \"Ana Maria\" watch for 1h30m");
  EXPECT_EQ(full.text, "Ana Maria");
  EXPECT_EQ(full.role, LinkRole::kWatch);
  EXPECT_EQ(full.lifetime_ns, 5400 * kSecond);
  EXPECT_EQ(good("link Ana run").role, LinkRole::kRun);
  EXPECT_EQ(good("role bako run").role, LinkRole::kRun);
  EXPECT_EQ(good("role bako hold").text, "bako");
  EXPECT_EQ(good("expire bako 10m").lifetime_ns, 600 * kSecond);
  EXPECT_EQ(good("expire bako never").lifetime_ns, 0);
}

TEST(Console, ParametersTakeAFluidAndANumber) {
  const ConsoleCommand one = good("set viscosity 0.5");
  EXPECT_EQ(one.what, SetWish::What::kViscosity);
  EXPECT_EQ(one.value, 0.5);
  EXPECT_EQ(good("set viscosity honey 1e1").text, "honey");
  EXPECT_EQ(good("set gravity 0.2").what, SetWish::What::kGravity);
  EXPECT_EQ(good("set stiffness 'left hand' 0.2").what, SetWish::What::kStiffness);
  EXPECT_EQ(good("set stiffness 'left hand' 0.2").text, "left hand");
}

TEST(Console, WhatIsWrongIsSaidInWords) {
  for (const char* line : {"helo",
                           "who there",
                           "revoke",
                           "revoke a b",
                           "expire bako",
                           "expire bako soon",
                           "link a b",
                           "role",
                           "role bako",
                           "role bako watch",
                           "role bako king",
                           "log now",
                           "link for",
                           "link for 0s",
                           "set",
                           "set viscosity",
                           "set colour 1",
                           "set viscosity -1",
                           "set viscosity nan",
                           "set viscosity 1x",
                           "set gravity moon 1",
                           "kick",
                           "kick Ana for",
                           "kick Ana for ever",
                           "kick Ana 10m",
                           "unban",
                           "release",
                           "quit now",
                           "link aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa",
                           "link \xdc\xbentc2",  // a mark, which stood on the space
                           "\x1b[2J",
                           "a\x01",
                           "\xff"}) {
    const Result<ConsoleCommand> parsed = parse_console(line);
    EXPECT_FALSE(parsed) << line;
    if (parsed) continue;
    EXPECT_GT(parsed.error().text().size(), 10u) << line;
  }
  EXPECT_FALSE(parse_console(std::string(kMaxConsoleLine + 1, 'a')));
}

TEST(Console, Durations) {
  EXPECT_EQ(parse_duration("90s").value(), 90 * kSecond);
  EXPECT_EQ(parse_duration("1d").value(), 86400 * kSecond);
  for (const char* text : {"", "0s", "5", "m", "1x", "-1m", "99999999d", "1e3s", "9999999999999999999s"})
    EXPECT_FALSE(parse_duration(text)) << text;
  EXPECT_EQ(duration_text(59 * kSecond), "59 s");
  EXPECT_EQ(duration_text(600 * kSecond), "10 min");
  EXPECT_EQ(duration_text(7800 * kSecond), "2 h 10 min");
}

TEST(Console, AnyBytesMayCome) {
  std::mt19937 random(7);
  const std::string words[] = {"link ", "for ", "set ",   "viscosity ", "'",
                               "\"",    "10m",  "watch ", "kick ",      "1e9"};
  std::size_t refused = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string line;
    for (std::uint32_t n = random() % 8; n > 0; --n) {
      if (random() % 3)
        line += words[random() % std::size(words)];
      else
        line += static_cast<char>(random());
    }
    const Result<ConsoleCommand> parsed = parse_console(line);
    refused += parsed ? 0 : 1;
    if (!parsed) continue;
    EXPECT_LE(parsed.value().text.size(), line.size());
  }
  EXPECT_GT(refused, 1000u);
}

}  // namespace
}  // namespace slosh
