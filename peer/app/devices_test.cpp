#include "peer/app/devices.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "net/text/clean.h"
#include "peer/app/common_options.h"
#include "peer/app/interrupt.h"
#include "peer/devices/device_test.h"
#include "peer/devices/passive_gains.h"
#include "peer/haptics/real_time.h"
#include "peer/output/chart.h"
#include "peer/output/gnuplot.h"
#include "peer/output/whole_file.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr const char* kDevicesTestFooter =
    R"(Take the handle as you would to work with it, and hold it still. Along one axis after another the force
rises slowly to at most --force (turning: --torque), there and back. From how the handle gives way the
stiffness, damping and mass of what holds it are fitted: your arm's, or the device's own when nobody
does. A fit below 0.8 says that it was something else. It stops at once, with a force of zero, at
Ctrl-C, when the handle moves faster than 0.5 m/s, and when the device falls silent.

Examples:
  slosh devices test falcon --force 2 --out falcon_test
  slosh devices test plugin:build/release/lib/slosh_example_device.so --torque 0
  slosh devices test operator:tight,correction=0)";

struct TestOptions {
  std::string spec;
  std::string out;
  DeviceTestOptions test;
};

void print_axes(const DeviceTestReport& report) {
  std::printf("axis  stiffness        damping            mass              travel       fit\n");
  for (const DeviceTestAxis& axis : report.axes) {
    if (!axis.moved) {
      std::printf("%-4s  it did not move\n", axis.name.c_str());
    } else if (axis.turning) {
      std::printf("%-4s  %8.3f N·m/rad  %8.4f N·m·s/rad  %8.5f kg·m²  %6.2f mrad  %.3f\n", axis.name.c_str(),
                  axis.stiffness, axis.damping, axis.mass, 1e3 * axis.travel, axis.fit);
    } else {
      std::printf("%-4s  %8.1f N/m      %8.2f N·s/m      %8.3f kg      %6.2f mm    %.3f\n", axis.name.c_str(),
                  axis.stiffness, axis.damping, axis.mass, 1e3 * axis.travel, axis.fit);
    }
  }
}

void print_timing(const DeviceTestReport& report) {
  if (report.period.count() > 0) {
    std::printf("From reading to reading: %.2f / %.2f / %.2f ms (p50 / p99 / longest); ",
                1e3 * report.period.percentile(0.5), 1e3 * report.period.percentile(0.99),
                1e3 * report.period.max());
  }
  std::printf("from a reading to the force that answers it: %.3f / %.3f / %.3f ms\n",
              1e3 * report.turn.percentile(0.5), 1e3 * report.turn.percentile(0.99), 1e3 * report.turn.max());
}

