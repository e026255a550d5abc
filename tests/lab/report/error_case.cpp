#include "tests/lab/report/error_case.h"

#include <cmath>
#include <iterator>

namespace slosh::report {

double Reading::error() const {
  return (measured - expected) / (scale > 0.0 ? scale : std::abs(expected));
}

const std::vector<ErrorCase>& error_cases() {
  static const std::vector<ErrorCase> all = [] {
    std::vector<ErrorCase> cases;
    for (auto& some :
         {resting_cases(), thin_wall_cases(), buoyancy_cases(), wave_cases(), viscous_cases(),
          stirring_cases(), plane_flow_cases(), flow_cases(), contact_cases(), heat_cases(), solid_cases()})
      cases.insert(cases.end(), some.begin(), some.end());
    return cases;
  }();
  return all;
}

const ErrorCase* find_error_case(const std::string& id) {
  for (const ErrorCase& each : error_cases()) {
    if (id == each.id) return &each;
  }
  return nullptr;
}

}  // namespace slosh::report
