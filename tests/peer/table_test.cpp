// Tables and small files on a disk that is full, or might as well be.
#include "peer/output/table.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <iterator>

#include "peer/output/later_table.h"
#include "peer/output/whole_file.h"

namespace slosh {
namespace {

namespace fs = std::filesystem;

class TableTest : public ::testing::Test {
 protected:
  fs::path file_ = fs::path(::testing::TempDir()) / ("table_" + std::to_string(getpid()) + ".csv");
  void SetUp() override { fs::remove(file_); }
  void TearDown() override { fs::remove(file_); }
  std::string text() const {
    std::ifstream in(file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// Runs `body` in a process whose files may have `most` bytes: a write then stops in the middle, as it does
  /// on a full disk. The body's result becomes the exit code.
  static int with_small_files(rlim_t most, const std::function<bool()>& body) {
    const pid_t child = fork();
    if (child == 0) {
      signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{most, most};
      setrlimit(RLIMIT_FSIZE, &limit);
      _exit(body() ? 0 : 1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
};

TEST_F(TableTest, RowsAreThereOnceFlushed) {
  Result<std::unique_ptr<Table>> table = Table::create(file_, "a,b");
  ASSERT_TRUE(table) << table.error().text();
  EXPECT_EQ(text(), "a,b\n");
  table.value()->add("1,2\n");
  table.value()->add("3,4\n");
  EXPECT_EQ(text(), "a,b\n");
  EXPECT_TRUE(table.value()->flush());
  EXPECT_EQ(text(), "a,b\n1,2\n3,4\n");
  EXPECT_EQ(table.value()->problem(), "");
}

TEST_F(TableTest, ANameIsOneCellAndNoFormula) {
  EXPECT_EQ(csv_cell("left hand"), "left hand");
  EXPECT_EQ(csv_cell("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_cell("a;=1+1"), "a;'=1+1") << "where semicolons divide cells";
  EXPECT_EQ(csv_cell("=1+1"), "'=1+1");
  EXPECT_EQ(csv_cell("@a \"b\", c"), "\"'@a \"\"b\"\", c\"");
}

TEST_F(TableTest, AFullDiskEndsItAfterAWholeRow) {
  for (rlim_t most = 8; most < 40; ++most) {
    fs::remove(file_);
    const int code = with_small_files(most, [&] {
      Result<std::unique_ptr<Table>> table = Table::create(file_, "a,b");
      if (!table) return false;
      bool whole = true;
      for (int i = 0; i < 8; ++i) {
        table.value()->add("12,34\n");
        table.value()->add("5,6\n");
        whole = table.value()->flush() && whole;
      }
      return !whole && table.value()->problem().find(file_.string() + " ends early: ") == 0;
    });
    EXPECT_EQ(code, 0) << most;
    const std::string left = text();
    ASSERT_FALSE(left.empty());
    EXPECT_EQ(left.back(), '\n') << most << " bytes: " << left;
    EXPECT_LE(left.size(), most);
    EXPECT_GT(left.size() + 6, most) << "and no row is given up that fitted";
  }
}

TEST_F(TableTest, AFullDiskAtTheStartIsAnError) {
  EXPECT_FALSE(Table::create("/dev/full", "a,b"));
  EXPECT_FALSE(Table::create("/nowhere/at/all.csv", "a,b"));
}

TEST_F(TableTest, ASmallFileIsWholeOrAsItWas) {
  ASSERT_TRUE(write_whole(file_, "before"));
  EXPECT_EQ(with_small_files(100,
                             [&] {
                               const Result<bool> written = write_whole(file_, std::string(1000, 'x'));
                               return !written &&
                                      written.error().text().find("cannot be written") != std::string::npos;
                             }),
            0);
  EXPECT_EQ(text(), "before");
  EXPECT_FALSE(fs::exists(file_.string() + ".part"));
  ASSERT_TRUE(write_whole(file_, "after"));
  EXPECT_EQ(text(), "after");
}

TEST_F(TableTest, NothingIsWrittenThroughALinkThatSomebodyLaidThere) {
  const fs::path theirs = file_.string() + ".theirs";
  std::ofstream(theirs) << "precious";
  fs::remove(file_);
  fs::create_symlink(theirs, file_.string() + ".part");
  ASSERT_TRUE(write_whole(file_, "ours"));
  EXPECT_EQ(text(), "ours");
  EXPECT_FALSE(fs::is_symlink(file_));
  fs::remove(file_);
  fs::create_symlink(theirs, file_);
  EXPECT_FALSE(Table::create(file_, "a,b"));
  fs::remove(file_);
  std::ifstream in(theirs);
  std::string left;
  std::getline(in, left);
  EXPECT_EQ(left, "precious");
  fs::remove(theirs);
}

}  // namespace
}  // namespace slosh
