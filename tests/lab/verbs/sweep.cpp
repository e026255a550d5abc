// The verb `sweep`: a scene again and again with other values of its fields, one table and one plot of all.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>

#include "peer/app/common_options.h"
#include "peer/app/interrupt.h"
#include "peer/app/prepare.h"
#include "peer/app/verbs.h"
#include "peer/output/chart.h"
#include "peer/output/field_words.h"
#include "peer/output/gnuplot.h"
#include "peer/output/later_table.h"
#include "peer/view/palette.h"
#include "scenes/load.h"
#include "scenes/sample.h"
#include "scenes/vary.h"
#include "sim/backend.h"
#include "sim/math/format.h"
#include "sim/step_limits.h"
#include "tests/lab/verbs/report.h"
#include "tests/lab/verbs/rest_forces.h"
#include "tests/lab/verbs/scripted_run.h"

namespace slosh {
namespace {

constexpr std::size_t kMaxRuns = 1000;
constexpr const char* kSweepTable = "sweep.csv";

struct SweepVerbOptions {
  std::string scene;
  std::vector<std::string> sets;
  std::string out;
  double spacing = 0.0;  // m; 0: the scene's own, else its coarsest
  double seconds = 0.0;  // 0: the scene's duration
  std::string backend = "cpu";
  int threads = 0;
  bool overwrite = false;
};

/// One member of the family.
struct Member {
  std::vector<FieldEdit> edits;  // one a --set
  Scene scene;
  /// Those of the edits that `chosen` says.
  std::string name(const std::vector<bool>& chosen) const {
    std::string text;
    for (std::size_t i = 0; i < edits.size(); ++i) {
      if (chosen[i]) text += (text.empty() ? "" : ", ") + field_in_words(edits[i].field, edits[i].value);
    }
    return text;
  }
};

/// Which of the edits are not the same in all members; all of them of one member alone.
std::vector<bool> varied(const std::vector<Member>& family) {
  std::vector<bool> varies(family.front().edits.size(), family.size() == 1);
  for (const Member& member : family) {
    for (std::size_t i = 0; i < varies.size(); ++i)
      varies[i] = varies[i] || member.edits[i].value != family.front().edits[i].value;
  }
  return varies;
}

/// Every combination, the last --set changing fastest; each loaded, so that what is wrong is said before
/// anything runs.
Result<std::vector<Member>> members(const SweepVerbOptions& options) {
  const Result<std::filesystem::path> file = find_scene(options.scene);
  if (!file) return file.error();
  std::vector<std::vector<FieldEdit>> family(1);
  for (const std::string& set : options.sets) {
    const Result<std::vector<FieldEdit>> values = parse_field_edits(set);
    if (!values) return values.error();
    std::vector<std::vector<FieldEdit>> wider;
    for (const std::vector<FieldEdit>& member : family) {
      for (const FieldEdit& value : values.value()) {
        wider.push_back(member);
        wider.back().push_back(value);
      }
    }
    family = std::move(wider);
    if (family.size() > kMaxRuns)
      return Error{"--set", "makes more than " + std::to_string(kMaxRuns) + " runs", "Give fewer values"};
  }
  std::vector<Member> all;
  for (std::vector<FieldEdit>& edits : family) {
    Result<Scene> scene = load_scene_with(file.value(), edits);
    if (!scene) return scene.error();
    if (scene.value().grips.empty())
      return Error{options.scene, "has no grip: there is no hand that feels anything",
                   "Give a body a grip and a hand"};
    all.push_back({std::move(edits), std::move(scene.value())});
  }
  return all;
}

/// m, of one member.
double spacing_of(const SweepVerbOptions& options, const Scene& scene) {
  if (options.spacing > 0.0) return options.spacing;
  return scene.spacing > 0.0 ? scene.spacing : scene.spacing_max;
}

/// Why one of them cannot be run: its step would be endless, or its walls are too thin. No field of --set
/// moves a mesh, so each spacing is sampled once.
std::optional<Error> refused(const SweepVerbOptions& options, const std::vector<Member>& family) {
  std::vector<double> sampled;
  for (const Member& member : family) {
    const double spacing = spacing_of(options, member.scene);
    if (std::optional<Error> endless = refuse_endless(member.scene, make_plan(member.scene, spacing)))
      return endless;
    if (std::find(sampled.begin(), sampled.end(), spacing) != sampled.end()) continue;
    const Result<SampledScene> there = sample_scene(member.scene, spacing);
    if (!there) return there.error();
    sampled.push_back(spacing);
  }
  return std::nullopt;
}

struct Felt {
  double mean_force = 0.0, peak_force = 0.0;    // N
  double mean_torque = 0.0, peak_torque = 0.0;  // N·m
};

Felt felt(const WrenchSeries& hand) {
  Felt f;
  for (const Wrench& w : hand.on_hand) {
    f.mean_force += glm::length(w.force);
    f.mean_torque += glm::length(w.torque);
    f.peak_force = std::max(f.peak_force, glm::length(w.force));
    f.peak_torque = std::max(f.peak_torque, glm::length(w.torque));
  }
  const double count = static_cast<double>(std::max<std::size_t>(hand.on_hand.size(), 1));
  f.mean_force /= count;
  f.mean_torque /= count;
  return f;
}

std::string row_of(std::size_t number, const Member& member, std::size_t grip, const ScriptedRun& run) {
  std::string row = std::to_string(number);
  for (const FieldEdit& edit : member.edits) (row += ',') += csv_cell(edit.value);
  const Felt f = felt(run.hands[grip]);
  return row + format(",%zu,%.6g,%.6g,%.6g,%.6g,%llu,%llu,%llu,%.4g\n", grip, f.mean_force, f.peak_force,
                      f.mean_torque, f.peak_torque, static_cast<unsigned long long>(run.cost.particles),
                      static_cast<unsigned long long>(run.cost.retired - run.cost.lost),
                      static_cast<unsigned long long>(run.cost.lost), run.cost.wall_s);
}

/// A panel a hand and quantity, a curve a run.
std::vector<ChartPanel> panels_of(const Scene& scene) {
  std::vector<ChartPanel> panels;
  for (const Grip& grip : scene.grips) {
    for (const char* quantity : {"force on the hand, N", "torque on the hand, N\xC2\xB7m"}) {
      ChartPanel panel;
      panel.title = grip.name;
      panel.x_label = "time, s";
      panel.y_label = quantity;
      panels.push_back(panel);
    }
  }
  return panels;
}

void add_curves(std::vector<ChartPanel>& panels, const std::string& name, std::size_t number,
                const ScriptedRun& run) {
  for (std::size_t i = 0; i < run.hands.size(); ++i) {
    for (const bool torque : {false, true}) {
      ChartSeries series;
      series.name = name;
      series.color = device_color(number).hex;
      series.mark = 0;
      series.width = 1.6;
      series.dashed = number / 6 % 2 == 1;  // the palette has six
      for (std::size_t r = 0; r < run.hands[i].time.size(); ++r) {
        const Wrench& w = run.hands[i].on_hand[r];
        series.points.emplace_back(run.hands[i].time[r], glm::length(torque ? w.torque : w.force));
      }
      panels[2 * i + (torque ? 1 : 0)].series.push_back(std::move(series));
    }
  }
}

/// What hands feel at rest, by what else than viscosity is the same in their runs: those ought to agree.
class RestsByViscosity {
 public:
  explicit RestsByViscosity(const Scene& scene) : scene_(scene) {}

