#include "exitance/sweep/step_store.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/child_process.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/sweep/sweep_json.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

constexpr const char *status_file = "status.txt", *output_file = "stdout.txt", *error_file = "stderr.txt";
constexpr int max_replacements = 3;  ///< Attempts to replace a folder that other processes write, too.

Error cannot_make(const std::string& path, const std::error_code& reason) {
    return {ErrorCode::cannot_write, fmt::format("cannot be written: {}", reason.message()), path,
            "check the space on the disk and the permissions"};
}

/// Makes the folder of the file `path` below `work`.
Result<void> make_parent(const std::string& work, const std::string& path) {
    std::error_code failed;
    const fs::path parent = (fs::path(work) / path).parent_path();
    fs::create_directories(parent, failed);
    if (failed) return cannot_make(parent.string(), failed);
    return {};
}

/// The line of an error stream that tells why the program failed: its first error, else its last line.
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
std::vector<std::string> command_of(const ResolvedStep& step, const std::string& work, const StepRunner& runner) {
    std::vector<std::string> words{runner.program};
    for (std::string word : step.words) {
        static const std::string mark = "{dir}";
        for (std::size_t at = word.find(mark); at != std::string::npos; at = word.find(mark, at + work.size()))
            word.replace(at, mark.size(), work);
        words.push_back(std::move(word));
    }
    const bool chooses_threads =
        std::any_of(words.begin(), words.end(), [](const std::string& word) { return word.starts_with("--threads"); });
    if (runner.threads > 0 && !chooses_threads && runner.threaded.contains(step.words.front()))
        words.insert(words.end(), {"--threads", std::to_string(runner.threads)});
    return words;
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
    const Result<std::string> status = read_whole_file((fs::path(path(step)) / status_file).string());
    if (!status) return false;
    const int number = std::atoi(status->c_str());
    return std::find(step.accepted.begin(), step.accepted.end(), number) != step.accepted.end();
}

bool StepStore::is_running(const ResolvedStep& step) const {
    return StepLock::is_held(lock_path(step));
}

std::optional<StepFailure> StepStore::failure(const ResolvedStep& step) const {
    const Result<std::string> text = read_whole_file(failure_path(step));
    if (!text) return std::nullopt;
    return parse_failure(*text);
}

/// Renames the finished folder `work` to its final name. A folder of that name was finished by another process whose
/// lock was lost, or with an exit status that is no longer accepted.
Result<void> StepStore::keep(const ResolvedStep& step, const std::string& work) const {
    std::error_code failed;
    for (int attempt = 0; attempt < max_replacements; ++attempt) {
        fs::rename(work, path(step), failed);
        if (!failed) return {};
        if (is_finished(step)) return {};
        std::error_code ignored;
        fs::remove_all(path(step), ignored);
    }
    return cannot_make(path(step), failed);
}

/// Records the failure of a step.
Result<StepStore::Outcome> StepStore::fail(const ResolvedStep& step, int status, const std::string& message) const {
    const StepFailure failure{status, message, fmt::format("{}", fmt::join(step.words, " "))};
    if (const Result<void> told = write_file(failure_path(step), failure_json(failure)); !told) return told.error();
    return Outcome::failed;
}

Result<StepStore::Outcome> StepStore::run_command(const ResolvedStep& step, const std::string& work,
                                                  const StepRunner& runner, const StopRequest& stop) const {
    int status = 0;
    for (const auto& [name, content] : step.texts) {
        if (const Result<void> made = make_parent(work, name); !made) return made.error();
        if (const Result<void> written = write_file((fs::path(work) / name).string(), content); !written)
            return written.error();
    }
    for (const std::string& output : step.outputs)
        if (const Result<void> made = make_parent(work, output); !made) return made.error();
    if (!step.words.empty()) {
        const std::vector<std::string> words = command_of(step, work, runner);
        const ProgramRun run = run_program(words, runner.base, stop.seconds_left(), stop);
        if (stop.requested()) return Outcome::stopped;
        if (std::find(step.accepted.begin(), step.accepted.end(), run.status) == step.accepted.end())
            return fail(step, run.status,
                        run.status < 0 ? "the program cannot be started" : reason_in(run.err, run.status));
        if (const std::string input = changed_input(step); !input.empty())
            return fail(step, run.status, fmt::format("{} changed after its content was hashed: run it again", input));
        status = run.status;
        for (const auto& [name, text] : {std::pair(output_file, &run.out), std::pair(error_file, &run.err)})
            if (const Result<void> written = write_file((fs::path(work) / name).string(), *text); !written)
                return written.error();
    }
    const std::string last = (fs::path(work) / status_file).string();
    if (const Result<void> written = write_file(last, fmt::format("{}\n", status)); !written) return written.error();
    if (const Result<void> kept = keep(step, work); !kept) return kept.error();
    return Outcome::finished;
}

Result<StepStore::Outcome> StepStore::run(const ResolvedStep& step, const StepRunner& runner, const StopRequest& stop) {
    if (is_finished(step)) return Outcome::was_finished;
    std::error_code failed;
    fs::create_directories(folder_, failed);
    if (failed) return cannot_make(folder_, failed);
    const Result<std::optional<StepLock>> lock = StepLock::take(lock_path(step), unfinished_path(step), renewal_);
    if (!lock) return lock.error();
    if (!*lock) return Outcome::busy;
    if (is_finished(step)) return Outcome::was_finished;
    fs::remove(failure_path(step), failed);
    const std::string work = fmt::format("{}.{}", unfinished_path(step), (*lock)->token());
    fs::create_directories(work, failed);
    if (failed) return cannot_make(work, failed);
    const Result<Outcome> outcome = run_command(step, work, runner, stop);
    fs::remove_all(work, failed);
    return outcome;
}

}  // namespace exitance
