#pragma once

#include <cstdint>

// Kernels are made for all processors, and again with EXITANCE_AVX512; they take along what is EXITANCE_INLINE.
#define EXITANCE_INLINE [[gnu::always_inline]] inline
#if defined(__x86_64__) && !defined(__clang__)  // which inlines nothing of 512 bits into a function of another target
#define EXITANCE_HAS_WIDE_KERNELS
#define EXITANCE_AVX512 [[gnu::target("avx512f,avx512dq,avx512vl,avx512bw,prefer-vector-width=512")]]
#else
#define EXITANCE_AVX512
#endif

namespace exitance {

/// What a batch is evaluated with: the widest registers there are, or those that every processor has. The bits are the
/// same; the second is there for tests.
enum class Processor : std::uint8_t { fastest, any };

inline bool has_avx512() {
#ifdef EXITANCE_HAS_WIDE_KERNELS
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
#else
    return false;
#endif
}

}  // namespace exitance
