#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace exitance {

/// Threads that run the workers of one loop after another. It takes the place of oneTBB in builds without it.
///
/// A loop that is started by a worker of the pool, or while another thread runs a loop, runs on the calling thread
/// alone.
class ThreadPool {
  public:
    /// Starts threads - 1 threads; the thread that calls run() is one more. threads: at least 1.
    explicit ThreadPool(std::size_t threads);
    ~ThreadPool();

    /// Calls work(worker) once for every worker in [0, count) and returns when all calls have returned. If calls throw,
    /// the first exception is thrown again here, and workers that have not begun are left out.
    void run(std::size_t count, const std::function<void(std::size_t)>& work);

    /// Calls body() so that loops inside it run on the calling thread alone.
    static void run_alone(const std::function<void()>& body);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace exitance
