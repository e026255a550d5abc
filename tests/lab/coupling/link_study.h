// Two simulated people and the bucket over the real link: programs as users start them, each at a site of its
// own, and slosh-impair on the wire between them.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sim/math/result.h"
#include "tests/lab/coupling/study.h"

namespace slosh::coupling {

struct LinkCase {
  Scheme scheme = Scheme::kReplica;  ///< kReplica or kPeerSpring
  double round_trip = 0.0;           ///< s
  double jitter = 0.0;               ///< s, 0 to this much on top of each way
  double loss = 0.0;                 ///< probability, each way
};

/// What one person felt.
struct LinkRow {
  LinkCase c;
  int grip = 0;
  double measured_round_trip = 0.0;  ///< s, by QUIC, at the end
  double pace = 0.0;  ///< simulated s a wall s of the person's run, joining and waiting included
  Verdict verdict = Verdict::kStable;
  /// J, generated_by() in link_count.h; what the fluid swings by and what is spilled is not counted.
  double generated = 0.0;
  /// Of force against the same grip's over a round trip of nothing; 1 = 100 %. NaN: the first case was no
  /// such.
  double error = 0.0;
  double peak = 0.0;      ///< N
  double carried = 0.0;   ///< N, in the mean of the last 4 s
  double row_step = 0.0;  ///< N, in the mean from row to row, 2 ms, of the last 2 s
  int steps = 0;          ///< rows that differ by more than 1 N from the one before
};

/// The handful. The first is what the others' forces are measured against.
std::vector<LinkCase> link_cases(bool quick);
std::string name_of(const LinkCase& c);
/// Where case `i` of a run keeps what its programs write: "ana" and "ben" below it.
std::filesystem::path case_folder(const std::filesystem::path& folder, std::size_t i);
/// One row of the table without its end, and the line over it.
extern const char* const kLinkHeader;
std::string csv_line(const LinkRow& row);

struct LinkRun {
  std::filesystem::path program;  ///< slosh; slosh-impair lies beside it
  std::filesystem::path folder;   ///< what each program writes is kept here, a folder a case
  std::function<bool()> stop;     ///< asked all the time: the case that runs is given up
  std::function<void(double, const std::string&)> told;  ///< share of the work done, and which case is next
};

/// 9 s of the bucket at 14 mm each, in real time: two rows a whole case. Every program that it starts has
/// ended when it returns, and is asked to when this process is killed. Errors: no network namespaces here, a
/// program that is not there or fails.
Result<std::vector<LinkRow>> measure_link(const std::vector<LinkCase>& cases, const LinkRun& run);

}  // namespace slosh::coupling
