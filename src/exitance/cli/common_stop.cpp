#include "exitance/cli/common_stop.hpp"

#include "exitance/cli/processes.hpp"
#include "exitance/processes/result_of_all.hpp"

namespace exitance {

CommonStop::CommonStop(Terminal& terminal, StopRequest& asked)
    : terminal_(terminal), asked_(asked), together_(asked, agreed_) {
    terminal.limits().watch_memory_of_several();
}

std::optional<ExitCode> CommonStop::signal() const {
    return signal_of_any(terminal_.limits().signal());
}

std::string CommonStop::reason() const {
    const bool is_own = asked_.requested();
    const Error own{ErrorCode::limit, terminal_.limits().reason(), "", ""};
    const Result<void> all = result_of_all(is_own ? Result<void>(own) : Result<void>());
    return all ? own.message : all.error().message;
}

ExitCode CommonStop::fail(const std::string& message) const {
    if (const std::optional<ExitCode> received = signal()) return *received;
    const Error own = terminal_.limits().error(message);
    const Result<void> all = result_of_all(asked_.requested() ? Result<void>(own) : Result<void>());
    return terminal_.fail(all ? own : all.error());
}

}  // namespace exitance
