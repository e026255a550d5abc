// Cases whose answer is known beforehand, by a closed form or an experiment.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tests/lab/report/trial.h"

namespace slosh::report {

/// One number of a case, beside what it should be.
struct Reading {
  std::string quantity;  ///< "period", "force, moving"
  std::string unit;      ///< "" for a share
  double measured = 0.0;
  double expected = 0.0;
  double scale = 0.0;    ///< what an error is a share of; 0: |expected|
  bool plotted = false;  ///< the case's own picture shows it; the others are in the table alone

  double error() const;  ///< (measured − expected) / scale
};

struct ErrorCase {
  const char* id;                ///< as file names and --case have it: "sloshing"
  const char* title;             ///< one line for a table
  const char* reference;         ///< the closed form or the experiment
  std::vector<double> spacings;  ///< m, coarse to fine, of a full report
  std::size_t quick = 1;         ///< how many of them a quick one takes, from the coarse end
  std::vector<Reading> (*run)(const Setting& setting, Cost& cost);  ///< throws Refused, Stopped
};

/// Every one, in the order of the report.
const std::vector<ErrorCase>& error_cases();
/// nullptr when there is none of that id.
const ErrorCase* find_error_case(const std::string& id);

// Each file of cases/ gives its own.
std::vector<ErrorCase> resting_cases();    ///< tanks at rest, accelerated, turning
std::vector<ErrorCase> thin_wall_cases();  ///< vessels and plates of one to three spacings
std::vector<ErrorCase> buoyancy_cases();   ///< what is lifted, floats and rises
std::vector<ErrorCase> wave_cases();
std::vector<ErrorCase> viscous_cases();     ///< torques and drags
std::vector<ErrorCase> stirring_cases();    ///< what a stirrer's torque tells
std::vector<ErrorCase> plane_flow_cases();  ///< flows of one direction, and a vortex
std::vector<ErrorCase> flow_cases();        ///< dam breaks, a column in a flow, a jet
std::vector<ErrorCase> contact_cases();     ///< bodies alone
std::vector<ErrorCase> heat_cases();        ///< conduction
std::vector<ErrorCase> solid_cases();       ///< what has set

}  // namespace slosh::report
