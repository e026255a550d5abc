// `slosh report figure N`: a figure of the paper again, and its words held against the numbers.
#include <algorithm>
#include <cstdio>
#include <fstream>

#include "peer/output/gnuplot.h"
#include "peer/output/whole_file.h"
#include "peer/app/interrupt.h"
#include "peer/app/prepare.h"
#include "peer/app/verbs.h"
#include "sim/math/format.h"
#include "tests/lab/verbs/figures.h"
#include "tests/lab/verbs/report.h"

namespace slosh {
namespace {

/// What was asked for, to be typed again.
std::string command_line(const ReportOptions& options, const FigureOptions& figure, double spacing) {
  return format("slosh report figure %d --spacing %g%s --backend %s%s", figure.number, spacing,
                figure.tare ? " --tare" : "", options.backend.c_str(),
                figure.plot == "png" ? "" : (" --plot " + figure.plot).c_str());
}

std::string words(const FigureOptions& figure, const std::vector<Claim>& claims,
                  const std::string& conclusion, const std::string& origin) {
  std::string text = format("# Figure %d\n\n%s\n\n", figure.number, origin.c_str());
  if (!conclusion.empty()) text += conclusion + ".\n\n";
  for (const Claim& claim : claims) {
    text += std::string(claim.holds ? "- **holds**" : "- **does not hold**") + ": \xE2\x80\x9C" +
            claim.paper + "\xE2\x80\x9D: " + claim.measured + "\n";
  }
  return text;
}

/// Which model shows what the paper's Figure 10 shows, and why the other one cannot. Two lines of a sheet.
std::string spin_in_words(const std::vector<bool>& reproduced) {
  const bool paper = !reproduced.empty() && reproduced[0];
  const bool ours = reproduced.size() > 1 && reproduced[1];
  std::string text = paper && ours ? "Both models reproduce the figure"
                     : paper       ? "The paper's model reproduces the figure, the default model does not"
                     : ours        ? "The default model reproduces the figure, the paper's model does not"
                                   : "Neither model reproduces the figure";
  if (!ours) {
    text +=
        ": by default fluid sticks to its walls, as real fluid does, and soon turns with its glass, and then "
        "no viscosity is "
        "felt. The paper's walls slip, and drag for as long as they turn";
  }
  return text;
}

FigureParts judge(const FigureOptions& figure, const ScriptedRun& run, const Scene& scene) {
  switch (figure.number) {
    case 8:
      return judge_spoon(run, figure.tare);
    case 9:
      return judge_pour(run);
    case 10:
      return judge_spin(run,
                        scene.model == ParticleModel::kPaper ? "the paper's model" : "the default model");
    case 12:
      return judge_crepe_pour(run);
    case 13:
      return judge_crepe_tools(run);
    default:
      return judge_bucket(run);
  }
}

}  // namespace

int report_figure(const ReportOptions& options, const FigureOptions& figure) {
  if (const std::optional<Error> missing = no_backend(options)) return fail(*missing);
  Result<Scene> loaded = load_named_scene(scene_of_figure(figure.number));
  if (!loaded) return fail(loaded.error());
  Scene scene = std::move(loaded.value());
  const std::string stem = "figure-" + std::to_string(figure.number);
  const Result<std::filesystem::path> folder = report_folder(options, "figure", (stem + ".md").c_str());
  if (!folder) return fail(folder.error());
  report::Setting setting;
  setting.spacing = figure.spacing > 0.0 ? figure.spacing : scene.spacing_max;
  setting.backend = backends_of(options).front();
  setting.threads = options.threads;
  setting.stopped = [] { return interrupted_by() != 0; };
  // What the paper shows of its container's viscosity depends on the model: its own beside ours.
  std::vector<ParticleModel> models{scene.model};
  if (figure.number == 10) models = {ParticleModel::kPaper, scene.model};
  catch_interrupts();
  Progress progress;
  progress.phase("measuring", scene.title);
  FigureParts all;
  std::vector<bool> reproduced;  // by each model
  try {
    for (std::size_t m = 0; m < models.size(); ++m) {
      scene.model = models[m];
      const ScriptedRun run = run_scripted(scene, setting, scene.duration, [&](double share) {
        progress.update((static_cast<double>(m) + share) / static_cast<double>(models.size()),
                        name(models[m]));
      });
      FigureParts parts = judge(figure, run, scene);
      all.panels.insert(all.panels.end(), parts.panels.begin(), parts.panels.end());
      all.claims.insert(all.claims.end(), parts.claims.begin(), parts.claims.end());
      reproduced.push_back(parts.reproduced);
      const std::string table = stem + (models.size() > 1 ? std::string("-") + name(models[m]) : "") + ".csv";
      if (!write_wrenches(folder.value() / table, run))
        return fail({(folder.value() / table).string(), "cannot be written", "Is the disk full?"});
    }
  } catch (const report::Refused& refused) {
    return fail(refused.error);
  } catch (const report::Stopped&) {
    progress.note("interrupted: nothing was drawn");
    return 128 + interrupted_by();
  }
  const std::string command = command_line(options, figure, setting.spacing);
  const std::string origin = command + ", " + machine_line(options);
  const std::string text =
      words(figure, all.claims, figure.number == 10 ? spin_in_words(reproduced) : "", origin);
  const Result<bool> written = write_whole(folder.value() / (stem + ".md"), text);
  if (!written) return fail(written.error());
  const std::string title = format("Figure %d: ", figure.number) + scene.title;
  const Result<bool> drawn =
      draw(chart_script(all.panels, std::min<int>(2, static_cast<int>(all.panels.size())), title, figure.plot,
                        origin),
           folder.value() / (stem + "." + figure.plot));
  if (!drawn) return fail(drawn.error());
  progress.end();
  std::printf("%s\n%s.%s, .md and .csv are in %s\n", text.c_str(), stem.c_str(), figure.plot.c_str(),
              folder.value().c_str());
  return kExitOk;
}

}  // namespace slosh
