// Files of names that others can foresee, in folders where they may write.
#include "host/keep/file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "net/fresh_file.h"
#include "tests/host/keep_kit.h"
#include "tests/support/process.h"

namespace slosh::keep {
namespace {

namespace fs = std::filesystem;
using test::read_text;

const Bytes kContent{'n', 'e', 'w'};
constexpr auto kMine = fs::perms::owner_read | fs::perms::owner_write;

void write(const fs::path& file, const char* text) {
  const File out(std::fopen(file.c_str(), "w"));
  std::fputs(text, out.get());
}

TEST(KeptFiles, NothingIsWrittenThroughALinkThatSomebodyLaidThere) {
  const fs::path folder = fresh_folder();
  const fs::path file = folder / "world";
  const fs::path theirs = folder / "theirs";
  write(theirs, "precious");
  for (const char* ending : {".new", ".previous.new"}) {
    for (const bool hard : {false, true}) {
      write(file, "old");
      fs::remove(file.string() + ending);
      hard ? fs::create_hard_link(theirs, file.string() + ending)
           : fs::create_symlink(theirs, file.string() + ending);
      const Result<bool> replaced = replace_file(file, kContent);
      ASSERT_TRUE(replaced) << replaced.error().text();
      EXPECT_EQ(read_text(file), "new");
      EXPECT_EQ(read_text(previous_of(file)), "old");
      EXPECT_EQ(fs::status(file).permissions(), kMine);
      EXPECT_EQ(read_text(theirs), "precious") << ending << (hard ? ", a hard link" : "");
    }
  }
}

TEST(KeptFiles, WhatIsNeitherFileNorLinkIsLeftThereAndSaid) {
  const fs::path folder = fresh_folder();
  const fs::path file = folder / "world";
  fs::create_directory(folder / "world.new");
  const Result<bool> replaced = replace_file(file, kContent);
  ASSERT_FALSE(replaced);
  EXPECT_NE(replaced.error().text().find("world.new: cannot be made anew"), std::string::npos)
      << replaced.error().text();
  EXPECT_TRUE(fs::is_directory(folder / "world.new"));
}

TEST(KeptFiles, AFileThatSomebodyNamedIsEmptiedAndItsOwnersAlone) {
  const fs::path file = fresh_folder() / "recording";
  write(file, "a long text of before");
  fs::permissions(file, fs::perms::all);
  ASSERT_TRUE(open_to_write(file));
  EXPECT_EQ(fs::file_size(file), 0u);
  EXPECT_EQ(fs::status(file).permissions(), kMine);
}

TEST(KeptFiles, FoldersAreTheirOwnersAloneWhateverTheMask) {
  const fs::path folder = fresh_folder() / "deep" / "deeper";
  const mode_t before = umask(0);
  make_own_folder(folder);
  umask(before);
  EXPECT_EQ(fs::status(folder).permissions(), fs::perms::owner_all);
  EXPECT_EQ(fs::status(folder.parent_path()).permissions(), fs::perms::owner_all);
}

}  // namespace
}  // namespace slosh::keep
