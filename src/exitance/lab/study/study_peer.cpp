#include "exitance/lab/study/study_peer.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "exitance/base/random.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/lab/peers/peers.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

std::string options_of(const StudySolve& run) {
    return filled_in(run.row.options, {{"value", fmt::format("{:g}", run.value)}, {"setting", run.setting}});
}

Table unfinished(const StudySolve& run, const std::string& status) {
    Table table{result_columns, {}};
    begin_row(table, run, 1);
    table.set("method", run.row.peer), table.set("is_last", "1"), table.set("status", status);
    return table;
}

std::string last_line(const std::string& text) {
    const std::size_t end = text.find_last_not_of(" \n");
    if (end == std::string::npos) return "it ended without output";
    const std::size_t begin = text.find_last_of('\n', end);
    return text.substr(begin == std::string::npos ? 0 : begin + 1, end - begin);
}

Table measured(const StudySolve& run, const Scene& scene, const ProgramRun& program, const Result<PeerLight>& light) {
    const ReferencePoints& reference = *run.stage.reference;
    if (program.out_of_time) return unfinished(run, "time limit");
    if (program.status != 0) return unfinished(run, "failed: " + last_line(program.err));
    if (!light) return unfinished(run, "failed: " + light.error().message);
    if (light->irradiance.size() != reference.points.size())
        return unfinished(run, fmt::format("failed: it printed light at {} points instead of {}",
                                           light->irradiance.size(), reference.points.size()));
    Table table = unfinished(run, "done");
    add_error(table, error_against(light->irradiance, reference, scene));
    table.set("seconds", field(light->seconds.value_or(program.seconds)));
    table.set("processor_seconds", field(program.processor_seconds));
    table.set("wall_seconds", field(program.seconds)), table.set("peak_bytes", std::to_string(program.peak_bytes));
    table.set("command", fmt::format("{}: {}", run.row.peer, options_of(run)));
    return table;
}

}  // namespace

Result<std::optional<Table>> peer_for_study(const StudySolve& run, std::mutex& files, const StopRequest& stop) {
    const Peer& peer = *find_peer(run.row.peer);
    if (!is_program(std::string(peer.program)))
        return std::optional(unfinished(run, fmt::format("not run: there is no '{}'", peer.program)));
    if (!run.stage.reference) return std::optional(unfinished(run, "not run: the study has no reference"));
    const fs::path folder = run.options.folder;
    const std::string name =
        fmt::format("{}_{}_{:016x}", run.scene.name, run.row.peer,
                    hash(run.stage.key, key_of(options_of(run)), static_cast<std::uint64_t>(run.study.threads)));
    const std::string record = (folder / "runs" / (name + ".csv")).string();
    if (fs::exists(record))
        if (Result<Table> before = read_csv(record)) return std::optional(std::move(*before));
    const CheckedScene checked = load_scene({run.stage.path}, {});
    if (!checked.scene) return checked.scene.error();
    const PeerScene scene = peer_scene(*checked.scene, *run.stage.reference);
    const std::string work = fs::absolute(folder / "work" / name).string();
    std::error_code failed;
    fs::create_directories(work, failed);
    if (failed) return Error{ErrorCode::cannot_write, failed.message(), work, ""};
    const PeerTask task{scene, split_words(options_of(run)), run.study.threads, work};
    const Result<std::vector<std::string>> words = peer.prepare(task);
    if (!words) return words.error();
    const std::string input = peer.input.empty() ? "" : fmt::format("{}/{}", work, peer.input);
    const ProgramRun program = run_program(*words, work, study_time_limit(run), stop, input);
    if (stop.requested()) return std::optional<Table>();
    Table table = measured(run, *checked.scene, program, peer.read(task, program));
    fs::remove_all(work, failed);
    const std::lock_guard lock(files);
    if (const Result<void> written = write_csv(record, table); !written) return written.error();
    return std::optional(std::move(table));
}

}  // namespace exitance
