#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glob.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "exitance/base/words.hpp"
#include "exitance/io/files/toml_keys.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/sweep/sweep_parameters.hpp"
#include "exitance/sweep/sweep_plan.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::pair<SweepOutput::Take, std::string_view>, 6> take_names{{
    {SweepOutput::Take::value, "value"},
    {SweepOutput::Take::mean, "mean"},
    {SweepOutput::Take::sum, "sum"},
    {SweepOutput::Take::min, "min"},
    {SweepOutput::Take::max, "max"},
    {SweepOutput::Take::all, "all"},
}};

constexpr std::size_t max_folder_name_bytes = 255;  ///< Longest name of a folder.

int line_of(const toml::node& node) {
    return static_cast<int>(node.source().begin.line);
}

/// Files that a pattern names, relative to the plan's folder if the pattern is relative, in alphabetical order.
std::vector<std::string> files_of(const TomlKeys& keys, const toml::node& at, const std::string& pattern,
                                  const std::string& base) {
    glob_t found{};
    const int status = ::glob((fs::path(base) / pattern).c_str(), 0, nullptr, &found);
    std::vector<std::string> out;
    for (std::size_t i = 0; status == 0 && i < found.gl_pathc; ++i) {
        const fs::path path = found.gl_pathv[i];
        out.push_back(fs::path(pattern).is_absolute() ? path.string() : path.lexically_relative(base).string());
    }
    ::globfree(&found);
    if (out.empty()) keys.fail(at, fmt::format("there is no file {}", pattern));
    return out;
}

std::vector<std::string> texts_of(TomlKeys& keys, const std::string& key) {
    std::vector<std::string> texts;
    const toml::node* const node = keys.find(key);
    if (node && node->is_string())
        keys.take(key, texts.emplace_back());
    else if (node)
        keys.take(key, texts);
    return texts;
}

/// Words of a command in the plan.
std::vector<std::string> words_of(const TomlKeys& keys, const toml::node& at, const std::string& command) {
    if (const char quote = open_quote(command); quote != 0)
        keys.fail(at, fmt::format("the command has a quote {} that is not closed", quote),
                  "close it; a word with an apostrophe must be in double quotes");
    return split_words(with_plain_placeholders(command));
}

/// Reads [scene]. Files of a scene are a block of variants.
SweepBlock read_scene(TomlKeys& keys, SweepPlan& plan) {
    std::string generate;
    keys.take("generate", generate);
    plan.scene_template.files = texts_of(keys, "template");
    const std::vector<std::string> patterns = texts_of(keys, "files");
    keys.finish();
    if (!generate.empty() + !plan.scene_template.files.empty() + !patterns.empty() != 1)
        keys.fail(keys.table(), "a scene needs exactly one of 'generate', 'template' and 'files'");
    if (!generate.empty()) {
        SweepStep step{"scene", {"generate"}, {0}, {}, line_of(*keys.find("generate"))};
        for (std::string& word : words_of(keys, *keys.find("generate"), generate))
            step.words.push_back(std::move(word));
        step.words.insert(step.words.end(), {"-o", "{dir}/scene.obj"});
        plan.scene = step.words.back();
        plan.steps.push_back(std::move(step));
    }
    if (!plan.scene_template.files.empty()) {
        plan.scene_template.line = line_of(*keys.find("template"));
        plan.scene = "{dir}/" + fs::path(plan.scene_template.files.front()).filename().string();
    }
    SweepBlock block;
    for (const std::string& pattern : patterns)
        for (const std::string& file : files_of(keys, *keys.find("files"), pattern, plan.base))
            block.push_back({{"scene", {file}}});
    return block;
}

void read_step(TomlKeys& keys, SweepPlan& plan) {
    std::string run;
    keys.need("run", run);
    SweepStep step;
    step.words = words_of(keys, *keys.find("run"), run);
    step.line = line_of(*keys.find("run"));
    if (!step.words.empty() && step.words.front() == "exitance") step.words.erase(step.words.begin());
    if (step.words.empty()) keys.fail(*keys.find("run"), "'run' is empty", "write a verb: run = \"solve {scene} ...\"");
    step.name = step.words.front();
    keys.take("name", step.name);
    if (step.name.empty() || step.name.find('/') != std::string::npos)
        keys.fail(keys.table(), fmt::format("'{}' cannot be the name of a step", step.name),
                  "the output of a step is stored in a file of its name: choose a name without '/'");
    if (const toml::node* const node = keys.find("accept")) {
        std::vector<int> accepted;
        keys.take("accept", accepted);
        if (accepted.empty()) keys.fail(*node, "'accept' lists no exit status");
        step.accepted = accepted;
    }
    for (const std::string& pattern : texts_of(keys, "inputs")) step.inputs.push_back(with_plain_placeholders(pattern));
    for (const SweepStep& other : plan.steps)
        if (other.name == step.name)
            keys.fail(keys.table(), fmt::format("two steps are called '{}'", step.name), "give one of them a 'name'");
    plan.steps.push_back(std::move(step));
}

/// True if an output of the name `list`, with one column per row of its file, makes a column `name`, such as E_1.
bool makes_column(const std::string& list, const std::string& name) {
    const std::size_t digits = list.size() + 1;
    return name.size() > digits && name.starts_with(list) && name[list.size()] == '_' &&
           name.find_first_not_of("0123456789", digits) == std::string::npos;
}