  void add(const Member& member, const ScriptedRun& run) {
    std::string others;
    for (const FieldEdit& edit : member.edits)
      if (edit.field != "viscosity_pa_s") others += edit.object + "." + edit.field + "=" + edit.value + "\n";
    for (std::size_t i = 0; i < run.hands.size(); ++i)
      rests_[{i, others}].push_back(rest_forces(run.hands[i], run.poses[i]));
  }
  /// A line for each hand that has not settled.
  std::vector<std::string> unsettled() const {
    std::map<std::size_t, std::string> lines;
    for (const auto& [of, runs] : rests_) {
      const std::string text = unsettled_text(scene_.grips[of.first].name, runs);
      if (!text.empty()) lines.try_emplace(of.first, text);
    }
    std::vector<std::string> all;
    for (const auto& [hand, text] : lines) all.push_back(text);
    return all;
  }

 private:
  const Scene& scene_;
  std::map<std::pair<std::size_t, std::string>, std::vector<std::vector<RestForce>>> rests_;
};

int sweep(const SweepVerbOptions& options) {
  const Result<std::vector<Member>> family = members(options);
  if (!family) return fail(family.error());
  ReportOptions machine;
  machine.backend = options.backend;
  machine.threads = options.threads;
  machine.out = options.out;
  machine.overwrite = options.overwrite;
  if (const std::optional<Error> missing = no_backend(machine)) return fail(*missing);
  const Scene& first = family.value().front().scene;
  report::Setting setting;
  setting.backend = backends_of(machine).front();
  setting.threads = options.threads;
  setting.stopped = [] { return interrupted_by() != 0; };
  if (const std::optional<Error> wrong = refused(options, family.value())) return fail(*wrong);
  const Result<std::filesystem::path> folder = report_folder(machine, "sweep", kSweepTable);
  if (!folder) return fail(folder.error());
  const std::filesystem::path table = folder.value() / kSweepTable;
  std::ofstream out(table);
  out << "run";
  for (const FieldEdit& edit : family.value().front().edits)
    out << "," << csv_cell(edit.object + "." + edit.field);
  out << ",device,mean_force_n,peak_force_n,mean_torque_nm,peak_torque_nm,fluid_particles,spilled,lost,wall_"
         "s\n";
  catch_interrupts();
  Progress progress;
  std::vector<ChartPanel> panels = panels_of(first);
  const std::vector<bool> varies = varied(family.value());
  RestsByViscosity rests(first);
  std::vector<ReportJob> jobs;
  std::size_t done = 0;
  std::optional<Error> refusal;
  for (std::size_t n = 0; n < family.value().size(); ++n) {
    const Member& member = family.value()[n];
    const std::string name = member.name(varies);
    jobs.push_back({name, 1.0, [&, n, name] {
                      const Scene& scene = family.value()[n].scene;
                      report::Setting one = setting;
                      one.spacing = spacing_of(options, scene);
                      const double seconds = options.seconds > 0.0 ? options.seconds : scene.duration;
                      try {
                        const ScriptedRun run = run_scripted(scene, one, seconds, [&](double share) {
                          progress.update((static_cast<double>(n) + share) / static_cast<double>(jobs.size()),
                                          name);
                        });
                        for (std::size_t i = 0; i < run.hands.size(); ++i)
                          out << row_of(n + 1, member, i, run);
                        if (!write_wrenches(folder.value() / format("run-%zu-wrenches.csv", n + 1), run))
                          refusal = Error{folder.value().string(), "cannot be written", "Is the disk full?"};
                        add_curves(panels, name, n, run);
                        rests.add(family.value()[n], run);
                        done += 1;
                      } catch (const report::Refused& refused) {
                        refusal = refused.error;
                        throw report::Stopped();
                      }
                    }});
  }
  const Result<bool> ran = run_jobs(jobs, out, table, progress);
  if (!ran) return fail(ran.error());
  if (done > 0) {
    std::vector<bool> alike = varies;
    alike.flip();
    const std::string same = family.value().front().name(alike);
    const std::vector<std::string> unsettled = rests.unsettled();
    const std::string title = first.title + (same.empty() ? "" : "; " + same) +
                              (unsettled.empty() ? "" : "; forces at rest differ by viscosity") + "\n" +
                              machine_line(machine);
    const Result<bool> drawn = draw(chart_script(panels, 2, title), folder.value() / "sweep.png");
    if (!drawn) return fail(drawn.error());
  }
  for (const std::string& line : rests.unsettled()) std::printf("%s.\n", line.c_str());
  std::printf("%zu of %zu runs are in %s%s\n", done, jobs.size(), table.c_str(),
              done > 0 ? " and sweep.png" : "");
  std::fflush(stdout);
  if (refusal) return fail(*refusal);
  return interrupted_by() != 0 ? 128 + interrupted_by() : kExitOk;
}

}  // namespace

void add_sweep(CLI::App& app, VerbRun& chosen) {
  CLI::App* verb = app.add_subcommand("sweep", kSweepAbout);
  auto o = std::make_shared<SweepVerbOptions>();
  verb->add_option("SCENE", o->scene, "A shipped scene's name, or a .gltf or .glb file")->required();
  verb->add_option(
          "--set", o->sets,
          "OBJECT.FIELD=VALUE,VALUE,…: an object by its name, body, fluid or grip for all of that kind, or\n"
          "scene; a field of scenes/FIELDS.md. Again for every combination with others")
      ->required()
      ->allow_extra_args(false);
  add_never_a_window_option(*verb, "No window: a sweep has none anyway, its plot goes into --out");
  verb->add_option("--out", o->out, "Folder for the results")->required();
  verb->add_flag("--overwrite", o->overwrite, "What an earlier sweep left in --out may be lost");
  verb->add_option("--spacing", o->spacing, "Metres between particles (the scene's own, else its coarsest)")
      ->check(in_range(1e-4, 1.0));
  add_seconds_option(*verb, o->seconds, 0.01, "Simulated seconds of each run (the scene's duration)");
  verb->add_option("--backend", o->backend, "cpu or cuda")
      ->check(CLI::IsMember({"cpu", "cuda"}))
      ->capture_default_str();
  verb->add_option("--threads", o->threads, "Cores for the simulation (all)")->check(CLI::Range(1, 256));
  verb->footer(
      "Plays the scene's own hands as fast as the machine goes, once for each value. DIR gets\n"
      "  sweep.csv               a row a run and hand: the values, mean and peak of what the hand felt\n"
      "  sweep.png               force and torque of each hand over time, a colour a run\n"
      "  run-N-wrenches.csv      as play's wrenches.csv, a row a step\n"
      "A hand that stands still and feels another force by viscosity alone is named, as rest knows none: its "
      "fluid\n"
      "has not settled, or the spacing is too coarse for it.\n"
      "Every value is checked before anything runs. Ctrl-C keeps what is done, with its plot.\n\n"
      "Examples:\n"
      "  slosh sweep spoon --set fluid.viscosity_pa_s=0.5,2,8 --out thick\n"
      "  slosh sweep spin --set glass_2.viscosity_pa_s=2,10,20,40 --set scene.model=paper,corrected --out "
      "walls");
  verb->callback([&chosen, o] { chosen = [o] { return sweep(*o); }; });
}

}  // namespace slosh
