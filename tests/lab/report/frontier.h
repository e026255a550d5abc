// What error buys: which points no other beats in both error and time, and how fast an error falls.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace slosh::report {

/// For points (time, error), both ≥ 0: true for those that no other is at least as good as in both, and
/// better in one. Non-finite points are on no frontier.
std::vector<bool> on_frontier(const std::vector<glm::dvec2>& points);

/// The slope of log |error| over log spacing, least squares: the order of convergence. Nothing for fewer than
/// two spacings or an error of nothing.
std::optional<double> order_of(const std::vector<glm::dvec2>& spacing_and_error);

}  // namespace slosh::report
