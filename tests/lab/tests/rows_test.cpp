// Rows of errors.csv: written, read again, refused when damaged.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/lab/report/stress_case.h"
#include "tests/lab/report/sweep.h"

namespace slosh::report {
namespace {

std::filesystem::path file_with(const std::string& text) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "errors_rows_test.csv";
  std::ofstream(file) << text;
  return file;
}

ErrorRow some_row() {
  ErrorRow row;
  row.case_id = "sloshing";
  row.quantity = "swing, kept";  // a comma must not become a field
  row.unit = "s";
  row.model = "corrected";
  row.backend = "cpu";
  row.plotted = true;
  row.threads = 2;
  row.spacing = 0.01;
  row.support_ratio = 2.0;
  row.step_share = 1.0;
  row.particles = 1600;
  row.steps = 1000;
  row.time_step = 0.0015;
  row.simulated_s = 1.5;
  row.wall_s = 3.0;
  row.measured = 0.67;
  row.expected = 0.66;
  row.scale = 0.66;
  row.status = 2;
  return row;
}

TEST(ErrorRows, AreReadAsTheyWereWritten) {
  const ErrorRow row = some_row();
  const auto read = read_errors(file_with(std::string(kErrorHeader) + '\n' + csv_line(row) + '\n'));
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_EQ(read.value().size(), 1u);
  const ErrorRow& back = read.value()[0];
  EXPECT_EQ(back.case_id, "sloshing");
  EXPECT_EQ(back.quantity, "swing; kept");
  EXPECT_EQ(csv_line(back), csv_line(row));
  EXPECT_DOUBLE_EQ(back.wall_per_simulated(), 2.0);
  EXPECT_TRUE(back.is_default());
}

TEST(ErrorRows, NoTextIsAFormula) {
  ErrorRow row = some_row();
  row.quantity = "@SUM(1)";
  row.refused = "-1+1 is no spacing";
  const std::string line = csv_line(row);
  EXPECT_NE(line.find(",'@SUM(1),"), std::string::npos) << line;
  EXPECT_NE(line.find(",'-1+1 is no spacing"), std::string::npos) << line;
  const auto read = read_errors(file_with(std::string(kErrorHeader) + '\n' + line + '\n'));
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read.value()[0].quantity, row.quantity);
  EXPECT_EQ(read.value()[0].refused, row.refused);
}

TEST(ErrorRows, OfOtherFilesAndCutLinesAreRefusedWithTheirLine) {
  EXPECT_FALSE(read_errors("nowhere.csv"));
  EXPECT_FALSE(read_errors(file_with("time,device\n1,2\n")));
  const std::string whole = std::string(kErrorHeader) + '\n' + csv_line(some_row()) + '\n';
  const auto cut = read_errors(file_with(whole + csv_line(some_row()).substr(0, 40)));
  ASSERT_FALSE(cut);
  EXPECT_NE(cut.error().text().find("line 3"), std::string::npos) << cut.error().text();
}

TEST(StressRows, AreReadAsTheyWereWritten) {
  StressRow row;
  row.case_id = "jerk";
  row.model = "paper";
  row.backend = "cuda";
  row.verdict = Verdict::kLimited;
  row.why = "12 % lost, and so on";
  row.found.energy_ratio = 0.25;
  row.found.momentum_error = 2e-7;
  row.found.lost_share = 0.12;
  row.cost.particles = 1000;
  row.cost.steps = 152;
  row.cost.time_step = 0.002;
  row.cost.wall_s = 0.5;
  row.cost.status = 2;
  const std::string head = std::string(kStressHeader) + '\n';
  const auto read = read_stresses(file_with(head + csv_line(row) + '\n'));
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_EQ(read.value().size(), 1u);
  EXPECT_EQ(csv_line(read.value()[0]), csv_line(row));
  EXPECT_FALSE(read_stresses(file_with(head + "jerk,paper,cuda,ran away,0,0,0,0,0,0,0,0,0,\n")));
  EXPECT_FALSE(read_stresses(file_with(std::string(kErrorHeader) + '\n')));
}

TEST(Sweep, NamesTheCasesThereAreWhereOneIsUnknown) {
  EXPECT_EQ(chosen(stress_cases(), {}).value().size(), stress_cases().size());
  const auto two = chosen(stress_cases(), {"press", "jerk"});
  ASSERT_TRUE(two) << two.error().text();
  ASSERT_EQ(two.value().size(), 2u);
  const auto none = chosen(error_cases(), {"sloshing", "sloshin"});
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().text().find("'sloshin'"), std::string::npos);
  EXPECT_NE(none.error().text().find("still_tank, "), std::string::npos);
}

TEST(Sweep, AQuickOneIsTheCoarseSpacingsAndAFullOneHasVariants) {
  ErrorCase some{"x", "X", "known", {0.02, 0.01, 0.005}, 1, nullptr};
  SweepOptions options;
  options.quick = true;
  EXPECT_EQ(settings_of(some, options).size(), 3u);  // a model each
  options.quick = false;
  const auto all = settings_of(some, options);
  EXPECT_EQ(all.size(), 3u * 3u * 3u);
  std::size_t base = 0;
  for (const Setting& each : all) base += each.support_ratio == 2.0 && each.step_share == 1.0;
  EXPECT_EQ(base, 9u);
  options.spacings = {0.003};
  EXPECT_EQ(settings_of(some, options).size(), 3u * 3u);
  options.quick = true;
  ASSERT_EQ(settings_of(some, options).size(), 3u);
  EXPECT_EQ(settings_of(some, options)[0].spacing, 0.003);
}

TEST(Verdicts, ARefusalIsARowAndNoCrash) {
  StressCase refused{"x", "X", 0.01, true, true, [](const Setting&, Cost&) -> Stress {
                       throw Refused(Error{"scene", "is not to be had", "Take another"});
                     }};
  const StressRow row = run_stress(refused, {});
  EXPECT_EQ(row.verdict, Verdict::kRefused);
  EXPECT_NE(row.why.find("is not to be had"), std::string::npos);
}

Verdict verdict_for(Stress (*run)(const Setting&, Cost&)) {
  return run_stress({"x", "X", 0.01, true, true, run}, {}).verdict;
}

TEST(Verdicts, SayTrueLimitedOrFailed) {
  EXPECT_EQ(verdict_for([](const Setting&, Cost&) { return Stress{}; }), Verdict::kTrue);
  // Out of bounds without a word is a failure, with a status it is a limit, and no status excuses what is not
  // finite or has gained energy.
  EXPECT_EQ(verdict_for([](const Setting&, Cost&) {
              Stress s;
              s.lost_share = 0.1;
              return s;
            }),
            Verdict::kFailed);
  EXPECT_EQ(verdict_for([](const Setting&, Cost& cost) {
              cost.status = kStatusEscaped;
              Stress s;
              s.lost_share = 0.1;
              return s;
            }),
            Verdict::kLimited);
  EXPECT_EQ(verdict_for([](const Setting&, Cost& cost) {
              cost.status = kStatusEscaped;
              Stress s;
              s.energy_ratio = 1.2;
              return s;
            }),
            Verdict::kFailed);
  EXPECT_EQ(verdict_for([](const Setting&, Cost& cost) {
              cost.status = kStatusNonFinite;
              Stress s;
              s.finite = false;
              return s;
            }),
            Verdict::kFailed);
}

}  // namespace
}  // namespace slosh::report
