#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glob.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>

#include "exitance/base/words.hpp"
#include "exitance/io/files/table.hpp"
#include "exitance/io/files/toml_keys.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/sweep/sweep_plan.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_variants = 1'000'000;
constexpr double rounding_of_range = 1e-9;  ///< Share of a step by which the last value of a range may exceed `to`.

constexpr std::array<std::pair<SweepOutput::Take, std::string_view>, 6> take_names{{
    {SweepOutput::Take::value, "value"},
    {SweepOutput::Take::mean, "mean"},
    {SweepOutput::Take::sum, "sum"},
    {SweepOutput::Take::min, "min"},
    {SweepOutput::Take::max, "max"},
    {SweepOutput::Take::all, "all"},
}};

/// Settings of some parameters, each of which is combined with each of the other blocks.
using Block = std::vector<SweepSetting>;

int line_of(const toml::node& node) {
    return static_cast<int>(node.source().begin.line);
}

/// Entries of a table in the order of the file; the table itself is in alphabetical order.
std::vector<std::pair<std::string, const toml::node*>> entries_of(const toml::table& table) {
    std::vector<std::pair<std::string, const toml::node*>> out;
    for (const auto& [key, node] : table) out.emplace_back(std::string(key.str()), &node);
    std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) {
        const toml::source_position x = a.second->source().begin, y = b.second->source().begin;
        return x.line != y.line ? x.line < y.line : x.column < y.column;
    });
    return out;
}

/// Text of a number, without the rounding of sums such as 0.1 + 0.2.
std::string number_text(double value) {
    return fmt::format("{:.12g}", value);
}

std::string word_of(const TomlKeys& keys, const toml::node& node, const std::string& key) {
    if (const auto text = node.value_exact<std::string>()) return *text;
    if (const auto whole = node.value_exact<std::int64_t>()) return fmt::format("{}", *whole);
    if (const auto number = node.value_exact<double>(); number && std::isfinite(*number)) return number_text(*number);
    if (const auto truth = node.value_exact<bool>()) return *truth ? "true" : "false";
    keys.fail(node, fmt::format("'{}' has a value that is neither text, a number, true nor false", key));
}

SweepValue value_of(const TomlKeys& keys, const toml::node& node, const std::string& key) {
    const toml::array* const list = node.as_array();
    if (!list) return {word_of(keys, node, key)};
    SweepValue out;
    for (const toml::node& entry : *list) out.push_back(word_of(keys, entry, key));
    return out;
}

/// Values of a range { from, to, step } or { from, to, count }.
std::vector<SweepValue> range_of(const TomlKeys& keys, const toml::table& table, const std::string& key) {
    TomlKeys range(table, keys.file());
    double from = 0, to = 0, step = 0;
    std::size_t count = 0;
    range.need("from", from), range.need("to", to);
    range.take("step", step), range.take("count", count);
    range.finish();
    const bool by_step = table.contains("step"), by_count = table.contains("count");
    if (by_step == by_count) keys.fail(table, fmt::format("the range '{}' has either 'step' or 'count'", key));
    if (by_step && (step == 0 || (to - from) / step < 0))
        keys.fail(table, fmt::format("the step of '{}' does not lead from {} to {}", key, from, to));
    if (by_count && (count == 0 || (count == 1 && from != to)))
        keys.fail(table, fmt::format("'{}' needs a count of at least {}", key, from == to ? 1 : 2));
    const double steps = by_step ? std::floor((to - from) / step + rounding_of_range) : static_cast<double>(count - 1);
    if (steps >= static_cast<double>(max_variants))
        keys.fail(table, fmt::format("the range '{}' has more than {} values", key, max_variants));
    if (by_count) step = steps > 0 ? (to - from) / steps : 0;
    std::vector<SweepValue> out;
    for (double i = 0; i <= steps; ++i) out.push_back({number_text(from + i * step)});
    return out;
}

std::vector<SweepValue> values_of(const TomlKeys& keys, const toml::node& node, const std::string& key) {
    if (const toml::table* const table = node.as_table()) return range_of(keys, *table, key);
    const toml::array* const list = node.as_array();
    if (!list) return {value_of(keys, node, key)};
    if (list->empty()) keys.fail(node, fmt::format("'{}' has no values", key));
    std::vector<SweepValue> out;
    for (const toml::node& entry : *list) out.push_back(value_of(keys, entry, key));
    return out;
}

void check_name(const TomlKeys& keys, const toml::node& node, const std::string& name) {
    const bool is_plain =
        std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; });
    if (name.empty() || !is_plain || name == "dir" || name == "variant" || name == "state")
        keys.fail(node, fmt::format("'{}' cannot be a parameter", name),
                  "names have letters, digits and underscores, and are not dir, variant or state");
}

/// Every setting of `a` with every one of `b`; the last parameter changes first.
Block crossed(const TomlKeys& keys, const toml::node& at, const Block& a, const Block& b) {
    if (a.size() * b.size() > max_variants) keys.fail(at, fmt::format("there are more than {} variants", max_variants));
    Block out;
    for (const SweepSetting& first : a)
        for (const SweepSetting& second : b) {
            out.push_back(first);
            out.back().insert(out.back().end(), second.begin(), second.end());
        }
    return out;
}

