#include <algorithm>
#include <filesystem>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <type_traits>
#include <variant>
#include <vector>

#include "exitance/base/memory.hpp"
#include "exitance/base/processor.hpp"
#include "exitance/cli/options/arguments.hpp"
#include "exitance/cli/processes.hpp"
#include "exitance/cli/signals.hpp"
#include "exitance/cli/terminal.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/lab/laboratory.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {
namespace {

template <class Arguments, class... Supported>
constexpr bool is_one_of = (std::is_same_v<Arguments, Supported> || ...);
/// True for the arguments of verbs that may be started as several processes.
template <class Arguments>
constexpr bool supports_processes = is_one_of<Arguments, SolveArguments, ProbeArguments, RenderArguments, BakeArguments,
                                              DaylightArguments, ViewFactorArguments, ExperimentArguments>;

int run_program(const std::vector<std::string>& arguments) {
    const auto parsed = parse_arguments(arguments);
    if (!parsed) return static_cast<int>(Terminal({}).fail(parsed.error()));
    if (const auto* information = std::get_if<Information>(&*parsed)) {
        Terminal terminal({});
        terminal.print(information->text);
        return static_cast<int>(terminal.finish(ExitCode::done));
    }
    const ExitCode code = std::visit(
        []<class Arguments>(const Arguments& command) {
            Terminal terminal(command);
            if (processes() > 1 && !supports_processes<Arguments>)
                return terminal.fail({ErrorCode::usage,
                                      "starts several processes, which only solve, probe, render, bake, daylight, "
                                      "viewfactors and experiment support",
                                      "mpirun", "run the other verbs without mpirun"});
            const ExitCode code = run(command, terminal);
            if (code == ExitCode::done && !is_one_of<Arguments, SolveArguments, ExperimentArguments>)
                note_division(terminal.progress());
            return terminal.finish(code);
        },
        std::get<Command>(*parsed));
    return static_cast<int>(code);
}

}  // namespace
}  // namespace exitance

int main(int argc, char** argv) {
    using namespace exitance;
    leave_at_signals();
    install_laboratory();
    if (const std::optional<Error> error = processor_error()) return static_cast<int>(Terminal({}).fail(*error));
    keep_large_arrays_apart();
    if (const Result<void> joined = join_processes(); !joined)
        return static_cast<int>(Terminal({}).fail(joined.error()));
    try {
        std::vector<std::string> words(argv + 1, argv + std::max(argc, 1));
        // Called as View3D's program, it takes that program's arguments.
        if (argc > 0 && std::filesystem::path(argv[0]).filename() == "view3d") words.insert(words.begin(), "view3d");
        const int status = run_program(words);
        leave_processes();
        return status;
    } catch (const std::system_error& failure) {  // error of output that was written directly to standard output
        return static_cast<int>(Terminal({}).fail({ErrorCode::cannot_write, failure.what(), "standard output", ""}));
    } catch (const std::bad_alloc&) {
        return static_cast<int>(Terminal({}).fail({ErrorCode::limit, "the system has no more memory", "",
                                                   "allow a larger --error, or see what `solve --dry-run` forecasts"}));
    }
}
