// A stranger's scene, through the whole program: what it is called and what it contains runs nothing, writes
// nowhere else and tells a terminal nothing.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "net/text/clean.h"
#include "peer/output/plot.h"
#include "process.h"
#include "render/image.h"
#include "scenes/make/solid.h"
#include "scenes/make/writer.h"

namespace slosh {
namespace {

namespace fs = std::filesystem;
using test::Outcome;

/// Each would make a file "obeyed…" in the working folder if anything obeyed it.
const std::vector<std::string>& hostile_names() {
  static const std::vector<std::string> names{
      "`touch obeyed1`",
      "$(touch obeyed2)",
      "\"; system(\"touch obeyed3\"); x=\"",
      "'; system(\"touch obeyed4\"); x='",
      "''; system(\"touch obeyed5\"); x=''",
      "a\nsystem(\"touch obeyed6\")\n!touch obeyed6\n",
      "|touch obeyed7",
      "<touch obeyed8",
      "@`touch obeyed9`",
      "END_OF_DATA\n`touch obeyed10`",
      "\x1b[31m\u009b2J\u202e`touch obeyed11`",
      std::string(4000, '`') + "touch obeyed12" + std::string(82, '`'),
  };
  return names;
}

/// A cup in many hands.
void write_scene(const fs::path& file, const std::string& fluid = "water") {
  const nlohmann::json about{{"title", "`touch obeyed-title` \x1b]0;t\x07 \u009b31m"}};
  make::SceneWriter writer(about);
  const int paint = writer.add_material("paint", {});
  const int cup =
      writer.add_node("cup", writer.add_mesh("cup_mesh", make::tank({0.1, 0.1, 0.1}, 0.02), paint), {},
                      {{"slosh", "body"}, {"motion", "free"}, {"mass_kg", 0.5}});
  writer.add_node(fluid,
                  writer.add_mesh("water_mesh", make::box({-0.05, 0.02, -0.05}, {0.05, 0.09, 0.05}), paint),
                  {}, {{"slosh", "fluid"}});
  const Pose top{{0.0, 0.1, 0.0}, {1.0, 0.0, 0.0, 0.0}};
  for (const std::string& name : hostile_names()) writer.add_node(name, -1, top, {{"slosh", "grip"}}, cup);
  fs::create_directories(file.parent_path());
  ASSERT_TRUE(writer.write(file));
}

void expect_fit_for_a_terminal(const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    EXPECT_EQ(text_problem(text.substr(at, end - at)), "") << clean_text(text.substr(at, end - at), 300);
    at = end + 1;
  }
}

void expect_nothing_obeyed() {
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(test::test_folder()))
    EXPECT_EQ(entry.path().filename().string().rfind("obeyed", 0), std::string::npos) << entry.path();
}

