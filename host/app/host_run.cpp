#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "host/app/host_links.h"
#include "host/app/host_options.h"
#include "host/app/host_supervisor.h"
#include "host/app/hosted_run.h"
#include "net/clock.h"
#include "net/link.h"
#include "net/text/clean.h"
#include "net/wire/scene_package.h"
#include "peer/app/interrupt.h"
#include "peer/app/verbs.h"
#include "peer/output/line_input.h"
#include "peer/output/summary.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr int kTurn_ms = 100;
constexpr std::int64_t kLineEvery = 500'000'000;  // ns

/// As people see it who may read standard output: a log keeps no secrets unless it is asked to.
std::string shown(const std::string& text, const HostVerbOptions& options) {
  return options.show_links || isatty(STDOUT_FILENO) != 0 ? text : shorten_links(text);
}

void print_links(const HostedRun& run, const HostVerbOptions& options) {
  for (const LinkRecord& link : run.first_links()) {
    if (link.revoked) continue;
    constexpr std::array kMay{"take hold", "watch", "take hold and run the world"};
    const std::string whom = link.name.empty() ? std::string("Whoever has this link") : link.name;
    std::printf("%s may %s (link %s): start ./slosh %s, and when asked paste\n  %s\n\n", whom.c_str(),
                kMay[static_cast<std::size_t>(link.role)], link.id.c_str(),
                may_hold(link.role) ? "join" : "watch", shown(run.text_of(link), options).c_str());
  }
  if (!options.show_links && isatty(STDOUT_FILENO) == 0)
    std::printf(
        "Links are cut off here, for this is no terminal. `./slosh links` shows them, --links FILE keeps "
        "them in a "
        "file for your eyes alone, --show-links prints them.\n\n");
  std::fflush(stdout);
}

std::string live_line(const HostProgress& progress, const ServerFigures& figures, double rate) {
  std::string line = progress.paused ? format("%.2f s, standing still", progress.time)
                                     : format("%.2f s, real time × %.2f, step %.2f ms", progress.time,
                                              progress.rate, progress.step_ms);
  line += "; " + (figures.who.empty() ? std::string("nobody here yet") : figures.who);
  if (rate > 0.0) line += format("; %.0f kB/s out", 1e-3 * rate);
  return line;
}

void print_summary(const HostedRun& run, const HostReport& report, const ServerFigures& figures,
                   double net_seconds) {
  const double wall = std::max(report.wall, 1e-9);
  std::printf("hosted     %.2f s in %.2f s, real time × %.2f, %llu steps of %.2f ms (p99 %.2f)\n",
              report.simulated, report.wall, report.simulated / wall,
              static_cast<unsigned long long>(report.steps), 1e3 * report.step_time.percentile(0.5),
              1e3 * report.step_time.percentile(0.99));
  std::printf("people     %llu joined, %llu refused\n", static_cast<unsigned long long>(figures.joins),
              static_cast<unsigned long long>(figures.refused));
  if (figures.samples_expected > 0) {
    std::printf("poses      %s of %s came (%.2f %%)\n", grouped(figures.samples_received).c_str(),
                grouped(figures.samples_expected).c_str(),
                100.0 * static_cast<double>(figures.samples_received) /
                    static_cast<double>(figures.samples_expected));
  }
  std::printf("snapshots  %s sent, %s withheld from links that were full; %.1f s of coding\n",
              grouped(figures.frames_sent).c_str(), grouped(figures.frames_withheld).c_str(),
              run.coding_seconds());
  if (figures.fluid_models_sent > 0)
    std::printf("fluid      %s wrenches modelled, %s sent to hands\n", grouped(report.fluid_models).c_str(),
                grouped(figures.fluid_models_sent).c_str());
  std::printf("network    %.1f MB sent, %.1f s of processor time\n",
              1e-6 * static_cast<double>(figures.bytes_sent), net_seconds);
  if (run.task() != nullptr) {
    const TaskLines task = run.task()->lines();
    std::printf("task       %s: %s\n", task.title.c_str(), task.say.c_str());
  }
  if (report.status != 0) std::printf("status     %s\n", status_text(report.status).c_str());
  for (const std::string& body : report.gone) std::printf("gone       %s\n", clean_lines(body, 300).c_str());
  if (run.checkpoint()) {
    const keep::CheckpointReport saved = run.checkpoint()->report();
    if (saved.problem.empty())
      std::printf("saved      %s\n           carry on with: ./slosh host --resume %s\n",
                  run.checkpoint_file().c_str(), run.checkpoint_file().c_str());
    else
      std::printf("saved      not: %s\n", saved.problem.c_str());
  }
  const WorldFiles& files = run.files();
  if (files.measurer())
    std::printf("measured   %s: probes.csv, and bodies.csv where there are bodies to follow\n",
                clean_text(files.folder().string(), kMaxTextBytes).c_str());
  if (files.exporter())
    std::printf("exported   %s frames for other programs\n",
                grouped(files.exporter()->report().frames).c_str());
  const keep::RecordingReport& recorded = files.recorded();
  if (recorded.bytes > 0) {
    const std::string& why = recorded.problem.empty() ? recorded.totals.ended_early : recorded.problem;
    std::printf("recorded   %s steps, %.1f MB%s%s\n", grouped(recorded.totals.steps).c_str(),
                1e-6 * static_cast<double>(recorded.bytes),
                why.empty() ? "" : "; it ended early: ", why.c_str());
  }
}

