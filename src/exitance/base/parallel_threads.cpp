// Parallel loops by std::thread, for builds without oneTBB (EXITANCE_TBB=OFF).

#include <algorithm>
#include <memory>
#include <mutex>
#include <thread>

#include "exitance/base/parallel.hpp"
#include "exitance/base/thread_pool.hpp"
#include "exitance/base/workers.hpp"

namespace exitance {
namespace {

int available_threads() {
    return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

int thread_count = available_threads();
std::unique_ptr<ThreadPool> pool;  // started by the first loop, so that its threads exist only if there are loops

}  // namespace

void set_threads(int count) {
    thread_count = count > 0 ? count : available_threads();
    pool.reset();
}

int threads() {
    return thread_count;
}

void run_alone(const std::function<void()>& body) {
    ThreadPool::run_alone(body);
}

void run_workers(std::size_t count, void (*work)(void* team, std::size_t worker), void* team) {
    static std::mutex start;
    ThreadPool* started = nullptr;
    {
        const std::lock_guard lock(start);
        if (!pool) pool = std::make_unique<ThreadPool>(static_cast<std::size_t>(thread_count));
        started = pool.get();
    }
    started->run(count, [&](std::size_t worker) { work(team, worker); });
}

}  // namespace exitance