/// Fails if the table of results would have two columns of one name.
void check_columns(const TomlKeys& keys, const SweepOutput& output, const SweepPlan& plan) {
    if (output.name.empty()) keys.fail(keys.table(), "the 'name' of an output is empty");
    std::vector<SweepOutput> others = plan.outputs;
    for (const std::string& name : plan.parameters) others.emplace_back().name = name;
    for (const char* const name : {"variant", "state"}) others.emplace_back().name = name;
    using Take = SweepOutput::Take;
    for (const SweepOutput& other : others) {
        if (other.name == output.name)
            keys.fail(keys.table(), fmt::format("two columns would be called '{}'", output.name));
        if ((output.take == Take::all && makes_column(output.name, other.name)) ||
            (other.take == Take::all && makes_column(other.name, output.name)))
            keys.fail(
                keys.table(),
                fmt::format("the columns of the outputs '{}' and '{}' would have equal names", other.name, output.name),
                "take = \"all\" adds _1, _2, ... to the name of an output: rename one of the two");
    }
}

void read_output(TomlKeys& keys, SweepPlan& plan) {
    SweepOutput output;
    output.line = line_of(keys.table());
    keys.need("name", output.name);
    keys.take("step", output.step);
    keys.take("file", output.file);
    keys.take("json", output.json);
    keys.take("column", output.column);
    keys.take("row", output.row);
    keys.take_choice("take", take_names, output.take);
    if (output.step.empty() == output.file.empty())
        keys.fail(keys.table(), "an output needs either 'file' or 'step'",
                  "file = \"light.csv\" is a file in {dir}, and step = \"solve\" what the step prints");
    if (output.json.empty() == output.column.empty())
        keys.fail(keys.table(), "an output needs either 'json' or 'column'");
    if (output.row == 0) keys.fail(*keys.find("row"), "rows are counted from 1");
    if (const std::string path = path_in_folder(output.file); output.step.empty() && path.empty())
        keys.fail(*keys.find("file"), fmt::format("'{}' is not below {{dir}}", output.file),
                  "name a file that a step writes: file = \"light.csv\" is {dir}/light.csv");
    else
        output.file = path;
    check_columns(keys, output, plan);
    const auto step =
        std::find_if(plan.steps.begin(), plan.steps.end(), [&](const SweepStep& s) { return s.name == output.step; });
    if (!output.step.empty() && step == plan.steps.end()) {
        std::vector<std::string> names;
        for (const SweepStep& s : plan.steps) names.push_back(s.name);
        keys.fail(*keys.find("step"), fmt::format("there is no step '{}'", output.step),
                  fmt::format("the steps are {}", fmt::join(names, ", ")));
    }
    if (!output.step.empty() && !output.json.empty() &&
        std::find(step->words.begin(), step->words.end(), "--json") == step->words.end())
        keys.fail(*keys.find("step"), fmt::format("the step '{}' prints no JSON", output.step),
                  "add --json to its 'run'");
    plan.outputs.push_back(std::move(output));
}

/// Hint for an error of the TOML parser.
std::string hint_for(std::string_view description) {
    const bool is_repeated = description.find("redefine") != std::string_view::npos;
    for (const char* const key : {"vary", "step", "output"})
        if (is_repeated && description.find(fmt::format("'{}'", key)) != std::string_view::npos)
            return fmt::format("a plan may have several such tables: write each as [[{0}]], not as [{0}]", key);
    return "plans are written in TOML";
}

SweepPlan read_plan(const toml::table& table, const std::string& path) {
    SweepPlan plan;
    std::error_code ignored;
    plan.path = path;
    plan.base = fs::absolute(fs::path(path), ignored).lexically_normal().parent_path().string();
    TomlKeys keys(table, path);
    std::string folder = fs::path(path).stem().string() + ".sweep";
    keys.take("title", plan.title);
    keys.take("folder", folder);
    plan.folder = (fs::path(plan.base) / folder).lexically_normal().string();
    for (const fs::path& part : fs::path(folder))
        if (part.string().size() > max_folder_name_bytes)
            keys.fail(table,
                      fmt::format("the name of the folder of the results has {} bytes, and {} are possible: {}",
                                  part.string().size(), max_folder_name_bytes, part.string()),
                      "choose a shorter name by the key 'folder', or rename the plan");
    plan.variants = {{}};
    if (const toml::node* const node = keys.find("scene")) {
        if (!node->is_table()) keys.fail(*node, "'scene' is not a table", "write it as [scene]; a plan has one");
        TomlKeys scene(*node->as_table(), path);
        add_block(scene, read_scene(scene, plan), plan);
    }
    for_each_table(keys, "vary", [&](TomlKeys& vary) { add_block(vary, read_block(vary, plan.base), plan); });
    if (!plan.scene.empty() && std::count(plan.parameters.begin(), plan.parameters.end(), "scene") > 0)
        keys.fail(table, "'scene' is a parameter and also a scene that is made");
    for_each_table(keys, "step", [&](TomlKeys& step) { read_step(step, plan), step.finish(); });
    for_each_table(keys, "output", [&](TomlKeys& output) { read_output(output, plan), output.finish(); });
    keys.finish();
    if (plan.steps.empty()) keys.fail(table, "a plan needs at least one [[step]]");
    return plan;
}

}  // namespace

Result<SweepPlan> parse_sweep_plan(const std::string& text, const std::string& path) {
    return read_toml(
        text, path, [&](const toml::table& table) { return read_plan(table, path); }, hint_for);
}

Result<SweepPlan> load_sweep_plan(const std::string& path) {
    const Result<std::string> text = read_whole_file(path);
    if (!text) return text.error();
    return parse_sweep_plan(*text, path);
}

}  // namespace exitance
