// Where the link of `join` and `watch` may come from.
#include "peer/remote/link_source.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "host/app/host_links.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

namespace slosh {
namespace {

constexpr auto kHold = wire::Role::kParticipant;
constexpr auto kWatch = wire::Role::kSpectator;

std::string write_file(const std::string& name, const std::string& text) {
  const std::filesystem::path folder = test::build_dir() / "test_files" / "link_source";
  std::filesystem::create_directories(folder);
  const std::filesystem::path file = folder / name;
  std::ofstream(file, std::ios::binary) << text;
  return file.string();
}

std::string got(const Result<std::string>& text) {
  return text ? text.value() : "error: " + text.error().text();
}

/// Runs with `text` on standard input; gives back what was not read of it.
template <class Call>
std::string with_input(const std::string& text, Call&& call) {
  std::array<int, 2> ends{};
  EXPECT_EQ(pipe(ends.data()), 0);
  EXPECT_EQ(write(ends[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  close(ends[1]);
  const int before = dup(STDIN_FILENO);
  dup2(ends[0], STDIN_FILENO);
  call();
  std::string rest(1000, '\0');
  const ssize_t left = read(STDIN_FILENO, rest.data(), rest.size());
  rest.resize(left > 0 ? static_cast<std::size_t>(left) : 0);
  dup2(before, STDIN_FILENO);
  close(before);
  close(ends[0]);
  return rest;
}

TEST(LinkSource, IsTheArgumentALineOfInputOrAFile) {
  EXPECT_EQ(got(read_link_text("slosh://x", "", kHold)), "slosh://x");
  const std::string rest = with_input(
      "slosh://secret\nwho\n", [] { EXPECT_EQ(got(read_link_text("-", "", kHold)), "slosh://secret"); });
  EXPECT_EQ(rest, "who\n") << "the next line is for the console";
  with_input("slosh://secret\n", [] { EXPECT_EQ(got(read_link_text("", "", kHold)), "slosh://secret"); });
  const std::string file = write_file("one", "slosh://from\n  a_file\n");
  EXPECT_EQ(got(read_link_text("@" + file, "", kHold)), "slosh://from\n  a_file\n");
  EXPECT_EQ(got(read_link_text("", file, kWatch)), "slosh://from\n  a_file\n");
}

TEST(LinkSource, TheLineForTheRoleIsTakenOfWhatAHostWrote) {
  const std::string file = write_file("links", "hold slosh://h Ana Maria\nwatch slosh://w\n");
  EXPECT_EQ(got(read_link_text("", file, kHold)), "slosh://h");
  EXPECT_EQ(got(read_link_text("", file, kWatch)), "slosh://w");
  const std::string own =
      write_file("own", "run slosh://r Cem\nhold slosh://a Ana\nhold slosh://h\nwatch slosh://w\n");
  EXPECT_EQ(got(read_link_text("", own, kHold)), "slosh://h") << "the one for anybody";
  EXPECT_EQ(got(read_link_text("", own, kHold, "Ana")), "slosh://a");
  EXPECT_EQ(got(read_link_text("", own, kHold, "Cem")), "slosh://r");
  EXPECT_EQ(got(read_link_text("", own, kWatch, "Cem")), "slosh://w");
  EXPECT_EQ(got(read_link_text("", write_file("run_only", "run slosh://r\n"), kHold)), "slosh://r");
  const std::string one = write_file("hold_only", "hold slosh://h\n");
  EXPECT_NE(got(read_link_text("", one, kWatch)).find("has no link to watch. Use `slosh join`"),
            std::string::npos);
}

TEST(LinkSource, WhatIsMissingOrTooMuchIsSaid) {
  EXPECT_NE(got(read_link_text("slosh://x", "file", kHold)).find("there are two"), std::string::npos);
  EXPECT_NE(got(read_link_text("@/nowhere/link", "", kHold)).find("/nowhere/link: No such file"),
            std::string::npos);
  EXPECT_NE(got(read_link_text("", write_file("huge", std::string(2 << 20, 'x')), kHold)).find("too large"),
            std::string::npos);
  with_input("", [] {
    EXPECT_NE(got(read_link_text("-", "", kHold)).find("standard input gave none"), std::string::npos);
    EXPECT_NE(got(read_link_text("", "", kHold)).find("--link-file"), std::string::npos) << "and what to do";
  });
}

TEST(LinkSource, IsTakenOutOfTheWordsOfACommandLine) {
  std::array<std::string, 4> words{"slosh", "join", "SLOSH://v2/a:1/key/token", "<slosh://v2/b>"};
  std::array<char*, 4> pointers{};
  for (std::size_t i = 0; i < words.size(); ++i) pointers[i] = words[i].data();
  hide_links(static_cast<int>(words.size()), pointers.data());
  EXPECT_EQ(words[1], "join");
  EXPECT_EQ(words[2], "SLOSH://" + std::string(16, '*'));
  EXPECT_EQ(words[3], "<slosh://*****");
}

TEST(LinkFile, IsNewAndItsOwnersAlone) {
  const std::filesystem::path file = write_file("written", "before");
  const std::filesystem::path theirs = write_file("theirs", "precious");
  std::filesystem::permissions(file, std::filesystem::perms::all);
  std::filesystem::remove(file.string() + ".new");
  std::filesystem::create_symlink(theirs, file.string() + ".new");
  ASSERT_TRUE(write_private(file.string(), "hold slosh://h\n"));
  EXPECT_EQ(test::read_text(file), "hold slosh://h\n");
  EXPECT_EQ(test::read_text(theirs), "precious");
  EXPECT_EQ(std::filesystem::status(file).permissions(),
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
}

}  // namespace
}  // namespace slosh
