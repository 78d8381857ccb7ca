#pragma once

#include <cstdint>

// Kernels are compiled twice: for every processor, and again with EXITANCE_AVX512. Functions that they call must be
// EXITANCE_INLINE, so that they are compiled for the same target.
#define EXITANCE_INLINE [[gnu::always_inline]] inline
#if defined(__x86_64__) && !defined(__clang__)  // clang does not inline 512-bit code into functions of another target
#define EXITANCE_HAS_WIDE_KERNELS
#define EXITANCE_AVX512 [[gnu::target("avx512f,avx512dq,avx512vl,avx512bw,prefer-vector-width=512")]]
#else
#define EXITANCE_AVX512
#endif

namespace exitance {

/// Instruction set for a batch: the widest vectors of this processor, or those of every processor. Results are
/// bit-identical; `any` exists for tests.
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