// Until somebody or something ends it; tells why.
std::string run_until_ended(HostedRun& run, const HostVerbOptions& options, Progress& progress,
                            SupervisorControl* supervision) {
  std::int64_t next_line_ns = 0;
  std::int64_t counted_ns = 0;  // when bytes were ...
  double sent = 0.0;            // ... this many
  LineInput input(progress.terminal());
  std::string trouble;
  // Who asks from elsewhere sees no status line.
  const auto ask = [&](const std::string& line) {
    Outcome answer = run.net().ask(line);
    if (!trouble.empty()) answer.text += "\n" + trouble;
    return answer;
  };
  while (run.host().running()) {
    run.door().serve(kTurn_ms, input.fd(), ask);
    for (const std::string& line : input.read())
      progress.answer(input.edits() ? line : "", shown(ask(line).text, options));
    progress.typed(input.typed());
    for (const std::string& line : run.news()) progress.note(line);
    run.save_server_state();
    if (std::string now = run.trouble(); now != trouble) {
      trouble = std::move(now);
      progress.note("slosh: " + (trouble.empty() ? "the world is saved again" : trouble));
    }
    if (interrupted_by() != 0) {
      if (supervision) supervision->ends();
      return "the host was stopped";
    }
    if (run.net().quit_asked()) return "the host has ended the run";
    const std::int64_t now = steady_now_ns();
    if (now < next_line_ns) continue;
    next_line_ns = now + kLineEvery;
    const ServerFigures figures = run.net().figures();
    const double before = std::exchange(sent, static_cast<double>(figures.bytes_sent));
    const std::int64_t since_ns = std::exchange(counted_ns, now);
    const double rate = since_ns == 0 ? 0.0 : (sent - before) / to_seconds(now - since_ns);
    // First, for the end of a long line is cut off.
    progress.update(-1.0, (trouble.empty() ? "" : "DISK: " + trouble + "; ") +
                              live_line(run.host().progress(), figures, rate));
  }
  return "the world has come to its end";
}

int run_host(const HostVerbOptions& options, SupervisorControl* supervision) {
  end_at_interrupts();
  signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error like a full disk, and no reason to die
  if (const Result<bool> there = can_host_there(options); !there) return fail(there.error());
  Progress progress;
  Result<HostedWorld> hosted = make_hosted_world(options, progress);
  if (!hosted) return fail(hosted.error(), progress);
  catch_interrupts();
  Result<std::unique_ptr<HostedRun>> created = HostedRun::create(hosted.value(), options, supervision);
  if (!created) return fail(created.error(), progress);
  HostedRun& run = *created.value();
  progress.note("listening at " + run.address());
  for (const std::string& sentence : images_left_behind(hosted.value().prepared.scene))
    progress.note("slosh: " + sentence);
  if (!run.set_aside().empty())
    progress.note("an earlier host's world was there: carry it on with ./slosh host --resume " +
                  run.set_aside());
  if (!run.checkpoint_file().empty())
    progress.note(format("saved every %g s in ", options.checkpoint_seconds) + run.checkpoint_file());
  if (supervision) supervision->can_carry_on_from(run.checkpoint_file());
  if (options.restarts == 0) print_links(run, options);
  if (run.waits()) {
    progress.note(format(
        "the world stands still until %s; type continue to start it now (--wait 0: at once)",
        options.wait == 1 ? "the first hand takes hold" : format("%d grips are held", options.wait).c_str()));
  }
  if (!options.links_file.empty()) {
    const Result<bool> written = write_private(
        options.links_file,
        links_for_scripts(run.first_links(), [&](const LinkRecord& link) { return run.text_of(link); }));
    if (!written) return fail(written.error());
  }
  progress.phase("hosting");
  run.start();
  const std::string why = run_until_ended(run, options, progress, supervision);
  progress.typed("");
  const ServerFigures figures = run.net().figures();
  const double net_seconds = run.net().cpu_seconds();
  run.stop(why);
  progress.note(why);
  print_summary(run, run.host().report(), figures, net_seconds);
  if (interrupted_by() != 0) return 128 + interrupted_by();
  return run.trouble().empty() ? kExitOk : kExitFailed;
}

}  // namespace

int host_world(const HostVerbOptions& options) {
  if (const auto supervision = inherited_supervisor_control())
    return run_host(supervision->to_run(options), supervision.get());
  // Without a checkpoint another process would have nothing to carry on from.
  if (!options.supervised || options.checkpoint == "none") return run_host(options, nullptr);
  return supervise_host(options, again_from_the_start());
}

}  // namespace slosh
