// Force and torque of every hand, large: zoomed by the wheel, held still, kept as a table.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "sim/snapshot.h"

namespace slosh {

/// On the drawing thread.
class ForcePanel {
 public:
  explicit ForcePanel(const Scene& scene);

  bool shown = false;

  /// A new state of the bodies. Kept since the world started, at most the newest ten minutes of pictures.
  void record(const BodySnapshot& bodies);
  /// Dear ImGui calls.
  void draw();
  /// The table that somebody asked for since the last call: time_s, then force and torque of each hand, SI,
  /// on the hand.
  std::optional<std::string> take_table();
  /// What is kept, as that table.
  std::string table() const;
  /// Simulated s that the plots span.
  double span() const { return span_; }
  void zoom(double notches);

 private:
  struct Row {
    double time;
    std::vector<Wrench> hands;
  };
  void plot(const char* title, const char* unit, bool torque, float height);

  std::vector<std::string> names_;
  std::vector<Row> rows_;
  double span_ = 5.0;
  std::optional<double> held_;  // s, the plots' right end where they are held still
  bool wanted_ = false;
};

}  // namespace slosh
