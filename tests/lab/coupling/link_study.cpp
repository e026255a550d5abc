#include "tests/lab/coupling/link_study.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "peer/output/child_process.h"
#include "peer/output/plot.h"
#include "sim/math/format.h"
#include "tests/lab/coupling/link_count.h"
#include "tests/lab/coupling/network_sites.h"

namespace slosh::coupling {
namespace {

namespace fs = std::filesystem;

constexpr double kSeconds = 9.0;       // simulated; the bucket is tilted to both sides in it
constexpr double kBrokenLink = 999.0;  // N: a simulated person's device gives 1000
constexpr double kHums = 0.3;          // N from row to row: more is no carrying
constexpr double kLinks = 60.0;        // s that the host has for its links
constexpr double kGoodbye = 10.0;      // s that a person has once the host has ended
constexpr double kGiveUp = 120.0;      // s, of wall time, after which a program is asked to end,
constexpr double kKilled = 10.0;       // and s after that until it is killed
constexpr auto kLook = std::chrono::milliseconds(50);

/// What a person's run wrote, of the one grip that they held. Errors: those of read_wrenches(), no rows.
Result<std::pair<int, Felt>> felt_in(const fs::path& out) {
  const Result<std::vector<WrenchSeries>> series = read_wrenches(out / "wrenches.csv");
  if (!series) return series.error();
  const auto held =
      std::max_element(series.value().begin(), series.value().end(),
                       [](const auto& a, const auto& b) { return a.time.size() < b.time.size(); });
  if (held == series.value().end() || held->time.size() < 100)
    return Error{out.string(), "has no forces of a person who held on",
                 "Look at stderr of the programs there"};
  std::vector<Pose> places;
  std::ifstream poses(out / "poses.csv");
  for (std::string line; std::getline(poses, line);) {
    double time = 0.0;
    int device = 0;
    Pose p;
    glm::dvec3& x = p.position;
    glm::dquat& q = p.orientation;
    if (std::sscanf(line.c_str(), "%lf,%d,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &time, &device, &x.x, &x.y, &x.z,
                    &q.w, &q.x, &q.y, &q.z) == 9)
      places.push_back(p);
  }
  Felt felt;
  const std::size_t rows = std::min(held->time.size(), places.size());
  for (std::size_t i = 0; i < rows; ++i) felt.add(held->time[i], places[i], held->on_hand[i]);
  return std::pair{static_cast<int>(held - series.value().begin()), std::move(felt)};
}

void note_felt(const Felt& felt, LinkRow& row) {
  int carried = 0, last = 0;
  for (std::size_t i = 0; i < felt.time.size(); ++i) {
    row.peak = std::max(row.peak, glm::length(felt.force[i]));
    if (felt.time[i] > kSeconds - 4.0) {
      row.carried -= felt.force[i].y;
      carried += 1;
    }
    const double step = i > 0 ? glm::length(felt.force[i] - felt.force[i - 1]) : 0.0;
    row.steps += step > 1.0 ? 1 : 0;
    if (felt.time[i] > kSeconds - 2.0) {
      row.row_step += step;
      last += 1;
    }
  }
  row.carried /= std::max(carried, 1);
  row.row_step /= std::max(last, 1);
  row.verdict = row.peak > kBrokenLink ? Verdict::kDiverged
                : row.row_step > kHums ? Verdict::kLimitCycle
                                       : Verdict::kStable;
}

/// The host's link of that kind, once it has written it; empty before.
std::string link_in(const fs::path& file, const std::string& kind) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word, link;
    if (words >> word >> link && word == kind) return link;
  }
  return {};
}

/// The programs of a trial. Whichever way it ends, none is left running.
class Programs {
 public:
  explicit Programs(const LinkRun& run) : run_(run) {}
  ~Programs() {
    for (const auto& program : all_) program->ask_to_end();
  }
  Programs(const Programs&) = delete;
  Programs& operator=(const Programs&) = delete;

  Result<ChildProcess*> start(const std::vector<std::string>& command) {
    Result<std::unique_ptr<ChildProcess>> made = ChildProcess::start(command);
    if (!made) return made.error();
    all_.push_back(std::move(made.value()));
    return all_.back().get();
  }
  /// Waits until `done`, for so many seconds. False: the time is over, or the report is to end.
  template <class Done>
  bool wait(double seconds, Done&& done) const {
    const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!done()) {
      if (stopped() || std::chrono::steady_clock::now() > until) return false;
      std::this_thread::sleep_for(kLook);
    }
    return true;
  }
  bool stopped() const { return run_.stop && run_.stop(); }

 private:
  const LinkRun& run_;
  std::vector<std::unique_ptr<ChildProcess>> all_;
};

class Trial {
 public:
  Trial(const NetworkSites& sites, const LinkCase& c, const LinkRun& run, const fs::path& folder)
      : sites_(sites), c_(c), run_(run), folder_(folder) {}

