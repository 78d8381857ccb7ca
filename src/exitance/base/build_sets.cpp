#include "exitance/base/processor_check.hpp"

// This file contains data only: its code might be compiled to the instructions whose presence is to be checked.

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
