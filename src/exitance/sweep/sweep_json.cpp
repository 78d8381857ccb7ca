#include "exitance/sweep/sweep_json.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

namespace exitance {
namespace {

using Json = nlohmann::ordered_json;

/// Names of files need not be UTF-8, so invalid bytes are replaced.
std::string dump(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

Json parameters_of(const SweepPlan& plan, std::size_t index) {
    Json out = Json::object();
    for (const auto& [name, value] : plan.variants[index]) out[name] = text_of(value);
    return out;
}

Json steps_of(const SweepPlan& plan, const ResolvedVariant& variant) {
    Json out = Json::array();
    for (const ResolvedStep& step : variant.steps)
        out.push_back({{"step", step.name},
                       {"key", step.key},
                       {"folder", (std::filesystem::path(step_folder(plan)) / step.key).string()}});
    return out;
}

}  // namespace

std::string failure_json(const StepFailure& failure) {
    return dump({{"status", failure.status}, {"message", failure.message}, {"command", failure.command}}) + '\n';
}

std::optional<StepFailure> parse_failure(const std::string& text) {
    const Json json = Json::parse(text, nullptr, false);
    if (!json.is_object() || !json.contains("status") || !json["status"].is_number_integer()) return std::nullopt;
    const auto text_at = [&](const char* key) {
        return json.contains(key) && json[key].is_string() ? json[key].get<std::string>() : "";
    };
    return StepFailure{json["status"].get<int>(), text_at("message"), text_at("command")};
}

std::string variant_json(const SweepPlan& plan, std::size_t index, const ResolvedVariant& variant) {
    Json steps = Json::object();
    for (const ResolvedStep& step : variant.steps) steps[step.name] = step.key;
    const std::string file = std::filesystem::path(plan.path).filename().string();
    return dump(
               {{"plan", file}, {"variant", index + 1}, {"parameters", parameters_of(plan, index)}, {"steps", steps}}) +
           '\n';
}

std::optional<VariantRecord> parse_variant(const std::string& text) {
    const Json json = Json::parse(text, nullptr, false);
    if (!json.is_object() || !json.contains("variant") || !json["variant"].is_number_unsigned() ||
        !json.contains("steps") || !json["steps"].is_object())
        return std::nullopt;
    const bool has_plan = json.contains("plan") && json["plan"].is_string();
    return VariantRecord{json["variant"].get<std::size_t>(), has_plan ? json["plan"].get<std::string>() : ""};
}

std::string sweep_json(const SweepPlan& plan, const std::vector<VariantState>& states) {
    Json variants = Json::array();
    for (std::size_t i = 0; i < states.size(); ++i) {
        const VariantState& state = states[i];
        variants.push_back({{"variant", i + 1},
                            {"state", name_of(state.kind)},
                            {"parameters", parameters_of(plan, i)},
                            {"folder", variant_folder(plan, i)},
                            {"finished_steps", state.finished_steps},
                            {"steps", steps_of(plan, state.variant)}});
        if (!state.failure.empty()) variants.back()["failure"] = state.failure;
    }
    return dump({{"plan", plan.path}, {"title", plan.title}, {"folder", plan.folder}, {"variants", variants}});
}

std::string sweep_report_json(const SweepReport& report) {
    return dump({{"variants", report.variants},
                 {"done", report.done},
                 {"failed", report.failures.size()},
                 {"steps_run", report.steps_run},
                 {"steps_reused", report.steps_reused},
                 {"failures", report.failures},
                 {"warnings", report.warnings}});
}

std::optional<std::string> json_value(const std::string& text, const std::string& key) {
    const Json json = Json::parse(text, nullptr, false);
    const Json* at = &json;
    for (std::size_t begin = 0; begin <= key.size();) {
        const std::size_t end = std::min(key.find('.', begin), key.size());
        const std::string part = key.substr(begin, end - begin);
        const bool is_index =
            !part.empty() && part.size() < 10 && part.find_first_not_of("0123456789") == std::string::npos;
        if (at->is_object() && at->contains(part))
            at = &(*at)[part];
        else if (at->is_array() && is_index && std::stoul(part) < at->size())
            at = &(*at)[std::stoul(part)];
        else
            return std::nullopt;
        begin = end + 1;
    }
    if (at->is_null()) return "";
    if (at->is_boolean()) return at->get<bool>() ? "1" : "0";
    if (at->is_string()) return at->get<std::string>();
    if (at->is_number()) return at->dump();
    return std::nullopt;
}

}  // namespace exitance
