// Ends the program with a sentence where the processor lacks what it was compiled for, in place of an illegal
// instruction somewhere in its start. Compiled for the first x86-64 (CMakeLists.txt), it includes nothing
// that has inline code, and it runs before every other initialisation of the program's own.
#include <unistd.h>

#include "peer/install/processor_needs.h"

namespace slosh {
namespace {

struct Named {
  unsigned need;
  const char* name;
};
constexpr Named kNames[] = {
    {kNeedsSse42, "sse4.2"},      {kNeedsPopcnt, "popcnt"},
    {kNeedsAvx, "avx"},           {kNeedsBmi, "bmi2"},
    {kNeedsAvx2, "avx2"},         {kNeedsFma, "fma"},
    {kNeedsAvx512f, "avx512f"},   {kNeedsAvx512bw, "avx512bw"},
    {kNeedsAvx512vl, "avx512vl"}, {kNeedsAvx512vnni, "avx512vnni"},
};

void say(const char* text) {
  unsigned length = 0;
  while (text[length] != '\0') ++length;
  if (write(STDERR_FILENO, text, length) < 0) return;  // nobody hears it
}

__attribute__((constructor(101))) void check_processor() {
  const unsigned missing = missing_needs(kProcessorNeeds);
  if (missing == 0) return;
  char names[128];
  name_needs(missing, names, sizeof names);
  say("slosh: this build is for processors that have more than this one: it lacks ");
  say(names);
  say(". Build it from its sources here (./slosh), or for an older processor (cmake "
      "-DSLOSH_ARCH=x86-64-v2)\n");
  _exit(1);
}

}  // namespace

void name_needs(unsigned needs, char* text, unsigned size) {
  unsigned length = 0;
  const auto add = [&](const char* word) {
    for (; *word != '\0' && length + 1 < size; ++word) text[length++] = *word;
  };
  for (const Named& each : kNames) {
    if (!(needs & each.need)) continue;
    if (length > 0) add(", ");
    add(each.name);
  }
  text[length] = '\0';
}

unsigned missing_needs(unsigned needs) {
  unsigned there = ~0u;
#if defined(__x86_64__)
  there = 0;
  __builtin_cpu_init();  // a constructor may come before the compiler's own
  if (__builtin_cpu_supports("sse4.2")) there |= kNeedsSse42;
  if (__builtin_cpu_supports("popcnt")) there |= kNeedsPopcnt;
  if (__builtin_cpu_supports("avx")) there |= kNeedsAvx;
  if (__builtin_cpu_supports("bmi2")) there |= kNeedsBmi;
  if (__builtin_cpu_supports("avx2")) there |= kNeedsAvx2;
  if (__builtin_cpu_supports("fma")) there |= kNeedsFma;
  if (__builtin_cpu_supports("avx512f")) there |= kNeedsAvx512f;
  if (__builtin_cpu_supports("avx512bw")) there |= kNeedsAvx512bw;
  if (__builtin_cpu_supports("avx512vl")) there |= kNeedsAvx512vl;
  if (__builtin_cpu_supports("avx512vnni")) there |= kNeedsAvx512vnni;
#endif
  return needs & ~there;
}

}  // namespace slosh
