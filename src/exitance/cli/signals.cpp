#include "exitance/cli/signals.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>

#include "exitance/io/files/atomic_file.hpp"

namespace exitance {
namespace {

// Global, since a signal handler has no argument that could pass these.
std::atomic<StopRequest*> target{nullptr};
std::atomic<int> last_signal{0};

void leave(int signal) {
    remove_unfinished_files();
    _exit(static_cast<int>(signal == SIGINT ? ExitCode::interrupted : ExitCode::terminated));
}

void on_signal(int signal) {
    if (last_signal.exchange(signal) != 0) leave(signal);
    if (StopRequest* stop = target.load())
        stop->interrupt(signal == SIGINT ? StopRequest::Cause::interrupt : StopRequest::Cause::termination);
}

void install(void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

void leave_at_signals() {
    install(leave);
}

SignalGuard::SignalGuard(StopRequest& stop) {
    last_signal = 0;
    target = &stop;
    install(on_signal);
}

SignalGuard::~SignalGuard() {
    install(leave);
    target = nullptr;
}

std::optional<ExitCode> SignalGuard::received() const {
    switch (last_signal.load()) {
        case SIGINT:
            return ExitCode::interrupted;
        case SIGTERM:
            return ExitCode::terminated;
        default:
            return std::nullopt;
    }
}

}  // namespace exitance
