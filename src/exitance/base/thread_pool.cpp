#include "exitance/base/thread_pool.hpp"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace exitance {
namespace {

thread_local bool runs_alone = false;  // true: loops started by this thread run on it alone

/// Sets `runs_alone` for its lifetime.
class Alone {
  public:
    Alone() : before_(std::exchange(runs_alone, true)) {}
    ~Alone() { runs_alone = before_; }

  private:
    bool before_;
};

}  // namespace

struct ThreadPool::State {
    std::mutex loops;  // held by the thread whose loop runs
    std::mutex mutex;  // guards all members below
    std::condition_variable begun, ended;
    const std::function<void(std::size_t)>* work = nullptr;
    std::size_t next = 0, count = 0;  // worker to begin, and number of workers
    std::size_t running = 0;          // threads within work()
    std::exception_ptr failure;
    bool stops = false;
    std::vector<std::thread> threads;

    /// Runs workers of the current loop until none is left to begin.
    void take_workers(std::unique_lock<std::mutex>& lock) {
        while (next < count) {
            const std::size_t worker = next++;
            ++running;
            lock.unlock();
            std::exception_ptr caught;
            try {
                const Alone alone;
                (*work)(worker);
            } catch (...) {
                caught = std::current_exception();
            }
            lock.lock();
            --running;
            if (caught) next = count;
            if (caught && !failure) failure = caught;
        }
        if (running == 0) ended.notify_all();
    }

    void serve() {
        std::unique_lock lock(mutex);
        while (!stops) {
            take_workers(lock);
            begun.wait(lock, [&] { return stops || next < count; });
        }
    }
};

ThreadPool::ThreadPool(std::size_t threads) : state_(std::make_unique<State>()) {
    for (std::size_t i = 1; i < threads; ++i) state_->threads.emplace_back([state = state_.get()] { state->serve(); });
}

ThreadPool::~ThreadPool() {
    {
        const std::lock_guard lock(state_->mutex);
        state_->stops = true;
    }
    state_->begun.notify_all();
    for (std::thread& thread : state_->threads) thread.join();
}

void ThreadPool::run(std::size_t count, const std::function<void(std::size_t)>& work) {
    std::unique_lock loop(state_->loops, std::defer_lock);
    if (runs_alone || state_->threads.empty() || count < 2 || !loop.try_lock()) {
        for (std::size_t worker = 0; worker < count; ++worker) work(worker);
        return;
    }
    std::unique_lock lock(state_->mutex);
    state_->work = &work, state_->next = 0, state_->count = count;
    state_->begun.notify_all();
    state_->take_workers(lock);
    state_->ended.wait(lock, [&] { return state_->running == 0; });
    state_->work = nullptr, state_->next = state_->count = 0;
    if (std::exception_ptr failure = std::exchange(state_->failure, nullptr)) std::rethrow_exception(failure);
}

void ThreadPool::run_alone(const std::function<void()>& body) {
    const Alone alone;
    body();
}

}  // namespace exitance
