#include <benchmark/benchmark.h>

#include <cmath>

#include "exitance/base/parallel.hpp"

namespace exitance {

/// Cost per term of a sum in fixed blocks, and its relative error.
static void sum_in_blocks(benchmark::State& state) {
    const auto count = static_cast<std::size_t>(state.range(0));
    double sum = 0;
    for (auto _ : state) {
        sum = parallel_sum<double>(count, [](std::size_t i) { return 0.1 * static_cast<double>(i % 10); });
        benchmark::DoNotOptimize(sum);
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
    state.counters["relative_error"] = std::abs(sum / (0.45 * static_cast<double>(count)) - 1);
}
BENCHMARK(sum_in_blocks)->Arg(1000)->Arg(100'000)->Arg(10'000'000)->UseRealTime();

}  // namespace exitance
