#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exitance/cli/options/arguments.hpp"
#include "exitance/methods/options/make_request.hpp"

namespace exitance {

// Functions that declare options for CLI11, by kind of value. They check values while reading them and throw a
// CLI::ValidationError for a wrong value; parse_arguments() catches it.

/// The finite number in a word; throws for anything else. `option` is named in errors.
double read_number(const std::string& option, const std::string& word);
/// Number of bytes in words such as "4G", "500M" or "1048576". K, M, G and T are powers of 1024. Throws outside 1 to
/// 1e18.
std::size_t read_bytes(const std::string& option, const std::string& word);
/// Numbers separated by commas or blanks.
std::vector<double> read_numbers(const std::string& option, std::string words);

std::vector<std::string> names_of(const auto& table) {
    std::vector<std::string> names;
    for (const auto& entry : table) names.emplace_back(entry.second);
    return names;
}

/// Declares an option whose values are the names in `table`.
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

/// Declares an option whose value is a number above 0. `unit`: its type in the help.
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

/// Declares an option whose value is a whole number of at least `least`.
template <class Target>
CLI::Option* add_count(CLI::App& app, const std::string& name, Target& target, long long least,
                       const std::string& help) {
    constexpr double max_count = std::is_same_v<Target, int> ? 1 << 16 : 9e15;
    const auto read = [name, &target, least](const std::string& word) {
        const double value = read_number(name, word);
        if (value != std::floor(value) || value < static_cast<double>(least))
            throw CLI::ValidationError(name, fmt::format("must be a whole number from {}, not {}", least, word));
        if (value > max_count) throw CLI::ValidationError(name, fmt::format("{} is too large", word));
        target = static_cast<std::size_t>(value);
    };
    return app.add_option_function<std::string>(name, read, help)->type_name("N");
}

// The functions below declare options that several verbs have.

/// --quiet and --verbose
void declare_common(CLI::App& app, CommonArguments& arguments);
/// --time-limit and, unless the verb has declared it, --memory-limit. `at_limit`: clause of the help that describes the
/// verb's action when a limit is exceeded.
void declare_limits(CLI::App& app, LimitArguments& limits, const std::string& at_limit);
/// --json
void declare_json(CLI::App& app, CommonArguments& arguments);
/// --progress
void declare_progress(CLI::App& app, CommonArguments& arguments);
/// --threads
void declare_threads(CLI::App& app, int& threads);
/// --threads and --progress
void declare_work(CLI::App& app, CommonArguments& arguments, int& threads);
/// Reads a size such as "640x400", pixels.
PictureSize read_size(const std::string& words);
/// Scene files and the options for reading them.
void declare_scene(CLI::App& app, SceneArguments& scene);
/// --unit and --efficacy
void declare_unit(CLI::App& app, UnitArguments& unit);

/// Options of `solve` that set the light of a scene, which `view` has as well.
inline constexpr std::array<std::string_view, 4> view_light_options{"--sky", "--epw", "--quantity", "--light-groups"};
/// Declares rows of solve_option_table() by their names, or all rows if there are no names. The returned list, which
/// the app keeps, has the given options after parsing.
std::shared_ptr<std::vector<GivenOption>> declare_rows(CLI::App& app, std::span<const std::string_view> names);

// Declare the options for quantities of lighting standards: --plane, --cylindrical, --maintenance, --observers and
// --tables of `report`; --observers of `glare`; --eyes, --sun-day and --sun-altitude of `daylight`.
void declare_standards(CLI::App& app, ReportArguments& arguments);

// Declare all options of a verb, except those of declare_common() and declare_limits().
void declare(CLI::App& app, SolveArguments& arguments);
void declare(CLI::App& app, ProbeArguments& arguments);
void declare(CLI::App& app, LightProbeArguments& arguments);
void declare(CLI::App& app, CompareArguments& arguments);
void declare(CLI::App& app, StatsArguments& arguments);
void declare(CLI::App& app, MixArguments& arguments);
void declare(CLI::App& app, ExportArguments& arguments);
void declare(CLI::App& app, RenderArguments& arguments);
void declare(CLI::App& app, BakeArguments& arguments);
void declare(CLI::App& app, ReportArguments& arguments);
void declare(CLI::App& app, GlareArguments& arguments);
void declare(CLI::App& app, DaylightArguments& arguments);
void declare(CLI::App& app, CheckArguments& arguments);
void declare(CLI::App& app, GenerateArguments& arguments);
void declare(CLI::App& app, LuminaireArguments& arguments);
void declare(CLI::App& app, ExperimentArguments& arguments);
void declare(CLI::App& app, ViewFactorArguments& arguments);
void declare(CLI::App& app, View3dArguments& arguments);
void declare(CLI::App& app, HeatArguments& arguments);
void declare(CLI::App& app, SweepArguments& arguments);
void declare(CLI::App& app, ViewArguments& arguments);
void declare(CLI::App& app, ReferenceArguments& arguments);

}  // namespace exitance
