// Views that a person kept of a scene, there again in the next run.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "peer/view/orbit_camera.h"
#include "sim/math/result.h"

namespace slosh {

/// Four places for views, in a JSON file of the scene's own. One thread.
class KeptViews {
 public:
  static constexpr std::size_t kPlaces = 4;
  using Places = std::array<std::optional<OrbitCamera::Look>, kPlaces>;

  /// For this run only.
  KeptViews() = default;
  /// Reads `file`, which need not exist. What is in it but cannot be read is problem(), and then nothing is
  /// written there: what somebody has stays.
  explicit KeptViews(std::filesystem::path file);

  /// In words, with what to do; empty where all is well.
  const std::string& problem() const { return problem_; }
  /// `place` below kPlaces.
  const std::optional<OrbitCamera::Look>& view(std::size_t place) const { return places_[place]; }
  /// In any case for this run. Errors: problem(), or it cannot be written.
  Result<bool> keep(std::size_t place, const OrbitCamera::Look& look);

 private:
  std::filesystem::path file_;  // empty: nowhere
  std::string problem_;
  Places places_;
};

}  // namespace slosh
