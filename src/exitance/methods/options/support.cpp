#include "exitance/methods/options/support.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "exitance/methods/options/solve_option_table.hpp"

namespace exitance {
namespace {

/// Methods of the standard form, in the order in which `auto` tries them.
constexpr std::array<Method, 8> standard_methods{Method::matrix,        Method::hierarchical,   Method::wavelet,
                                                 Method::progressive,   Method::substructuring, Method::monte_carlo,
                                                 Method::discontinuity, Method::growing_cells};
constexpr std::array<Method, 5> published_methods{Method::matrix, Method::progressive, Method::substructuring,
                                                  Method::hierarchical, Method::wavelet};
constexpr std::array<Method, 1> task_methods{Method::hierarchical}, local_pass_methods{Method::discontinuity};

std::span<const Method> methods_of(Form form) {
    switch (form) {
        case Form::standard:
            return standard_methods;
        case Form::published:
            return published_methods;
        case Form::tasks:
            return task_methods;
        case Form::local_passes:
            return local_pass_methods;
    }
    return {};
}

Error usage(std::string message, std::string hint = "") {
    return {ErrorCode::usage, std::move(message), "", std::move(hint)};
}

std::string name(Method method) {
    return std::string(name_in(method_names, method));
}

/// Lists the values "a|b|c" as "a, b or c".
std::string alternatives(const std::string& values) {
    std::string out;
    for (const char c : values) out += c == '|' ? std::string(", ") : std::string(1, c);
    if (const std::size_t last = out.rfind(", "); last != std::string::npos) out.replace(last, 2, " or ");
    return out;
}

/// True if the request sets an option to one of the values in a condition such as "--oracle ff|bf".
bool is_given(const std::string& condition, const SolveRequest& request) {
    const std::size_t blank = std::min(condition.find(' '), condition.size());
    const OptionRow* const row = find_option(condition.substr(0, blank));
    const std::optional<std::string> word = row ? row->value.word(request) : std::nullopt;
    return word && (blank == condition.size() || is_among(*word, condition.substr(blank + 1)));
}

bool holds(const OptionSupport& support, const std::string& value) {
    return support.values.empty() || value.empty() || is_among(value, support.values);
}

std::string with_value(const OptionRow& row, const std::string& value) {
    return row.value.type.empty() ? row.name : row.name + " " + value;
}

/// The option with its value, such as "--visibility exact", if support depends on values; otherwise only its name.
std::string shown(const OptionRow& row, const std::string& value) {
    const bool depends =
        std::any_of(row.support.begin(), row.support.end(), [](const auto& s) { return !s.values.empty(); });
    return depends ? with_value(row, value) : row.name;
}
/// Like shown(row, value), considering support by one method and form only.
std::string shown(const OptionRow& row, const std::string& value, MethodForm method_form) {
    const bool depends = std::any_of(row.support.begin(), row.support.end(), [&](const OptionSupport& s) {
        return s.forms.contains(method_form) && !holds(s, value);
    });
    return depends ? with_value(row, value) : row.name;
}

/// Like supporting_methods(). Conditions that hold in `request` (may be null) are omitted.
std::string supporting_here(const OptionRow& row, Form form, const std::string& value, const SolveRequest* request);

/// The given option that selects the published form, for error messages.
std::string selecting_option(const SolveRequest& request) {
    if (!request.recipe.empty()) return "--recipe " + request.recipe;
    for (const OptionRow& row : solve_option_table()) {
        const std::optional<std::string> word = row.value.word(request);
        if (!word) continue;
        const bool in_standard = !supporting_methods(row, Form::standard, *word).empty() || row.support.empty();
        const bool in_published = !supporting_methods(row, Form::published).empty();
        if (in_published && !in_standard) return shown(row, *word);
    }
    return request.options.snapshots.any() ? "--snapshots" : "--direct";
}

/// The error for an option that a method and form do not support.
Error not_supported(const OptionRow& row, const std::string& value, MethodForm method_form,
                    const SolveRequest& request) {
    const std::string option = shown(row, value, method_form),
                      here = supporting_here(row, method_form.form, value, &request);
    const std::string hint = "exitance solve --help-all says which methods support an option";
    const std::string by = here.empty() ? "" : fmt::format(" (supported by {})", here);
    switch (method_form.form) {
        case Form::tasks:
            return usage(option + " is not supported by --task-engine",
                         "leave one of them out; --method hierarchical supports more options without --task-engine");
        case Form::local_passes:
            return usage(option + " is not supported by --local-pass a to d", "leave one of them out");
        case Form::published:
            if (here.empty())
                return usage(fmt::format("{} cannot be combined with {}, which selects the method's published form",
                                         option, selecting_option(request)),
                             "leave one of them out; docs/laboratory/recipes.md lists the options of published forms");
            return usage(
                fmt::format("{} is not supported by the published form of {}{}", option, name(method_form.method), by),
                hint);
        case Form::standard:
            break;
    }
    if (request.options.bounces > 0 && method_form.method != request.options.method)
        return usage(fmt::format("{} is not supported by --bounces {}, whose reflections --method matrix counts",
                                 option, request.options.bounces),
                     "leave one of them out");
    if (!here.empty())
        return usage(fmt::format("{} is not supported by --method {}{}", option, name(method_form.method), by), hint);
    const std::string published = supporting_methods(row, Form::published, value);
    return usage(fmt::format("{} is not supported by --method {} (supported by the published forms of {})", option,
                             name(method_form.method), published),
                 "--recipe classical-METHOD selects a published form");
}

/// The method that computes the light. If the number of reflections is limited, `matrix` replaces the standard form of
/// other methods, except discontinuity meshing.
Method in_force(Form form, Method method, const SolveRequest& request) {
    const bool replaced = form == Form::standard && request.options.bounces > 0 && method != Method::discontinuity;
    return replaced ? Method::matrix : method;
}

/// Checks which options need or exclude one another.
Result<void> check_rules(const SolveRequest& request, Form form) {
    for (const OptionRow& row : solve_option_table()) {
        const std::optional<std::string> word = row.value.word(request);
        if (!word) continue;
        const auto applies = [&](const OptionRule& rule) {
            return (!rule.form || rule.form == form) && (rule.values.empty() || is_among(*word, rule.values));
        };
        const auto subject = [&](const OptionRule& rule) {
            return rule.values.empty() ? row.name : with_value(row, *word);
        };
        for (const OptionRule& rule : row.needs)
            if (applies(rule) && !is_given(rule.other, request))
                return usage(fmt::format("{} needs {}", subject(rule), alternatives(rule.other)),
                             "exitance solve --help-all");
        for (const OptionRule& rule : row.excludes)
            if (applies(rule) && is_given(rule.other, request))
                return usage(fmt::format("{} cannot be combined with {}", subject(rule), alternatives(rule.other)),
                             "leave one of them out");
    }
    return {};
}

/// First option that a method and form do not support; null if it supports all.
const OptionRow* first_unsupported(const SolveRequest& request, MethodForm method_form) {
    for (const OptionRow& row : solve_option_table())
        if (row.value.word(request) && !supports(row, request, method_form)) return &row;
    return nullptr;
}

/// The error for options that no method supports together.
Error no_method(const SolveRequest& request, Form form) {
    // Finds the first option after which no method is left, and the last one before it that removed methods.
    std::vector<Method> left(methods_of(form).begin(), methods_of(form).end());
    const OptionRow* before = nullptr;
    for (const OptionRow& row : solve_option_table()) {
        const std::optional<std::string> word = row.value.word(request);
        if (!word || row.support.empty()) continue;
        std::vector<Method> now;
        for (const Method m : left)
            if (supports(row, request, {form, in_force(form, m, request)})) now.push_back(m);
        if (now.empty()) {
            const bool alone = supporting_methods(row, form, *word).empty();
            if (alone || !before)
                return not_supported(row, *word, {form, in_force(form, left.front(), request)}, request);
            return usage(fmt::format("no method supports both {} and {}", shown(*before, *before->value.word(request)),
                                     shown(row, *word)),
                         "leave one of them out");
        }
        if (now.size() < left.size()) before = &row;
        left = std::move(now);
    }
    return usage("no method supports all options together");
}

std::string supporting_here(const OptionRow& row, Form form, const std::string& value, const SolveRequest* request) {
    const auto depends = [&](const OptionSupport& s) { return s.only_if && !(request && s.only_if(*request)); };
    std::string free, conditional;
    for (const Method method : methods_of(form)) {
        if (row.support.empty()) {
            free += (free.empty() ? "" : ", ") + name(method);
            continue;
        }
        const auto find = [&](bool with_condition) {
            return std::find_if(row.support.begin(), row.support.end(), [&](const OptionSupport& s) {
                return s.forms.contains({form, method}) && holds(s, value) && depends(s) == with_condition;
            });
        };
        if (find(false) != row.support.end())
            free += (free.empty() ? "" : ", ") + name(method);
        else if (const auto s = find(true); s != row.support.end())
            conditional += fmt::format("{}{} {}", conditional.empty() ? "" : "; ", name(method), s->condition);
    }
    return free + (free.empty() || conditional.empty() ? "" : "; ") + conditional;
}

}  // namespace

Form form_of(const SolveOptions& options) {
    if (options.task_engine) return Form::tasks;
    if (options.local_pass.value_or(LocalPassRule::e) != LocalPassRule::e) return Form::local_passes;
    const bool takes_snapshots = options.snapshots.any() && options.discontinuity.layers != true;
    return options.classical.any() || takes_snapshots ? Form::published : Form::standard;
}

bool supports(const OptionRow& row, const SolveRequest& request, MethodForm method_form) {
    if (row.support.empty()) return true;
    const std::string value = row.value.word(request).value_or("");
    return std::any_of(row.support.begin(), row.support.end(), [&](const OptionSupport& s) {
        return s.forms.contains(method_form) && holds(s, value) && (!s.only_if || s.only_if(request));
    });
}

std::string supporting_methods(const OptionRow& row, Form form, const std::string& value) {
    return supporting_here(row, form, value, nullptr);
}

Result<MethodForm> find_method_form(const SolveRequest& request) {
    return find_method_form(request, form_of(request.options));
}

Result<MethodForm> find_method_form(const SolveRequest& request, Form form) {
    const Method method = request.options.method;
    const std::span<const Method> methods = methods_of(form);
    const bool has_form = std::find(methods.begin(), methods.end(), method) != methods.end();
    if (form != Form::standard && method != Method::automatic && !has_form) {
        std::string names;
        for (const Method m : methods) names += (names.empty() ? "" : ", ") + name(m);
        const std::string option = form == Form::tasks          ? "--task-engine"
                                   : form == Form::local_passes ? "--local-pass"
                                                                : selecting_option(request);
        return usage(fmt::format("{} is not supported by --method {} (supported by {})", option, name(method), names),
                     "exitance solve --help-all says which methods support an option");
    }
    if (method != Method::automatic) {
        const MethodForm method_form{form, in_force(form, method, request)};
        if (const OptionRow* row = first_unsupported(request, method_form))
            return not_supported(*row, *row->value.word(request), method_form, request);
        if (const Result<void> rules = check_rules(request, form); !rules) return rules.error();
        return MethodForm{form, method};
    }
    for (const Method m : methods) {
        if (first_unsupported(request, {form, in_force(form, m, request)})) continue;
        if (const Result<void> rules = check_rules(request, form); !rules) return rules.error();
        return MethodForm{form, m};
    }
    return no_method(request, form);
}

Result<SolveOptions> with_published_method(SolveOptions options) {
    if (form_of(options) == Form::standard) return options;
    const Result<MethodForm> method_form = find_method_form({.options = options});
    if (!method_form) return method_form.error();
    options.method = method_form->method;
    return options;
}

bool supports_all(Method method, const SolveOptions& options) {
    const SolveRequest request{.options = options};
    return !first_unsupported(request, {Form::standard, in_force(Form::standard, method, request)});
}

Method first_supporting(const SolveOptions& options) {
    const auto* const found = std::find_if(standard_methods.begin(), standard_methods.end(),
                                           [&](Method m) { return supports_all(m, options); });
    return found == standard_methods.end() ? Method::automatic : *found;
}

Result<void> check_one_process(const SolveRequest& request) {
    for (const OptionRow& row : solve_option_table()) {
        const std::optional<std::string> word = row.value.word(request);
        const bool any = row.one_process == "*";
        if (!word || row.one_process.empty() || (!any && !is_among(*word, row.one_process))) continue;
        return usage(
            fmt::format("{} does not work over several processes", any ? row.name : row.name + " " + *word),
            "use one process, or --form-factors ray-cast, --basis constant or linear, and --relaxation jacobi, "
            "cg, gmres or chebyshev");
    }
    if (form_of(request.options) != Form::published) return {};
    return usage(fmt::format("{} selects a published form, which does not work over several processes",
                             selecting_option(request)),
                 "use one process");
}

}  // namespace exitance