  /// Both people's rows and what they felt, by grip.
  Result<std::array<LinkRow, 2>> go(std::array<Felt, 2>& people) {
    std::error_code code;
    fs::remove_all(folder_, code);
    fs::create_directories(folder_, code);
    if (code) return Error{folder_.string(), "cannot be made: " + code.message(), "Choose another --out"};
    const std::string at = sites_.address("host") + ":4433";
    std::vector<std::string> words{"host",           "bucket",
                                   "--spacing",      "0.014",
                                   "--threads",      "1",
                                   "--wait",         "2",
                                   "--listen",       at,
                                   "--links",        links().string(),
                                   "--seconds",      format("%g", kSeconds),
                                   "--checkpoint",   "none",
                                   "--no-supervisor"};
    for (const char* site : {"ana", "ben"})
      words.insert(words.end(), {"--address", sites_.wire_address(site) + ":5000"});
    Programs programs(run_);
    const Result<ChildProcess*> host = programs.start(command("host", words));
    if (!host) return host.error();
    (void)programs.wait(kLinks, [&] { return host.value()->over() || !link_in(links(), "watch").empty(); });
    const std::string link = link_in(links(), "hold");
    if (programs.stopped()) return interrupted();
    if (link.empty()) return Error{"slosh host", "wrote no link within a minute", "Is the machine too busy?"};
    const Result<ChildProcess*> wire = programs.start(
        with_us("wire", {(run_.program.parent_path() / "slosh-impair").string(), "--listen", "0.0.0.0:5000",
                         "--to", at, "--delay-ms", format("%g", 500.0 * c_.round_trip), "--jitter-ms",
                         format("%g", 1e3 * c_.jitter), "--loss", format("%g", c_.loss), "--seed", "7"}));
    if (!wire) return wire.error();
    const std::string coupling = c_.scheme == Scheme::kReplica ? "replica" : "spring";
    std::vector<ChildProcess*> joined;
    for (const char* name : {"ana", "ben"}) {
      const Result<ChildProcess*> person = programs.start(
          command(name, {"join", link, "--name", name, "--headless", "--no-render", "--coupling", coupling,
                         "--device", "operator:tight", "--out", out(name).string(), "--key",
                         (folder_ / (std::string(name) + ".key")).string()}));
      if (!person) return person.error();
      joined.push_back(person.value());
    }
    const auto over = [](const ChildProcess* program) { return program->over(); };
    (void)programs.wait(kGiveUp, [&] { return over(host.value()) || std::ranges::any_of(joined, over); });
    if (!programs.wait(kGoodbye, [&] { return over(host.value()); })) host.value()->ask_to_end();
    // Who did not hear that the host has ended would try to come back for minutes; asked, they write what
    // they felt.
    std::vector<bool> asked;
    for (ChildProcess* person : joined) {
      asked.push_back(!programs.wait(kGoodbye, [&] { return over(person); }));
      if (asked.back()) person->ask_to_end();
    }
    if (programs.stopped()) return interrupted();
    for (std::size_t i = 0; i < joined.size(); ++i)
      if (const Result<bool> ended = joined[i]->finish(); !ended && !asked[i]) return ended.error();
    if (const Result<bool> hosted = host.value()->finish(); !hosted) return hosted.error();
    const std::string quit = "quit\n";
    (void)wire.value()->write(quit.data(), quit.size());
    return take(people);
  }

 private:
  fs::path links() const { return folder_ / "links.txt"; }
  fs::path out(const std::string& name) const { return folder_ / name; }
  static Error interrupted() { return {"report coupling --link", "was interrupted", "Run it again"}; }
  /// As it runs at `site`, asked to end when this program is gone, however it ends. After nsenter, as
  /// entering a namespace of users clears that.
  std::vector<std::string> with_us(const std::string& site, std::vector<std::string> words) const {
    const std::vector<std::string> before{"setpriv", "--pdeathsig", "TERM", "--"};
    words.insert(words.begin(), before.begin(), before.end());
    return sites_.at(site, std::move(words));
  }
  std::vector<std::string> command(const std::string& site, const std::vector<std::string>& words) const {
    const std::string home = (folder_ / "home").string();
    std::vector<std::string> all{
        "timeout", "--kill-after",       format("%g", kKilled), format("%g", kGiveUp),
        "env",     "SLOSH_SETTINGS=none"};
    for (const char* kind : {"XDG_STATE_HOME=", "XDG_DATA_HOME=", "XDG_CONFIG_HOME=", "XDG_CACHE_HOME="})
      all.push_back(kind + home);
    all.push_back(run_.program.string());
    all.insert(all.end(), words.begin(), words.end());
    return with_us(site, std::move(all));
  }
  Result<std::array<LinkRow, 2>> take(std::array<Felt, 2>& people) const {
    std::array<LinkRow, 2> rows;
    for (const char* name : {"ana", "ben"}) {
      Result<std::pair<int, Felt>> felt = felt_in(out(name));
      if (!felt) return felt.error();
      const auto grip = static_cast<std::size_t>(felt.value().first);
      if (grip > 1 || !people[grip].time.empty())
        return Error{out(name).string(), "holds a grip that the other has",
                     "Delete the folder and try again"};
      LinkRow& row = rows[grip];
      row.c = c_;
      row.grip = static_cast<int>(grip);
      const auto summary = nlohmann::json::parse(std::ifstream(out(name) / "summary.json"), nullptr, false);
      if (summary.is_discarded() || !summary.contains("network"))
        return Error{(out(name) / "summary.json").string(), "is not whole", "Try again"};
      row.measured_round_trip = 1e-3 * summary["network"].value("rtt_ms", 0.0);
      row.pace = summary.value("real_time_factor", 0.0);
      note_felt(felt.value().second, row);
      people[grip] = std::move(felt.value().second);
    }
    const double generated = generated_by(people);
    for (LinkRow& row : rows) row.generated = generated;
    return rows;
  }

