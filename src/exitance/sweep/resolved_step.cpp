#include "exitance/sweep/resolved_step.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glob.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>

#include "exitance/base/version.hpp"
#include "exitance/io/files/sha256.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/sweep/sweep_template.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t key_digits = 40;  ///< 160 bits of SHA-256 name the folder of a step.
constexpr std::string_view own_folder = "{dir}";
/// Names of the files that the sweep itself writes into folders of steps and variants.
constexpr std::array<std::string_view, 5> reserved_names{"status.txt", "stdout.txt", "stderr.txt", "failure.json",
                                                         "variant.json"};

Error plan_error(const SweepPlan& plan, int line, std::string message, std::string hint = "") {
    return {ErrorCode::bad_input, std::move(message), fmt::format("{}:{}", plan.path, line), std::move(hint)};
}

/// True if `path` is `folder` or below it.
bool is_in(const std::string& path, const std::string& folder) {
    return path == folder || (path.starts_with(folder) && path[folder.size()] == '/');
}

/// True for "-o" and for short options that end with it, such as "-vo".
bool is_short_output(const std::string& word) {
    return word.size() > 1 && word.front() == '-' && word.find_first_not_of("qv", 1) == word.size() - 1 &&
           word.back() == 'o';
}

/// The value of an option such as --output=FILE or -oFILE in one word.
std::optional<std::string> attached_output(const std::string& word) {
    constexpr std::string_view long_name = "--output=";
    if (word.starts_with(long_name)) return word.substr(long_name.size());
    const std::size_t letter = word.starts_with('-') ? word.find_first_not_of("qv", 1) : std::string::npos;
    if (letter == std::string::npos || word[letter] != 'o' || letter + 1 == word.size()) return std::nullopt;
    return word.substr(letter + 1);
}

/// The steps of a variant so far, and the step that writes each file.
class StepChain {
  public:
    StepChain(const SweepPlan& plan, const SweepSetting& variant, InputHashes& hashes)
        : plan_(plan), variant_(variant), hashes_(hashes) {}

    Result<void> add_template();
    Result<void> add(const SweepStep& step);
    /// The last step that makes the file `path` below {dir}.
    std::optional<std::size_t> maker_of(const std::string& path) const;
    std::vector<ResolvedStep> steps;

  private:
    /// A word of a command with its paths below {dir}.
    struct Word {
        std::string command;               ///< The command as the program runs it.
        std::string hashed;                ///< The command as it is hashed, without the folder of the sweep.
        std::vector<std::string> outputs;  ///< Paths that no earlier step makes.
    };
    Result<Word> connect(const std::string& word, bool is_output, const SweepStep& step) const;
    Result<void> check_output(const std::string& word, const SweepStep& step) const;
    /// True if a step makes the file `path` below {dir}, apart from files in folders that it makes.
    bool has_file(const std::string& path) const;
    std::size_t path_end(const std::string& word, std::size_t begin, bool is_output) const;
    Result<std::string> checked_path(const std::string& text, const SweepStep& step) const;
    Result<void> add_inputs(const SweepStep& step, ResolvedStep& out);

    const SweepPlan& plan_;
    const SweepSetting& variant_;
    InputHashes& hashes_;
};

std::optional<std::size_t> StepChain::maker_of(const std::string& path) const {
    for (std::size_t i = steps.size(); i-- > 0;) {
        for (const std::string& output : steps[i].outputs)
            if (is_in(path, output)) return i;
        for (const auto& [name, unused] : steps[i].texts)
            if (path == name) return i;
    }
    return std::nullopt;
}

/// Error unless the value of -o is a path below {dir}, or standard output.
Result<void> StepChain::check_output(const std::string& word, const SweepStep& step) const {
    if (word == "-") return {};
    if (word.starts_with("{dir}/") && !path_in_folder(word.substr(own_folder.size())).empty()) return {};
    return plan_error(plan_, step.line,
                      fmt::format("'run' of step '{}' writes {}, which is not below {{dir}}", step.name, word),
                      "write into the variant's folder, such as -o {dir}/room.h5");
}

bool StepChain::has_file(const std::string& path) const {
    return std::any_of(steps.begin(), steps.end(), [&](const ResolvedStep& step) {
        const auto is_text = [&](const auto& text) { return text.first == path; };
        return std::find(step.outputs.begin(), step.outputs.end(), path) != step.outputs.end() ||
               std::any_of(step.texts.begin(), step.texts.end(), is_text);
    });
}

