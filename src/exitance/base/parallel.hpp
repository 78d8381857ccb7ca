#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "exitance/base/schedule.hpp"

namespace exitance {

/// Sets the number of threads of all later parallel loops; 0 means all cores. Results do not depend on it.
void set_threads(int count);
int threads();

/// Sets how the tasks of later loops are assigned to threads; the default is `stealing`. Results do not depend on it.
void set_schedule(Schedule schedule);
Schedule schedule();

/// Describes a loop: its name for traces, and which input polygon each index belongs to.
struct Work {
    const char* name = "";  ///< Name of the tasks in traces; empty: the name of the phase.
    /// Returns the input polygon that an index belongs to. A task belongs to the polygon of its first index.
    std::function<std::size_t(std::size_t)> polygon_of = {};
    /// If true, polygons (not tasks) are assigned to workers, so that all work on a polygon is done by the same worker
    /// in every loop.
    bool by_polygon = false;
};

/// Calls body(first, last) on all threads for consecutive ranges that cover [0, count), each at most `grain` long. A
/// body may write only data of its own indices.
void parallel_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body,
                     const Work& work = {});

/// Calls body() so that parallel work inside it runs on the calling thread alone. For libraries whose results depend on
/// the number of threads.
void run_alone(const std::function<void()>& body);

/// Calls body(i) for every i in [0, count), `grain` indices per task.
template <class Body>
void parallel_for(std::size_t count, std::size_t grain, const Body& body, const Work& work = {}) {
    parallel_ranges(
        count, grain,
        [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) body(i);
        },
        work);
}

/// Sum of term(i) over [0, count). Blocks of fixed length are summed in order, then their sums in order, so that the
/// result is bit-identical on any number of threads.
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