  const NetworkSites& sites_;
  const LinkCase& c_;
  const LinkRun& run_;
  const fs::path folder_;
};

}  // namespace

const char* const kLinkHeader =
    "scheme,round_trip_ms,jitter_ms,loss,grip,measured_round_trip_ms,pace,verdict,generated_mj,force_error,"
    "peak_n,"
    "carried_n,row_step_n,steps_over_1n";

std::string csv_line(const LinkRow& r) {
  return format("%s,%g,%g,%g,%d,%.4g,%.3g,%s,%.4g,%.3g,%.4g,%.4g,%.3g,%d", word(r.c.scheme),
                1e3 * r.c.round_trip, 1e3 * r.c.jitter, r.c.loss, r.grip, 1e3 * r.measured_round_trip, r.pace,
                word(r.verdict), 1e3 * r.generated, r.error, r.peak, r.carried, r.row_step, r.steps);
}

std::string name_of(const LinkCase& c) {
  return format("%s, %g ms", word(c.scheme), 1e3 * c.round_trip) +
         (c.loss > 0.0 ? format(", jitter %g ms, %g %% lost", 1e3 * c.jitter, 1e2 * c.loss) : std::string());
}

fs::path case_folder(const fs::path& folder, std::size_t i) {
  return folder / format("link_%zu", i);
}

std::vector<LinkCase> link_cases(bool quick) {
  std::vector<LinkCase> cases{{Scheme::kReplica, 0.0}, {Scheme::kReplica, 0.2, 0.0, 0.01}};
  if (quick) return cases;
  cases.push_back({Scheme::kReplica, 0.1});
  cases.push_back({Scheme::kReplica, 0.3});
  cases.push_back({Scheme::kReplica, 0.3, 0.04, 0.2});
  cases.push_back({Scheme::kReplica, 0.5, 0.04, 0.2});
  cases.push_back({Scheme::kPeerSpring, 0.1});
  cases.push_back({Scheme::kPeerSpring, 0.3, 0.04, 0.2});
  return cases;
}

Result<std::vector<LinkRow>> measure_link(const std::vector<LinkCase>& cases, const LinkRun& run) {
  std::error_code code;
  if (!fs::exists(run.program.parent_path() / "slosh-impair", code))
    return Error{(run.program.parent_path() / "slosh-impair").string(),
                 "is not there: it is the wire between the sites",
                 "Run the slosh of a build folder or of a package, which have it beside it"};
  const NetworkSites sites({"host", "ana", "ben"});
  if (!sites.problem().empty())
    return Error{"network namespaces", "cannot be made here: " + sites.problem(),
                 "Allow a user namespaces (sysctl kernel.unprivileged_userns_clone=1) or run as root"};
  std::vector<LinkRow> rows;
  std::array<Felt, 2> reference;
  for (std::size_t i = 0; i < cases.size() && !(run.stop && run.stop()); ++i) {
    if (run.told) run.told(static_cast<double>(i) / static_cast<double>(cases.size()), name_of(cases[i]));
    std::array<Felt, 2> people;
    Result<std::array<LinkRow, 2>> measured =
        Trial(sites, cases[i], run, case_folder(run.folder, i)).go(people);
    if (!measured && run.stop && run.stop()) break;
    if (!measured) return measured.error();
    if (i == 0 && !(cases[i].round_trip > 0.0)) reference = people;
    for (LinkRow& row : measured.value()) {
      const auto grip = static_cast<std::size_t>(row.grip);
      row.error = error_of(people[grip], reference[grip]);
      rows.push_back(row);
    }
  }
  return rows;
}

}  // namespace slosh::coupling