/// Settings of the lists in a block, crossed or zipped.
Block lists_of(const TomlKeys& keys, const toml::table& table, bool zip) {
    Block block{{}};
    std::size_t length = 0;
    for (const auto& [name, node] : entries_of(table)) {
        if (name == "combine") continue;
        check_name(keys, *node, name);
        const std::vector<SweepValue> values = values_of(keys, *node, name);
        Block own;
        for (const SweepValue& value : values) own.push_back({{name, value}});
        if (!zip || length == 0) {
            block = crossed(keys, *node, block, own);
        } else {
            if (values.size() != length)
                keys.fail(*node, fmt::format("'{}' has {} values where the lists before have {}", name, values.size(),
                                             length));
            for (std::size_t i = 0; i < length; ++i) block[i].push_back(own[i].front());
        }
        length = values.size();
    }
    return block;
}

Block rows_of(const TomlKeys& keys, const toml::node& node) {
    const toml::array* const list = node.as_array();
    if (!list || list->empty()) keys.fail(node, "'rows' is not a list of the form [{ name = value, ... }, ...]");
    Block block;
    for (const toml::node& entry : *list) {
        const toml::table* const row = entry.as_table();
        if (!row) keys.fail(entry, "'rows' is not a list of the form [{ name = value, ... }, ...]");
        SweepSetting setting;
        for (const auto& [name, value] : entries_of(*row)) {
            check_name(keys, *value, name);
            setting.emplace_back(name, value_of(keys, *value, name));
        }
        if (!block.empty()) {
            // Rows may list their parameters in any order.
            SweepSetting sorted;
            for (const auto& [name, unused] : block.front())
                for (const auto& own : setting)
                    if (own.first == name) sorted.push_back(own);
            if (sorted.size() != block.front().size() || setting.size() != sorted.size())
                keys.fail(entry, "this row has other parameters than the first one");
            setting = std::move(sorted);
        }
        block.push_back(std::move(setting));
    }
    return block;
}

Block table_of(const TomlKeys& keys, const toml::node& node, const std::string& base) {
    const auto name = node.value_exact<std::string>();
    if (!name) keys.fail(node, "'table' is not the name of a CSV file");
    const Result<Table> table = read_csv((fs::path(base) / *name).string());
    if (!table) throw WrongToml{table.error()};
    if (table->rows.empty()) keys.fail(node, fmt::format("the table {} has no rows", *name));
    for (const std::string& column : table->columns) check_name(keys, node, column);
    Block block;
    for (const std::vector<std::string>& row : table->rows) {
        SweepSetting& setting = block.emplace_back();
        for (std::size_t i = 0; i < row.size(); ++i) setting.push_back({table->columns[i], {row[i]}});
    }
    return block;
}

