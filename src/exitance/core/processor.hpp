#pragma once

#include <cstdint>

// Kernels are made twice: for every processor, and with EXITANCE_AVX512 for those that have 512-bit registers. They
// take along what is EXITANCE_INLINE.
#define EXITANCE_INLINE [[gnu::always_inline]] inline
#ifdef __x86_64__
#define EXITANCE_AVX512 [[gnu::target("avx512f,avx512dq,avx512vl,avx512bw,prefer-vector-width=512")]]
#else
#define EXITANCE_AVX512
#endif

namespace exitance {

/// What a batch is evaluated with: the widest registers there are, or those that every processor has. The bits are the
/// same; the second is there for tests.
enum class Processor : std::uint8_t { fastest, any };

inline bool has_avx512() {
#ifdef __x86_64__
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
#else
    return false;
#endif
}

}  // namespace exitance