/// End of the path whose "{dir}" ends at `begin` of a word. The value of -o is one path. Elsewhere commas and
/// semicolons separate paths, and so do blanks, unless an earlier step makes a file with such a name.
std::size_t StepChain::path_end(const std::string& word, std::size_t begin, bool is_output) const {
    if (is_output) return word.size();
    const std::size_t last = std::min(word.find(own_folder, begin), word.size());
    for (std::size_t end = last; end != std::string::npos && end > begin; end = word.find_last_of(",; ", end - 1))
        if (has_file(path_in_folder(word.substr(begin, end - begin)))) return end;
    return std::min(word.find_first_of(",;", begin), last);
}

/// The path below {dir} that is written as `text`, such as "/light.csv", in the command of a step.
Result<std::string> StepChain::checked_path(const std::string& text, const SweepStep& step) const {
    const std::string path = text.starts_with('/') ? path_in_folder(text) : "";
    if (path.empty())
        return plan_error(
            plan_, step.line,
            fmt::format("'run' of step '{}' has {{dir}}{}, which is not a file below {{dir}}", step.name, text),
            "name a file in it, such as {dir}/room.h5");
    const auto is_reserved = std::find(reserved_names.begin(), reserved_names.end(), path) != reserved_names.end();
    if (is_reserved || path.find(own_folder) != std::string::npos)
        return plan_error(plan_, step.line,
                          fmt::format("'run' of step '{}' has {{dir}}{}, a name that is not possible", step.name, text),
                          fmt::format("choose another name than {}", fmt::join(reserved_names, ", ")));
    return path;
}

Result<StepChain::Word> StepChain::connect(const std::string& word, bool is_output, const SweepStep& step) const {
    Word out;
    for (std::size_t at = 0; at < word.size();) {
        const std::size_t begin = std::min(word.find(own_folder, at), word.size());
        out.command += word.substr(at, begin - at), out.hashed += word.substr(at, begin - at);
        if (begin == word.size()) break;
        const std::size_t text_begin = begin + own_folder.size(), end = path_end(word, text_begin, is_output);
        const Result<std::string> path = checked_path(word.substr(text_begin, end - text_begin), step);
        if (!path) return path.error();
        const std::optional<std::size_t> maker = maker_of(*path);
        if (maker && is_output)
            return plan_error(plan_, step.line,
                              fmt::format("step '{}' writes {{dir}}/{}, which is a file of step '{}'", step.name, *path,
                                          steps[*maker].name),
                              "choose another name: finished steps never change");
        if (maker) {
            out.command += (fs::path(step_folder(plan_)) / steps[*maker].key / *path).string();
            out.hashed += fmt::format("{}/{}", steps[*maker].key, *path);
        } else {
            const std::string own = fmt::format("{}/{}", own_folder, *path);
            out.command += own, out.hashed += own;
            out.outputs.push_back(*path);
        }
        at = end;
    }
    return out;
}

/// Adds the files under the key 'inputs' of a step.
Result<void> StepChain::add_inputs(const SweepStep& step, ResolvedStep& out) {
    const Result<std::vector<std::string>> patterns = fill_in(plan_, step.inputs, variant_, step.line);
    if (!patterns) return patterns.error();
    for (const std::string& pattern : *patterns) {
        glob_t found{};
        ::glob((fs::path(plan_.base) / pattern).c_str(), 0, nullptr, &found);
        const std::vector<std::string> files(found.gl_pathv, found.gl_pathv + found.gl_pathc);
        ::globfree(&found);
        if (files.empty())
            return plan_error(plan_, step.line,
                              fmt::format("'inputs' of step '{}': there is no file {}", step.name, pattern));
        for (const std::string& file : files) {
            const Result<std::string> content = hashes_.of(file);
            if (!content) return content.error();
            out.inputs.push_back({file, *content});
        }
    }
    return {};
}

