#include "sim/columns.h"

#include "sim/plan.h"

namespace slosh {

bool needs(const Plan& plan, ColumnNeed need) {
  switch (need) {
    case ColumnNeed::kAlways:
      return true;
    case ColumnNeed::kPairViscosity:
      return plan.has(PassId::kPairViscosity);
    case ColumnNeed::kCorrected:
      return corrects_gradients(plan.model);
    case ColumnNeed::kSolved:
      return plan.has(PassId::kPressureSolve);
  }
  return true;
}

}  // namespace slosh
