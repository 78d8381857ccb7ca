#include "exitance/base/parallel.hpp"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <memory>

#include "exitance/base/workers.hpp"

namespace exitance {
namespace {

std::unique_ptr<tbb::global_control> control;

}  // namespace

void set_threads(int count) {
    control.reset();
    const int wanted = count > 0 ? count : tbb::info::default_concurrency();
    control = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                    static_cast<std::size_t>(wanted));
}

int threads() {
    return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void run_alone(const std::function<void()>& body) {
    tbb::task_arena alone(1);
    alone.execute(body);
}

void run_workers(std::size_t count, void (*work)(void* team, std::size_t worker), void* team) {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count),
        [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t worker = range.begin(); worker < range.end(); ++worker) work(team, worker);
        },
        tbb::simple_partitioner());
}

}  // namespace exitance
