#include "tests/lab/coupling/cells.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <numeric>
#include <sstream>

#include "peer/output/whole_file.h"
#include "sim/math/format.h"
#include "tests/lab/report/csv.h"
#include "tests/lab/verbs/on_cores.h"

namespace slosh::coupling {
namespace {

struct Cell {
  Case c;
  Scheme scheme;
  std::size_t of;  // which of the cases
};

/// A site's tick goes over all hands.
double work_of(const Case& c) {
  return c.hands * (4.0 + c.hands) * c.seconds;
}

/// What a line says before its results: which cell it is of.
std::string key_of(const Case& c, Scheme scheme) {
  return report::csv_field(c.name) + "," + word(scheme) + format(",%d,%g,", c.hands, c.stiffness) +
         report::csv_field(c.grip) +
         format(",%g,%g,%g,%g,%g,", 1e3 * c.round_trip, 1e3 * c.jitter, c.loss, c.pose_rate, c.host_rate);
}
constexpr std::size_t kKeyFields = 10;

Row row_of(const Cell& cell, const Outcome& o, const Outcome& reference) {
  return {cell.c, cell.scheme, o.verdict, o.generated, force_error(o, reference),
          o.peak, o.swing,     o.fired,   o.fell_back, o.steps};
}

/// The results of a line back; `fields` has as many as the header. Throws where they are none.
Row row_of(const Cell& cell, const report::Fields& fields) {
  Row row;
  row.c = cell.c;
  row.scheme = cell.scheme;
  const auto number = [&](std::size_t i) { return std::stod(fields.at(kKeyFields + i)); };
  const std::string& verdict = fields.at(kKeyFields);
  for (const Verdict v : {Verdict::kStable, Verdict::kLimitCycle, Verdict::kDiverged}) {
    if (verdict == word(v)) row.verdict = v;
  }
  row.generated = 1e-3 * number(1);
  row.error = number(2);
  row.peak = number(3);
  row.swing = 1e-3 * number(4);
  row.fired = number(5);
  row.fell_back = number(6) != 0.0;
  row.steps = static_cast<int>(number(7));
  return row;
}

Error not_written(const std::filesystem::path& table) {
  return {table.string(), "cannot be written", "Is the disk full? Rows so far are kept: go on with --resume"};
}

/// The lines of an earlier run by their cells, without the last where a run was ended in the middle of it.
Result<std::map<std::string, report::Fields>> kept_lines(const std::filesystem::path& table) {
  std::map<std::string, report::Fields> kept;
  std::error_code none;
  if (!std::filesystem::exists(table, none)) return kept;
  std::stringstream text;
  text << std::ifstream(table).rdbuf();
  const std::string all = text.str();
  const std::size_t end = all.rfind('\n');
  const std::string whole =
      end == std::string::npos ? std::string(kCellHeader) + "\n" : all.substr(0, end + 1);
  if (whole != all) {
    if (const Result<bool> cut = write_whole(table, whole); !cut) return cut.error();
  }
  const Result<bool> read = report::read_rows(table, kCellHeader, "coupling", [&](const report::Fields& f) {
    std::string key;
    for (std::size_t i = 0; i < kKeyFields; ++i) key += f[i] + ",";
    kept[key] = f;
  });
  if (!read) return read.error();
  return kept;
}

struct Link {
  const char* name;
  double jitter, loss, poses, host;
};

Case opposing(int hands, double stiffness, const char* grip, const char* load, const Link& link) {
  Case c;
  c.hands = hands;
  c.stiffness = stiffness;
  c.grip = grip;
  c.motion = Motion::kOpposing;
  c.jitter = link.jitter;
  c.loss = link.loss;
  c.pose_rate = link.poses;
  c.host_rate = link.host;
  c.name = format("%d hands, %g N/m, %s, %s%s", hands, stiffness, grip, load, link.name);
  return c;
}

/// With jitter and loss apart and together.
std::vector<Case> fluid_grid(const char* load) {
  constexpr Link kLinks[] = {{"40 ms", 0.04, 0.0, 500.0, 500.0},
                             {"20 %", 0.0, 0.2, 500.0, 500.0},
                             {"40 ms, 20 %", 0.04, 0.2, 500.0, 500.0}};
  std::vector<Case> cases;
  for (const int hands : {2, 4, 8})
    for (const double stiffness : {200.0, 2000.0})
      for (const char* grip : {"tight", "loose"})
        for (const Link& link : kLinks) cases.push_back(opposing(hands, stiffness, grip, load, link));
  return cases;
}

/// What a run at no delay goes by: cases that differ by their links alone share one.
std::string without_link(const Case& c) {
  std::string key =
      format("%d,%.17g,%d,%d,", c.hands, c.stiffness, static_cast<int>(c.motion), static_cast<int>(c.load)) +
      c.grip + format(",%.17g,%.17g", c.seconds, c.body_mass);
  for (const double tone : c.tones) key += format(",%.17g", tone);
  return key;
}

}  // namespace

const char* const kCellHeader =
    "case,scheme,hands,stiffness_n_m,grip,round_trip_ms,jitter_ms,loss,pose_rate_hz,host_rate_hz,verdict,"
    "generated_mj,force_error,peak_n,swing_mm_s,guarded,fell_back,steps_over_1n";

std::string csv_line(const Row& r) {
  return key_of(r.c, r.scheme) + format("%s,%.4g,%.4g,%.4g,%.4g,%.3g,%d,%d", word(r.verdict),
                                        1e3 * r.generated, r.error, r.peak, 1e3 * r.swing, r.fired,
                                        r.fell_back ? 1 : 0, r.steps);
}

std::vector<double> map_round_trips(bool quick) {
  if (quick) return {0.0, 0.05, 0.1, 0.2, 0.3};
  return {0.0, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5};
}

std::vector<Case> map_cases(bool quick) {
  std::vector<Case> cases;
  for (const char* grip : {"tight", "loose,mass=1.5"}) {
    Case& alone = cases.emplace_back();
    alone.hands = 1;
    alone.grip = grip;
    alone.name = std::string("alone, ") + (alone.grip == "tight" ? "tight" : "loose");
  }
  for (const Case& c : known_breakers()) cases.push_back(c);
  if (quick) return cases;
  // Where nothing swings words may also come at a screen's rate.
  constexpr Link kRigid[] = {{"good link", 0.0, 0.0, 500.0, 500.0},
                             {"40 ms, 20 %", 0.04, 0.2, 500.0, 500.0},
                             {"40 ms, 20 %, 60 Hz", 0.04, 0.2, 60.0, 70.0}};
  for (const int hands : {2, 4, 8})
    for (const double stiffness : {200.0, 700.0, 2000.0})
      for (const char* grip : {"tight", "loose"})
        for (const Link& link : kRigid) cases.push_back(opposing(hands, stiffness, grip, "", link));
  for (Case& c : fluid_grid("fluid carried, ")) {
    c.load = Load::kCarried;
    cases.push_back(std::move(c));
  }
  return cases;
}

std::vector<Case> bucket_cases(const std::shared_ptr<const Bucket>& bucket) {
  std::vector<Case> cases = fluid_grid("");
  for (Case& c : cases) {
    c.load = Load::kBucket;
    c.bucket = bucket;
  }
  return cases;
}

Result<std::vector<Row>> measure_cells(const std::vector<Case>& cases, const std::vector<double>& round_trips,
                                       const std::filesystem::path& table, const CellRun& run) {
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (const Scheme scheme : run.schemes) {
      for (const double round_trip : round_trips) {
        cells.push_back({cases[i], scheme, i});
        cells.back().c.round_trip = round_trip;
      }
    }
  }
  std::map<std::string, report::Fields> kept;
  if (run.resume) {
    Result<std::map<std::string, report::Fields>> read = kept_lines(table);
    if (!read) return read.error();
    kept = std::move(read.value());
  }

