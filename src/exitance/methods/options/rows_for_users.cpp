#include "exitance/methods/options/option_rows.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>

#include "exitance/base/random.hpp"
#include "exitance/methods/options/value_kinds.hpp"

namespace exitance::option_rows {
namespace {

namespace group = option_groups;
using namespace option_values;

std::string text_of_points(const std::vector<ImportantPoint>& points) {
    if (points.empty()) return "null";
    std::uint64_t all = 0;
    for (const ImportantPoint& p : points)
        for (const double v : {p.at.x, p.at.y, p.at.z, p.normal.x, p.normal.y, p.normal.z})
            all = hash(all, std::bit_cast<std::uint64_t>(v));
    return fmt::format("\"{} points {:016x}\"", points.size(), all);
}

OptionValue requested_error() {
    OptionValue out = positive("R", at(&SolveOptions::error));
    out.json = [](const SolveRequest& r) {
        const std::optional<double> demand = r.options.error_demand();
        return demand ? text_of(*demand) : "null";
    };
    return out;
}

OptionValue bounces() {
    const auto text = [](int n) { return n == all_bounces ? std::string("all") : std::to_string(n); };
    OptionValue out = value_of("N|all", at(&SolveOptions::bounces), text,
                               [](int n) { return n == all_bounces ? json_text("all") : std::to_string(n); });
    out.read = [](const std::string& word, SolveRequest& r) -> std::string {
        const std::optional<double> value = word == "all" ? all_bounces : number_in(word);
        if (!value) return not_a_number(word);
        if (word != "all" && (*value != std::floor(*value) || *value < 0 || *value > 1e9))
            return fmt::format("must be 'all' or a whole number from 0, not {}", word);
        r.options.bounces = static_cast<int>(*value);
        return "";
    };
    return out;
}

OptionValue importance() {
    OptionValue out = text("FILE", at(&SolveRequest::importance));
    out.word = [](const SolveRequest& r) -> std::optional<std::string> {
        if (r.importance.empty() && r.options.importance.empty()) return {};
        return r.importance.empty() ? "points" : r.importance;
    };
    out.json = [](const SolveRequest& r) { return text_of_points(r.options.importance); };
    return out;
}

OptionValue memory_limit() {
    OptionValue out = count(at(&SolveOptions::memory_limit_bytes), 1);
    out.type = "SIZE";
    out.read = [](const std::string& word, SolveRequest& r) -> std::string {
        r.options.memory_limit_bytes = bytes_in(word);
        if (r.options.memory_limit_bytes) return "";
        return fmt::format("'{}' is not a size from 1 byte to an exabyte, such as 500M or 4G", word);
    };
    return out;
}

bool has_no_gradient(const SolveRequest& r) {
    return !r.options.classical.refine_gradient;
}

constexpr std::array<std::pair<bool, std::string_view>, 2> quantity_kinds{
    {{false, "radiometric"}, {true, "photometric"}}};

OptionRow row_of_light_groups() {
    using R = SolveRequest;
    return {.name = "--light-groups",
            .value = flag(at(&R::light_groups)),
            .does =
                "Also solve for each light group (the lamps of one object, see docs/methods/light_groups.md) and "
                "store its light, so that mix, view and bake can dim it",
            .when = "A solve then takes two to three times as long",
            .group = group::light,
            .support = {{standard({matrix, hierarchical, wavelet, progressive, substructuring, monte_carlo})},
                        {standard({discontinuity}), "", has_layers, with_layers}},
            .excludes = {{"--keep-links"}, {"--checkpoint-every"}, {"--resume"}},
            .one_process = "*",
            .section = "-"};
}

std::vector<OptionRow> rows_of_light() {
    using R = SolveRequest;
    using O = SolveOptions;
    return {
        {.name = "--method",
         .value = choice(method_names, at(&O::method)),
         .does = "Method that finds the reflected light",
         .initial = "auto: the method with the best forecast for the scene",
         .when = "Name a method to compare it with others",
         .group = group::light},
        {.name = "--error",
         .value = requested_error(),
         .does = "Requested error of the light that probe evaluates: root mean square (RMS) over all surfaces, "
                 "relative to the mean light",
         .initial = "0.02 (2%)",
         .when = "The run ends with status 4 if it is not reached",
         .group = group::light,
         .support = {{every_standard | every_published | local_passes}}},
        {.name = "--error-interpolant",
         .value = positive("R", at(&O::error_interpolant)),
         .does = "Requested relative RMS error of the mesh that export writes",
         .initial = "3 times --error",
         .when = "Use it if you need the exported mesh rather than light at points",
         .group = group::light,
         .support = {{every_standard | local_passes}}},
        {.name = "--output-light",
         .value = choice(output_light_names, at(&R::output_light)),
         .does = "Light that the solution stores: reflected light computed once more from all surfaces (final gather), "
                 "the light on the method's own elements, or that light smoothed",
         .initial = "gathered",
         .when = "Use elements to see the result of the method alone",
         .group = group::light,
         .support = {{every_standard | every_published}, {tasks, "elements|smoothed-elements"}}},
        {.name = "--bounces",
         .value = bounces(),
         .does = "Number of reflections to compute; 0 is direct light alone",
         .initial = "all",
         .when = "A number above 0 selects --method matrix, whichever method is given",
         .group = group::light,
         .support = {{every_standard}}},
        {.name = "--importance",
         .value = importance(),
         .does = "Points (.csv or .pts, as for probe) at which the light must be accurate; links are refined for them",
         .when =
             "Use it if only a few places of a large scene are of interest, together with --error, which then holds "
             "at these points; without --error no error is required",
         .group = group::light,
         .support = links_of_hierarchies(),
         .one_process = "*"},
        row_of_light_groups(),
    };
}

std::vector<OptionRow> rows_of_scene_and_limits() {
    using R = SolveRequest;
    using O = SolveOptions;
    return {
        {.name = "--sky",
         .value = text("SKY", at(&R::sky)),
         .does =
             "Light from outside: uniform, overcast, clear, cie1 to cie15 or perez with its parameters, such as "
             "'perez,lat=47.4,lon=8.5,time=06-21T12:00,dni=700,dhi=120', or a picture: image=FILE.hdr,rotation=DEGREES",
         .when = "See docs/daylight.md",
         .group = group::scene,
         .section = "-"},
        {.name = "--epw",
         .value = text("FILE", at(&R::epw)),
         .does = "Weather file (.epw or .wea) with the place and the irradiances for --sky",
         .group = group::scene,
         .needs = {{"--sky"}},
         .section = "-"},
        {.name = "--quantity",
         .value = choice(quantity_kinds, at(&R::photometric)),
         .does = "Unit of the scene's emission: watts or lumens",
         .initial = "given by the file: photometric for glTF files with lights",
         .group = group::scene,
         .section = "-"},
        {.name = "--memory-limit",
         .value = memory_limit(),
         .does = "Limit on the resident memory of the process, such as 4G. If it is exceeded, the light found so far "
                 "is written, with status 4",
         .group = group::limits,
         .section = "-"},
        {.name = "--checkpoint-every",
         .value = positive("SECONDS", at(&R::checkpoint_every)),
         .does = "Save the state of the solve at this interval, in FILE.checkpoint beside the output",
         .when = "Use it for solves that take hours",
         .group = group::limits,
         .section = "-"},
        {.name = "--resume",
         .value = flag(at(&R::resume)),
         .does = "Continue from the checkpoint beside the output, if there is one",
         .group = group::limits,
         .section = "-"},
        {.name = "--dry-run",
         .value = flag(at(&R::dry_run)),
         .does = "Print counts and a forecast of time and memory; solve and write nothing",
         .group = group::limits,
         .support = {{every_standard | published({matrix, progressive})},
                     {published({substructuring}), "", has_no_gradient, "without --refine-gradient"}},
         .one_process = "*",
         .section = "-"},
        {.name = "--threads",
         .value = count(at(&O::threads), 1, 1 << 16),
         .does = "Number of threads; the result does not depend on it",
         .initial = "all cores",
         .group = group::run,
         .section = "-"},
    };
}

}  // namespace

std::vector<OptionRow> for_users() {
    return joined({rows_of_light(), rows_of_scene_and_limits()});
}

}  // namespace exitance::option_rows
