// `slosh report coupling --link`: the handful over the real link.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <iterator>

#include "net/text/clean.h"
#include "peer/output/chart.h"
#include "peer/output/gnuplot.h"
#include "peer/output/plot.h"
#include "peer/output/progress.h"
#include "peer/output/whole_file.h"
#include "peer/app/interrupt.h"
#include "peer/app/verbs.h"
#include "sim/math/format.h"
#include "tests/lab/coupling/link_study.h"
#include "tests/lab/verbs/report_coupling.h"

namespace slosh {
namespace {

constexpr double kTooSlow = 0.8;  // of real time

/// What both hands felt over the time, a panel a case; of a person whose table cannot be read no curve.
std::vector<ChartPanel> felt_panels(const std::vector<coupling::LinkCase>& cases, std::size_t measured,
                                    const std::filesystem::path& folder) {
  constexpr const char* kPeople[] = {"ana", "ben"};
  constexpr const char* kColors[] = {"#2a6fb0", "#c8322b"};
  constexpr std::size_t kPoints = 900;
  std::vector<ChartPanel> panels;
  for (std::size_t i = 0; i < measured; ++i) {
    ChartPanel& panel = panels.emplace_back();
    panel.title = name_of(cases[i]);
    panel.x_label = std::string("s");
    panel.y_label = "force on the hand, N";
    for (std::size_t person = 0; person < 2; ++person) {
      const auto felt = read_wrenches(coupling::case_folder(folder, i) / kPeople[person] / "wrenches.csv");
      if (!felt) continue;
      std::vector<glm::dvec2> curve;
      for (const WrenchSeries& series : felt.value())
        for (std::size_t k = 0; k < series.time.size(); ++k)
          curve.emplace_back(series.time[k], glm::length(series.on_hand[k].force));
      ChartSeries line;
      line.name = kPeople[person];
      line.color = kColors[person];
      line.mark = 0;
      line.width = 1.0;
      for (const glm::dvec2& point : thinned(curve, kPoints)) line.points.push_back({point.x, point.y});
      panel.series.push_back(std::move(line));
    }
  }
  return panels;
}

/// Those asked for, in that order, again where asked for again; all of them where none was.
std::vector<coupling::LinkCase> chosen_cases(const ReportOptions& options) {
  const std::vector<coupling::LinkCase> all = coupling::link_cases(options.quick);
  if (options.cases.empty()) return all;
  std::vector<coupling::LinkCase> chosen;
  for (const std::string& part : options.cases) {
    const std::size_t before = chosen.size();
    std::copy_if(all.begin(), all.end(), std::back_inserter(chosen),
                 [&](const coupling::LinkCase& c) { return name_of(c).find(part) != std::string::npos; });
    if (chosen.size() == before) return {};
  }
  return chosen;
}

std::string all_names(bool quick) {
  std::string names;
  for (const coupling::LinkCase& c : coupling::link_cases(quick))
    names += (names.empty() ? "\"" : "; \"") + name_of(c) + "\"";
  return names;
}

}  // namespace

int report_coupling_link(const ReportOptions& options) {
  constexpr const char* kTable = "coupling_link.csv";
  if (options.resume)
    return fail({"--resume",
                 "is not for --link, whose handful is measured as a whole, each case against the first",
                 "Leave it out; --overwrite measures again into the same folder"});
  if (options.threads > 0)
    return fail({"--jobs",
                 "is not for --link, whose programs go by the wall's clock: two cases at once would disturb "
                 "one another",
                 "Leave it out"});
  const Result<std::filesystem::path> folder = report_folder(options, "coupling", kTable);
  if (!folder) return fail(folder.error());
  std::signal(SIGPIPE, SIG_IGN);
  catch_interrupts();
  Progress progress;
  const std::vector<coupling::LinkCase> cases = chosen_cases(options);
  if (cases.empty())
    return fail({"--case", "is in the name of none", "They are: " + all_names(options.quick)});
  progress.phase("measuring", format("%zu runs over QUIC", cases.size()));
  std::error_code code;
  coupling::LinkRun run;
  run.program = std::filesystem::read_symlink("/proc/self/exe", code).parent_path() / "slosh";
  run.folder = std::filesystem::absolute(folder.value(), code);
  run.stop = [] { return interrupted_by() != 0; };
  run.told = [&](double share, const std::string& which) { progress.update(share, which); };
  const Result<std::vector<coupling::LinkRow>> rows = measure_link(cases, run);
  if (!rows) return fail(rows.error());
  const int signal = interrupted_by();
  if (rows.value().empty() && signal != 0) {
    std::fprintf(stderr, "slosh: interrupted before a case was whole: there is no table.\n");
    return 128 + signal;
  }
  std::string text = std::string(coupling::kLinkHeader) + "\n";
  std::printf("%-12s %-26s grip  verdict      force off  peak     carried  from row to row  generated\n",
              "scheme", "link");
  for (const coupling::LinkRow& r : rows.value()) {
    text += csv_line(r) + "\n";
    const std::string link =
        format("%g ms", 1e3 * r.c.round_trip) +
        (r.c.loss > 0.0 ? format(", %g ms, %g %% lost", 1e3 * r.c.jitter, 1e2 * r.c.loss) : "");
    const std::string off = std::isnan(r.error) ? "-" : format("%.1f", 1e2 * r.error);
    std::printf("%-12s %-26s %4d  %-11s  %6s %%  %6.1f N  %5.1f N  %10.3f N  %9.3g J\n", word(r.c.scheme),
                link.c_str(), r.grip, word(r.verdict), off.c_str(), r.peak, r.carried, r.row_step,
                r.generated);
  }
  double slowest = 1.0;
  for (const coupling::LinkRow& r : rows.value()) slowest = std::min(slowest, r.pace);
  if (slowest < kTooSlow)
    std::printf(
        "The slowest run kept %.2f of real time, joining included: a delay counts for as much less there "
        "(pace)\n",
        slowest);
  if (const Result<bool> written = write_whole(folder.value() / kTable, text); !written)
    return fail(written.error());
  const std::vector<ChartPanel> panels = felt_panels(cases, rows.value().size() / 2, folder.value());
  if (!panels.empty()) {
    const std::string title = "What two hands feel over the real link. " + machine_line(options);
    if (const Result<bool> drawn = draw(chart_script(panels, 2, title), folder.value() / "coupling_link.png");
        !drawn)
      return fail(drawn.error());
  }
  std::printf("Written to %s: coupling_link.csv and .png, and what each person felt in link_…/\n",
              clean_text(folder.value().string(), kMaxTextBytes).c_str());
  return signal != 0 ? 128 + signal : kExitOk;
}

}  // namespace slosh