TEST(ForeignNames, RunNothing) {
  fs::remove_all(test::test_folder());
  write_scene(test::test_folder() / "`touch obeyed-file`;\x1b[31m.glb");
  const Outcome outcome =
      test::slosh({"play", "`touch obeyed-file`;\x1b[31m.glb", "--headless", "--size", "64x48", "--fps", "5",
                   "--threads", "1", "--seconds", "0.2", "--spacing", "0.02"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  expect_nothing_obeyed();
  expect_fit_for_a_terminal(outcome.out);
  expect_fit_for_a_terminal(outcome.err);

  const fs::path out = test::test_folder() / "out" / "-touch-obeyed-file----31m";
  for (const char* file : {"wrenches.csv", "wrenches.png", "view.mp4", "final.png", "summary.json"})
    EXPECT_TRUE(fs::is_regular_file(out / file)) << file;
  const Result<Image> plot = read_png(out / "wrenches.png");
  ASSERT_TRUE(plot) << plot.error().text();
  EXPECT_EQ(plot.value().width, 1200);
  const nlohmann::json summary = nlohmann::json::parse(test::read_text(out / "summary.json"));
  ASSERT_EQ(summary["devices"].size(), hostile_names().size());
  EXPECT_EQ(summary["devices"][0]["grip"], "`touch obeyed1`") << "shown as it is";
  EXPECT_LE(summary["devices"][11]["grip"].get<std::string>().size(), 400u);
  EXPECT_TRUE(summary["problems"].empty()) << summary["problems"];
}

TEST(ForeignNames, ARecordingsNamesRunNothingEither) {
  fs::remove_all(test::test_folder());
  write_scene(test::test_folder() / "cup.glb");
  Outcome outcome =
      test::slosh({"play", "cup.glb", "--headless", "--no-render", "--threads", "1", "--seconds", "0.1",
                   "--spacing", "0.02", "--backend", "cpu", "--record", "cup.rec"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  outcome = test::slosh({"replay", "cup.rec", "--no-render", "--out", "again"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(fs::is_regular_file(test::test_folder() / "again/wrenches.png"));
  expect_nothing_obeyed();
  expect_fit_for_a_terminal(outcome.out);
  expect_fit_for_a_terminal(outcome.err);
}

TEST(ForeignNames, FiguresAndFramesHoldThemAsText) {
  fs::remove_all(test::test_folder());
  const std::string fluid = "--><script>alert(1)</script>]]>\nend_header\n`touch obeyed-fluid`";
  write_scene(test::test_folder() / "]]><script>.glb", fluid);
  for (const char* format : {"svg", "pdf"}) {
    const Outcome outcome = test::slosh({"play",
                                         "]]><script>.glb",
                                         "--headless",
                                         "--no-render",
                                         "--unpaced",
                                         "--threads",
                                         "1",
                                         "--seconds",
                                         "0.1",
                                         "--spacing",
                                         "0.02",
                                         "--plot",
                                         format,
                                         "--out",
                                         format,
                                         "--export",
                                         "particles:ply",
                                         "--export",
                                         "particles:vtu",
                                         "--export",
                                         "surface:vdb",
                                         "--export",
                                         "surface:glb"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    expect_fit_for_a_terminal(outcome.out);
    expect_nothing_obeyed();
  }
  // A reader of XML that is not ours takes all of it for text.
  const char* const read =
      "import sys, xml.etree.ElementTree as tree\n"
      "for file in sys.argv[1:]:\n"
      "  parts = list(tree.parse(file).iter())\n"
      "  print(file, len(parts), sum('script' in part.tag for part in parts))\n";
  const Outcome parsed = test::Process({"/usr/bin/python3", "-c", read, "svg/wrenches.svg",
                                        "svg/frames/particles.pvd", "svg/frames/particles_00000.vtu"},
                                       test::test_folder())
                             .wait();
  ASSERT_EQ(parsed.code, 0) << parsed.out << parsed.err;
  std::istringstream rows(parsed.out);
  std::string file;
  int parts = 0, scripts = 0, files = 0;
  for (; rows >> file >> parts >> scripts; ++files) {
    EXPECT_GE(parts, 3) << file;
    EXPECT_EQ(scripts, 0) << file;
  }
  EXPECT_EQ(files, 3);
  EXPECT_EQ(test::read_text(test::test_folder() / "pdf/wrenches.pdf").rfind("%PDF-", 0), 0u);
  const std::string ply = test::read_text(test::test_folder() / "svg/frames/particles_00000.ply");
  EXPECT_EQ(ply.find("\nend_header\n"), ply.rfind("\nend_header\n")) << "one line of a name stays one";
}

TEST(ForeignNames, AreNoFormulasInTables) {
  fs::remove_all(test::test_folder());
  fs::create_directories(test::test_folder());
  const std::string formula = "=cmd|' /C touch obeyed'!A0", other = "@SUM(1,1);=1+1";
  make::SceneWriter writer({{"title", "=1+1"}, {"spacing_m", 0.02}});
  const int paint = writer.add_material("paint", {});
  writer.add_node(formula, writer.add_mesh("tank", make::tank({0.16, 0.12, 0.12}, 0.03), paint), {},
                  {{"slosh", "body"}, {"measured", true}});
  writer.add_node("+water",
                  writer.add_mesh("water", make::box({-0.08, 0.03, -0.06}, {0.08, 0.09, 0.06}), paint), {},
                  {{"slosh", "fluid"}});
  writer.add_node(other, -1, {{0.0, 0.05, 0.0}, {1, 0, 0, 0}}, {{"slosh", "gauge"}});
  writer.add_node("-1+1", writer.add_mesh("right", make::box({0.0, -0.1, -0.2}, {0.3, 0.4, 0.2}), paint), {},
                  {{"slosh", "region"}});
  ASSERT_TRUE(writer.write(test::test_folder() / "=1+1.glb"));
  const Outcome outcome = test::slosh({"play", "=1+1.glb", "--headless", "--no-render", "--unpaced",
                                       "--threads", "1", "--seconds", "0.05", "--out", "out"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  // As a spreadsheet divides them, by commas or by semicolons.
  const char* const read =
      "import csv, sys\n"
      "for file in sys.argv[1:]:\n"
      "  for between in ',;':\n"
      "    for row in csv.reader(open(file, newline=''), delimiter=between):\n"
      "      for cell in row:\n"
      "        if cell[:1] in ('=', '+', '@') or cell[:1] == '-' and not cell[1:2].isdigit(): "
      "print('formula', cell)\n"
      "table = list(csv.reader(open('out/probes.csv', newline='')))\n"
      "print(table[0][-3:], {len(row) for row in table})\n"
      "table = list(csv.DictReader(open('out/bodies.csv', newline='')))\n"
      "print({row['body'] for row in table})\n";
  const Outcome tables =
      test::Process({"/usr/bin/python3", "-c", read, "out/probes.csv", "out/bodies.csv"}, test::test_folder())
          .wait();
  ASSERT_EQ(tables.code, 0) << tables.out << tables.err;
  EXPECT_EQ(tables.out.find("formula"), std::string::npos) << tables.out;
  EXPECT_NE(
      tables.out.find("\"'@SUM(1,1);'=1+1_level_m\", \"'@SUM(1,1);'=1+1_pressure_pa\", \"'-1+1_mass_kg\"]"),
      std::string::npos)
      << tables.out;
  EXPECT_NE(tables.out.find("{\"'" + formula + "\"}"), std::string::npos) << tables.out;
  expect_nothing_obeyed();
}

TEST(ForeignNames, AColorConfigurationOfAStrangerIsShownAsText) {
  fs::remove_all(test::test_folder());
  fs::create_directories(test::test_folder());
  std::ofstream(test::test_folder() / "studio.ocio")
      << "ocio_profile_version: 2\nroles:\n  aces_interchange: aces\n  default: aces\ndisplays:\n"
         "  \"P\\e[2J\\x9b31m`touch obeyed`\":\n    - !<View> {name: \"V\\e]0;t\\x07\", colorspace: aces}\n"
         "colorspaces:\n  - !<ColorSpace>\n    name: aces\n    \"\\e[2Jkey\": 1\n";
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, {"--view", "no\x1b[2Jview"}, {"--display", "no\u009b2Jdisplay"}}) {
    std::vector<std::string> all{"play",  "probe",       "--headless", "--threads", "1",      "--spacing",
                                 "0.012", "--seconds",   "0.1",        "--size",    "64x48",  "--fps",
                                 "5",     "--overwrite", "--out",      "out",       "--ocio", "studio.ocio"};
    all.insert(all.end(), more.begin(), more.end());
    const Outcome outcome = test::Process(
                                [&] {
                                  all.insert(all.begin(), test::program());
                                  return all;
                                }(),
                                test::test_folder())
                                .wait();
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    expect_fit_for_a_terminal(outcome.out);
    expect_fit_for_a_terminal(outcome.err);
    if (!more.empty()) {
      EXPECT_NE(outcome.err.find("'P?[2J?31m`touch obeyed`"), std::string::npos) << outcome.err;
    }
  }
  expect_nothing_obeyed();
}

TEST(ForeignNames, CheckAndPlanPrintThemClean) {
  fs::remove_all(test::test_folder());
  write_scene(test::test_folder() / "cup.glb");
  for (const char* verb : {"check", "plan"}) {
    const Outcome outcome = test::slosh({verb, "cup.glb"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    expect_fit_for_a_terminal(outcome.out);
    expect_nothing_obeyed();
  }
  EXPECT_EQ(test::slosh({"check", "cup.glb"}).out.rfind("ok: `touch obeyed-title` ?]0;t? ?31m\n", 0), 0u);
  expect_fit_for_a_terminal(test::slosh({"check", "no\x1b[2Jwhere.glb"}).err);
  expect_fit_for_a_terminal(test::slosh({"play", "no\u009b2Jwhere"}).err);
}

}  // namespace
}  // namespace slosh
