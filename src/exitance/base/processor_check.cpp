#include "exitance/base/processor_check.hpp"

#include <unistd.h>

#include <cstring>

// This file is compiled for every processor, whatever EXITANCE_ARCH is, and runs before all other initialisation. It
// calls no function of a header that other files might have compiled for newer processors.

namespace exitance {
namespace {

struct NamedSet {
    InstructionSets set;
    const char* name;
};
constexpr NamedSet named_sets[] = {{sse42, "SSE4.2"}, {avx, "AVX"},   {avx2, "AVX2"},
                                   {fma, "FMA"},      {bmi2, "BMI2"}, {avx512, "AVX-512"}};

void print_error(const char* text) {
    [[maybe_unused]] const auto written = write(STDERR_FILENO, text, std::strlen(text));
}

/// Ends the program with an explanation, before it would meet an instruction that the processor does not have.
[[gnu::constructor(101)]] void require_sets_of_build() {
    const char* const missing = missing_set(sets_of_build, sets_of_processor());
    if (missing == nullptr) return;
    print_error("error: this build of exitance needs a processor with ");
    print_error(missing);
    print_error("\nhint: build it with -D EXITANCE_ARCH= (the default), which runs on every processor\n");
    _exit(1);
}

}  // namespace

unsigned sets_of_processor() {
    unsigned sets = 0;
#ifdef __x86_64__
    __builtin_cpu_init();
    if (__builtin_cpu_supports("sse4.2")) sets |= sse42;
    if (__builtin_cpu_supports("avx")) sets |= avx;
    if (__builtin_cpu_supports("avx2")) sets |= avx2;
    if (__builtin_cpu_supports("fma")) sets |= fma;
    if (__builtin_cpu_supports("bmi2")) sets |= bmi2;
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512bw"))
        sets |= avx512;
#endif
    return sets;
}

const char* missing_set(unsigned needed, unsigned available) {
    for (const NamedSet& named : named_sets)
        if ((needed & ~available & named.set) != 0) return named.name;
    return nullptr;
}

}  // namespace exitance
