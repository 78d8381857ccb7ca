#include "exitance/cli/json_output.hpp"

#include <nlohmann/json.hpp>

#include "exitance/methods/options/solve_option_table.hpp"

namespace exitance {
namespace {

using Json = nlohmann::ordered_json;

/// Text of a JSON value. Bytes that are not UTF-8, which text from files may contain, are replaced.
std::string dump(const Json& json, int indent) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// The value as JSON; null without a value.
template <class T>
Json value_or_null(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

Json to_json(const std::vector<Finding>& findings, Finding::Kind kind) {
    Json list = Json::array();
    for (const Finding& finding : findings)
        if (finding.kind == kind)
            list.push_back({{"file", finding.file}, {"line", finding.line}, {"message", finding.message}});
    return list;
}

}  // namespace

std::string forecast_json(const Forecast& f) {
    const Json json{
        {"method", f.method},
        {"surfaces", f.surfaces},
        {"regions", f.regions},
        {"emitters", f.emitters},
        {"solve_elements", f.solve_elements},
        {"gather_elements", f.gather_elements},
        {"rays", f.rays},
        {"seconds", f.seconds},
        {"memory_bytes", f.memory_bytes},
        {"at_least", f.is_at_least},
    };
    return dump(json, 2);
}

std::string options_json(const SolveRequest& request) {
    return dump(Json::parse(recorded_options(request)), -1);
}

std::string with_scene_options(const std::string& options, const LoadOptions& load) {
    Json json = Json::parse(options);
    if (load.metres_per_unit) json["length_unit"] = *load.metres_per_unit;
    if (load.y_is_up) json["up"] = *load.y_is_up ? "y" : "z";
    if (!load.lod.empty()) json["lod"] = load.lod;
    if (load.turn_bodies) json["turn_bodies"] = true;
    if (load.texture_parts) json["texture_parts"] = *load.texture_parts;
    return dump(json, -1);
}

std::vector<std::pair<std::string, std::string>> option_facts(const SolveRequest& request) {
    std::vector<std::pair<std::string, std::string>> facts;
    const Json json = Json::parse(recorded_options(request));
    for (const auto& [name, value] : json.items())
        if (name != "recipe" && name != "output_light")
            // recipe and output_light are recorded by the options that they set
            facts.emplace_back(name, dump(value, -1));
    facts.emplace_back("memory_limit", dump(value_or_null(request.options.memory_limit_bytes), -1));
    return facts;
}

std::string check_json(const CheckedScene& checked) {
    const std::size_t surfaces = checked.scene ? checked.scene->surfaces().size() : 0;
    Json errors = to_json(checked.findings, Finding::Kind::error);
    if (!checked.scene && errors.empty())
        errors.push_back(
            {{"file", checked.scene.error().where}, {"line", 0}, {"message", checked.scene.error().message}});
    const Json json{
        {"surfaces", surfaces},
        {"errors", errors},
        {"warnings", to_json(checked.findings, Finding::Kind::warning)},
        {"repairs", to_json(checked.findings, Finding::Kind::repair)},
    };
    return dump(json, 2);
}

std::string error_json(const ErrorMeasure& error) {
    const Json json{
        {"relative_rms_error", error.relative_rms_error},
        {"raw_relative_rms_error", error.raw_relative_rms_error},
        {"reference_noise", error.reference_noise},
        {"bias", error.bias},
        {"median_relative_error", error.median_relative_error},
        {"p95_relative_error", error.p95_relative_error},
        {"points", error.points},
    };
    return dump(json, 2);
}

namespace {

Json json_of(const RayCheck& check) {
    return {{"entries", check.entries},
            {"rays", check.rays},
            {"wrong", check.wrong},
            {"largest_deviation_in_standard_errors", check.largest_deviation},
            {"largest_relative_deviation", check.largest_relative},
            {"relative_standard_error_there", check.relative_error_there},
            {"median_relative_standard_error", check.usual_relative_error}};
}

Json json_of(const RowCheck& check) {
    return {{"rows", check.rows.size()},
            {"rays", check.rays},
            {"wrong", check.wrong},
            {"wrong_sums", check.wrong_sums},
            {"largest_sum_error", check.sum_error},
            {"detectable_error", check.detectable_error},
            {"detectable_sum_error", check.detectable_sum}};
}

}  // namespace

std::string heat_json(const GrayExchange& exchange) {
    return dump({{"surfaces", exchange.heat.size()},
                 {"temperature", exchange.temperature},
                 {"heat", exchange.heat},
                 {"surroundings", exchange.surroundings},
                 {"residual", exchange.residual},
                 {"iterations", exchange.iterations}},
                2);
}

std::string view_factors_json(const ViewFactorFacts& facts) {
    Json json{
        {"surfaces", facts.surfaces}, {"rows_finished", facts.finished_rows},
        {"entries", facts.entries},   {"smallest", facts.smallest},
        {"dropped", facts.dropped},   {"row_sum", {{"least", facts.min_row_sum}, {"most", facts.max_row_sum}}},
        {"seconds", facts.seconds},
    };
    if (facts.has_defects) json["reciprocity_defect"] = facts.reciprocity_defect;
    if (facts.tolerance) {
        json["tolerance"] = *facts.tolerance;
        if (facts.has_defects) json["entry_reciprocity_defect"] = facts.entry_defect;
        json["pairs_computed_again"] = facts.mended;
        json["pairs_unsettled"] = facts.unsettled;
        json["check"] = json_of(facts.check);
    } else {
        json["error"] = facts.error;
        json["row_error"] = facts.row_error;
        json["row_error_checked"] = facts.row_check.rows.empty() ? Json() : Json(facts.row_check.error);
        if (facts.has_defects) json["closure_defect"] = facts.closure_defect, json["rows_unclosed"] = facts.unclosed;
        json["check"] = json_of(facts.row_check);
    }
    if (facts.transport)
        json["operator"] = {{"entries", facts.transport->entries},
                            {"node_entries", facts.transport->node_entries},
                            {"row_error", facts.transport->row_error},
                            {"closure_defect", facts.transport->closure_defect},
                            {"product_seconds", facts.transport->product_seconds}};
    return dump(json, 2);
}

std::string glare_json(std::span<const Observer> observers, std::span<const DaylightGlare> glare,
                       std::optional<double> error) {
    const auto triple = [](const auto& v) { return Json::array({v.x, v.y, v.z}); };
    Json list = Json::array();
    for (std::size_t i = 0; i < observers.size(); ++i) {
        const DaylightGlare& g = glare[i];
        Json sources = Json::array();
        for (std::size_t k = 0; k < g.sources.size(); ++k) {
            const DaylightGlareSource& s = g.sources[k];
            sources.push_back({{"name", g.names[k]},
                               {"luminance", s.luminance},
                               {"solid_angle", s.solid_angle},
                               {"position_index", s.position},
                               {"direction", triple(s.towards)}});
        }
        list.push_back({{"eye", triple(observers[i].eye)},
                        {"direction", triple(observers[i].view)},
                        {"DGP", g.probability()},
                        {"DGP_low", error ? Json(g.probability_with(1 - *error)) : Json(nullptr)},
                        {"DGP_high", error ? Json(g.probability_with(1 + *error)) : Json(nullptr)},
                        {"class", glare_class(g.probability())},
                        {"vertical_illuminance", g.vertical_illuminance},
                        {"low_light_factor", low_light_factor(g.vertical_illuminance)},
                        {"mean_luminance", g.mean_luminance},
                        {"threshold", g.threshold},
                        {"sources", std::move(sources)}});
    }
    return dump(Json{{"observers", std::move(list)}, {"error", value_or_null(error)}}, 2);
}

std::string values_json(const std::vector<std::pair<std::string, double>>& values,
                        const std::vector<std::pair<std::string, std::vector<std::string>>>& texts) {
    Json json;
    for (const auto& [name, value] : values) json[name] = value;
    for (const auto& [name, list] : texts) json[name] = list;
    return dump(json, 2);
}

std::string progress_json(std::string_view phase, double fraction, std::string_view detail, double elapsed,
                          std::optional<double> remaining) {
    const Json json{{"phase", phase},
                    {"fraction", fraction},
                    {"detail", detail},
                    {"elapsed", elapsed},
                    {"remaining", value_or_null(remaining)}};
    return dump(json, -1);
}

std::string light_groups_json(const LightGroups& groups, const Scene& scene) {
    Json out{{"groups", Json::array()}, {"materials", Json::array()}};
    for (const LightGroup& g : groups.groups)
        out["groups"].push_back({{"name", g.emitters.name}, {"factor", g.factor}});
    if (!groups.empty())
        for (const Material& m : scene.materials()) {
            Json bands_of = Json::array();
            for (const double rho : m.reflectance.value) bands_of.push_back(rho);
            out["materials"].push_back({{"name", m.name}, {"reflectance", bands_of}});
        }
    return dump(out, -1);
}

}  // namespace exitance
