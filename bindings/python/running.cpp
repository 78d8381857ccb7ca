#include "running.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace python {
namespace {

/// Keeps the latest report of a run for the thread that waits for it.
class Reports : public api::Progress {
  public:
    void phase(std::string_view name) override {
        const std::lock_guard lock(mutex_);
        phase_ = name, fraction_ = 0, is_new_ = true;
    }
    void advance(double fraction, std::string_view) override {
        const std::lock_guard lock(mutex_);
        fraction_ = fraction, is_new_ = true;
    }

    /// Waits for the end of the run, at most for `time`. Returns true after the end.
    bool wait(std::chrono::milliseconds time) {
        std::unique_lock lock(mutex_);
        return ended_.wait_for(lock, time, [&] { return has_ended_; });
    }
    void end() {
        const std::lock_guard lock(mutex_);
        has_ended_ = true;
        ended_.notify_all();
    }
    /// Moves the latest report to the arguments. Returns false if there was none since the last call.
    bool take(std::string& phase, double& fraction) {
        const std::lock_guard lock(mutex_);
        phase = phase_, fraction = fraction_;
        return std::exchange(is_new_, false);
    }

  private:
    std::mutex mutex_;
    std::condition_variable ended_;
    std::string phase_;
    double fraction_ = 0;
    bool is_new_ = false, has_ended_ = false;
};

/// Passes reports to a Python function or prints them.
class Display {
  public:
    explicit Display(const py::object& progress) {
        if (progress.is_none() || progress.is(py::bool_(false))) return;
        if (progress.is(py::bool_(true)))
            prints_ = true;
        else if (PyCallable_Check(progress.ptr()))
            function_ = progress;
        else
            raise_usage("is neither True nor a function", "progress", "give a function of (phase, fraction)");
    }
    /// Shows a report. Returns false if the work is to be stopped.
    bool show(const std::string& phase, double fraction) {
        if (prints_ && phase != printed_) {
            py::print("exitance:", phase, py::arg("file") = py::module_::import("sys").attr("stderr"));
            printed_ = phase;
        }
        if (!function_) return true;
        return !function_(phase, fraction).is(py::bool_(false));
    }

  private:
    bool prints_ = false;
    std::string printed_;
    py::object function_;
};

}  // namespace

void run_in_thread(const py::object& progress, const std::function<void(const api::Control&)>& work) {
    constexpr std::chrono::milliseconds interval{50};  // between checks of signals
    Display display(progress);
    Reports reports;
    api::StopRequest stop;
    std::thread worker([&] {
        work({&reports, &stop});
        reports.end();
    });
    std::optional<py::error_already_set> raised;
    const auto keep = [&](const auto& step) {
        try {
            if (!step()) stop.request();
        } catch (py::error_already_set& e) {
            raised.emplace(std::move(e));
            stop.request();
        }
    };
    for (bool has_ended = false; !has_ended;) {
        {
            const py::gil_scoped_release release;
            has_ended = reports.wait(interval);
        }
        if (!raised && PyErr_CheckSignals() != 0) keep([]() -> bool { throw py::error_already_set(); });
        std::string phase;
        double fraction = 0;
        if (!raised && reports.take(phase, fraction)) keep([&] { return display.show(phase, fraction); });
    }
    {
        const py::gil_scoped_release release;
        worker.join();
    }
    if (raised) throw std::move(*raised);
}

}  // namespace python
