// `slosh report coupling`, the shipped bucket with its water in the hands of 2, 4 and 8 over a bad link.
#include <algorithm>
#include <cstdio>

#include "sim/math/format.h"
#include "tests/lab/coupling/cells.h"
#include "tests/lab/coupling/particle_host.h"
#include "tests/lab/verbs/report_coupling.h"

namespace slosh {
namespace {

using coupling::Row;

/// "2 hands, 200 N/m, tight" of "2 hands, 200 N/m, tight, 40 ms, 20 %", and the rest.
std::pair<std::string, std::string> hold_and_link(const std::string& name) {
  std::size_t at = 0;
  for (int comma = 0; comma < 3; ++comma) at = name.find(',', at) + 1;
  return {name.substr(0, at - 1), name.substr(at + 1)};
}

std::size_t place_of(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  names.push_back(name);
  return names.size() - 1;
}

}  // namespace

Result<bool> report_bucket(const std::filesystem::path& folder, const coupling::CellRun& run,
                           const std::string& machine, TileMap& map) {
  Result<std::shared_ptr<const coupling::Bucket>> bucket = coupling::load_bucket();
  if (!bucket) return bucket.error();
  const std::vector<coupling::Case> cases = coupling::bucket_cases(bucket.value());
  coupling::CellRun of_replica = run;
  of_replica.schemes = {coupling::Scheme::kReplica};
  const Result<std::vector<Row>> rows =
      measure_cells(cases, {coupling::kBucketRoundTrip}, folder / "bucket.csv", of_replica);
  if (!rows) return rows.error();
  map.title = "The shipped bucket and its water in several hands, 300 ms away";
  map.subtitle = "columns: jitter and loss, each way; on the tiles: largest force on a hand. " + machine;
  map.kinds = {{"stable", "#3a9d5d"}, {"limit cycle", "#e0b93c"}, {"diverged", "#c8322b"}};
  for (const Row& row : rows.value()) {
    const auto [hold, link] = hold_and_link(row.c.name);
    place_of(map.rows, hold);
    place_of(map.columns, link);
  }
  map.kind.assign(map.rows.size(), std::vector<int>(map.columns.size(), -1));
  map.text.assign(map.rows.size(), std::vector<std::string>(map.columns.size()));
  int counts[3] = {0, 0, 0};
  double generated = 0.0;
  for (const Row& row : rows.value()) {
    const auto [hold, link] = hold_and_link(row.c.name);
    const std::size_t r = place_of(map.rows, hold), c = place_of(map.columns, link);
    map.kind[r][c] = static_cast<int>(row.verdict);
    map.text[r][c] = format("%.0f N", row.peak);
    counts[static_cast<std::size_t>(row.verdict)] += 1;
    generated = std::max(generated, row.generated);
  }
  std::printf(
      "bucket of water, 2 to 8 hands at 300 ms: stable %d, limit cycle %d, diverged %d of %zu; most energy "
      "generated %.3g mJ\n",
      counts[0], counts[1], counts[2], cases.size(), 1e3 * generated);
  return true;
}

}  // namespace slosh