  std::vector<Row> rows(cells.size());
  std::vector<bool> there(cells.size());
  const bool begun = !kept.empty();
  std::vector<std::size_t> left;
  std::size_t again =
      cells.size();  // a kept one that is measured anew, one in which a controller acted if there is
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto line = kept.find(key_of(cells[i].c, cells[i].scheme));
    if (line == kept.end()) {
      left.push_back(i);
      continue;
    }
    try {
      rows[i] = row_of(cells[i], line->second);
    } catch (const std::exception&) {
      return Error{table.string(), "has a row without numbers: " + cells[i].c.name, "Remove that line"};
    }
    there[i] = true;
    kept.erase(line);
    const bool telling = cells[i].scheme == Scheme::kReplica && cells[i].c.round_trip > 0.0;
    const bool guarded = again < cells.size() && rows[again].fired > 0.0;
    if (telling && (again == cells.size() || (!guarded && rows[i].fired > 0.0))) again = i;
  }
  std::stable_sort(left.begin(), left.end(),
                   [&](std::size_t a, std::size_t b) { return work_of(cells[a].c) > work_of(cells[b].c); });

  // First what they are measured against.
  std::vector<std::size_t> needed;                // the first case of each
  std::vector<std::size_t> shared(cases.size());  // of `needed`
  std::map<std::string, std::size_t> known;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const bool is =
        std::any_of(left.begin(), left.end(), [&](std::size_t cell) { return cells[cell].of == i; }) ||
        (again < cells.size() && cells[again].of == i);
    if (!is) continue;
    const auto [entry, fresh] = known.try_emplace(without_link(cases[i]), needed.size());
    if (fresh) needed.push_back(i);
    shared[i] = entry->second;
  }
  double whole = 0.0, done = 0.0;
  for (const std::size_t i : needed) whole += work_of(cases[i]);
  for (const std::size_t i : left) whole += work_of(cells[i].c);
  std::vector<Outcome> references(needed.size());
  bool went = run_on_cores(
      needed.size(), run.jobs,
      [&](std::size_t i) { references[i] = coupling::run(cases[needed[i]], Scheme::kZeroDelay); },
      [&](std::size_t i) {
        done += work_of(cases[needed[i]]);
        run.told(done / whole, cases[needed[i]].name + ", at no delay");
      },
      run.stop);
  if (went && again < cells.size()) {
    const Cell& cell = cells[again];
    const std::string now =
        csv_line(row_of(cell, coupling::run(cell.c, cell.scheme), references[shared[cell.of]]));
    if (now != csv_line(rows[again])) {
      return Error{table.string(), "is of another version of this program: " + cell.c.name + " is now " + now,
                   "Begin anew with --overwrite, or go on with the program that began it"};
    }
  }

  std::ofstream out(table, begun ? std::ios::app : std::ios::trunc);
  if (!begun) out << kCellHeader << '\n';
  std::size_t count = cells.size() - left.size();
  went = went &&
         run_on_cores(
             left.size(), run.jobs,
             [&](std::size_t i) {
               const Cell& cell = cells[left[i]];
               rows[left[i]] = row_of(cell, coupling::run(cell.c, cell.scheme), references[shared[cell.of]]);
             },
             [&](std::size_t i) {
               const Cell& cell = cells[left[i]];
               there[left[i]] = true;
               out << csv_line(rows[left[i]]) << '\n' << std::flush;
               done += work_of(cell.c);
               run.told(done / whole, format("%zu of %zu: ", ++count, cells.size()) + cell.c.name +
                                          format(", %g ms, ", 1e3 * cell.c.round_trip) + word(cell.scheme));
             },
             [&] { return run.stop() || !out; });
  out.close();
  if (!out) return not_written(table);
  std::vector<Row> all;
  std::string text = std::string(kCellHeader) + "\n";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!there[i]) continue;
    all.push_back(rows[i]);
    text += csv_line(rows[i]) + "\n";
  }
  // A full report's rows stay where a quick one goes on with it.
  for (const auto& [key, fields] : kept) {
    for (std::size_t i = 0; i < fields.size(); ++i) text += (i > 0 ? "," : "") + fields[i];
    text += '\n';
  }
  if (const Result<bool> written = write_whole(table, text); !written) return written.error();
  return all;
}

}  // namespace slosh::coupling
