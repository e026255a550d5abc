#include "tests/physics/lab.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace slosh::lab {

double report(const std::string& name, double measured, double predicted, const char* unit) {
  const double error = (measured - predicted) / predicted;
  char text[200];
  std::snprintf(text, sizeof text, "measured %.5g %s, predicted %.5g %s, error %+.2f %%", measured, unit,
                predicted, unit, 100.0 * error);
  std::printf("  %s: %s\n", name.c_str(), text);
  ::testing::Test::RecordProperty(name, text);
  return error;
}

void report_value(const std::string& name, double value, const char* unit) {
  char text[100];
  std::snprintf(text, sizeof text, "%.4g %s", value, unit);
  std::printf("  %s: %s\n", name.c_str(), text);
  ::testing::Test::RecordProperty(name, text);
}

}  // namespace slosh::lab
