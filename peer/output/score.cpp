#include "peer/output/score.h"

#include <algorithm>
#include <charconv>
#include <ctime>
#include <fstream>
#include <sstream>

#include "net/text/spreadsheet.h"
#include "peer/output/summary.h"
#include "peer/output/whole_file.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr const char* kScoreHeader =
    "date,scene,steps,done,late,time_s,spilled_g,peak_n,mean_n,spacing_mm,step_s,measured";
constexpr std::size_t kScoreFields = 12;
constexpr std::size_t kMaxScoreBytes = std::size_t{16} << 20;

/// One field: without what separates fields and rows.
std::string score_field(std::string text) {
  for (char& c : text)
    if (c == ',' || c == '"' || c == '\n' || c == '\r') c = ';';
  return as_spreadsheet_text(text);
}

template <class T>
bool read_number(const std::string& text, T& value) {
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  return problem == std::errc() && end == text.data() + text.size();
}

bool read_row(const std::string& line, Score& score) {
  std::vector<std::string> fields;
  std::stringstream row(line);
  for (std::string field; std::getline(row, field, ',');) fields.push_back(field);
  if (line.ends_with(',')) fields.emplace_back();
  if (fields.size() != kScoreFields) return false;
  score.date = fields[0];
  score.scene = from_spreadsheet_text(fields[1]);
  double grams = 0.0, millimetres = 0.0;
  const bool numbers = read_number(fields[2], score.steps) && read_number(fields[3], score.done) &&
                       read_number(fields[4], score.late) && read_number(fields[5], score.time) &&
                       read_number(fields[6], grams) && read_number(fields[7], score.peak_force) &&
                       read_number(fields[8], score.mean_force) && read_number(fields[9], millimetres);
  score.spilled = 1e-3 * grams;
  score.spacing = 1e-3 * millimetres;
  std::stringstream times(fields[10]);
  for (std::string time; times >> time;) {
    double seconds = 0.0;
    if (!read_number(time, seconds)) return false;
    score.step_times.push_back(seconds);
  }
  score.measured = from_spreadsheet_text(fields[11]);
  return numbers;
}

std::string row_of(const Score& score) {
  std::string times;
  for (const double time : score.step_times) times += format("%s%.2f", times.empty() ? "" : " ", time);
  return score_field(score.date) + "," + score_field(score.scene) +
         format(",%zu,%zu,%zu,%.2f,%.4g,%.4g,%.4g,%.4g,", score.steps, score.done, score.late, score.time,
                1e3 * score.spilled, score.peak_force, score.mean_force, 1e3 * score.spacing) +
         times + "," + score_field(score.measured) + "\n";
}

Result<std::string> bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(in), {});
  if (!in || bytes.size() > kMaxScoreBytes)
    return Error{file.string(), "cannot be read", "Give the file that `slosh play --score` wrote"};
  return bytes;
}

}  // namespace

Score score_of(const RunSummary& summary) {
  Score score;
  char date[32] = "";
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  if (localtime_r(&now, &local)) std::strftime(date, sizeof date, "%Y-%m-%d %H:%M:%S", &local);
  score.date = date;
  score.scene = summary.scene;
  score.steps = summary.task.size();
  for (const TaskStepSummary& step : summary.task) {
    if (!step.done) continue;
    score.done += 1;
    score.late += step.late;
    score.time += step.took;
    score.step_times.push_back(step.took);
    for (const std::string& measured : step.measured)
      score.measured += (score.measured.empty() ? "" : "; ") + measured;
  }
  score.spacing = summary.spacing;
  score.spilled = summary.spilled_mass;
  std::size_t hands = 0;
  for (const DeviceSummary& device : summary.devices) {
    score.peak_force = std::max(score.peak_force, device.peak_force);
    if (device.mean_force > 0.0)
      score.mean_force += (device.mean_force - score.mean_force) / static_cast<double>(++hands);
  }
  return score;
}

Result<std::vector<Score>> read_scores(const std::filesystem::path& file) {
  const Result<std::string> bytes = bytes_of(file);
  if (!bytes) return bytes.error();
  std::stringstream lines(bytes.value());
  std::string line;
  if (!std::getline(lines, line) || line != kScoreHeader)
    return Error{file.string(), "is no table of scores: its first line is another",
                 "Give the file that `slosh play --score` wrote"};
  std::vector<Score> scores;
  for (std::size_t number = 2; std::getline(lines, line); ++number) {
    Score score;
    if (!read_row(line, score))
      return Error{file.string() + ":" + std::to_string(number), "is no row of a table of scores",
                   "Take the line out, or mend it"};
    scores.push_back(std::move(score));
  }
  return scores;
}

Result<bool> append_score(const std::filesystem::path& file, const Score& score) {
  std::string whole = std::string(kScoreHeader) + "\n";
  std::error_code problem;
  if (std::filesystem::exists(file, problem)) {
    if (const Result<std::vector<Score>> there = read_scores(file); !there) return there.error();
    whole = bytes_of(file).value();
    if (!whole.ends_with('\n')) whole += '\n';
  }
  return write_whole(file, whole + row_of(score));
}

std::string score_words(std::span<const Score> scores, bool with_this) {
  if (scores.empty()) return {};
  std::string text = "  run                  steps     time   spilled   peak   mean force\n";
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const Score& s = scores[i];
    text += format("  %-19.19s  %2zu of %-2zu  %5.1f s  %5.1f g  %5.1f N  %5.1f N\n",
                   with_this && i + 1 == scores.size() ? "this run" : s.date.c_str(), s.done, s.steps, s.time,
                   1e3 * s.spilled, s.peak_force, s.mean_force);
  }
  return text;
}

}  // namespace slosh
