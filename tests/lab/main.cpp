// The program `slosh-lab`: the verbs that measure. `slosh report` and `slosh sweep` become it.
#include "peer/app/program.h"

int main(int argc, char** argv) {
  constexpr slosh::AddVerb kVerbs[] = {slosh::add_sweep, slosh::add_report};
  return slosh::run_program(kVerbs, argc, argv);
}
