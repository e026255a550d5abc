#include "net/link.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace slosh {
namespace {

JoinLink example(std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  JoinLink link;
  link.addresses = {"192.0.2.7:4433", "[2001:db8::7]:4433", "bucket.example.org:443"};
  for (auto& byte : link.host) byte = static_cast<std::uint8_t>(random());
  for (auto& byte : link.token) byte = static_cast<std::uint8_t>(random());
  return link;
}

std::string text_of(const JoinLink& link) {
  const Result<std::string> text = format_link(link);
  return text ? text.value() : text.error().text();
}

void expect_same(const Result<JoinLink>& parsed, const JoinLink& link) {
  ASSERT_TRUE(static_cast<bool>(parsed)) << parsed.error().text();
  EXPECT_EQ(parsed.value().addresses, link.addresses);
  EXPECT_EQ(parsed.value().host, link.host);
  EXPECT_EQ(parsed.value().token, link.token);
}

std::string error_of(const std::string& text) {
  const Result<JoinLink> parsed = parse_link(text);
  return parsed ? "" : parsed.error().text();
}

TEST(Link, HasTheFormThatIsWrittenDown) {
  JoinLink link;
  link.addresses = {"127.0.0.1:4433"};
  EXPECT_EQ(text_of(link),
            "slosh://v2/127.0.0.1:4433/" + std::string(52, 'a') + "/" + std::string(25, 'a') + "dd3u473");
  const std::string text = text_of(example());
  EXPECT_TRUE(text.starts_with("slosh://v2/192.0.2.7:4433,[2001:db8::7]:4433,bucket.example.org:443/"));
  EXPECT_EQ(text.size() - text.rfind('/'), 1 + 32u);
}

TEST(Link, ComesBack) {
  for (std::uint32_t seed = 0; seed < 200; ++seed)
    expect_same(parse_link(text_of(example(seed))), example(seed));
}

TEST(Link, IsShownWithoutWhatOpensAWorld) {
  const std::string text = text_of(example());
  const std::string token = text.substr(text.rfind('/') + 1);
  const std::string shown = shorten_links("bako  to hold\n  " + text + "\n<" + text + "> again");
  EXPECT_EQ(shown.find(token), std::string::npos) << shown;
  EXPECT_EQ(shown.find(text.substr(text.find("443/") + 4, 20)), std::string::npos) << shown;
  EXPECT_TRUE(shown.starts_with("bako  to hold\n  slosh://v2/192.0.2.7:4433,")) << shown;
  EXPECT_TRUE(shown.ends_with("/…> again")) << shown;
  EXPECT_EQ(shorten_links("no link"), "no link");
  EXPECT_EQ(shorten_links("slosh://secret"), "slosh://…") << "of what is no link nothing is shown";
  EXPECT_EQ(shorten_links("SLOSH://v2/a:1"), "SLOSH://…");
}

TEST(Link, SurvivesMailAndShells) {
  const JoinLink link = example();
  const std::string text = text_of(link);
  for (const char* around : {"  %  ", "\"%\"", "'%'", "<%>", " <%>\r\n", "`%`", "\t'<%>'\n"}) {
    std::string wrapped = around;
    wrapped.replace(wrapped.find('%'), 1, text);
    expect_same(parse_link(wrapped), link);
  }
  for (std::size_t at = 1; at < text.size(); ++at) {
    for (const char* cut : {"\n", "\r\n", " \n  ", "\n> ", "\r\n>> "})
      expect_same(parse_link(text.substr(0, at) + cut + text.substr(at)), link);
  }
}

TEST(Link, CapitalsDoNotMatter) {
  const JoinLink link = example();
  std::string text = text_of(link);
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
  const Result<JoinLink> parsed = parse_link(text);
  ASSERT_TRUE(static_cast<bool>(parsed)) << parsed.error().text();
  EXPECT_EQ(parsed.value().host, link.host);
  EXPECT_EQ(parsed.value().token, link.token);
}

TEST(Link, EveryChangedCharacterIsFound) {
  const std::string text = text_of(example());
  const std::string others = "abcdefghijklmnopqrstuvwxyz0123456789/:,.[]-_%!?é";
  for (std::size_t at = 0; at < text.size(); ++at) {
    for (const char other : others) {
      if (other == text[at]) continue;
      std::string changed = text;
      changed[at] = other;
      EXPECT_NE(error_of(changed), "") << changed;
    }
  }
}

TEST(Link, EveryCutLossAndSwapIsFound) {
  const std::string text = text_of(example());
  for (std::size_t at = 0; at < text.size(); ++at) {
    EXPECT_NE(error_of(text.substr(0, at)), "") << at;
    EXPECT_NE(error_of(text.substr(at + 1)), "") << at;
    EXPECT_NE(error_of(text.substr(0, at) + text.substr(at + 1)), "") << at;
    EXPECT_NE(error_of(text.substr(0, at) + text[at] + text.substr(at)), "") << at;
    if (at == 0 || text[at] == text[at - 1]) continue;
    std::string swapped = text;
    std::swap(swapped[at], swapped[at - 1]);
    EXPECT_NE(error_of(swapped), "") << swapped;
  }
}

TEST(Link, SaysWhichPartIsDamaged) {
  const std::string text = text_of(example());
  const std::size_t token = text.rfind('/') + 1;
  const std::size_t key = text.rfind('/', token - 2) + 1;
  const auto with = [&](std::size_t at, const std::string& piece) {
    return text.substr(0, at) + piece + text.substr(at + piece.size());
  };
  const struct {
    std::string text;
    const char* words;
  } cases[] = {
      {"", "it is empty"},
      {" <> ", "it is empty"},
      {"https://example.org", "it does not begin with slosh://"},
      {std::string(kMaxLinkText + 1, 'a'), "it is too long"},
      {text.substr(0, key - 1), "the host's key and the token are missing"},
      {text.substr(0, token - 1), "the token is missing: the link is cut off or mistyped"},
      {text + "/more", "more than four parts"},
      {text.substr(0, text.size() - 3), "the token is 29 characters long and not 32: the link is cut off"},
      {text.substr(0, key) + text.substr(key + 1), "the host's key is 51 characters long and not 52"},
      {with(key + 4, "1"), "the host's key has a character that is neither"},
      {with(token + 4, "0"), "the token has a character that is neither"},
      {with(token, text[token] == 'a' ? "b" : "a"),
       "its parts do not fit together: the link is cut off or mistyped"},
      {"slosh://v2//" + text.substr(key), "address 1 '' has no port"},
      {"slosh://v2/host:0/" + text.substr(key), "address 1 'host:0' has no port from 1 to 65535"},
      {"slosh://v2/host:99999999999999999999/" + text.substr(key), "has no port from 1 to 65535"},
      {"slosh://v2/host:;;;;;;;;;;;;;;;;;;;;/" + text.substr(key), "has no port from 1 to 65535"},
      {"slosh://v2/host:-1/" + text.substr(key), "has no port from 1 to 65535"},
      {"slosh://v2/host:65536/" + text.substr(key), "has no port from 1 to 65535"},
      {"slosh://v2/ok:1,h!st:1/" + text.substr(key), "address 2 'h!st:1' is not a name or an IP address"},
      {"slosh://v2/::1:80/" + text.substr(key), "is not a name or an IP address (IPv6 in brackets)"},
      {"slosh://v2/[1.2.3.4]:80/" + text.substr(key), "is not an IPv6 address in brackets"},
      {"slosh://v2/a:1,a:1,a:1,a:1,a:1,a:1,a:1,a:1,a:1/" + text.substr(key),
       "it has 9 addresses, more than 8"},
  };
  for (const auto& each : cases) {
    const std::string error = error_of(each.text);
    EXPECT_NE(error.find(each.words), std::string::npos) << each.text << "\n  " << error;
    EXPECT_NE(error.find("Copy the whole link anew"), std::string::npos) << error;
  }
}

TEST(Link, OneOfAnotherVersionIsToldSo) {
  // As the first version had it, with a check that was right then.
  const std::string old =
      "slosh://127.0.0.1:4433/" + std::string(52, 'a') + "/" + std::string(25, 'a') + "d7jrdyj";
  EXPECT_EQ(error_of(old),
            "link: it is of an older slosh. Ask the host for a new one; host and peers need the same slosh");
  std::string text = text_of(example());
  text.replace(text.find("v2"), 2, "v3");
  EXPECT_EQ(
      error_of(text),
      "link: it is of a newer slosh: version 3 of the links, and this one reads 2. Use the slosh that the "
      "host uses");
  text.replace(text.find("v3"), 2, "v1");
  EXPECT_NE(error_of(text).find("older slosh"), std::string::npos);
  for (const char* version : {"v", "v02", "w2", "v2x", "v99999", "2"}) {
    std::string other = text;
    other.replace(other.find("v1"), 2, version);
    EXPECT_NE(error_of(other).find("does not say which version"), std::string::npos) << other;
  }
}

TEST(Link, IsNotMadeFromWhatCouldNotBeRead) {
  JoinLink link = example();
  link.addresses.clear();
  EXPECT_FALSE(static_cast<bool>(format_link(link)));
  link.addresses = {"no port"};
  EXPECT_FALSE(static_cast<bool>(format_link(link)));
  link.addresses = {"host:1/x"};
  EXPECT_FALSE(static_cast<bool>(format_link(link)));
  link.addresses.assign(kMaxLinkAddresses + 1, "host:1");
  EXPECT_FALSE(static_cast<bool>(format_link(link)));
}

}  // namespace
}  // namespace slosh
