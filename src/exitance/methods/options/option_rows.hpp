#pragma once

#include <initializer_list>
#include <vector>

#include "exitance/methods/options/solve_option_table.hpp"

/// The rows of the option table, in its order, and the sets of methods that their options share.
namespace exitance::option_rows {

std::vector<OptionRow> for_users();
std::vector<OptionRow> for_experts();
std::vector<OptionRow> of_laboratory();

using enum Method;

using Support = std::vector<OptionSupport>;

// Sets of methods and forms, for the `support` of rows.

constexpr MethodForms standard(std::initializer_list<Method> methods) {
    return {Form::standard, methods};
}
constexpr MethodForms published(std::initializer_list<Method> methods) {
    return {Form::published, methods};
}
inline constexpr MethodForms tasks(Form::tasks, {hierarchical}), local_passes(Form::local_passes, {discontinuity});
inline constexpr MethodForms every_standard =
    standard({matrix, hierarchical, wavelet, progressive, substructuring, monte_carlo, discontinuity, growing_cells});
inline constexpr MethodForms every_published = published({matrix, progressive, substructuring, hierarchical, wavelet});
inline constexpr MethodForms shooting =
    standard({progressive, substructuring}) | published({progressive, substructuring});
inline constexpr MethodForms linked = standard({hierarchical, wavelet}),
                             published_links = published({hierarchical, wavelet});
inline constexpr MethodForms discontinuities = standard({discontinuity}) | local_passes;

/// `--method discontinuity` finds reflected light as `hierarchical` does, unless reflections are counted.
inline bool counts_no_reflections(const SolveRequest& r) {
    return r.options.bounces <= 0;
}

inline constexpr const char* without_counting = "without --bounces N";

inline bool has_layers(const SolveRequest& r) {
    return r.options.discontinuity.layers == true;
}

inline constexpr const char* with_layers = "with --layers on";

/// Methods with links between elements of a hierarchy.
inline Support links_of_hierarchies(const char* values = "") {
    return {{linked, values}, {standard({discontinuity}), values, counts_no_reflections, without_counting}};
}

/// The rows of several groups, one group after the other.
inline std::vector<OptionRow> joined(std::initializer_list<std::vector<OptionRow>> groups) {
    std::vector<OptionRow> all;
    for (const std::vector<OptionRow>& rows : groups) all.insert(all.end(), rows.begin(), rows.end());
    return all;
}

}  // namespace exitance::option_rows
