#include "exitance/sweep/plan_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <set>

#include "exitance/io/files/whole_file.hpp"
#include "exitance/sweep/sweep_template.hpp"

namespace exitance {
namespace {

bool is_in_commands(const SweepPlan& plan, const std::string& parameter) {
    const std::string mark = fmt::format("{{{}}}", parameter);
    const auto has_mark = [&](const std::string& word) { return word.find(mark) != std::string::npos; };
    return std::any_of(plan.steps.begin(), plan.steps.end(), [&](const SweepStep& step) {
        return std::any_of(step.words.begin(), step.words.end(), has_mark) ||
               std::any_of(step.inputs.begin(), step.inputs.end(), has_mark);
    });
}

/// Warns of the first two variants with equal parameters, and of the number of all such variants.
void warn_of_equal_variants(const SweepPlan& plan, std::vector<std::string>& warnings) {
    std::vector<std::size_t> order(plan.variants.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return plan.variants[a] < plan.variants[b]; });
    std::size_t count = 0, first = 0, second = 0;
    for (std::size_t i = 1; i < order.size(); ++i) {
        if (plan.variants[order[i - 1]] != plan.variants[order[i]]) continue;
        if (count++ == 0 || order[i] < second) first = order[i - 1], second = order[i];
    }
    if (count == 1)
        warnings.push_back(
            fmt::format("{}: variants {} and {} have equal parameters", plan.path, first + 1, second + 1));
    if (count > 1)
        warnings.push_back(fmt::format("{}: {} variants have the parameters of an earlier one, such as {} and {}",
                                       plan.path, count, first + 1, second + 1));
}

}  // namespace

Result<std::vector<std::string>> plan_warnings(const SweepPlan& plan) {
    std::set<std::string> names;
    for (const std::string& file : plan.scene_template.files) {
        const Result<std::string> content = read_whole_file((std::filesystem::path(plan.base) / file).string());
        if (!content) return content.error();
        names.merge(names_in_template(*content));
    }
    std::vector<std::string> warnings;
    for (const std::string& parameter : plan.parameters)
        if (!names.contains(parameter) && !is_in_commands(plan, parameter))
            warnings.push_back(fmt::format(
                "{}: no command and no template uses the parameter '{}', so it changes nothing", plan.path, parameter));
    warn_of_equal_variants(plan, warnings);
    return warnings;
}

}  // namespace exitance
