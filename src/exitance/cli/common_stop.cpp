#include "exitance/cli/common_stop.hpp"

#include "exitance/cli/processes.hpp"
#include "exitance/processes/result_of_all.hpp"

namespace exitance {

CommonStop::CommonStop(Terminal& terminal, StopRequest& asked, MemoryLimit memory)
    : terminal_(terminal), asked_(asked), together_(asked, agreed_) {
    if (memory == MemoryLimit::watched) terminal.limits().watch_memory_of_several();
}

std::optional<ExitCode> CommonStop::signal() const {
    return signal_of_any(terminal_.limits().signal());
}

StopReason CommonStop::reason() const {
    const StopReason own = terminal_.limits().reason();
    const Error stopped{ErrorCode::limit, std::string(name_of(own)), "", ""};
    const Result<void> all = result_of_all(asked_.requested() ? Result<void>(stopped) : Result<void>());
    return all ? own : stop_reason_of(all.error().message);
}

ExitCode CommonStop::fail(const std::string& message) const {
    if (const std::optional<ExitCode> received = signal()) return *received;
    const Error own = terminal_.limits().error(message);
    const Result<void> all = result_of_all(asked_.requested() ? Result<void>(own) : Result<void>());
    return terminal_.fail(all ? own : all.error());
}

}  // namespace exitance
