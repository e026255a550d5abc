// The cells of the maps of `slosh report coupling`: every case by every scheme at every round trip, on all
// cores, each in the table as soon as it is there, and taken up again where a run was ended.
#pragma once

#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "sim/math/result.h"
#include "tests/lab/coupling/study.h"

namespace slosh::coupling {

/// The schemes of the maps, in the table's order.
constexpr Scheme kMapped[] = {Scheme::kHostForce, Scheme::kPeerSpring, Scheme::kReplica};

/// One cell and how it went.
struct Row {
  Case c;
  Scheme scheme = Scheme::kReplica;
  Verdict verdict = Verdict::kStable;
  double generated = 0.0;  ///< J, as in Outcome, and so the others
  double error = 0.0;      ///< force_error() against zero delay
  double peak = 0.0;
  double swing = 0.0;
  double fired = 0.0;
  bool fell_back = false;
  int steps = 0;
};

/// The line of names over the table, without its end.
extern const char* const kCellHeader;
std::string csv_line(const Row& row);

/// The bucket of water held by 2, 4 and 8 at 300 ms, by stiffness, grip and link: six axes, every other hand
/// the other way. For the replica alone; a cell takes some ten seconds of a core.
std::vector<Case> bucket_cases(const std::shared_ptr<const Bucket>& bucket);
constexpr double kBucketRoundTrip = 0.3;  // s

/// s
std::vector<double> map_round_trips(bool quick);
/// Alone, what broke schemes, and in a full report every number of hands, stiffness, grip and link.
std::vector<Case> map_cases(bool quick);

struct CellRun {
  int jobs = 0;         ///< threads; 0: one a core
  bool resume = false;  ///< keep the rows of `table` that are there
  std::vector<Scheme> schemes{std::begin(kMapped), std::end(kMapped)};
  std::function<bool()> stop;  ///< asked from any thread
  /// On the caller's thread: the share of the work that is done, and in words which.
  std::function<void(double, const std::string&)> told;
};

/// Measures the cells that `table` has not, longest first, and writes each row as it comes; at the end the
/// rows stand in the order of the cells, whatever the number of threads. Gives the rows that are there: fewer
/// than cells when `stop` ended it. A cell is the same numbers again, so where rows are kept one of them is
/// measured anew, and a table that does not hold it is of another program and refused.
/// Errors: `table` cannot be read or written, or is refused.
Result<std::vector<Row>> measure_cells(const std::vector<Case>& cases, const std::vector<double>& round_trips,
                                       const std::filesystem::path& table, const CellRun& run);

}  // namespace slosh::coupling