ChartPanel motion_panel(const DeviceTestReport& report, bool turning) {
  ChartPanel panel;
  panel.title = turning ? "turning" : "moving";
  panel.x_label = turning ? "mrad" : "mm";
  panel.y_label = turning ? "torque, mN m" : "force, N";
  constexpr const char* kColors[] = {"#c02020", "#208020", "#2040c0"};
  int color = 0;
  for (const DeviceTestAxis& axis : report.axes) {
    if (axis.turning != turning) continue;
    ChartSeries series;
    series.name = axis.name + format(turning ? ": %.2f Nm/rad, %.3f Nms/rad" : ": %.0f N/m, %.1f Ns/m",
                                     axis.stiffness, axis.damping);
    series.color = kColors[color++ % 3];
    series.mark = 0;
    series.width = 1.0;
    for (std::size_t i = 0; i < axis.samples.size(); i += 5) {
      const DeviceTestSample& s = axis.samples[i];
      series.points.push_back({1e3 * (s.place - axis.samples[0].place), (turning ? 1e3 : 1.0) * s.push});
    }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

ChartPanel timing_panel(const DeviceTestReport& report) {
  ChartPanel panel;
  panel.title = "loop";
  panel.x_label = "share of all, %";
  panel.y_label = "ms";
  panel.log_y = true;
  struct Line {
    const char* name;
    const char* color;
    const Histogram* of;
  };
  for (const Line& line : {Line{"reading to reading", "#202020", &report.period},
                           Line{"reading to force", "#c08020", &report.turn}}) {
    if (line.of->count() == 0) continue;
    ChartSeries series;
    series.name = line.name;
    series.color = line.color;
    series.mark = 0;
    series.width = 1.5;
    for (int percent = 1; percent <= 100; ++percent)
      series.points.push_back({static_cast<double>(percent), 1e3 * line.of->percentile(0.01 * percent)});
    panel.series.push_back(std::move(series));
  }
  return panel;
}

Result<bool> write_files(const DeviceTestReport& report, const TestOptions& options) {
  const std::filesystem::path folder = options.out;
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) return Error{options.out, "cannot be made: " + code.message(), "Name another folder with --out"};
  std::string csv = "axis,time_s,push,place,velocity\n";
  for (const DeviceTestAxis& axis : report.axes) {
    for (const DeviceTestSample& s : axis.samples)
      csv += axis.name + format(",%.6f,%.6g,%.8g,%.6g\n", s.time, s.push, s.place, s.velocity);
  }
  if (const Result<bool> written = write_whole(folder / "device_test.csv", csv); !written) return written;
  std::vector<ChartPanel> panels{motion_panel(report, false)};
  if (report.torque > 0.0) panels.push_back(motion_panel(report, true));
  panels.push_back(timing_panel(report));
  return draw(chart_script(panels, static_cast<int>(panels.size()), clean_text(options.spec, 60)),
              folder / "device_test.png");
}

int run_test(const TestOptions& options) {
  Result<std::unique_ptr<Device>> opened = open_named_device(options.spec);
  if (!opened) return fail(opened.error());
  Device& device = *opened.value();
  for (const std::string& warning : device.warnings())
    std::fprintf(stderr, "slosh: %s\n", clean_text(warning, kMaxTextBytes).c_str());
  if (!device.gives_way()) {
    return fail({options.spec, "it gives no force, so there is nothing to push with",
                 "`slosh devices --live` shows what it says"});
  }
  const DeviceLimits limits = device.limits();
  std::printf("At most %.2f N and %.3f N·m. The device holds %.0f N/m and %.2f N·s/m, %.2f N·m/rad.\n",
              std::min(options.test.force, limits.max_force),
              std::min(options.test.torque, limits.max_torque), limits.max_stiffness, limits.max_damping,
              limits.max_rotational_stiffness);
  std::fflush(stdout);
  catch_interrupts();
  DeviceTestReport report;
  // Not on this thread: signals are for it.
  std::thread([&] {
    (void)become_device_thread("slosh-hand");
    report = test_device(device, options.test, [] { return interrupted_by() != 0; });
  }).join();
  device.close();
  print_axes(report);
  print_timing(report);
  if (!options.out.empty()) {
    if (const Result<bool> written = write_files(report, options); !written) return fail(written.error());
    std::printf("Written to %s: device_test.csv, device_test.png.\n", options.out.c_str());
  }
  if (report.stopped.empty()) return kExitOk;
  return fail({options.spec, "the test ended early: " + clean_text(report.stopped, kMaxTextBytes),
               "Hold the handle still and try a smaller --force"});
}

}  // namespace

void add_devices_test(CLI::App& devices, VerbRun& chosen) {
  CLI::App* verb = devices.add_subcommand("test", "Push slowly along every axis: stiffness, damping, timing");
  auto o = std::make_shared<TestOptions>();
  verb->add_option("NAME", o->spec, "The device, as --device has it")->required();
  verb->add_option("--force", o->test.force, "N at most")->check(in_range(0.01, 20.0))->capture_default_str();
  verb->add_option("--torque", o->test.torque, "N·m at most; 0: no turning")
      ->check(in_range(0.0, 2.0))
      ->capture_default_str();
  verb->add_option("--seconds", o->test.seconds, "An axis")
      ->check(in_range(3.0, 60.0))
      ->capture_default_str();
  verb->add_option("--out", o->out, "Folder for device_test.csv and device_test.png");
  verb->footer(kDevicesTestFooter);
  verb->callback([&chosen, o] { chosen = [o] { return run_test(*o); }; });
}

}  // namespace slosh
