// The score of a guided task, a row a run, in a table that grows over runs.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "sim/math/result.h"

namespace slosh {

struct RunSummary;

/// What a run of a task came to.
struct Score {
  std::string date;  ///< "2026-11-30 14:05:12", local
  std::string scene;
  std::size_t steps = 0, done = 0, late = 0;
  double time = 0.0;               ///< s, of the steps that are done
  double spilled = 0.0;            ///< kg
  double peak_force = 0.0;         ///< N, the largest that any hand felt
  double mean_force = 0.0;         ///< N, over hands and time, while they felt any
  double spacing = 0.0;            ///< m
  std::vector<double> step_times;  ///< s, of the steps that are done
  std::string measured;            ///< what their goals measured, in words
};

Score score_of(const RunSummary& summary);

/// In the order of the file. Errors: it cannot be read, or is no such table; where, and how to mend it.
Result<std::vector<Score>> read_scores(const std::filesystem::path& file);
/// Behind what is there; a file that is not there is begun. Errors: as read_scores, or it cannot be written,
/// and then it is as it was.
Result<bool> append_score(const std::filesystem::path& file, const Score& score);

/// The runs, a line each; empty for none. `with_this`: the last is told as "this run".
std::string score_words(std::span<const Score> scores, bool with_this = true);

}  // namespace slosh
