#include "exitance/methods/options/solve_option_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "exitance/base/random.hpp"
#include "exitance/methods/hierarchical/hierarchical.hpp"
#include "exitance/methods/options/recipes.hpp"
#include "exitance/methods/options/value_kinds.hpp"

namespace exitance {
namespace {

namespace group = option_groups;
using namespace option_values;
using enum Method;

// ---------------------------------------------------------------------------------------- who supports what

constexpr Ways standard(std::initializer_list<Method> methods) {
    return {Form::standard, methods};
}
constexpr Ways published(std::initializer_list<Method> methods) {
    return {Form::published, methods};
}
constexpr Ways tasks(Form::tasks, {hierarchical}), local_passes(Form::local_passes, {discontinuity});
constexpr Ways every_standard =
    standard({matrix, hierarchical, wavelet, progressive, substructuring, monte_carlo, discontinuity, growing_cells});
constexpr Ways every_published = published({matrix, progressive, substructuring, hierarchical, wavelet});
constexpr Ways shooting = standard({progressive, substructuring}) | published({progressive, substructuring});
constexpr Ways linked = standard({hierarchical, wavelet}), published_links = published({hierarchical, wavelet});
constexpr Ways discontinuities = standard({discontinuity}) | local_passes;

bool has_constant_elements(const SolveRequest& r) {
    return r.options.basis.value_or(BasisKind::constant) == BasisKind::constant;
}
bool is_galerkin_matrix(const SolveRequest& r) {
    return r.options.basis && is_galerkin(*r.options.basis) && r.options.bounces < 0;
}
bool is_no_galerkin_matrix(const SolveRequest& r) {
    return !is_galerkin_matrix(r);
}
bool has_constant_or_linear_elements(const SolveRequest& r) {
    return has_constant_elements(r) || r.options.basis == BasisKind::linear;
}
bool samples_matrix_by_pairs(const SolveRequest& r) {
    return has_constant_elements(r) && r.options.form_factors == FormFactorKind::analytic;
}
bool has_hemicubes(const SolveRequest& r) {
    return has_constant_elements(r) && r.options.form_factors == FormFactorKind::hemicube;
}
/// `--method discontinuity` finds reflected light as `hierarchical` does, unless reflections are counted.
bool counts_no_reflections(const SolveRequest& r) {
    return r.options.bounces <= 0;
}
bool finds_links_by_rays(const SolveRequest& r) {
    return !asks_for_judged_links(r.options);
}
bool finds_discontinuity_links_by_rays(const SolveRequest& r) {
    return counts_no_reflections(r) && finds_links_by_rays(r);
}

const char* const with_constant = "with --basis constant";
const char* const with_galerkin = "with --basis galerkin1 to galerkin3";
const char* const without_counting = "without --bounces N";
const char* const with_links_by_rays = "if rays find the links (see docs/methods.md)";

using Support = std::vector<OptionSupport>;

Support operator+(Support a, const Support& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

/// Methods with links between elements of a hierarchy.
Support links_of_hierarchies(const char* values = "") {
    return {{linked, values}, {standard({discontinuity}), values, counts_no_reflections, without_counting}};
}
/// Methods with links, of hierarchies or of the blocks of Galerkin's matrix.
Support all_links(const char* values = "") {
    return links_of_hierarchies(values) + Support{{standard({matrix}), values, is_galerkin_matrix, with_galerkin}};
}
/// Methods that sample the visibility between pairs of elements.
Support sampled_pairs(const char* values = "") {
    return {{shooting, values}, {standard({matrix}), values, samples_matrix_by_pairs, "with --form-factors analytic"}};
}

// -------------------------------------------------------------------------------------------- kinds of values

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
                               [](int n) { return n == all_bounces ? quoted("all") : std::to_string(n); });
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

OptionValue clusters() {
    OptionValue out = on_off(at(&SolveOptions::clusters));
    const auto read = out.read;
    out.type = "auto|on|off";
    out.read = [read](const std::string& word, SolveRequest& r) -> std::string {
        if (word != "auto" && word != "on" && word != "off")
            return fmt::format("must be auto, on or off, not '{}'", word);
        return word == "auto" ? r.options.clusters.reset(), std::string() : read(word, r);
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

/// A value with the names of two tables, each stored in a member of its own: one for the standard form, and one for
/// names that only published forms have.
template <class First, class FirstMember, class Second, class SecondMember>
OptionValue either(const First& first, FirstMember in_first, const Second& second, SecondMember in_second) {
    const OptionValue one = choice(first, in_first), other = choice(second, in_second);
    OptionValue out;
    out.type = one.type + "|" + other.type;
    out.read = [&first, &second, in_first, in_second](const std::string& word, SolveRequest& r) -> std::string {
        in_first(r).reset(), in_second(r).reset();
        if (choose(first, word, in_first(r)) || choose(second, word, in_second(r))) return "";
        return fmt::format("'{}' is not one of {}, {}", word, names_of(first, ", "), names_of(second, ", "));
    };
    out.word = [one, other](const SolveRequest& r) {
        const std::optional<std::string> word = one.word(r);
        return word ? word : other.word(r);
    };
    out.json = [one, other](const SolveRequest& r) { return one.word(r) ? one.json(r) : other.json(r); };
    return out;
}

/// Value of --threshold. Published forms and the task engine store it in different members.
OptionValue threshold() {
    OptionValue out = positive("X", at(&ClassicalOptions::threshold));
    const auto value = [](const SolveRequest& r) {
        return r.classical.threshold ? r.classical.threshold : r.options.threshold;
    };
    out.word = [value](const SolveRequest& r) {
        const auto set = value(r);
        return set ? std::optional(text_of(*set)) : std::nullopt;
    };
    out.json = [value](const SolveRequest& r) {
        const auto set = value(r);
        return set ? text_of(*set) : "null";
    };
    return out;
}

OptionValue multigrid() {
    static constexpr double most = 40;
    OptionValue out = count(at(&ClassicalOptions::multigrid), 1);
    out.type = "N|off";
    out.read = [](const std::string& word, SolveRequest& r) -> std::string {
        if (word == "off") return r.classical.multigrid.reset(), "";
        const std::optional<double> value = number_in(word);
        if (!value || *value != std::floor(*value) || *value < 1 || *value > most)
            return fmt::format("must be 'off' or a whole number from 1 to {}, not '{}'", most, word);
        r.classical.multigrid = static_cast<std::size_t>(*value);
        return "";
    };
    return out;
}

/// Reads --snapshots: "rounds", "shots=100,1000" or "t=0.5,1,2" (seconds). Returns the message of an error.
std::string read_snapshots(const std::string& word, SnapshotPlan& plan) {
    if (word == "rounds") return plan.rounds = true, "";
    const bool shots = word.starts_with("shots="), times = word.starts_with("t=");
    const std::string wrong = fmt::format("'{}' is not 'rounds', 'shots=N,...' or 't=SECONDS,...'", word);
    if (!shots && !times) return wrong;
    std::string rest = word.substr(word.find('=') + 1);
    while (!rest.empty()) {
        const std::size_t comma = std::min(rest.find(','), rest.size());
        const std::optional<double> value = number_in(rest.substr(0, comma));
        if (!value || !(*value > 0) || *value > 1e15 || (shots && *value != std::floor(*value))) return wrong;
        if (shots)
            plan.shots.push_back(static_cast<std::size_t>(*value));
        else
            plan.seconds.push_back(*value);
        rest.erase(0, comma + 1);
    }
    return plan.any() ? "" : wrong;
}

OptionValue snapshots() {
    OptionValue out;
    out.type = "WHEN";
    out.read = [](const std::string& word, SolveRequest& r) {
        r.classical.snapshots = {};
        return read_snapshots(word, r.classical.snapshots);
    };
    out.word = [](const SolveRequest& r) -> std::optional<std::string> {
        const SnapshotPlan& plan = r.classical.snapshots;
        if (!plan.any()) return {};
        return plan.rounds ? "rounds" : plan.shots.empty() ? "t" : "shots";
    };
    out.json = [](const SolveRequest&) { return "null"; };
    return out;
}

/// Value of --dm-sources: "8" for a number of surfaces, "20W" for the surfaces that send out at least that power.
OptionValue secondary_sources() {
    OptionValue out;
    out.type = "N|POWER";
    out.read = [](const std::string& word, SolveRequest& r) -> std::string {
        const bool is_power = word.ends_with("W");
        const std::optional<double> value = number_in(is_power ? word.substr(0, word.size() - 1) : word);
        if (!value) return not_a_number(word);
        if (is_power && !(*value > 0)) return fmt::format("must be above 0 W, not {}", word);
        if (!is_power && (*value != std::floor(*value) || *value < 0 || *value > 1e6))
            return fmt::format("must be a whole number of surfaces, or a power such as 20W, not {}", word);
        r.options.discontinuity.sources =
            is_power ? SecondarySources{.power = *value} : SecondarySources{.count = static_cast<std::size_t>(*value)};
        return "";
    };
    out.word = [](const SolveRequest& r) -> std::optional<std::string> {
        const auto& set = r.options.discontinuity.sources;
        if (!set) return {};
        return set->power ? text_of(*set->power) + "W" : std::to_string(set->count.value_or(0));
    };
    out.json = [](const SolveRequest& r) -> std::string {
        const auto& set = r.options.discontinuity.sources;
        if (!set) return "null";
        return fmt::format(R"({{"count": {}, "power": {}}})", set->count ? std::to_string(*set->count) : "null",
                           set->power ? text_of(*set->power) : "null");
    };
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

OptionValue recipe_name() {
    OptionValue out = text("NAME", at(&SolveRequest::recipe));
    out.read = [](const std::string& word, SolveRequest& r) -> std::string {
        if (find_recipe(word)) return r.recipe = word, "";
        const std::string near = nearest_recipe(word);
        return near.empty() ? fmt::format("there is no recipe '{}'; exitance solve --help-all lists them", word)
                            : fmt::format("there is no recipe '{}'; did you mean {}?", word, near);
    };
    return out;
}

constexpr std::array<std::pair<bool, std::string_view>, 2> quantity_kinds{
    {{false, "radiometric"}, {true, "photometric"}}};

// -------------------------------------------------------------------------------------------------- the table

std::vector<OptionRow> rows_for_users() {
    using R = SolveRequest;
    using O = SolveOptions;
    return {
        {.name = "--method",
         .value = choice(method_names, at(&O::method)),
         .does = "Method that finds the reflected light",
         .initial = "auto: the one that a forecast finds best for the scene",
         .when = "Give one to compare methods",
         .group = group::light},
        {.name = "--error",
         .value = requested_error(),
         .does = "Requested relative RMS error of the light that probe evaluates",
         .initial = "0.02",
         .when = "The run ends with status 4 if it is not reached",
         .group = group::light,
         .support = {{every_standard | every_published | local_passes}}},
        {.name = "--error-interpolant",
         .value = positive("R", at(&O::error_interpolant)),
         .does = "Requested relative RMS error of the mesh that export writes",
         .initial = "3 times --error",
         .when = "Use it if the exported mesh is the product",
         .group = group::light,
         .support = {{every_standard | local_passes}}},
        {.name = "--output-light",
         .value = choice(output_light_names, at(&R::output_light)),
         .does = "Light that the solution holds: the final gather, the method's own elements, or these smoothed",
         .initial = "gathered",
         .when = "Elements show what a method alone finds",
         .group = group::light,
         .support = {{every_standard | every_published}, {tasks, "elements|smoothed-elements"}}},
        {.name = "--bounces",
         .value = bounces(),
         .does = "Number of reflections to compute; 0 is direct light alone",
         .initial = "all",
         .when = "Numbers above 0 are counted by --method matrix, which replaces other methods",
         .group = group::light,
         .support = {{every_standard}}},
        {.name = "--importance",
         .value = importance(),
         .does = "Points (.csv or .pts, as for probe) at which the light is wanted; links are refined for them",
         .when = "Use it if only a few places of a large scene matter",
         .group = group::light,
         .support = links_of_hierarchies(),
         .one_process = "*"},
        {.name = "--light-groups",
         .value = flag(at(&R::light_groups)),
         .does = "Also solve each light group of the scene and keep its light, for mix, view and bake",
         .when = "It takes the time of all these solves",
         .group = group::light,
         .support = {{standard({matrix, hierarchical, wavelet, progressive, substructuring, monte_carlo})}},
         .excludes = {{"--keep-links"}, {"--checkpoint-every"}, {"--resume"}},
         .one_process = "*",
         .section = "-"},
        {.name = "--sky",
         .value = text("SKY", at(&R::sky)),
         .does = "Light from outside: uniform, overcast, clear, cie1 to cie15 or perez with its parameters, such as "
                 "'perez,lat=47.4,lon=8.5,time=06-21T12:00,dni=700,dhi=120'",
         .when = "See docs/daylight.md",
         .group = group::scene,
         .section = "-"},
        {.name = "--epw",
         .value = text("FILE", at(&R::epw)),
         .does = "Weather file with the place and the irradiances for --sky",
         .group = group::scene,
         .needs = {{"--sky"}},
         .section = "-"},
        {.name = "--quantity",
         .value = choice(quantity_kinds, at(&R::photometric)),
         .does = "Unit of the scene's emission: watts or lumens",
         .initial = "as the file says: photometric for glTF files with lights",
         .group = group::scene,
         .section = "-"},
        {.name = "--memory-limit",
         .value = memory_limit(),
         .does = "Resident memory of the process, such as 4G; if it is exceeded, the light found so far is written, "
                 "with status 4",
         .group = group::limits,
         .support = {{every_standard | every_published}},
         .section = "-"},
        {.name = "--checkpoint-every",
         .value = positive("SECONDS", at(&R::checkpoint_every)),
         .does = "Keep the state of the solve in FILE.checkpoint beside the output",
         .when = "Use it for solves of hours",
         .group = group::limits,
         .support = {{every_standard}},
         .section = "-"},
        {.name = "--resume",
         .value = flag(at(&R::resume)),
         .does = "Continue from the checkpoint beside the output, if there is one",
         .group = group::limits,
         .support = {{every_standard}},
         .section = "-"},
        {.name = "--dry-run",
         .value = flag(at(&R::dry_run)),
         .does = "Print counts and a forecast of time and memory; solve and write nothing",
         .group = group::limits,
         .support = {{every_standard}},
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

std::vector<OptionRow> rows_for_experts() {
    using R = SolveRequest;
    using O = SolveOptions;
    const std::string judged = "Setting it makes one attempt, without refinement to --error";
    return {
        {.name = "--mesh-size",
         .value = positive("METRES", at(&O::mesh_size)),
         .does = "Longest edge of an element",
         .initial = "by --error",
         .when = judged,
         .group = group::accuracy,
         .support = {{every_standard | every_published}}},
        {.name = "--min-area",
         .value = positive("M2", at(&O::min_area)),
         .does = "Area below which no element is split, m^2",
         .initial = "by --error; published forms: 1/65536 of all surfaces",
         .group = group::accuracy,
         .support = {{every_standard | tasks | published({substructuring, hierarchical, wavelet})}}},
        {.name = "--residual",
         .value = positive("R", at(&O::residual)),
         .does = "Residual of the linear system, relative to its right-hand side, at which solving stops",
         .initial = "0.05 times --error",
         .group = group::accuracy,
         .support = {{every_standard | every_published | tasks}}},
        {.name = "--max-iterations",
         .value = count(at(&O::max_iterations), 1),
         .does = "Most sweeps, Krylov steps or shots",
         .initial = "by method",
         .group = group::accuracy,
         .support = {{every_standard | every_published | tasks}}},
        {.name = "--epsilon",
         .value = positive("R", at(&O::epsilon)),
         .does = "Tolerance for the total link error (relative RMS); links are then refined pair by pair",
         .initial = "by --error",
         .group = group::accuracy,
         .support = all_links()},
        {.name = "--basis",
         .value = choice(basis_names, at(&O::basis)),
         .does = "Functions on the elements",
         .initial = "constant for matrix, multiwavelet2 for wavelet",
         .group = group::method,
         .support = {{standard({matrix}), "constant|linear|galerkin1|galerkin2|galerkin3"},
                     {published({matrix}) | shooting | standard({monte_carlo}), "constant"},
                     {standard({hierarchical}) | published({hierarchical}) | tasks, "haar"},
                     {standard({wavelet}) | published({wavelet}),
                      "haar|flatlet2|flatlet3|multiwavelet2|multiwavelet3"}},
         .one_process = "galerkin1|galerkin2|galerkin3"},
        {.name = "--relaxation",
         .value = either(relaxation_names, at(&O::relaxation), classical_relaxation_names,
                         at(&ClassicalOptions::relaxation)),
         .does = "Solver of the linear system; sor and direct select the published form",
         .initial = "gmres; chebyshev for judged links; southwell for shooting methods",
         .group = group::method,
         .support = {{standard({matrix, hierarchical, wavelet}), "jacobi|chebyshev|gmres"},
                     {standard({discontinuity}), "jacobi|chebyshev|gmres", counts_no_reflections, without_counting},
                     {standard({matrix}), "gauss-seidel|southwell", is_no_galerkin_matrix,
                      "with --basis constant or linear"},
                     {standard({matrix}), "cg", has_constant_elements, with_constant},
                     {standard({hierarchical}), "gauss-seidel|cg|southwell", finds_links_by_rays, with_links_by_rays},
                     {standard({discontinuity}), "gauss-seidel|cg|southwell", finds_discontinuity_links_by_rays,
                      with_links_by_rays},
                     {shooting, "southwell"},
                     {standard({monte_carlo}), "jacobi"},
                     {published({matrix})},
                     {published_links, "jacobi"}},
         .one_process = "gauss-seidel|southwell|sor|direct"},
        {.name = "--overshooting",
         .value = flag(at(&O::overshooting)),
         .does = "Also shoot an estimate of the light that will be reflected back [Feda92]",
         .group = group::method,
         .support = {{shooting}}},
        {.name = "--clusters",
         .value = clusters(),
         .does = "Also link clusters of polygons",
         .initial = "auto: where polygons are many",
         .group = group::method,
         .support = links_of_hierarchies() + Support{{every_published | tasks, "off"}}},
        {.name = "--oracle",
         .value = choice(oracle_names, at(&O::oracle)),
         .does = "Criterion by which links are refined: the error of the transported light, form factor, or power",
         .initial = "transport",
         .group = group::method,
         .support = links_of_hierarchies() + Support{{published_links | tasks}},
         .needs = {{"--threshold", "ff|bf", Form::published}}},
        {.name = "--keep-links",
         .value = flag(at(&O::keep_links)),
         .does = "Write the links of a hierarchy into the solution, for export --links and view",
         .group = group::method,
         .support = links_of_hierarchies()},
        {.name = "--max-units",
         .value = count(at(&O::max_units), 8),
         .does = "Most units of each network of growing cells",
         .initial = "by --error",
         .group = group::method,
         .support = {{standard({growing_cells})}},
         .needs_method = true},
        {.name = "--seed",
         .value = count(at(&O::seed), 0),
         .does = "Seed of all random numbers",
         .initial = "1",
         .when = "Other seeds show how much of an error is noise",
         .group = group::method},
        {.name = "--schedule",
         .value = choice(schedule_names, at(&O::schedule)),
         .does = "How tasks are distributed to threads; the result does not depend on it",
         .initial = "stealing",
         .group = group::method,
         .section = "-"},
        {.name = "--trace",
         .value = text("FILE", at(&R::trace)),
         .does = "Write time, thread and data of every task (Chrome trace format, .json)",
         .group = group::method,
         .one_process = "*",
         .section = "-"},
        {.name = "--visibility",
         .value = choice(visibility_names, at(&O::visibility)),
         .does = "Visibility of pairs: one unoccluded share per pair, one ray per pair of nodes, or (published forms) "
                 "the exact visible part",
         .initial = "auto",
         .group = group::visibility,
         .support =
             all_links("fractional|quadrature") + sampled_pairs("fractional") +
             Support{{every_published | tasks | local_passes, "fractional"}, {published_links, "quadrature|exact"}}},
        {.name = "--visibility-samples",
         .value = count(at(&O::visibility_samples), 1),
         .does = "Rays per pair of elements",
         .initial = "16",
         .group = group::visibility,
         .support = sampled_pairs() + Support{{every_published | tasks | local_passes}}},
        {.name = "--triage",
         .value = on_off(at(&O::triage)),
         .does = "Find links that are certainly visible or hidden before rays are cast",
         .initial = "on",
         .group = group::visibility,
         .support = all_links() + Support{{published_links | tasks}}},
        {.name = "--form-factors",
         .value =
             either(form_factor_names, at(&O::form_factors), shooting_receiver_names, at(&ClassicalOptions::receivers)),
         .does =
             "How form factors are computed; vertex and middle are receivers of shots and select the published form",
         .initial = "by method",
         .group = group::visibility,
         .support = {{standard({matrix}), "analytic|hemicube", has_constant_elements, with_constant},
                     {standard({progressive, substructuring}), "analytic"},
                     {standard({matrix}), "ray-cast", has_constant_or_linear_elements,
                      "with --basis constant or linear"},
                     {published({matrix}), "analytic|hemicube|ray-cast"},
                     {published({progressive}), "hemicube|ray-cast"},
                     {published({progressive, substructuring}), "vertex|middle"},
                     {tasks | local_passes, "analytic"}},
         .one_process = "analytic|hemicube|vertex|middle"},
        {.name = "--hemicube-cells",
         .value = count(at(&O::hemicube_cells), 2),
         .does = "Cells along an edge of the top of a hemicube; an even number",
         .initial = "by --error",
         .group = group::visibility,
         .support = {{standard({matrix}), "", has_hemicubes, "with --form-factors hemicube"},
                     {published({matrix, progressive})}}},
        {.name = "--dm-sources",
         .value = secondary_sources(),
         .does = "Also mesh along shadows of reflected light: of the N surfaces that reflect the most, or of those "
                 "that reflect at least a power (20W)",
         .group = group::shadows,
         .support = {{discontinuities}},
         .needs_method = true,
         .excludes = {{"--bounces 0"}},
         .section = "discontinuity"},
        {.name = "--eee",
         .value = choice(three_edge_names, at(&DiscontinuityChoice::three_edges)),
         .does = "Curves of events of three edges",
         .initial = "auto: where they may bound an umbra",
         .group = group::shadows,
         .support = {{discontinuities}},
         .needs_method = true,
         .section = "discontinuity"},
        {.name = "--dm-quality",
         .value = choice(mesh_quality_names, at(&DiscontinuityChoice::quality)),
         .does = "Shape of triangles: as bisection leaves it, or with points added until angles exceed 20.7 degrees",
         .initial = "rivara",
         .group = group::shadows,
         .support = {{discontinuities}},
         .needs_method = true,
         .excludes = {{"--triangulation longest|shortest|heuristic", "delaunay"}},
         .section = "discontinuity"},
        {.name = "--dm-element",
         .value = choice(mesh_element_names, at(&DiscontinuityChoice::element)),
         .does = "Functions on triangles: quadratic, or cubic with continuous tangent planes where light is smooth",
         .initial = "quadratic",
         .group = group::shadows,
         .support = {{standard({discontinuity})}, {local_passes, "quadratic"}},
         .needs_method = true,
         .section = "discontinuity"},
    };
}

std::vector<OptionRow> rows_of_laboratory() {
    using C = ClassicalOptions;
    using O = SolveOptions;
    return {
        {.name = "--recipe",
         .value = recipe_name(),
         .does = "Preset the options of a published form (list below); options given beside it replace its presets",
         .group = group::published},
        {.name = "--direct",
         .value = choice(classical_direct_names, at(&C::direct)),
         .does = "Direct light of emitters: exact and apart, or carried by the method's own transport",
         .initial = "apart",
         .group = group::published,
         .support = {{every_published}},
         .section = "classical"},
        {.name = "--mesh",
         .value = choice(mesh_kind_names, at(&C::mesh)),
         .does = "Elements that follow contacts, edges and shadows, or elements by --mesh-size alone",
         .initial = "aligned; links make their own mesh",
         .group = group::published,
         .support = {{every_published, "uniform"}, {published({matrix, progressive, substructuring}), "aligned"}},
         .section = "classical"},
        {.name = "--certify",
         .value = on_off(at(&C::certify)),
         .does = "off: one attempt without an error estimate, which selects the published form",
         .group = group::published,
         .support = {{every_published, "off"}},
         .section = "classical"},
        {.name = "--threshold",
         .value = threshold(),
         .does = "Refine links above this form factor (--oracle ff) or power in W (--oracle bf)",
         .group = group::published,
         .support = {{published_links | tasks}},
         .needs = {{"--oracle ff|bf", "", Form::published}}},
        {.name = "--multigrid",
         .value = multigrid(),
         .does = "Rounds of refinement and solution, in each of which the threshold is halved",
         .initial = "off",
         .group = group::published,
         .support = {{published_links}},
         .needs = {{"--threshold"}},
         .section = "classical"},
        {.name = "--kernel",
         .value = choice(transfer_kernel_names, at(&C::kernel)),
         .does = "Form factor of a link: from point to point, to a disc, or exact",
         .initial = "exact",
         .group = group::published,
         .support = {{published_links}},
         .section = "classical"},
        {.name = "--refine-gradient",
         .value = positive("G", at(&C::refine_gradient)),
         .does = "Split elements across which radiosity changes by more than G, W/m^2",
         .group = group::published,
         .support = {{published({substructuring})}},
         .section = "classical"},
        {.name = "--refine",
         .value = choice(refine_when_names, at(&C::refine)),
         .does = "Split elements during shooting, or after it",
         .initial = "during",
         .group = group::published,
         .support = {{published({substructuring})}},
         .needs = {{"--refine-gradient"}},
         .section = "classical"},
        {.name = "--sor-factor",
         .value = positive("W", at(&C::sor_factor), 2),
         .does = "Factor of over-relaxation",
         .initial = "1.15",
         .group = group::published,
         .support = {{published({matrix})}},
         .needs = {{"--relaxation sor"}},
         .section = "classical"},
        {.name = "--ambient",
         .value = flag(at(&C::ambient)),
         .does = "Add an estimate of the unshot light to the result [Cohen88]",
         .group = group::published,
         .support = {{published({progressive, substructuring})}},
         .section = "classical"},
        {.name = "--snapshots",
         .value = snapshots(),
         .does = "Write intermediate solutions S.0001.h5, ...: t=0.5,1 (seconds), shots=10,100 or rounds",
         .group = group::published,
         .support = {{every_published, "t"},
                     {published({progressive, substructuring}), "shots"},
                     {published({matrix, hierarchical, wavelet}), "rounds"}},
         .excludes = {{"--relaxation cg|gmres|chebyshev|direct"}},
         .section = "-"},
        {.name = "--task-engine",
         .value = flag(at(&O::task_engine)),
         .does = "Hierarchical radiosity as tasks that create tasks [Vinod95]; links also carry the emitters' light",
         .group = group::structures,
         .support = {{tasks}},
         .needs_method = true,
         .one_process = "*"},
        {.name = "--gcs",
         .value = choice(cells_names, at(&O::gcs)),
         .does = "Growing cells as published, with all light through the networks, or improved",
         .initial = "improved",
         .group = group::structures,
         .support = {{standard({growing_cells})}},
         .needs_method = true},
        {.name = "--local-pass",
         .value = choice(local_pass_names, at(&O::local_pass)),
         .does = "Light at the nodes of a discontinuity mesh: a of the leaves, b with new form factors, c with new "
                 "visibility, d with primary sources recomputed, e with exact direct light",
         .initial = "e",
         .group = group::structures,
         .support = {{standard({discontinuity}), "e"}, {local_passes, "a|b|c|d"}},
         .needs_method = true},
        {.name = "--triangulation",
         .value = choice(triangulation_choices, at(&DiscontinuityChoice::triangulation)),
         .does = "Triangulation of the faces between curves: Delaunay's, or the thesis's on convex receivers",
         .initial = "delaunay",
         .group = group::structures,
         .support = {{discontinuities}},
         .needs_method = true,
         .section = "discontinuity"},
        {.name = "--premesh",
         .value = choice(premesh_names, at(&DiscontinuityChoice::premesh)),
         .does = "Lines that are inserted first: none, those that bound penumbrae, or a coarse grid",
         .initial = "off",
         .group = group::structures,
         .support = {{discontinuities}},
         .needs_method = true,
         .needs = {{"--triangulation longest|shortest|heuristic", "penumbra-first|coarse"}},
         .section = "discontinuity"},
        {.name = "--dm-structure",
         .value = choice(structure_names, at(&DiscontinuityChoice::structure)),
         .does = "Search for blockers: shafts and a tree of boxes, or a BSP tree with shadow volumes, one by one or "
                 "merged into one tree per source",
         .initial = "bvh",
         .group = group::structures,
         .support = {{discontinuities}},
         .needs_method = true,
         .section = "discontinuity"},
        {.name = "--layers",
         .value = on_off(at(&DiscontinuityChoice::layers)),
         .does = "Make one compressed mesh per source, whose light is added up, in place of one mesh for all",
         .initial = "off",
         .group = group::structures,
         .support = {{standard({discontinuity})}},
         .needs_method = true,
         .excludes = {{"--dm-element clough-tocher", "on"}},
         .section = "discontinuity"},
        {.name = "--smoothing",
         .value = on_off(at(&O::smoothing)),
         .does = "Old name of --output-light elements (off) and smoothed-elements (on); will be removed in 0.4",
         .group = group::old_names,
         .support = {{every_standard | every_published | tasks}}},
        {.name = "--gather",
         .value = on_off(at(&C::gather)),
         .does = "Old name of --recipe classical-METHOD (off) and --output-light gathered (on); will be removed in 0.4",
         .group = group::old_names,
         .support = {{every_published}},
         .section = "classical"},
    };
}

std::vector<OptionRow> make_table() {
    std::vector<OptionRow> table = rows_for_users();
    for (auto&& rows : {rows_for_experts(), rows_of_laboratory()}) table.insert(table.end(), rows.begin(), rows.end());
    return table;
}

std::string key_of(const OptionRow& row) {
    std::string key = row.name.substr(2);
    std::replace(key.begin(), key.end(), '-', '_');
    return quoted(key);
}

/// JSON members ("key": value, ...) of the options in a section.
std::string members(std::string_view section, const SolveRequest& request) {
    std::string out;
    for (const OptionRow& row : solve_option_table())
        if (row.section == section)
            out += fmt::format("{}{}: {}", out.empty() ? "" : ", ", key_of(row), row.value.json(request));
    return out;
}

}  // namespace

std::span<const OptionRow> solve_option_table() {
    static const std::vector<OptionRow> table = make_table();
    return table;
}

const OptionRow* find_option(std::string_view name) {
    const auto table = solve_option_table();
    const auto row = std::find_if(table.begin(), table.end(), [&](const OptionRow& r) { return r.name == name; });
    return row == table.end() ? nullptr : &*row;
}

std::string recorded_options(const SolveRequest& request) {
    std::string out = members("", request);
    if (request.options.discontinuity.any())
        out += fmt::format(", \"discontinuity\": {{{}}}", members("discontinuity", request));
    if (request.classical.any()) out += fmt::format(", \"classical\": {{{}}}", members("classical", request));
    return "{" + out + "}";
}

std::string help_of(const OptionRow& row) {
    std::string out = row.does + ".";
    if (!row.initial.empty()) out += fmt::format(" Default {}.", row.initial);
    if (!row.when.empty()) out += fmt::format(" {}.", row.when);
    return out;
}

bool is_among(std::string_view word, std::string_view values) {
    while (!values.empty()) {
        const std::size_t bar = std::min(values.find('|'), values.size());
        if (values.substr(0, bar) == word) return true;
        values.remove_prefix(std::min(bar + 1, values.size()));
    }
    return false;
}

}  // namespace exitance
