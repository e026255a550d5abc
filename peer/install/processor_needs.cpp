// Compiled as everything else is, so that the compiler says what it may use. Data only.
#include "peer/install/processor_needs.h"

namespace slosh {

const unsigned kProcessorNeeds = 0u
#ifdef __SSE4_2__
                                 | kNeedsSse42
#endif
#ifdef __POPCNT__
                                 | kNeedsPopcnt
#endif
#ifdef __AVX__
                                 | kNeedsAvx
#endif
#ifdef __BMI2__
                                 | kNeedsBmi
#endif
#ifdef __AVX2__
                                 | kNeedsAvx2
#endif
#ifdef __FMA__
                                 | kNeedsFma
#endif
#ifdef __AVX512F__
                                 | kNeedsAvx512f
#endif
#ifdef __AVX512BW__
                                 | kNeedsAvx512bw
#endif
#ifdef __AVX512VL__
                                 | kNeedsAvx512vl
#endif
#ifdef __AVX512VNNI__
                                 | kNeedsAvx512vnni
#endif
    ;

}  // namespace slosh
