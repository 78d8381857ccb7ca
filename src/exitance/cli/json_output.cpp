#include "exitance/cli/json_output.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numeric>

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

/// Seconds of every phase; null for the parts `visibility` and `form_factors` if they were not measured separately.
Json seconds_of(const SolveStatistics& s) {
    Json seconds;
    for (const char* phase : {"total", "read", "mesh", "direct", "link", "visibility", "form_factors", "solve",
                              "gather", "certify", "reconstruct", "write"}) {
        const auto at = s.seconds.find(phase);
        const bool is_part = phase == std::string_view("visibility") || phase == std::string_view("form_factors");
        seconds[phase] = at != s.seconds.end() ? Json(at->second) : is_part ? Json(nullptr) : Json(0.0);
    }
    return seconds;
}

}  // namespace

std::string statistics_json(const SolveStatistics& s, const LightUnit& own) {
    Json rooms = Json::array();
    for (const RoomError& room : s.rooms)
        rooms.push_back(
            {{"area", room.area}, {"mean", room.mean}, {"reference", room.reference}, {"error", room.error}});
    Json bodies = Json::array();
    for (const BodyError& body : s.bodies)
        bodies.push_back({{"surfaces", body.surfaces},
                          {"area", body.area},
                          {"mean", body.mean},
                          {"error", value_or_null(body.error)},
                          {"points", body.points}});
    const std::size_t elements =
        std::accumulate(s.elements_by_level.begin(), s.elements_by_level.end(), std::size_t(0));
    const auto share = [](std::size_t whole, std::size_t parts) {
        return parts > 0 ? static_cast<double>(whole) / static_cast<double>(parts) : 0.0;
    };
    Json json{
        {"method", s.method},
        {"basis", s.basis},
        {"threads", s.threads},
        {"processes", s.figures.contains("processes") ? static_cast<int>(s.figures.at("processes")) : 1},
        {"schedule", s.schedule},
        {"surfaces", s.surfaces},
        {"elements", s.elements},
        {"leaf_elements", s.leaf_elements},
        {"links", s.links},
        {"rays", s.rays},
        {"form_factors", s.form_factors},
        {"iterations", s.iterations},
        {"converged", s.converged},
        {"residual", s.residual},
        {"relative_error_estimate", value_or_null(s.relative_error_estimate)},
        {"relative_error_bound", value_or_null(s.relative_error_bound)},
        {"relative_error_estimate_interpolant", value_or_null(s.relative_error_estimate_interpolant)},
        {"relative_error_estimate_worst_room", value_or_null(s.relative_error_estimate_worst_room)},
        {"relative_error_estimate_worst_body", value_or_null(s.relative_error_estimate_worst_body)},
        {"error_p99", value_or_null(s.error_p99)},
        {"rooms", rooms},
        {"bodies", bodies},
        {"standard_error", s.standard_error > 0 ? Json(s.standard_error) : Json(nullptr)},
        {"energy",
         {{"emitted", s.energy.emitted},
          {"absorbed", s.energy.absorbed},
          {"escaped", s.energy.escaped},
          {"defect", s.energy.defect},
          {"unit", own.power()}}},
        {"seconds", seconds_of(s)},
        {"peak_memory_bytes", s.peak_memory_bytes},
        {"link_memory_bytes", s.link_memory_bytes},
        {"bytes_per_link", share(s.link_memory_bytes, s.links)},
        {"element_memory_bytes", s.element_memory_bytes},
        {"bytes_per_element", share(s.element_memory_bytes, elements)},
        {"elements_by_level", s.elements_by_level},
        {"warnings", s.warnings},
    };
    if (const auto& d = s.discontinuity) {
        json["curves"] = {{"d0", d->d0}, {"d1", d->d1}, {"d2", d->d2}, {"eee", d->eee}, {"left_out", d->left_out}};
        json["wedges"] = d->wedges;
        json["faces"] = {{"lit", d->lit}, {"penumbra", d->penumbra}, {"umbra", d->umbra}};
        json["triangles"] = d->triangles, json["mean_radius_ratio"] = d->mean_radius_ratio;
    }
    for (const auto& [name, value] : s.figures)
        if (!json.contains(name)) json[name] = value;
    return dump(json, 2);
}

