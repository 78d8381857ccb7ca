#include "exitance/cli/signals.hpp"

#include <atomic>
#include <csignal>

namespace exitance {
namespace {

// A handler has no argument that could carry these.
std::atomic<StopRequest*> target{nullptr};
std::atomic<int> last_signal{0};

void on_signal(int signal) {
    last_signal.store(signal);
    if (StopRequest* stop = target.load()) stop->interrupt();
}

void install(void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART | (handler == SIG_DFL ? 0 : static_cast<int>(SA_RESETHAND));
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

SignalGuard::SignalGuard(StopRequest& stop) {
    last_signal = 0;
    target = &stop;
    install(on_signal);
}

SignalGuard::~SignalGuard() {
    install(SIG_DFL);
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
