#pragma once

#include <cstdio>
#include <cstdlib>

namespace exitance::detail {
[[noreturn]] inline void invariant_broken(const char* what, const char* file, int line) {
    std::fprintf(stderr, "exitance: internal error: %s does not hold (%s:%d). Please report this.\n", what, file, line);
    std::abort();
}
}  // namespace exitance::detail

/// A cheap invariant, always checked: code is wrong if it fails, never the input.
#define EXI_CHECK(condition) \
    ((condition) ? void(0) : ::exitance::detail::invariant_broken(#condition, __FILE__, __LINE__))

/// An invariant checked in tested (debug and sanitizer) builds.
#ifdef NDEBUG
#define EXI_ASSERT(condition) void(0)
#else
#define EXI_ASSERT(condition) EXI_CHECK(condition)
#endif
