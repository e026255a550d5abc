// What this build's instructions ask of a processor, and whether the one that runs it has that.
#pragma once

namespace slosh {

/// Bits of kProcessorNeeds, one an extension of x86-64 that the compiler may have used.
enum ProcessorNeed : unsigned {
  kNeedsSse42 = 1u << 0,
  kNeedsPopcnt = 1u << 1,
  kNeedsAvx = 1u << 2,
  kNeedsBmi = 1u << 3,
  kNeedsAvx2 = 1u << 4,
  kNeedsFma = 1u << 5,
  kNeedsAvx512f = 1u << 6,
  kNeedsAvx512bw = 1u << 7,
  kNeedsAvx512vl = 1u << 8,
  kNeedsAvx512vnni = 1u << 9,
};

/// Of the instruction set that everything here was compiled for; 0 on processors of other kinds.
extern const unsigned kProcessorNeeds;

/// Their names with ", " between into `text`, which has room for `size` >= 1 characters; none: empty.
void name_needs(unsigned needs, char* text, unsigned size);
/// Those of `needs` that this processor, or the system on it, has not.
unsigned missing_needs(unsigned needs);

}  // namespace slosh
