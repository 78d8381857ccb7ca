#pragma once

#include <cstdio>
#include <cstdlib>

namespace exitance::detail {
[[noreturn]] inline void invariant_broken(const char* what, const char* file, int line) {
    std::fprintf(stderr, "exitance: internal error: %s does not hold (%s:%d). Please report this.\n", what, file, line);
    std::abort();
}
}  // namespace exitance::detail

/// Aborts if a cheap invariant fails, in every build. A failure means a bug in the code, never bad input.
#define EXI_CHECK(condition) \
    ((condition) ? void(0) : ::exitance::detail::invariant_broken(#condition, __FILE__, __LINE__))

/// Like EXI_CHECK, but only in debug and sanitizer builds.
#ifdef NDEBUG
#define EXI_ASSERT(condition) void(0)
#else
#define EXI_ASSERT(condition) EXI_CHECK(condition)
#endif
