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
    case ColumnNeed::kHeat:
      return plan.has(PassId::kHeat);
  }
  return true;
}

double column_bytes(const Plan& plan) {
  double bytes = 0.0;
  for (const ColumnInfo& column : kFluidColumns) {
    if (needs(plan, column.need)) bytes += static_cast<double>(column.bytes);
  }
  return plan.has_fluid() ? bytes : 0.0;
}

}  // namespace slosh
