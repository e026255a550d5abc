#include <array>

#include "sim/passes/list.h"
#include "sim/passes/pass.h"

namespace slosh {

namespace passes {
#define SLOSH_OWN(id, name) extern const PassEntry name##_pass;
#define SLOSH_FUSED(id, name, into) extern const PassEntry name##_pass;
SLOSH_PASSES(SLOSH_OWN, SLOSH_FUSED, SLOSH_OWN)
#undef SLOSH_OWN
#undef SLOSH_FUSED
}  // namespace passes

namespace {

struct Row {
  const PassEntry* entry;
  const char* name;
  PassId runs_in;
  bool on_engine;
};

const Row& row(PassId id) {
#define SLOSH_OWN(id, name) Row{&passes::name##_pass, #name, PassId::id, true},
#define SLOSH_FUSED(id, name, into) Row{&passes::name##_pass, #name, PassId::into, false},
#define SLOSH_WORLD(id, name) Row{&passes::name##_pass, #name, PassId::id, false},
  static constexpr std::array<Row, kPassCount> kRows{{SLOSH_PASSES(SLOSH_OWN, SLOSH_FUSED, SLOSH_WORLD)}};
#undef SLOSH_OWN
#undef SLOSH_FUSED
#undef SLOSH_WORLD
  return kRows[static_cast<std::size_t>(id)];
}

}  // namespace

const PassEntry& entry(PassId id) {
  return *row(id).entry;
}
const char* name(PassId id) {
  return row(id).name;
}
PassId runs_in(PassId id) {
  return row(id).runs_in;
}
bool on_engine(PassId id) {
  return row(id).on_engine;
}
}  // namespace slosh
