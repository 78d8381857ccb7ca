#include "exitance/cli/processes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "exitance/base/archive.hpp"
#include "exitance/base/memory.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/io/solution/solution_groups.hpp"
#include "exitance/methods/options/support.hpp"
#include "exitance/methods/plan/choice.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {

Result<void> check_processes(const SolveArguments& arguments) {
    if (processes() == 1) return {};
    const SolveOptions& o = arguments.options;
    const bool own_choice = o.method == Method::automatic;
    if (o.method == Method::hierarchical && !runs_over_processes(o.method, o))
        return Error{
            ErrorCode::usage,
            "hierarchical does not run over several processes with links that are refined pair by pair", "--method",
            "leave out --basis, --epsilon, --oracle, --importance, --output-light, --triage, --visibility, --clusters "
            "and --min-area, or use --method matrix"};
    if (!own_choice && !runs_over_processes(o.method, o))
        return Error{ErrorCode::usage,
                     std::string(name_in(method_names, o.method)) + " does not run over several processes", "--method",
                     "use matrix (auto selects it), or hierarchical with links found by rays"};
    return check_one_process(arguments);
}

LoadedScene load_for_all(const SceneArguments& scene) {
    if (processes() == 1) return load_scene(scene.files, scene.load);
    LoadedScene checked{{Error{}, {}}, {}};
    if (is_first_process()) checked = load_scene(scene.files, scene.load);
    const Result<void> read =
        by_first([&] { return checked.scene ? Result<void>() : Result<void>(checked.scene.error()); });
    if (!read) {
        checked.scene = read.error();
        return checked;
    }
    const std::string bytes =
        as_first(is_first_process() ? StoredScene::bytes_of(*checked.scene) : std::string(), "scene");
    if (!is_first_process()) checked.scene = StoredScene::from_bytes(bytes);
    ArchiveWriter own;
    own(checked.reflectance_deviation, checked.origin);
    const std::string rest = as_first(own.take(), "scene");
    ArchiveReader reader(rest);
    reader(checked.reflectance_deviation, checked.origin);
    return checked;
}

std::optional<ExitCode> signal_of_any(std::optional<ExitCode> own) {
    const double any = largest_of_all(own ? static_cast<double>(*own) : 0);
    return any > 0 ? std::optional(static_cast<ExitCode>(static_cast<int>(any))) : std::nullopt;
}

void record_processes(SolveStatistics& statistics) {
    const auto own = static_cast<double>(peak_memory_bytes());
    if (processes() == 1) return;
    statistics.peak_memory_bytes = static_cast<std::size_t>(largest_of_all(own));
    statistics.processes = processes();
    auto& figures = statistics.figures;
    figures["peak_memory_bytes_of_all"] = sum_of_all(own);
    figures["shared_memory_bytes"] = largest_of_all(static_cast<double>(shared_memory_bytes()));
    const ExchangeTime time = exchange_time();
    figures["waiting_seconds_of_all"] = sum_of_all(time.waiting);
    figures["sending_seconds_of_all"] = sum_of_all(time.sending);
    const std::map<std::string, Traffic> sent = traffic();
    double messages = 0, bytes = 0;
    for (const auto& [what, t] : sent) {
        std::string name = what;
        std::replace(name.begin(), name.end(), ' ', '_');
        messages += figures["messages_" + name] = sum_of_all(static_cast<double>(t.messages));
        bytes += figures["message_bytes_" + name] = sum_of_all(static_cast<double>(t.bytes));
        if (what != "fetch") continue;
        figures["messages_" + name + "_of_twice"] = sum_of_all(static_cast<double>(t.messages_of_twice));
        figures["message_bytes_" + name + "_of_twice"] = sum_of_all(static_cast<double>(t.bytes_of_twice));
    }
    double longest = 0;
    const std::map<std::string, DealtTime> dealt = dealt_time();
    for (const auto& [what, t] : dealt) {
        std::string name = what;
        std::replace(name.begin(), name.end(), ' ', '_');
        figures["dealt_seconds_" + name] = sum_of_all(t.own);
        longest += figures["longest_seconds_" + name] = t.longest;
        figures["repeated_seconds_" + name] = as_first(t.repeated);
    }
    figures["longest_processor_seconds"] = longest;
    figures["messages"] = messages, figures["message_bytes"] = bytes;
    record_processor_time(statistics);
}

void record_processor_time(SolveStatistics& statistics) {
    const double dealt = result_sharing().dealt_seconds;
    statistics.figures["dealt_processor_seconds"] = sum_of_all(dealt);
    statistics.figures["repeated_processor_seconds"] = as_first(processor_seconds() - dealt);
}

void note_division(Progress& progress) {
    if (processes() == 1) return;
    double longest = 0;
    for (const auto& [what, time] : dealt_time()) longest += time.longest;
    const double dealt = result_sharing().dealt_seconds, repeated = as_first(processor_seconds() - dealt);
    progress.note(fmt::format(
        "{} processes: {:.2f} s of processor time in divided loops, {:.2f} s of the slowest process in each; {:.2f} s "
        "of the first one outside them; at most {:.0f} MB in a process",
        processes(), sum_of_all(dealt), longest, repeated,
        largest_of_all(1e-6 * static_cast<double>(peak_memory_bytes()))));
}

}  // namespace exitance
