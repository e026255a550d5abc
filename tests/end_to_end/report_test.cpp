// `slosh report`: what is asked for is written, what cannot be asked for says why.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "process.h"
#include "render/image.h"

namespace slosh {
namespace {

using test::Outcome;

TEST(Report, OfErrorsWritesRowsATableAndPictures) {
  test::empty_folder();
  const Outcome ran = test::slosh({"report", "error", "--quick", "--case", "bounce", "--case", "slope",
                                   "--model", "corrected", "--out", "first"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const std::filesystem::path first = test::test_folder() / "first";
  const std::string rows = test::read_text(first / "errors.csv");
  EXPECT_NE(rows.find("\nbounce,rebound,m,1,corrected,cpu"), std::string::npos) << rows;
  EXPECT_NE(rows.find("\nslope,slope,"), std::string::npos) << rows;
  for (const char* file : {"errors.md", "errors.png", "bounce-rebound.png", "slope-slope.png"})
    EXPECT_GT(test::read_text(first / file).size(), 100u) << file;
  // A report that is there is not lost, and an earlier one's rows can be drawn again.
  const Outcome again =
      test::slosh({"report", "error", "--quick", "--case", "bounce", "--out", first.string()});
  EXPECT_EQ(again.code, 1);
  EXPECT_NE(again.err.find("--overwrite"), std::string::npos) << again.err;
  EXPECT_EQ(test::read_text(first / "errors.csv"), rows);
}

TEST(Report, OfErrorsDrawsEarlierRowsAgain) {
  test::empty_folder();
  ASSERT_EQ(test::slosh({"report", "error", "--quick", "--case", "bounce", "--out", "one"}).code, 0);
  const std::filesystem::path folder = test::test_folder();
  const std::string one = test::read_text(folder / "one" / "errors.csv");
  std::filesystem::copy_file(folder / "one" / "errors.csv", folder.parent_path() / "one-errors.csv",
                             std::filesystem::copy_options::overwrite_existing);
  const std::string from = (folder.parent_path() / "one-errors.csv").string();
  const Outcome both = test::slosh({"report", "error", "--from", from, "--from", from, "--out", "both"});
  ASSERT_EQ(both.code, 0) << both.err;
  // Every row twice, up to what is worked out anew from rounded numbers.
  const auto rows_of = [](const std::string& text) {
    std::multiset<std::string> rows;
    std::istringstream lines(text.substr(text.find('\n') + 1));
    for (std::string line; std::getline(lines, line);) rows.insert(line.substr(0, line.find(",0.")));
    return rows;
  };
  const auto before = rows_of(one),
             after = rows_of(test::read_text(test::test_folder() / "both" / "errors.csv"));
  ASSERT_FALSE(before.empty());
  EXPECT_EQ(after.size(), 2 * before.size());
  EXPECT_EQ(both.err.find("measuring"), std::string::npos) << both.err;
  for (const std::string& row : before) EXPECT_EQ(after.count(row), 2 * before.count(row)) << row;
}

// Three spacings close by are three rows, and one line and one point with their scatter; drawn again, too.
TEST(Report, OfErrorsTakesCloseSpacingsTogether) {
  test::empty_folder();
  const Outcome ran = test::slosh({"report", "error", "--quick", "--case", "bounce", "--model", "corrected",
                                   "--spacing", "0.02", "--close", "3", "--out", "close"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const std::filesystem::path close = test::test_folder() / "close";
  const std::string rows = test::read_text(close / "errors.csv");
  for (const char* spacing : {",0.01972,", ",0.02,", ",0.02028,"})
    EXPECT_NE(rows.find(spacing), std::string::npos) << rows;
  const std::string table = test::read_text(close / "errors.md");
  EXPECT_NE(table.find("| rebound | 20 |"), std::string::npos) << table;
  EXPECT_NE(table.find(" (3) / "), std::string::npos) << table;
  EXPECT_EQ(table.find("19.7"), std::string::npos) << table;
  const std::string from = (close / "errors.csv").string();
  ASSERT_EQ(test::slosh({"report", "error", "--from", from, "--out", "again"}).code, 0);
  const std::string again = test::read_text(test::test_folder() / "again" / "errors.md");
  EXPECT_EQ(again.substr(again.find("| rebound")), table.substr(table.find("| rebound")));
  const Outcome four = test::slosh({"report", "error", "--close", "4", "--quick"});
  EXPECT_EQ(four.code, 2);
  EXPECT_NE(four.err.find("3,5,7"), std::string::npos) << four.err;
}

TEST(Report, OfStabilityWritesVerdictsAndAMap) {
  test::empty_folder();
  const Outcome ran =
      test::slosh({"report", "stability", "--case", "viscosity_100000", "--case", "bullet", "--out", "s"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const std::filesystem::path folder = test::test_folder() / "s";
  const std::string rows = test::read_text(folder / "stability.csv");
  EXPECT_NE(rows.find("viscosity_100000,corrected,cpu,ran true"), std::string::npos) << rows;
  EXPECT_NE(rows.find("viscosity_100000,paper,cpu,refused"), std::string::npos) << rows;
  EXPECT_NE(rows.find("bullet,corrected,cpu,ran true"), std::string::npos) << rows;
  EXPECT_GT(test::read_text(folder / "stability.png").size(), 1000u);
  // An earlier one's rows are drawn again, and nothing runs.
  const std::string from = (folder.parent_path() / "s-rows.csv").string();
  std::filesystem::copy_file(folder / "stability.csv", from,
                             std::filesystem::copy_options::overwrite_existing);
  const Outcome again =
      test::slosh({"report", "stability", "--from", from, "--from", from, "--out", "again"});
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(again.err.find("measuring"), std::string::npos) << again.err;
  EXPECT_EQ(test::read_text(test::test_folder() / "again" / "stability.csv"),
            rows + rows.substr(rows.find('\n') + 1));
  EXPECT_GT(test::read_text(test::test_folder() / "again" / "stability.png").size(), 1000u);
  const Outcome wrong = test::slosh({"report", "error", "--from", from, "--out", "wrong"});
  EXPECT_EQ(wrong.code, 1);
  EXPECT_NE(wrong.err.find("slosh report error"), std::string::npos) << wrong.err;
}

TEST(Report, OfPassesNamesWhatWasLeftOut) {
  test::empty_folder();
  const Outcome ran = test::slosh({"report", "passes", "pool", "--quick", "--out", "p"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_NE(ran.out.find("as planned"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("with pair_viscosity"), std::string::npos) << ran.out;
  EXPECT_NE(test::read_text(test::test_folder() / "p" / "passes.csv").find("\ncpu,as planned,"),
            std::string::npos);
}

/// Small pools, but all that it promises: a row a pool, shares, a roofline, the paper's table, pictures.
TEST(Report, OfSpeedWritesFigureSixAndTableOne) {
  test::empty_folder();
  const Outcome ran = test::slosh({"report", "speed", "--quick", "--particles", "800", "--particles", "1600",
                                   "--total", "1000", "--out", "s"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const std::filesystem::path folder = test::test_folder() / "s";
  std::istringstream lines(test::read_text(folder / "speed.csv"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line,
            "figure,backend,device,fluid_particles,body_particles,wall_particles,bodies,spacing_m,step_ms,"
            "step_p10_ms,step_p90_ms,picture_ms,particle_steps_per_s,simulated_ms_a_step,sub_steps,"
            "real_time_factor");
  std::multiset<std::string> figures;
  while (std::getline(lines, line)) {
    figures.insert(line.substr(0, 2));
    std::vector<std::string> fields;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) fields.push_back(cell);
    ASSERT_EQ(fields.size(), 16u) << line;
    if (fields[0] != "6a") {
      EXPECT_EQ(std::stoi(fields[3]) + std::stoi(fields[4]), 1000) << line;
    }
    EXPECT_EQ(std::stoi(fields[4]) > 0, std::stoi(fields[6]) > 0) << line;
    EXPECT_GT(std::stod(fields[8]), 0.0) << line;
    EXPECT_GT(std::stod(fields[11]), 0.0) << "a picture was drawn: " << line;
  }
  EXPECT_EQ(figures.count("6a"), 2u);
  EXPECT_EQ(figures.count("6b"), 4u);
  EXPECT_EQ(figures.count("6c"), 2u) << "16 spheres of 200 particles would be smaller than these";
  EXPECT_NE(test::read_text(folder / "shares.csv").find(",1600,0,density,"), std::string::npos);
  const std::string roofs = test::read_text(folder / "roofline.csv");
  for (const char* pass : {",800,sort_fluid,", ",1600,density,", ",1600,pressure_force,"})
    EXPECT_NE(roofs.find(pass), std::string::npos) << roofs;
  EXPECT_NE(test::read_text(folder / "table-1.md").find("| slosh | Lagrangian | 6 |"), std::string::npos);
  for (const char* picture : {"figure-6.png", "passes.png"})
    EXPECT_GT(test::read_text(folder / picture).size(), 1000u) << picture;
  // An earlier one is not lost, and its rows are drawn again beside others.
  EXPECT_EQ(test::slosh({"report", "speed", "--quick", "--out", "s"}).code, 1);
  const Outcome again =
      test::slosh({"report", "speed", "--from", (folder / "speed.csv").string(), "--out", "again"});
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(again.err.find("measuring"), std::string::npos) << again.err;
  EXPECT_EQ(test::read_text(test::test_folder() / "again" / "shares.csv"),
            test::read_text(folder / "shares.csv"));
}

TEST(Report, OfPicturesComparesSurfaces) {
  test::empty_folder();
  const Outcome ran = test::slosh({"report", "picture", "--quick", "--out", "p"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const std::string table = test::read_text(test::test_folder() / "p" / "picture.md");
  // A row a surface: its name, then the mean error of its normals on the pool, degrees.
  const auto degrees = [&](const std::string& name) {
    const std::size_t at = table.find("| " + name + " | ");
    return at == std::string::npos ? -1.0 : std::atof(table.c_str() + at + name.size() + 5);
  };
  EXPECT_GT(degrees("paper, section 5"), 10.0) << table;
  EXPECT_GT(degrees("ours"), 0.1) << table;
  EXPECT_LT(degrees("ours"), 0.4 * degrees("curvature flow")) << table;
  // "restless of all change", of 255, in a slow stir.
  const std::size_t stir = table.find("/255 | ", table.find("| ours | ")) + 7;
  const double restless = std::atof(table.c_str() + stir);
  const double change = std::atof(table.c_str() + table.find(" of ", stir) + 4);
  EXPECT_GT(restless, 0.01) << table;
  EXPECT_LT(restless, 3.0) << table;
  EXPECT_GT(change, restless) << "it moves as well";
  const Result<Image> sheet = read_png(test::test_folder() / "p" / "picture.png");
  ASSERT_TRUE(sheet) << sheet.error().text();
  // With Embree, which the tests' packages bring, the traced truth stands beside the three.
  EXPECT_EQ(sheet.value().width, 4 * 640);
  EXPECT_NE(table.find("reference"), std::string::npos) << table;
  EXPECT_EQ(test::slosh({"report", "picture", "--quick", "--out", "p"}).code, 1)
      << "an earlier one is not lost";
}

TEST(Report, BadRequestsSayWhatThereIs) {
  const auto expect = [](const std::vector<std::string>& arguments, int code, const char* part) {
    const Outcome outcome = test::slosh(arguments);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
  };
  expect({"report", "picture", "--threads", "0"}, 2, "--threads");
  expect({"report", "speed", "--particles", "20"}, 2, "--particles");
  expect({"report"}, 2, "slosh report --help");
  expect({"report", "error", "--case", "sloshin"}, 1, "sloshing");
  expect({"report", "stability", "--case", "nothing"}, 1, "jerk");
  expect({"report", "error", "--model", "wcsph"}, 2, "corrected");
  expect({"report", "error", "--from", "nowhere.csv"}, 2, "nowhere.csv");
  expect({"report", "error", "--quick", "--backend", "cuda"}, 1, "--backend cpu");
}

TEST(Report, AFigureOfThePaperIsDrawnAndJudgedByThePapersWords) {
  test::empty_folder();
  // At the scene's coarsest, 12 mm, 90 % of the weight get there (95 % at 11.8 and 12.2 mm, 97 % at 10).
  const Outcome ran = test::slosh({"report", "figure", "9", "--spacing", "0.0118", "--out", "nine"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const std::filesystem::path nine = test::test_folder() / "nine";
  const std::string words = test::read_text(nine / "figure-9.md");
  EXPECT_EQ(words, ran.out.substr(0, words.size()));
  EXPECT_NE(words.find("slosh report figure 9 --spacing 0.0118"), std::string::npos) << "to be run again";
  EXPECT_NE(words.find("**holds**: \u201Cweight shifts from the bowl to the pan"), std::string::npos)
      << words;
  EXPECT_NE(words.find("**holds**: \u201Cthe bowl is first tilted (torque peak)"), std::string::npos)
      << words;
  EXPECT_EQ(words.find("does not hold"), std::string::npos) << words;
  EXPECT_GT(test::read_text(nine / "figure-9.png").size(), 10000u);
  EXPECT_GT(test::read_text(nine / "figure-9.csv").size(), 100000u);
  EXPECT_EQ(test::slosh({"report", "figure", "9", "--out", "nine"}).code, 1)
      << "a figure that is there is not lost";
  EXPECT_EQ(test::slosh({"report", "figure", "7"}).code, 2);
}

TEST(Report, OfATaskDrawsItsRuns) {
  test::empty_folder();
  std::filesystem::create_directories(test::test_folder());
  const std::filesystem::path table = test::test_folder() / "crepe.csv";
  std::ofstream(table)
      << "date,scene,steps,done,late,time_s,spilled_g,peak_n,mean_n,spacing_mm,step_s,measured\n"
         "2026-11-28 10:00:00,crepe,2,2,0,30.5,12,8,3,9,10.5 20,\n"
         "2026-11-29 10:00:00,pour,1,1,0,9,1,8,3,9,9,\n"
         "2026-11-30 10:00:00,crepe,2,1,0,8,3,7,2.5,9,8,fluid 0.2 kg\n";
  const Outcome drawn = test::slosh({"report", "task", "crepe.csv"});
  ASSERT_EQ(drawn.code, 0) << drawn.err;
  EXPECT_NE(drawn.out.find("crepe: 2 runs"), std::string::npos) << drawn.out;
  EXPECT_NE(drawn.out.find("1 of 2"), std::string::npos) << drawn.out;
  EXPECT_GT(test::read_text(test::test_folder() / "crepe.png").size(), 10000u);
  const Outcome none = test::slosh({"report", "task", "crepe.csv", "--scene", "spin"});
  EXPECT_EQ(none.code, 1);
  EXPECT_NE(none.err.find("It has runs of: crepe, pour"), std::string::npos) << none.err;
}

}  // namespace
}  // namespace slosh
