#include "exitance/base/processor_check.hpp"

// Data alone: code of this file might need the instructions that it names.

namespace exitance {

const unsigned sets_of_build = 0
#ifdef __SSE4_2__
                               | sse42
#endif
#ifdef __AVX__
                               | avx
#endif
#ifdef __AVX2__
                               | avx2
#endif
#ifdef __FMA__
                               | fma
#endif
#ifdef __BMI2__
                               | bmi2
#endif
#ifdef __AVX512BW__
                               | avx512
#endif
    ;

}  // namespace exitance
