#include "tests/bench/render_stereo.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <string>

namespace slosh::bench {

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

void time_stereo(Renderer& renderer, const Frame& frame, int frames) {
  std::array<View, 2> eyes{frame.view, frame.view};
  for (std::size_t eye = 0; eye < 2; ++eye) {
    const float aside = eye == 0 ? 0.032f : -0.032f;
    eyes[eye].view = glm::translate(glm::mat4(1.0f), glm::vec3(aside, 0.0f, 0.0f)) * frame.view.view;
  }
  const auto time = [](auto&& draw) {
    const auto start = std::chrono::steady_clock::now();
    draw();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  };
  const auto draw_both = [&](int i) {
    renderer.prepare(frame, eyes);
    renderer.draw(eyes);
    if (i % 6 == 0) renderer.draw_hud();
    renderer.present();
  };
  std::vector<double> mono;
  std::vector<double> stereo;
  for (int i = 0; i < frames + 2; ++i) {
    const double one = time([&] {
      renderer.draw(frame);
      (void)renderer.read_back();
    });
    const double two = time([&] {
      renderer.prepare(frame, eyes);
      renderer.draw(eyes);
      for (std::size_t eye = 0; eye < 2; ++eye) (void)renderer.read_back(eye);
      if (i % 6 == 0) renderer.draw_hud();
      renderer.present();
    });
    if (i < 2) continue;
    mono.push_back(one);
    stereo.push_back(two);
  }
  const auto print = [](const char* what, std::vector<double> one, std::vector<double> both) {
    std::printf("%s\n%-20s %10.3f %10.3f\n%-20s %10.3f %10.3f\n%-20s %10.3f %10.3f\n", what, "one eye",
                median(one), std::ranges::min(one), "both eyes", median(both), std::ranges::min(both),
                "both / one", median(both) / median(one), std::ranges::min(both) / std::ranges::min(one));
  };
  print("with read-back", mono, stereo);

  // As a headset has them: nobody reads them back, and nobody waits for one before the next is begun.
  mono.clear();
  stereo.clear();
  constexpr int kRow = 20;
  for (int i = 0; i < std::max(frames / 4, 3); ++i) {
    const auto in_a_row = [&](auto&& draw) {
      return time([&] {
               for (int k = 0; k < kRow; ++k) draw(k);
               (void)renderer.read_buffer(Buffer::kBackDepth);  // the smallest: waits for all
             }) /
             kRow;
    };
    mono.push_back(in_a_row([&](int) { renderer.draw(frame); }));
    stereo.push_back(in_a_row(draw_both));
  }
  print("without, twenty in a row", mono, stereo);

  // Pass by pass: what both eyes share costs the same, what each has for itself up to twice.
  mono.clear();
  stereo.clear();
  renderer.set_timing(true);
  std::vector<std::string> order;
  std::map<std::string, std::array<std::vector<double>, 2>> by_pass;
  const auto passes = [&](std::size_t eyes_drawn) {
    double sum = 0.0;
    for (const PassTime& pass : renderer.pass_times()) {
      sum += pass.milliseconds;
      if (!by_pass.contains(pass.pass)) order.push_back(pass.pass);
      by_pass[pass.pass][eyes_drawn - 1].push_back(pass.milliseconds);
    }
    return sum;
  };
  for (int i = 0; i < frames; ++i) {
    renderer.draw(frame);
    mono.push_back(passes(1));
    draw_both(i);
    stereo.push_back(passes(2));
  }
  renderer.set_timing(false);
  print("all passes", mono, stereo);
  std::printf("%-34s %10s %10s %10s\n", "fastest, ms", "one eye", "both eyes", "both / one");
  for (const std::string& pass : order) {
    const auto& [one, both] = by_pass[pass];
    if (one.empty() || both.empty()) continue;
    const double a = std::ranges::min(one), b = std::ranges::min(both);
    std::printf("%-34s %10.3f %10.3f %10.2f\n", pass.c_str(), a, b, a > 0.0 ? b / a : 0.0);
  }
}

}  // namespace slosh::bench
