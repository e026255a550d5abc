// Means over spacings close by: what becomes one, and what of it is the mean.
#include "tests/lab/report/close_spacings.h"

#include <gtest/gtest.h>

namespace slosh::report {
namespace {

ErrorRow reading(double spacing, double error, const char* model = "corrected") {
  ErrorRow row;
  row.case_id = "couette";
  row.quantity = "torque";
  row.model = model;
  row.backend = "cpu";
  row.plotted = true;
  row.spacing = spacing;
  row.support_ratio = 2.0;
  row.step_share = 1.0;
  row.particles = 1000.0;
  row.simulated_s = 2.0;
  row.wall_s = 4.0;
  row.expected = 0.5;
  row.scale = 0.5;
  row.measured = 0.5 * (1.0 + error);
  return row;
}

TEST(CloseSpacings, AreEvenlyApartAroundTheOneInTheMiddle) {
  const std::vector<double> five = close_spacings(0.005, 5);
  ASSERT_EQ(five.size(), 5u);
  EXPECT_EQ(five[2], 0.005) << "bitwise: it is the reading that the report has without";
  EXPECT_NEAR(five[0], 0.972 * 0.005, 1e-12);
  EXPECT_NEAR(five[4], 1.028 * 0.005, 1e-12);
  EXPECT_EQ(close_spacings(0.005, 1), std::vector<double>{0.005});
}

TEST(CloseSpacings, BecomeTheirMeanAndItsScatter) {
  std::vector<ErrorRow> rows;
  const double errors[] = {0.01, 0.03, -0.01, 0.05, 0.02};
  for (int i = 0; i < 5; ++i)
    rows.push_back(reading(close_spacings(0.005, 5)[static_cast<std::size_t>(i)], errors[i]));
  rows[0].wall_s = 14.0;
  rows[3].retired = 50.0;
  const std::vector<ErrorRow> means = means_of_close(rows);
  ASSERT_EQ(means.size(), 1u);
  const ErrorRow& mean = means[0];
  EXPECT_EQ(mean.readings, 5);
  EXPECT_EQ(mean.spacing, 0.005);
  EXPECT_NEAR(mean.error(), 0.02, 1e-12);
  EXPECT_NEAR(mean.scatter, 0.02, 1e-12) << "squares of 1, 1, 3, 3 and 0 hundredths: 20 over 5";
  EXPECT_NEAR(mean.wall_per_simulated(), 3.0, 1e-12);
  EXPECT_NEAR(mean.retired / mean.particles, 0.01, 1e-12);
  EXPECT_TRUE(mean.is_default());
}

TEST(CloseSpacings, OfOtherModelsReadingsAndSpacingsAreNotMixed) {
  std::vector<ErrorRow> rows;
  for (const double spacing : close_spacings(0.005, 3)) {
    rows.push_back(reading(spacing, 0.1));
    rows.push_back(reading(spacing, 0.3, "paper"));
    rows.push_back(reading(spacing, 0.5));
    rows.back().quantity = "torque; wet";
  }
  rows.push_back(reading(0.006, 0.7));
  const std::vector<ErrorRow> means = means_of_close(rows);
  ASSERT_EQ(means.size(), 4u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(means[i].readings, 3) << i;
  EXPECT_NEAR(means[0].error(), 0.1, 1e-12);
  EXPECT_EQ(means[1].model, "paper");
  EXPECT_NEAR(means[1].error(), 0.3, 1e-12);
  EXPECT_NEAR(means[2].error(), 0.5, 1e-12);
  EXPECT_EQ(means[3].readings, 1);
  EXPECT_NEAR(means[3].error(), 0.7, 1e-12);
}

// Two reports of one spacing are two rows, as they always were; beside others that are close the first
// counts.
TEST(CloseSpacings, WhatIsThereTwiceIsNoScatter) {
  const std::vector<ErrorRow> twice = means_of_close({reading(0.005, 0.1), reading(0.005, 0.2)});
  ASSERT_EQ(twice.size(), 2u);
  EXPECT_EQ(twice[0].readings, 1);
  const std::vector<ErrorRow> mean = means_of_close(
      {reading(0.005, 0.1), reading(0.005, 0.2), reading(0.00507, 0.3), reading(0.00493, 0.2)});
  ASSERT_EQ(mean.size(), 1u);
  EXPECT_EQ(mean[0].readings, 3);
  EXPECT_NEAR(mean[0].error(), 0.2, 1e-12);
}

// A spacing that was refused is not in the mean, and its row stays.
TEST(CloseSpacings, WhatWasRefusedIsNoReading) {
  ErrorRow refused = reading(0.005, 0.0);
  refused.refused = "too coarse";
  refused.measured = 99.0;
  const std::vector<ErrorRow> means = means_of_close({reading(0.00493, 0.1), refused, reading(0.00507, 0.3)});
  ASSERT_EQ(means.size(), 2u);
  EXPECT_EQ(means[0].readings, 2);
  EXPECT_EQ(means[0].spacing, 0.005) << "the middle of all, so that a table has one line";
  EXPECT_NEAR(means[0].error(), 0.2, 1e-12);
  EXPECT_EQ(means[1].refused, "too coarse");
}

TEST(CloseSpacings, AreRunAsTheOptionAsks) {
  SweepOptions options;
  options.quick = true;
  options.models = {"corrected"};
  options.spacings = {0.01, 0.005};
  options.close = 3;
  const std::vector<Setting> settings = settings_of(error_cases().front(), options);
  ASSERT_EQ(settings.size(), 6u);
  EXPECT_EQ(settings[1].spacing, 0.01);
  EXPECT_EQ(settings[4].spacing, 0.005);
  EXPECT_NEAR(settings[5].spacing, 0.00507, 1e-12);
}

}  // namespace
}  // namespace slosh::report
