#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "exitance/cli/arguments.hpp"

namespace exitance {

// How options of each kind are declared: their values are checked as they are read, and what is wrong with them is
// thrown as CLI11 wants it, which `parse_arguments` catches.

double read_number(const std::string& option, const std::string& word);
/// "4G", "500M", "1048576": bytes, with K, M, G and T as powers of 1024.
std::size_t read_bytes(const std::string& option, const std::string& word);
/// Numbers between commas and blanks.
std::vector<double> read_numbers(const std::string& option, std::string words);
/// on or off
bool read_switch(const char* option, const std::string& word);

std::vector<std::string> names_of(const auto& table) {
    std::vector<std::string> names;
    for (const auto& entry : table) names.emplace_back(entry.second);
    return names;
}

/// An option whose values are the names of a table.
template <class Choice, std::size_t N, class Target>
CLI::Option* add_choice(CLI::App& app, const std::string& name,
                        const std::array<std::pair<Choice, std::string_view>, N>& table, Target& target,
                        const std::string& help) {
    const auto read = [name, &table, &target](const std::string& word) {
        for (const auto& [value, known] : table)
            if (known == word) {
                target = value;
                return;
            }
        throw CLI::ValidationError(name, fmt::format("'{}' is not one of {}", word, fmt::join(names_of(table), ", ")));
    };
    return app.add_option_function<std::string>(name, read, help)
        ->type_name(fmt::format("{}", fmt::join(names_of(table), "|")));
}

/// A number above 0.
template <class Target>
CLI::Option* add_positive(CLI::App& app, const std::string& name, Target& target, const std::string& unit,
                          const std::string& help) {
    const auto read = [name, &target](const std::string& word) {
        const double value = read_number(name, word);
        if (value <= 0) throw CLI::ValidationError(name, fmt::format("must be above 0, not {}", word));
        target = value;
    };
    return app.add_option_function<std::string>(name, read, help)->type_name(unit);
}

/// A whole number of at least `least`.
template <class Target>
CLI::Option* add_count(CLI::App& app, const std::string& name, Target& target, long long least,
                       const std::string& help) {
    constexpr double most = std::is_same_v<Target, int> ? 1 << 16 : 9e15;
    const auto read = [name, &target, least](const std::string& word) {
        const double value = read_number(name, word);
        if (value != std::floor(value) || value < static_cast<double>(least))
            throw CLI::ValidationError(name, fmt::format("must be a whole number from {}, not {}", least, word));
        if (value > most) throw CLI::ValidationError(name, fmt::format("{} is too much", word));
        target = static_cast<std::size_t>(value);
    };
    return app.add_option_function<std::string>(name, read, help)->type_name("N");
}

/// on or off, into a bool or an optional one.
template <class Switch>
CLI::Option* add_switch(CLI::App& app, const std::string& name, Switch& value, const std::string& help) {
    return app
        .add_option_function<std::string>(
            name, [name, &value](const std::string& w) { value = read_switch(name.c_str(), w); }, help)
        ->type_name("on|off");
}

// Options that several verbs have.
void declare_common(CLI::App& app, CommonArguments& arguments);
/// --time-limit and, unless the verb has declared it, --memory-limit. at_limit: what the verb does when one is passed.
void declare_limits(CLI::App& app, LimitArguments& limits, const std::string& at_limit);
void declare_json(CLI::App& app, CommonArguments& arguments);
/// --progress
void declare_progress(CLI::App& app, CommonArguments& arguments);
/// --threads and --progress
void declare_work(CLI::App& app, CommonArguments& arguments, int& threads);
void declare_scene(CLI::App& app, SceneArguments& scene);
/// --unit and --efficacy
void declare_unit(CLI::App& app, UnitArguments& unit);

// Options for what lighting standards ask for: --plane, --cylindrical, --maintenance, --observers, --tables; --eyes,
// --sun-day, --sun-altitude.
void declare_standards(CLI::App& app, ReportArguments& arguments);
void declare_standards(CLI::App& app, DaylightArguments& arguments);

// All options of a verb.
void declare(CLI::App& app, SolveArguments& arguments);
void declare(CLI::App& app, ProbeArguments& arguments);
void declare(CLI::App& app, CompareArguments& arguments);
void declare(CLI::App& app, StatsArguments& arguments);
void declare(CLI::App& app, MixArguments& arguments);
void declare(CLI::App& app, ExportArguments& arguments);
void declare(CLI::App& app, RenderArguments& arguments);
void declare(CLI::App& app, BakeArguments& arguments);
void declare(CLI::App& app, ReportArguments& arguments);
void declare(CLI::App& app, DaylightArguments& arguments);
void declare(CLI::App& app, CheckArguments& arguments);
void declare(CLI::App& app, GenerateArguments& arguments);
void declare(CLI::App& app, LuminaireArguments& arguments);
void declare(CLI::App& app, ExperimentArguments& arguments);
void declare(CLI::App& app, ViewFactorArguments& arguments);
void declare(CLI::App& app, HeatArguments& arguments);
void declare(CLI::App& app, ViewArguments& arguments);

}  // namespace exitance
