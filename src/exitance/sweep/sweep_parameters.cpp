#include "exitance/sweep/sweep_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "exitance/io/files/table.hpp"
#include "exitance/io/files/toml_keys.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_variants = 1'000'000;
constexpr double rounding_of_range = 1e-9;  ///< Share of a step by which the last value of a range may exceed `to`.

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
    if (by_step == by_count) keys.fail(table, fmt::format("the range '{}' needs either 'step' or 'count'", key));
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
SweepBlock crossed(const TomlKeys& keys, const toml::node& at, const SweepBlock& a, const SweepBlock& b) {
    if (a.size() * b.size() > max_variants) keys.fail(at, fmt::format("there are more than {} variants", max_variants));
    SweepBlock out;
    for (const SweepSetting& first : a)
        for (const SweepSetting& second : b) {
            out.push_back(first);
            out.back().insert(out.back().end(), second.begin(), second.end());
        }
    return out;
}

/// Settings of the lists in a block, crossed or zipped.
SweepBlock lists_of(const TomlKeys& keys, const toml::table& table, bool zip) {
    SweepBlock block{{}};
    std::size_t length = 0;
    for (const auto& [name, node] : entries_of(table)) {
        if (name == "combine") continue;
        check_name(keys, *node, name);
        const std::vector<SweepValue> values = values_of(keys, *node, name);
        SweepBlock own;
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

SweepBlock rows_of(const TomlKeys& keys, const toml::node& node) {
    const toml::array* const list = node.as_array();
    if (!list || list->empty()) keys.fail(node, "'rows' is not a list of the form [{ name = value, ... }, ...]");
    SweepBlock block;
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

SweepBlock table_of(const TomlKeys& keys, const toml::node& node, const std::string& base) {
    const auto name = node.value_exact<std::string>();
    if (!name) keys.fail(node, "'table' is not the name of a CSV file");
    const Result<Table> table = read_csv((fs::path(base) / *name).string());
    if (!table) throw WrongToml{table.error()};
    if (table->rows.empty()) keys.fail(node, fmt::format("the table {} has no rows", *name));
    for (const std::string& column : table->columns) {
        check_name(keys, node, column);
        if (table->count(column) > 1)
            keys.fail(node, fmt::format("the table {} has {} columns '{}'", *name, table->count(column), column),
                      "every column is a parameter: rename or remove one of them");
    }
    SweepBlock block;
    for (const std::vector<std::string>& row : table->rows) {
        SweepSetting& setting = block.emplace_back();
        for (std::size_t i = 0; i < row.size(); ++i) setting.push_back({table->columns[i], {row[i]}});
    }
    return block;
}

}  // namespace

SweepBlock read_block(TomlKeys& keys, const std::string& base) {
    const toml::node *rows = keys.find("rows"), *table = keys.find("table");
    if (rows || table) {
        if (keys.table().size() != 1) keys.fail(keys.table(), "a block with 'rows' or 'table' must have no other keys");
        return rows ? rows_of(keys, *rows) : table_of(keys, *table, base);
    }
    std::string combine = "cross";
    keys.take("combine", combine);
    if (combine != "cross" && combine != "zip")
        keys.fail(*keys.find("combine"), fmt::format("'{}' is not cross or zip", combine));
    return lists_of(keys, keys.table(), combine == "zip");
}

void add_block(const TomlKeys& keys, const SweepBlock& block, SweepPlan& plan) {
    if (block.empty()) return;
    for (const auto& [name, unused] : block.front()) {
        if (std::find(plan.parameters.begin(), plan.parameters.end(), name) != plan.parameters.end())
            keys.fail(keys.table(), fmt::format("the parameter '{}' is given twice", name));
        plan.parameters.push_back(name);
    }
    plan.variants = crossed(keys, keys.table(), plan.variants, block);
}

}  // namespace exitance
