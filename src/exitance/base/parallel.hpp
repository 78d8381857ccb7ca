#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "exitance/base/schedule.hpp"

namespace exitance {

/// How many threads the parallel loops use from now on; 0 means all cores. Results never depend on it.
void set_threads(int count);
int threads();

/// How their tasks come to threads from now on; `stealing` to begin with. Results never depend on it.
void set_schedule(Schedule schedule);
Schedule schedule();

/// What a loop works on, for traces and for schedules that deal out.
struct Work {
    const char* name = "";  ///< Of its tasks, in traces; empty: that of the phase.
    /// The input polygon that an index belongs to. A task belongs where its first index does.
    std::function<std::size_t(std::size_t)> polygon_of = {};
    /// Deal out polygons, so that all work on one is one worker's, loop after loop; else every loop's own tasks.
    bool by_polygon = false;
};

/// Calls body(first, last) on consecutive ranges that cover [0, count), at most `grain` long, on all threads.
/// A body must write only what belongs to its own indices.
void parallel_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body,
                     const Work& work = {});

/// Calls body() so that parallel work within it runs on this thread alone: for libraries whose results follow from how
/// many threads they use.
void run_alone(const std::function<void()>& body);

/// Calls body(i) for every i in [0, count), `grain` indices a task.
template <class Body>
void parallel_for(std::size_t count, std::size_t grain, const Body& body, const Work& work = {}) {
    parallel_ranges(
        count, grain,
        [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) body(i);
        },
        work);
}

/// Sum of term(i) over [0, count): blocks of fixed length are summed in order, then the blocks in order, so that the
/// result has the same bits on any number of threads.
template <class T, class Term>
T parallel_sum(std::size_t count, const Term& term, T zero = T()) {
    constexpr std::size_t block = 1024;
    std::vector<T> sums((count + block - 1) / block, zero);
    parallel_for(sums.size(), 1, [&](std::size_t b) {
        T sum = zero;
        for (std::size_t i = b * block; i < count && i < (b + 1) * block; ++i) sum += term(i);
        sums[b] = sum;
    });
    T total = zero;
    for (const T& sum : sums) total += sum;
    return total;
}

}  // namespace exitance