Block read_block(TomlKeys& keys, const std::string& base) {
    const toml::node *rows = keys.find("rows"), *table = keys.find("table");
    if (rows || table) {
        if (keys.table().size() != 1) keys.fail(keys.table(), "a block with 'rows' or 'table' has no other keys");
        return rows ? rows_of(keys, *rows) : table_of(keys, *table, base);
    }
    std::string combine = "cross";
    keys.take("combine", combine);
    if (combine != "cross" && combine != "zip")
        keys.fail(*keys.find("combine"), fmt::format("'{}' is not cross or zip", combine));
    return lists_of(keys, keys.table(), combine == "zip");
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

/// Reads [scene]. Files of a scene are a block of variants.
Block read_scene(TomlKeys& keys, SweepPlan& plan) {
    std::string generate;
    keys.take("generate", generate);
    plan.scene_template.files = texts_of(keys, "template");
    const std::vector<std::string> patterns = texts_of(keys, "files");
    keys.finish();
    if (!generate.empty() + !plan.scene_template.files.empty() + !patterns.empty() != 1)
        keys.fail(keys.table(), "a scene has one of 'generate', 'template' and 'files'");
    if (!generate.empty()) {
        SweepStep step{"scene", {"generate"}, {0}, {}, line_of(*keys.find("generate"))};
        for (std::string& word : split_words(generate)) step.words.push_back(std::move(word));
        step.words.insert(step.words.end(), {"-o", "{dir}/scene.obj"});
        plan.scene = step.words.back();
        plan.steps.push_back(std::move(step));
    }
    if (!plan.scene_template.files.empty()) {
        plan.scene_template.line = line_of(*keys.find("template"));
        plan.scene = "{dir}/" + fs::path(plan.scene_template.files.front()).filename().string();
    }
    Block block;
    for (const std::string& pattern : patterns)
        for (const std::string& file : files_of(keys, *keys.find("files"), pattern, plan.base))
            block.push_back({{"scene", {file}}});
    return block;
}

void read_step(TomlKeys& keys, SweepPlan& plan) {
    std::string run;
    keys.need("run", run);
    SweepStep step;
    step.words = split_words(run);
    step.line = line_of(*keys.find("run"));
    if (!step.words.empty() && step.words.front() == "exitance") step.words.erase(step.words.begin());
    if (step.words.empty()) keys.fail(*keys.find("run"), "'run' is empty", "write a verb: run = \"solve {scene} ...\"");
    step.name = step.words.front();
    keys.take("name", step.name);
    if (const toml::node* const node = keys.find("accept")) {
        std::vector<int> accepted;
        keys.take("accept", accepted);
        if (accepted.empty()) keys.fail(*node, "'accept' lists no exit status");
        step.accepted = accepted;
    }
    step.inputs = texts_of(keys, "inputs");
    for (const SweepStep& other : plan.steps)
        if (other.name == step.name)
            keys.fail(keys.table(), fmt::format("two steps are called '{}'", step.name), "give one of them a 'name'");
    plan.steps.push_back(std::move(step));
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
    std::string take = "value";
    keys.take("take", take);
    const auto known =
        std::find_if(take_names.begin(), take_names.end(), [&](const auto& t) { return t.second == take; });
    if (known == take_names.end()) {
        std::vector<std::string_view> names;
        for (const auto& [value, name] : take_names) names.push_back(name);
        keys.fail(*keys.find("take"), fmt::format("'{}' is not one of {}", take, fmt::join(names, ", ")));
    }
    output.take = known->first;
    if (output.step.empty() == output.file.empty())
        keys.fail(keys.table(), "an output has either 'file' or 'step'",
                  "file = \"light.csv\" is a file in {dir}, and step = \"solve\" what the step prints");
    if (output.json.empty() == output.column.empty())
        keys.fail(keys.table(), "an output has either 'json' or 'column'");
    if (output.row == 0) keys.fail(*keys.find("row"), "rows are counted from 1");
    const auto is_named = [&](const auto& other) { return other.name == output.name; };
    const auto& p = plan.parameters;
    if (std::any_of(plan.outputs.begin(), plan.outputs.end(), is_named) ||
        std::find(p.begin(), p.end(), output.name) != p.end() || output.name == "variant" || output.name == "state")
        keys.fail(keys.table(), fmt::format("two columns would be called '{}'", output.name));
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

/// Reads the tables `[[key]]`, or the single table `[key]`, each by a function.
template <class Read>
void read_tables(TomlKeys& keys, const std::string& key, const Read& read) {
    const toml::node* const node = keys.find(key);
    if (!node) return;
    const auto read_one = [&](const toml::node& entry) {
        if (!entry.is_table()) keys.fail(entry, fmt::format("'{}' is not a table: [[{}]]", key, key));
        TomlKeys inner(*entry.as_table(), keys.file());
        read(inner);
    };
    if (!node->is_array()) return read_one(*node);
    for (const toml::node& entry : *node->as_array()) read_one(entry);
}

/// Adds a block of settings to the plan's variants.
void add_block(const TomlKeys& keys, const toml::node& at, const Block& block, SweepPlan& plan) {
    if (block.empty()) return;
    for (const auto& [name, unused] : block.front()) {
        if (std::find(plan.parameters.begin(), plan.parameters.end(), name) != plan.parameters.end())
            keys.fail(at, fmt::format("the parameter '{}' is given twice", name));
        plan.parameters.push_back(name);
    }
    plan.variants = crossed(keys, at, plan.variants, block);
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
    plan.variants = {{}};
    read_tables(keys, "scene",
                [&](TomlKeys& scene) { add_block(scene, scene.table(), read_scene(scene, plan), plan); });
    read_tables(keys, "vary",
                [&](TomlKeys& vary) { add_block(vary, vary.table(), read_block(vary, plan.base), plan); });
    if (!plan.scene.empty() && std::count(plan.parameters.begin(), plan.parameters.end(), "scene") > 0)
        keys.fail(table, "'scene' is a parameter and also a scene that is made");
    read_tables(keys, "step", [&](TomlKeys& step) { read_step(step, plan), step.finish(); });
    read_tables(keys, "output", [&](TomlKeys& output) { read_output(output, plan), output.finish(); });
    keys.finish();
    if (plan.steps.empty()) keys.fail(table, "a plan has a [[step]] at least");
    return plan;
}

}  // namespace

Result<SweepPlan> parse_sweep_plan(const std::string& text, const std::string& path) {
    try {
        return read_plan(toml::parse(text, path), path);
    } catch (const WrongToml& wrong) {
        return wrong.error;
    } catch (const toml::parse_error& error) {
        return Error{ErrorCode::bad_input, std::string(error.description()),
                     fmt::format("{}:{}", path, error.source().begin.line), "plans are written in TOML"};
    }
}

Result<SweepPlan> load_sweep_plan(const std::string& path) {
    const Result<std::string> text = read_whole_file(path);
    if (!text) return text.error();
    return parse_sweep_plan(*text, path);
}

}  // namespace exitance
