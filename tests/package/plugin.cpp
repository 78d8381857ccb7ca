#include <exitance/base/parallel.hpp>

/// Sum of the integers from 0 to `count` - 1, computed with the library's parallel loop.
extern "C" double sum_below(unsigned count) {
    return exitance::parallel_sum<double>(count, [](std::size_t i) { return static_cast<double>(i); });
}
