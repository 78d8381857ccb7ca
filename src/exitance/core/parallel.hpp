#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace exitance {

/// How many threads the parallel loops use from now on; 0 means all cores. Results never depend on it.
void set_threads(int count);
int threads();

/// Calls body(first, last) on consecutive ranges that cover [0, count), at most `grain` long, on all threads.
/// A body must write only what belongs to its own indices.
void parallel_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body);

/// Calls body() so that parallel work within it runs on this thread alone: for libraries whose results follow from how
/// many threads they use.
void run_alone(const std::function<void()>& body);

/// Calls body(i) for every i in [0, count), `grain` indices a task.
template <class Body>
void parallel_for(std::size_t count, std::size_t grain, const Body& body) {
    parallel_ranges(count, grain, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) body(i);
    });
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
