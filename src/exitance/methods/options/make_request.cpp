#include "exitance/methods/options/make_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "exitance/base/check.hpp"
#include "exitance/methods/options/recipes.hpp"
#include "exitance/methods/options/solve_option_table.hpp"
#include "exitance/methods/options/support.hpp"

namespace exitance {
namespace {

const GivenOption* find(std::span<const GivenOption> given, std::string_view name) {
    const auto found =
        std::find_if(given.begin(), given.end(), [&](const GivenOption& g) { return g.row->name == name; });
    return found == given.end() ? nullptr : &*found;
}

Error usage(const std::string& option, std::string message, std::string hint) {
    return {ErrorCode::usage, std::move(message), option, std::move(hint)};
}

Result<void> apply(const GivenOption& option, SolveRequest& request) {
    const std::string wrong = option.row->value.read(option.word, request);
    if (wrong.empty()) return {};
    return usage(option.row->name, wrong, "exitance solve --help-all describes its values");
}

/// The presets of a recipe as options.
std::vector<GivenOption> presets_of(const Recipe& recipe) {
    std::vector<GivenOption> out;
    const std::vector<std::string> words = preset_words(recipe);
    for (std::size_t i = 0; i < words.size(); ++i) {
        const OptionRow* const row = find_option(words[i]);
        EXI_CHECK(row);
        out.push_back({row, row->value.type.empty() ? "" : words[++i]});
    }
    return out;
}

/// Applies the presets of --recipe, if it is given. Error (usage): an unknown recipe, or a --method that differs from
/// the recipe's.
Result<void> apply_recipe(std::span<const GivenOption> given, SolveRequest& request) {
    const GivenOption* const option = find(given, "--recipe");
    if (!option) return {};
    if (const Result<void> known = apply(*option, request); !known) return known;
    const std::vector<GivenOption> presets = presets_of(*find_recipe(request.recipe));
    for (const GivenOption& preset : presets)
        if (const Result<void> applied = apply(preset, request); !applied) return applied;
    const GivenOption* const method = find(given, "--method");
    const GivenOption* const own = find(presets, "--method");
    if (method && own && method->word != own->word)
        return usage("--recipe",
                     fmt::format("{} is a form of --method {}, not of {}", request.recipe, own->word, method->word),
                     "leave --method or --recipe out");
    return {};
}

/// Error if --smoothing or --gather is combined with --output-light or --recipe, which replace them.
Result<void> check_old_names(std::span<const GivenOption> given, const SolveRequest& request) {
    if (!request.output_light) return {};
    const std::string other = find(given, "--output-light") ? "--output-light" : "--recipe " + request.recipe;
    for (const char* const name : {"--smoothing", "--gather"})
        if (find(given, name))
            return usage(name, fmt::format("cannot be combined with {}", other), "use --output-light");
    return {};
}

/// The options that replace --smoothing and --gather as given; empty if they can be omitted.
std::string new_spelling(const GivenOption* smoothing, const GivenOption* gather, const SolveRequest& request) {
    const bool smooths = smoothing && smoothing->word == "on";
    if (form_of(request.options) != Form::published)
        return smooths ? "--output-light smoothed-elements" : "--output-light elements";
    if (!gather) return smooths ? "nothing else" : "";  // gathered light is the default and is smooth already
    const Result<MethodForm> method_form = find_method_form(request);
    const std::string recipe = fmt::format(
        "--recipe classical-{}", method_form ? std::string(name_in(method_names, method_form->method)) : "METHOD");
    if (gather->word == "on") return recipe + " --output-light gathered";
    return smooths ? recipe + " --output-light smoothed-elements" : recipe;
}

void warn_of_old_names(std::span<const GivenOption> given, SolveRequest& request) {
    const GivenOption* const smoothing = find(given, "--smoothing");
    const GivenOption* const gather = find(given, "--gather");
    if (!smoothing && !gather) return;
    std::string old;
    for (const GivenOption* option : {gather, smoothing})
        if (option) old += fmt::format("{}{} {}", old.empty() ? "" : " ", option->row->name, option->word);
    const bool standard_gather = gather && gather->word == "on" && form_of(request.options) != Form::published;
    const std::string now = standard_gather ? "--output-light gathered" : new_spelling(smoothing, gather, request);
    request.warnings.push_back(now.empty()
                                   ? fmt::format("{} is the default and will be removed in 0.4: leave it out", old)
                                   : fmt::format("{} will be removed in 0.4: use {}", old, now));
}

}  // namespace

void settle(SolveRequest& request) {
    SolveOptions& o = request.options;
    ClassicalOptions& c = request.options.classical;
    if (o.task_engine && c.threshold) o.threshold = std::exchange(c.threshold, std::nullopt);
    // Growing cells have no published form that gathers: `off` delivers the light of their Gaussians.
    if (o.method == Method::growing_cells && c.gather) {
        if (!*c.gather) o.smoothing = false;
        c.gather.reset();
    }
    if (o.visibility == VisibilityKind::exact && !o.task_engine && !o.local_pass && !c.any())
        c.direct = ClassicalDirect::apart;
    if (!request.output_light) return;
    const OutputLight light = *request.output_light;
    if (form_of(request.options) == Form::published) {
        c.gather = light == OutputLight::gathered;
        o.smoothing = light == OutputLight::smoothed_elements ? std::optional(true) : std::nullopt;
    } else {
        o.smoothing =
            light == OutputLight::gathered ? std::nullopt : std::optional(light == OutputLight::smoothed_elements);
    }
}

Result<SolveRequest> make_request(std::span<const GivenOption> given) {
    SolveRequest request;
    if (const Result<void> preset = apply_recipe(given, request); !preset) return preset.error();
    for (const GivenOption& option : given)
        if (option.row->name != "--recipe")
            if (const Result<void> applied = apply(option, request); !applied) return applied.error();
    if (const Result<void> checked = check_old_names(given, request); !checked) return checked.error();
    settle(request);
    warn_of_old_names(given, request);
    return request;
}

}  // namespace exitance
