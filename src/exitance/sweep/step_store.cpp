#include "exitance/sweep/step_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "exitance/base/words.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/child_process.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/files/write_error.hpp"
#include "exitance/sweep/step_record.hpp"
#include "exitance/sweep/sweep_json.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

constexpr const char *output_file = "stdout.txt", *error_file = "stderr.txt", *failure_file = "failure.json";
constexpr int max_replacements = 3;  ///< Attempts to replace a folder that other processes write, too.

/// Makes the folder of the file `path` below `work`.
Result<void> make_parent(const std::string& work, const std::string& path) {
    std::error_code failed;
    const fs::path parent = (fs::path(work) / path).parent_path();
    fs::create_directories(parent, failed);
    if (failed) return cannot_write(parent.string(), failed.value());
    return {};
}

/// Returns the line of an error stream that states why the program failed: its first error, otherwise its last line.
std::string reason_in(const std::string& text, int status) {
    std::string last;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string line = text.substr(at, end - at);
        if (line.starts_with("error: ")) return line.substr(line.find(' ') + 1);
        if (!line.empty()) last = line;
        at = end + 1;
    }
    if (status >= 1000) return fmt::format("signal {} ended it", status - 1000);
    return last.empty() ? fmt::format("it ended with status {}", status) : last;
}

/// The first input whose content is no longer the one that the key of the step is made of; empty if there is none.
std::string changed_input(const ResolvedStep& step) {
    InputHashes hashes;
    for (const HashedFile& input : step.inputs)
        if (const Result<std::string> hash = hashes.of(input.path); !hash || *hash != input.hash) return input.path;
    return "";
}

/// The command of a step that writes into the folder `work`.
std::vector<std::string> command_of(const ResolvedStep& step, const std::string& program, const std::string& work,
                                    const StepRunner& runner) {
    std::vector<std::string> words{program};
    for (const std::string& word : step.words) words.push_back(filled_in(word, {{"dir", work}}));
    const bool chooses_threads =
        std::any_of(words.begin(), words.end(), [](const std::string& word) { return word.starts_with("--threads"); });
    if (runner.threads > 0 && !chooses_threads && runner.threaded.contains(step.words.front()))
        words.insert(words.end(), {"--threads", std::to_string(runner.threads)});
    return words;
}

/// Replaces the folder `from` in a text of a program by `to`, another folder in the same one. The name of `from` is
/// unique, so that its path is found however it is written.
std::string with_folder(std::string text, const std::string& from, const std::string& to) {
    const std::string before = fs::path(from).filename().string(), now = fs::path(to).filename().string();
    for (std::size_t at = text.find(before); at != std::string::npos; at = text.find(before, at + now.size()))
        text.replace(at, before.size(), now);
    return text;
}

/// Reason for which a run of a step's command has failed; empty if it has not.
std::string failure_of(const ResolvedStep& step, const ProgramRun& run) {
    if (std::find(step.accepted.begin(), step.accepted.end(), run.status) == step.accepted.end())
        return run.status < 0 ? "the program cannot be started" : reason_in(run.err, run.status);
    const std::string input = changed_input(step);
    return input.empty() ? "" : fmt::format("{} changed after its content was hashed: run it again", input);
}

}  // namespace

std::string StepStore::path(const ResolvedStep& step) const {
    return (fs::path(folder_) / step.key).string();
}

/// Path of a step's unfinished folder, without the name of its lock.
std::string StepStore::unfinished_path(const ResolvedStep& step) const {
    return (fs::path(folder_) / ("." + step.key)).string();
}

bool StepStore::is_finished(const ResolvedStep& step) const {
    const std::optional<StepCondition> condition = step_condition(path(step));
    return condition && condition->damage.empty() &&
           std::find(step.accepted.begin(), step.accepted.end(), condition->status) != step.accepted.end();
}

std::string StepStore::damage(const ResolvedStep& step) const {
    const std::optional<StepCondition> condition = step_condition(path(step));
    return condition ? condition->damage : "";
}

bool StepStore::is_running(const ResolvedStep& step) const {
    return StepLock::is_held(lock_path(step));
}

