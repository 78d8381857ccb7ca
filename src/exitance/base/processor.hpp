#pragma once

#include <cstdint>
#include <optional>

#include "exitance/base/result.hpp"

// The engine is compiled for every processor of its family. Kernels on vectors are compiled again with EXITANCE_AVX2
// and EXITANCE_AVX512, and chosen when the program runs. Functions that they call must be EXITANCE_INLINE, lambdas too,
// so that they are compiled for the same target: targets pass vectors in different registers.
#define EXITANCE_INLINE [[gnu::always_inline]] inline
#define EXITANCE_INLINE_LAMBDA __attribute__((always_inline))
#if defined(__x86_64__) && !defined(__clang__)  // clang does not inline such functions into functions of another target
#define EXITANCE_HAS_WIDE_KERNELS
#define EXITANCE_AVX2 [[gnu::target("avx2,fma")]]
#define EXITANCE_AVX512 [[gnu::target("avx512f,avx512dq,avx512vl,avx512bw,prefer-vector-width=512")]]
#else
#define EXITANCE_AVX2
#define EXITANCE_AVX512
#endif

namespace exitance {

/// Instruction set of a batch. Results are bit-identical; sets below the fastest exist for tests.
enum class Processor : std::uint8_t { any, avx2, avx512, fastest = avx512 };

/// The widest instruction set of this processor that kernels are compiled for, or the one that the environment variable
/// EXITANCE_PROCESSOR names (any, avx2, avx512) if that is less.
Processor this_processor();

/// Returns the given instruction set, or the widest of this processor if that is less.
inline Processor usable(Processor wanted) {
    const Processor widest = this_processor();
    return wanted < widest ? wanted : widest;
}

template <class Function>
EXITANCE_AVX2 [[gnu::noinline]] auto call_for_avx2(const Function& function) {
    return function();
}
template <class Function>
EXITANCE_AVX512 [[gnu::noinline]] auto call_for_avx512(const Function& function) {
    return function();
}

/// Calls a function that is compiled for each instruction set: an EXITANCE_INLINE_LAMBDA that returns no vector.
template <class Function>
auto call_for(Processor processor, const Function& function) {
    processor = usable(processor);
    if (processor == Processor::avx512) return call_for_avx512(function);
    if (processor == Processor::avx2) return call_for_avx2(function);
    return function();
}
/// Like call_for() on this processor, for functions on vectors of four, which gain nothing from AVX-512.
template <class Function>
auto call_for_four(const Function& function) {
    return this_processor() == Processor::any ? function() : call_for_avx2(function);
}

/// Returns an error if EXITANCE_PROCESSOR names no instruction set.
std::optional<Error> processor_error();

}  // namespace exitance
