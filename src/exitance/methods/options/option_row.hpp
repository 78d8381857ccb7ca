#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exitance/methods/options/method_form.hpp"
#include "exitance/methods/options/solve_request.hpp"

namespace exitance {

/// Readers for whom an option is meant. --help lists the options for users, --help-all those of all audiences.
enum class Audience : std::uint8_t { users, experts, laboratory, old_names };

/// A heading under which help and reference list options.
struct OptionGroup {
    std::string_view title = {};
    Audience audience = Audience::users;
};

namespace option_groups {

inline constexpr OptionGroup light{"Light", Audience::users}, scene{"Scene", Audience::users},
    limits{"Limits", Audience::users}, run{"Run", Audience::users}, scene_details{"Scene details", Audience::experts},
    accuracy{"Accuracy", Audience::experts}, method{"Method", Audience::experts},
    visibility{"Visibility and form factors", Audience::experts}, shadows{"Discontinuity meshing", Audience::experts},
    published{"Published forms", Audience::laboratory}, structures{"Published structures", Audience::laboratory},
    old_names{"Old names", Audience::old_names};

/// All groups, in the order of the help.
inline constexpr OptionGroup all[] = {light,  scene,      limits,  run,       scene_details, accuracy,
                                      method, visibility, shadows, published, structures,    old_names};

}  // namespace option_groups

/// How the word after an option is read.
struct OptionValue {
    std::string type = {};  ///< "R", "N|off", "jacobi|cg"; empty: the option is a flag.
    /// Stores a word in the request. Returns the message of an error, or an empty text.
    std::function<std::string(const std::string& word, SolveRequest& request)> read = {};
    /// Returns the current value as a word; none while the option has its default.
    std::function<std::optional<std::string>(const SolveRequest& request)> word = {};
    /// JSON with which a solution file records the option; "null" if it is not set.
    std::function<std::string(const SolveRequest& request)> json = {};
};

/// Methods and forms (`forms`) that support an option, and the values of it that they support.
struct OptionSupport {
    MethodForms forms = {};
    std::string values = {};                         ///< "a|b"; empty: all values.
    bool (*only_if)(const SolveRequest&) = nullptr;  ///< Condition of the support; null: none.
    std::string condition = {};                      ///< `only_if` in words: "with --basis constant".
};

/// Another option that an option needs or cannot be combined with.
struct OptionRule {
    std::string other = {};         ///< "--oracle ff|bf"; without values: the option with any value.
    std::string values = {};        ///< Values of the option for which the rule holds; empty: all.
    std::optional<Form> form = {};  ///< The rule holds in this form; empty: in all.
};

/// A row of the table of options.
struct OptionRow {
    std::string name = {};  ///< "--epsilon"
    OptionValue value = {};
    std::string does = {};     ///< Effect of the option: one sentence without a full stop.
    std::string initial = {};  ///< Default in words; empty: nothing is set.
    std::string when = {};     ///< When to use it, or the meaning of its values; may be empty.
    OptionGroup group = {};
    std::vector<OptionSupport> support = {};  ///< Support by methods and forms; empty: all of them support the option.
    std::vector<OptionRule> needs = {}, excludes = {};
    std::string one_process = {};  ///< Values that do not work over several processes; "*": all.
    std::string section = {};  ///< Object of the recorded options that contains this option; "-": it is not recorded.
};

/// Help text of an option: its effect, its default, and when to use it.
std::string help_of(const OptionRow& row);

/// True if `values`, such as "a|b|c", contain the word.
bool is_among(std::string_view word, std::string_view values);

}  // namespace exitance