std::string statistics_json(const Solution& solution) {
    Json json = Json::parse(statistics_json(solution.statistics, own_unit(solution.scene.is_photometric())));
    const Json options = Json::parse(solution.options, nullptr, false);
    const Json* facts = nullptr;
    if (options.is_object() && options.contains("classical")) {
        const Json& classical = options["classical"];
        if (classical.is_object() && classical.contains("facts")) facts = &classical["facts"];
    }
    const std::string& method = solution.statistics.method;
    const bool is_linked = method == "hierarchical" || method == "wavelet";
    const Json oracle = options.is_object() && options.contains("oracle") ? options["oracle"] : Json(nullptr);
    Json own{{"direct", solution.direct_in_elements ? "carried" : "apart"},
             {"mesh_kind", "aligned"},
             {"links_found_by", is_linked ? oracle : Json("none")},
             {"initial_links", nullptr},
             {"coefficient_memory_bytes", solution.statistics.element_memory_bytes}};
    if (method == name_in(method_names, Method::discontinuity)) {
        const bool given = options.is_object() && options.contains("local_pass") && options["local_pass"].is_string();
        own["local_pass"] = given ? options["local_pass"] : Json(name_in(local_pass_names, LocalPassRule::e));
        own["links_found_by"] = solution.direct_in_elements ? Json(name_in(oracle_names, LinkOracle::power)) : oracle;
    }
    for (const auto& [name, value] : own.items())
        if (!solution.statistics.figures.contains(name))
            json[name] = facts && facts->is_object() && facts->contains(name) ? (*facts)[name] : value;
    return dump(json, 2);
}

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
    if (load.turn_bodies) json["turn_bodies"] = true;
    return dump(json, -1);
}

std::string options_json(const SolveRequest& request, const ClassicalFacts& facts) {
    Json json = Json::parse(recorded_options(request));
    if (!facts.direct.empty())
        json["classical"]["facts"] = {
            {"direct", facts.direct},
            {"mesh_kind", facts.mesh_kind},
            {"links_found_by", facts.links_found_by},
            {"initial_links", facts.initial_links},
            {"coefficient_memory_bytes", facts.coefficient_memory_bytes},
        };
    return dump(json, -1);
}

std::vector<std::pair<std::string, std::string>> option_facts(const SolveRequest& request) {
    std::vector<std::pair<std::string, std::string>> facts;
    const Json json = Json::parse(recorded_options(request));
    for (const auto& [name, value] : json.items())
        if (name != "recipe" && name != "output_light")
            facts.emplace_back(name, dump(value, -1));  // other options record their effect
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
    return {{"rows", check.rows.size()}, {"rays", check.rays}, {"wrong", check.wrong}};
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
        {"surfaces", facts.surfaces},
        {"rows_finished", facts.finished_rows},
        {"entries", facts.entries},
        {"smallest", facts.smallest},
        {"dropped", facts.dropped},
        {"reciprocity_defect", facts.reciprocity_defect},
        {"row_sum", {{"least", facts.least_row_sum}, {"most", facts.most_row_sum}}},
        {"seconds", facts.seconds},
    };
    if (facts.tolerance) {
        json["tolerance"] = *facts.tolerance;
        json["entry_reciprocity_defect"] = facts.entry_defect;
        json["pairs_computed_again"] = facts.mended;
        json["pairs_unsettled"] = facts.unsettled;
        json["check"] = json_of(facts.check);
    } else {
        json["error"] = facts.error;
        json["row_error"] = facts.row_error;
        json["row_error_checked"] = facts.row_check.rows.empty() ? Json() : Json(facts.row_check.error);
        json["closure_defect"] = facts.closure_defect;
        json["rows_unclosed"] = facts.unclosed;
        json["check"] = json_of(facts.row_check);
    }
    return dump(json, 2);
}

std::string values_json(const std::vector<std::pair<std::string, double>>& values) {
    Json json;
    for (const auto& [name, value] : values) json[name] = value;
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
