#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "exitance/cli/arguments.hpp"
#include "exitance/cli/signals.hpp"
#include "exitance/cli/terminal.hpp"
#include "exitance/cli/verbs.hpp"

int main(int argc, char** argv) {
    using namespace exitance;
    leave_at_signals();
    const std::vector<std::string> arguments(argv + 1, argv + std::max(argc, 1));
    const auto parsed = parse_arguments(arguments);
    if (!parsed) return static_cast<int>(Terminal({}).fail(parsed.error()));
    if (const auto* information = std::get_if<Information>(&*parsed)) {
        Terminal terminal({});
        terminal.print(information->text);
        return static_cast<int>(terminal.finish(ExitCode::done));
    }
    const ExitCode code = std::visit(
        [](const auto& command) {
            Terminal terminal(command);
            return terminal.finish(run(command, terminal));
        },
        std::get<Command>(*parsed));
    return static_cast<int>(code);
}
