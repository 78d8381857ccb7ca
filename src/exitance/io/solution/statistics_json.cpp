#include "exitance/io/solution/statistics_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "exitance/solve/solve_options.hpp"

namespace exitance {
namespace {

using Json = nlohmann::ordered_json;

/// Text of a JSON value. Bytes that are not UTF-8, which text from files may contain, are replaced.
std::string dump(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

/// The value as JSON; null without a value.
template <class T>
Json value_or_null(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

/// Seconds of every part of the run. Only some runs have `light_groups` and `mix`; `visibility` and `form_factors` are
/// null if they were not timed.
Json seconds_of(const RunSeconds& seconds) {
    Json json;
    RunSeconds::for_parts([&](RunPart part) {
        const bool is_timed = seconds[part] > 0;
        if (!is_timed && (part == RunPart::light_groups || part == RunPart::mix)) return;
        const bool is_null = !is_timed && (part == RunPart::visibility || part == RunPart::form_factors);
        json[RunSeconds::name(part)] = is_null ? Json(nullptr) : Json(seconds[part]);
    });
    return json;
}

Json rooms_of(const SolveStatistics& s) {
    Json rooms = Json::array();
    for (const RoomError& room : s.rooms)
        rooms.push_back(
            {{"area", room.area}, {"mean", room.mean}, {"reference", room.reference}, {"error", room.error}});
    return rooms;
}

Json bodies_of(const SolveStatistics& s) {
    Json bodies = Json::array();
    for (const BodyError& body : s.bodies)
        bodies.push_back({{"surfaces", body.surfaces},
                          {"area", body.area},
                          {"mean", body.mean},
                          {"error", value_or_null(body.error)},
                          {"points", body.points}});
    return bodies;
}

/// Counts among the further results are written as whole numbers.
Json number_of(double value) {
    constexpr double exact = 0x1p53;  // derived from double precision: larger whole numbers are not exact
    if (std::abs(value) < exact && value == std::floor(value)) return static_cast<std::int64_t>(value);
    return value;
}

}  // namespace

std::string statistics_json(const SolveStatistics& s, const LightUnit& own) {
    const std::size_t elements =
        std::accumulate(s.elements_by_level.begin(), s.elements_by_level.end(), std::size_t(0));
    const auto share = [](std::size_t whole, std::size_t parts) {
        return parts > 0 ? static_cast<double>(whole) / static_cast<double>(parts) : 0.0;
    };
    Json json{
        {"method", s.method},
        {"basis", s.basis},
        {"threads", s.threads},
        {"processes", s.processes},
        {"schedule", s.schedule},
        {"surfaces", s.surfaces},
        {"elements", s.elements},
        {"leaf_elements", s.leaf_elements},
        {"links", s.links},
        {"rays", s.rays},
        {"form_factors", s.form_factors},
        {"iterations", s.iterations},
        {"converged", s.converged},
        {"stopped_by", name_of(s.stopped_by)},
        {"residual", s.residual},
        {"relative_error_estimate", value_or_null(s.relative_error_estimate)},
        {"relative_error_bound", value_or_null(s.relative_error_bound)},
        {"relative_error_estimate_interpolant", value_or_null(s.relative_error_estimate_interpolant)},
        {"relative_error_estimate_worst_room", value_or_null(s.relative_error_estimate_worst_room)},
        {"relative_error_estimate_worst_body", value_or_null(s.relative_error_estimate_worst_body)},
        {"error_p99", value_or_null(s.error_p99)},
        {"rooms", rooms_of(s)},
        {"bodies", bodies_of(s)},
        {"standard_error", s.standard_error > 0 ? Json(s.standard_error) : Json(nullptr)},
        {"energy",
         {{"emitted", s.energy.emitted},
          {"absorbed", s.energy.absorbed},
          {"escaped", s.energy.escaped},
          {"defect", s.energy.defect},
          {"unit", own.power()}}},
        {"seconds", seconds_of(s.seconds)},
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
    if (s.energy.defect_before) json["energy_defect_before"] = *s.energy.defect_before;
    if (s.refinement_steps > 0) json["refinement_steps"] = s.refinement_steps;
    for (const auto& [name, value] : s.figures)
        if (!json.contains(name)) json[name] = number_of(value);
    return dump(json);
}

namespace {

/// Adds the facts about a published form that follow from its recorded options.
void add_published_facts(const Json& options, bool is_linked, Json& facts) {
    const Json& classical = options["classical"];
    const auto given = [](const Json& in, const char* key) { return in.contains(key) && !in[key].is_null(); };
    if (is_linked)
        facts["mesh_kind"] = name_in(mesh_kind_names, MeshKind::uniform);
    else if (given(classical, "mesh"))
        facts["mesh_kind"] = classical["mesh"];
    if (is_linked && !given(options, "threshold")) facts["links_found_by"] = "leaves";
    if (given(classical, "facts")) facts.update(classical["facts"]);
}

}  // namespace

std::string statistics_json(const Solution& solution) {
    Json json = Json::parse(statistics_json(solution.statistics, own_unit(solution.scene.is_photometric())));
    const Json options = Json::parse(solution.options, nullptr, false);
    const std::string& method = solution.statistics.method;
    const bool is_linked = method == "hierarchical" || method == "wavelet";
    const Json oracle = options.is_object() && options.contains("oracle") ? options["oracle"] : Json(nullptr);
    Json own{{"direct", solution.direct_in_elements ? "carried" : "apart"},
             {"mesh_kind", "aligned"},
             {"links_found_by", is_linked ? oracle : Json("none")},
             {"initial_links", nullptr},
             {"coefficient_memory_bytes", solution.statistics.element_memory_bytes}};
    if (options.is_object() && options.contains("classical")) add_published_facts(options, is_linked, own);
    if (method == name_in(method_names, Method::discontinuity)) {
        const bool given = options.is_object() && options.contains("local_pass") && options["local_pass"].is_string();
        own["local_pass"] = given ? options["local_pass"] : Json(name_in(local_pass_names, LocalPassRule::e));
        own["links_found_by"] = solution.direct_in_elements ? Json(name_in(oracle_names, LinkOracle::power)) : oracle;
    }
    for (const auto& [name, value] : own.items())
        if (!solution.statistics.figures.contains(name)) json[name] = value;
    return dump(json);
}

}  // namespace exitance
