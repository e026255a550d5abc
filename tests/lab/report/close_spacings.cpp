#include "tests/lab/report/close_spacings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

namespace slosh::report {
namespace {

constexpr double kApart = 0.014;  ///< of the middle spacing
constexpr double kClose = 1.02;   ///< ratio of two neighbouring spacings at most

/// A reading at a setting, but for the spacing.
using Key = std::tuple<std::string, std::string, std::string, std::string, double, double>;
Key key_of(const ErrorRow& row) {
  return {row.case_id, row.quantity, row.model, row.backend, row.support_ratio, row.step_share};
}

// Of each of a case's spacings that has others close by: the one in the middle of them.
std::map<double, double> middles_of(const std::set<double>& spacings) {
  std::map<double, double> middles;
  std::vector<double> close;
  const auto end_cluster = [&] {
    for (const double spacing : close) {
      if (close.size() > 1) middles[spacing] = close[close.size() / 2];
    }
    close.clear();
  };
  for (const double spacing : spacings) {
    if (!close.empty() && spacing > kClose * close.back()) end_cluster();
    close.push_back(spacing);
  }
  end_cluster();
  return middles;
}

// `some` are of one setting, at different spacings.
ErrorRow mean_of(const std::map<double, const ErrorRow*>& some, double middle) {
  const auto own = some.find(middle);  // not there where it was refused
  ErrorRow mean = own != some.end() ? *own->second : *some.begin()->second;
  const auto count = static_cast<double>(some.size());
  double error = 0.0, square = 0.0, time = 0.0, lost = 0.0;
  for (const auto& [spacing, row] : some) {
    error += row->error() / count;
    time += row->wall_per_simulated() / count;
    lost += row->retired / std::max(row->particles, 1.0) / count;
  }
  for (const auto& [spacing, row] : some) square += (row->error() - error) * (row->error() - error) / count;
  mean.spacing = middle;
  mean.measured = mean.expected + error * mean.scale;
  mean.wall_s = time * mean.simulated_s;
  mean.retired = lost * mean.particles;
  mean.readings = static_cast<int>(some.size());
  mean.scatter = std::sqrt(square);
  return mean;
}

}  // namespace

std::vector<double> close_spacings(double spacing, int count) {
  std::vector<double> spacings;
  for (int i = 0; i < count; ++i) spacings.push_back(spacing * (1.0 + kApart * (i - (count - 1) / 2)));
  return spacings;
}

std::vector<ErrorRow> means_of_close(const std::vector<ErrorRow>& rows) {
  std::map<std::string, std::set<double>> spacings;
  for (const ErrorRow& row : rows) spacings[row.case_id].insert(row.spacing);
  std::map<std::string, std::map<double, double>> middles;
  for (const auto& [case_id, of_case] : spacings) middles[case_id] = middles_of(of_case);
  struct Place {
    std::size_t index = 0;                   // among the means
    std::map<double, const ErrorRow*> some;  // by spacing
  };
  std::map<std::pair<Key, double>, Place> places;
  std::vector<ErrorRow> means;
  for (const ErrorRow& row : rows) {
    const auto& of_case = middles[row.case_id];
    const auto middle = of_case.find(row.spacing);
    if (middle == of_case.end() || !row.refused.empty()) {
      means.push_back(row);
      continue;
    }
    const auto [place, is_new] = places.try_emplace({key_of(row), middle->second});
    if (is_new) {
      place->second.index = means.size();
      means.emplace_back();
    }
    place->second.some.emplace(row.spacing, &row);
  }
  for (const auto& [key, place] : places) means[place.index] = mean_of(place.some, key.second);
  return means;
}

}  // namespace slosh::report