Result<void> StepChain::add(const SweepStep& step) {
    const Result<std::vector<std::string>> words = fill_in(plan_, step.words, variant_, step.line);
    if (!words) return words.error();
    ResolvedStep out{step.name, "", {}, {}, step.accepted, {}, {}};
    Sha256 hash;
    hash.add_text(program_version);
    bool is_output = false;  // the word is the value of -o
    for (const std::string& word : *words) {
        const std::optional<std::string> output = is_output ? word : attached_output(word);
        if (output)
            if (const Result<void> below = check_output(*output, step); !below) return below.error();
        const Result<Word> connected = connect(word, output.has_value(), step);
        if (!connected) return connected.error();
        out.words.push_back(connected->command);
        out.outputs.insert(out.outputs.end(), connected->outputs.begin(), connected->outputs.end());
        hash.add_text(connected->hashed);
        if (word.find(own_folder) == std::string::npos) {
            const Result<std::vector<HashedFile>> inputs = hashes_.of_word(word, plan_.base);
            if (!inputs) return inputs.error();
            out.inputs.insert(out.inputs.end(), inputs->begin(), inputs->end());
        }
        is_output = !is_output && (word == "--output" || is_short_output(word));
    }
    if (const Result<void> added = add_inputs(step, out); !added) return added.error();
    for (const HashedFile& input : out.inputs) hash.add_text(input.hash);
    // The program writes a material file next to a generated scene.
    if (out.words.front() == "generate")
        for (std::size_t i = 0, n = out.outputs.size(); i < n; ++i)
            out.outputs.push_back(fs::path(out.outputs[i]).replace_extension(".mtl").string());
    out.key = hash.finish().substr(0, key_digits);
    steps.push_back(std::move(out));
    return {};
}

Result<void> StepChain::add_template() {
    ResolvedStep out{"scene", "", {}, {}, {0}, {}, {}};
    const auto add = [&](const std::string& path, const std::string& name, bool has_placeholders) -> Result<void> {
        const bool is_known =
            std::any_of(out.texts.begin(), out.texts.end(), [&](const auto& t) { return t.first == name; });
        if (is_known) return {};
        const Result<std::string> content = read_whole_file(path);
        if (!content) return content.error();
        const Result<std::string> filled =
            has_placeholders ? fill_in_template(plan_, variant_, path, *content) : *content;
        if (!filled) return filled.error();
        out.texts.emplace_back(name, *filled);
        return {};
    };
    for (const std::string& file : plan_.scene_template.files)
        if (const Result<void> added =
                add((fs::path(plan_.base) / file).string(), fs::path(file).filename().string(), true);
            !added)
            return added.error();
    for (const std::string& file : plan_.scene_template.files) {
        const fs::path path = fs::path(plan_.base) / file;
        const Result<std::vector<std::string>> named = files_named_by(path.string());
        if (!named) return named.error();
        for (const std::string& other : *named) {
            const std::string name = fs::path(other).lexically_relative(path.parent_path()).string();
            if (name.starts_with("..") || other == path.string()) continue;
            if (const Result<void> added = add(other, name, false); !added) return added.error();
        }
    }
    Sha256 hash;
    for (const auto& [name, content] : out.texts) hash.add_text(name), hash.add_text(content);
    out.key = hash.finish().substr(0, key_digits);
    steps.push_back(std::move(out));
    return {};
}

}  // namespace

std::string step_folder(const SweepPlan& plan) {
    return (fs::path(plan.folder) / "steps").string();
}

Result<ResolvedVariant> resolve_variant(const SweepPlan& plan, std::size_t index, InputHashes& hashes) {
    StepChain chain(plan, plan.variants[index], hashes);
    if (!plan.scene_template.files.empty())
        if (const Result<void> added = chain.add_template(); !added) return added.error();
    for (const SweepStep& step : plan.steps)
        if (const Result<void> added = chain.add(step); !added) return added.error();
    ResolvedVariant out;
    for (const SweepOutput& output : plan.outputs) {
        std::optional<std::size_t> step;
        if (!output.step.empty()) {
            const auto named = std::find_if(chain.steps.begin(), chain.steps.end(), [&](const ResolvedStep& s) {
                return s.name == output.step && !s.words.empty();
            });
            step = static_cast<std::size_t>(named - chain.steps.begin());
        } else {
            step = chain.maker_of(output.file);
        }
        if (!step)
            return plan_error(
                plan, output.line,
                fmt::format("no step writes {{dir}}/{}, the 'file' of output '{}'", output.file, output.name));
        out.output_steps.push_back(*step);
    }
    out.steps = std::move(chain.steps);
    return out;
}

}  // namespace exitance