std::optional<StepFailure> StepStore::failure(const ResolvedStep& step) const {
    const Result<std::string> text = read_whole_file((fs::path(failure_path(step)) / failure_file).string());
    if (!text) return std::nullopt;
    return parse_failure(*text);
}

/// Renames the finished folder `work` to its final name. A folder of that name was finished by another process whose
/// lock was lost, or with an exit status that is no longer accepted, or is damaged.
Result<void> StepStore::keep(const ResolvedStep& step, const std::string& work) const {
    std::error_code failed;
    for (int attempt = 0; attempt < max_replacements; ++attempt) {
        fs::rename(work, path(step), failed);
        if (!failed) return {};
        if (is_finished(step)) return {};
        std::error_code ignored;
        fs::remove_all(path(step), ignored);
    }
    return cannot_write(path(step), failed.value());
}

/// Keeps the folder `work` of a failed step with the reason.
Result<StepStore::Outcome> StepStore::fail(const ResolvedStep& step, const std::string& work,
                                           const StepFailure& failure) const {
    const Result<void> told = write_file((fs::path(work) / failure_file).string(), failure_json(failure));
    if (!told) return told.error();
    std::error_code failed;
    fs::remove_all(failure_path(step), failed);
    fs::rename(work, failure_path(step), failed);
    if (failed) return cannot_write(failure_path(step), failed.value());
    return Outcome::failed;
}

/// Writes the files from templates, and the folders of the files that the command writes.
Result<void> StepStore::prepare(const ResolvedStep& step, const std::string& work) const {
    for (const auto& [name, content] : step.texts) {
        if (const Result<void> made = make_parent(work, name); !made) return made.error();
        if (const Result<void> written = write_file((fs::path(work) / name).string(), content); !written)
            return written.error();
    }
    for (const std::string& output : step.outputs)
        if (const Result<void> made = make_parent(work, output); !made) return made.error();
    return {};
}

Result<StepStore::Outcome> StepStore::run_command(const ResolvedStep& step, const std::string& work,
                                                  const StepRunner& runner, const StopRequest& stop) const {
    int status = 0;
    if (const Result<void> prepared = prepare(step, work); !prepared) return prepared.error();
    if (!step.words.empty()) {
        const ProgramRun run =
            run_program(command_of(step, runner.program, work, runner), runner.base, stop.seconds_left(), stop);
        if (stop.requested()) return Outcome::stopped;
        const std::string failure = failure_of(step, run);
        const std::string final_path = failure.empty() ? path(step) : failure_path(step);
        for (const auto& [name, text] : {std::pair(output_file, &run.out), std::pair(error_file, &run.err)})
            if (const Result<void> written =
                    write_file((fs::path(work) / name).string(), with_folder(*text, work, final_path));
                !written)
                return written.error();
        if (!failure.empty())
            return fail(step, work,
                        {run.status, with_folder(failure, work, final_path),
                         shell_text(command_of(step, "exitance", final_path, runner))});
        status = run.status;
    }
    if (const Result<void> written = write_step_record(work, status); !written) return written.error();
    if (const Result<void> kept = keep(step, work); !kept) return kept.error();
    return Outcome::finished;
}

Result<StepStore::Outcome> StepStore::run(const ResolvedStep& step, const StepRunner& runner, const StopRequest& stop) {
    if (is_finished(step)) return Outcome::was_finished;
    std::error_code failed;
    fs::create_directories(folder_, failed);
    if (failed) return cannot_write(folder_, failed.value());
    const Result<std::optional<StepLock>> lock = StepLock::take(lock_path(step), unfinished_path(step), renewal_);
    if (!lock) return lock.error();
    if (!*lock) return Outcome::busy;
    if (is_finished(step)) return Outcome::was_finished;
    fs::remove_all(failure_path(step), failed);
    const std::string work = fmt::format("{}.{}", unfinished_path(step), (*lock)->token());
    fs::create_directories(work, failed);
    if (failed) return cannot_write(path(step), failed.value());
    Result<Outcome> outcome = run_command(step, work, runner, stop);
    fs::remove_all(work, failed);
    if (outcome) return outcome;
    Error error = outcome.error();
    error.where = with_folder(error.where, work, path(step));
    return error;
}

}  // namespace exitance
