// net/WIRE_FORMAT.md says what the code does.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "net/wire/all_messages.h"
#include "net/wire/describe.h"
#include "net/wire/scene_fields.h"
#include "tests/support/places.h"

namespace slosh::wire {
namespace {

const std::filesystem::path kPage = test::source_dir() / "net/WIRE_FORMAT.md";

std::string read_page() {
  std::ifstream in(kPage, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(FormatPage, ItsTablesAreTheListsOfTheCode) {
  const std::string page = read_page();
  const std::string filled = fill_tables(page);
  if (std::getenv("SLOSH_UPDATE_GOLDEN")) {
    std::ofstream(kPage, std::ios::binary) << filled;
    GTEST_SKIP() << "the page was written anew (SLOSH_UPDATE_GOLDEN)";
  }
  EXPECT_TRUE(page == filled)
      << "a list of fields has changed: run slosh-wire-format net/WIRE_FORMAT.md, or this "
         "test with SLOSH_UPDATE_GOLDEN=1, and look at the difference";
}

TEST(FormatPage, HasEveryTable) {
  const std::string page = read_page();
  for (const std::string& name : table_names())
    EXPECT_NE(page.find("<!-- table: " + name + " -->"), std::string::npos) << name;
  EXPECT_EQ(page.find("There is no list"), std::string::npos);
}

/// The first column of the table under "## Fields".
std::set<std::string> explained_fields(const std::string& page) {
  std::set<std::string> names;
  std::istringstream lines(page.substr(page.find("\n## Fields\n") + 1));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line) && !line.starts_with("## ")) {
    if (!line.starts_with("| ")) continue;
    std::istringstream cell(line.substr(2, line.find(" |", 2) - 2));
    for (std::string name; cell >> name;) {
      if (name.back() == ',') name.pop_back();
      names.insert(name);
    }
  }
  return names;
}

TEST(FormatPage, ExplainsEveryFieldOfEveryMessage) {
  const std::string page = read_page();
  ASSERT_NE(page.find("\n## Fields\n"), std::string::npos);
  const std::set<std::string> explained = explained_fields(page);
  const auto check = [&]<class M>(const M&) {
    Describer describer;
    M message{};
    visit(describer, message);
    for (const FieldRow& row : describer.rows()) {
      const std::string name = row.field.substr(row.field.rfind('.') + 1);
      EXPECT_TRUE(explained.contains(name)) << row.field << " is not in the table of fields";
    }
  };
  for_each_message(PeerControl{}, check);
  for_each_message(HostControl{}, check);
  for_each_message(PeerDatagrams{}, check);
  for_each_message(HostDatagrams{}, check);
}

TEST(FormatPage, ATableWithoutAListIsPointedOut) {
  const std::string page = "a\n<!-- table: Nothing -->\nold\n<!-- end of table -->\nb\n";
  EXPECT_EQ(fill_tables(page),
            "a\n<!-- table: Nothing -->\n\nThere is no list 'Nothing'.\n\n<!-- end of table -->\nb\n");
  EXPECT_EQ(fill_tables("<!-- table: Hello --> without an end"), "<!-- table: Hello --> without an end");
}

}  // namespace
}  // namespace slosh::wire
