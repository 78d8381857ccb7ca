#include "exitance/methods/options/option_rows.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "exitance/base/words.hpp"
#include "exitance/methods/hierarchical/hierarchical.hpp"
#include "exitance/methods/options/value_kinds.hpp"

namespace exitance::option_rows {
namespace {

namespace group = option_groups;
using namespace option_values;

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
bool finds_links_by_rays(const SolveRequest& r) {
    return !asks_for_judged_links(r.options);
}
bool finds_discontinuity_links_by_rays(const SolveRequest& r) {
    return counts_no_reflections(r) && finds_links_by_rays(r);
}

const char* const with_constant = "with --basis constant";
const char* const with_galerkin = "with --basis galerkin1 to galerkin3";
const char* const with_links_by_rays = "if rays find the links (see docs/methods/hierarchical.md)";
const char* const judged = "Setting it makes one attempt, without refinement to --error";

Support operator+(Support a, const Support& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

/// Methods with links, of hierarchies or of the blocks of Galerkin's matrix.
Support all_links(const char* values = "") {
    return links_of_hierarchies(values) + Support{{standard({matrix}), values, is_galerkin_matrix, with_galerkin}};
}
/// Methods that sample the visibility between pairs of elements.
Support sampled_pairs(const char* values = "") {
    return {{shooting, values}, {standard({matrix}), values, samples_matrix_by_pairs, "with --form-factors analytic"}};
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

/// Sets an option back to its default.
template <class T>
void clear(std::optional<T>& option) {
    option.reset();
}
template <class T>
void clear(T& option) {
    option = T();
}

/// A value with the names of two tables, each stored in a member of its own: one for the standard form, and one for
/// names that only published forms have.
template <class First, class FirstMember, class Second, class SecondMember>
OptionValue either(const First& first, FirstMember in_first, const Second& second, SecondMember in_second) {
    const OptionValue one = choice(first, in_first), other = choice(second, in_second);
    OptionValue out;
    out.type = one.type + "|" + other.type;
    out.read = [&first, &second, in_first, in_second](const std::string& word, SolveRequest& r) -> std::string {
        clear(in_first(r)), clear(in_second(r));
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

std::string text_of_lines(const ShadowLines& lines) {
    switch (lines.kind) {
        case ShadowLines::Kind::automatic:
            return "auto";
        case ShadowLines::Kind::all:
            return "all";
        case ShadowLines::Kind::strongest:
            return std::to_string(lines.count);
        case ShadowLines::Kind::on_surfaces:
            break;
    }
    return fmt::format("{}", fmt::join(lines.names, ","));
}

/// Value of --dm-lines: a number of lines, names that commas separate, or a file, which settle_options() reads.
OptionValue shadow_lines() {
    OptionValue out;
    out.type = "auto|all|N|NAMES|FILE";
    out.read = [](const std::string& word, SolveRequest& r) -> std::string {
        using Kind = ShadowLines::Kind;
        ShadowLines& lines = r.options.discontinuity.lines.emplace();
        if (const std::optional<double> number = number_in(word)) {
            if (*number != std::floor(*number) || *number < 0 || *number > 1e9)
                return "must be a whole number of lines, not " + word;
            lines = {.kind = Kind::strongest, .count = static_cast<std::size_t>(*number)};
        } else if (word == "auto" || word == "all") {
            lines = {.kind = word == "all" ? Kind::all : Kind::automatic};
        } else {
            lines.kind = Kind::on_surfaces;
            for (const std::string& name : split_at_commas(word))
                if (!name.empty()) lines.names.push_back(name);
            if (lines.names.empty()) return "names no surfaces";
        }
        return "";
    };
    out.word = [](const SolveRequest& r) -> std::optional<std::string> {
        const auto& set = r.options.discontinuity.lines;
        return set ? std::optional(text_of_lines(*set)) : std::nullopt;
    };
    out.json = [](const SolveRequest& r) -> std::string {
        const auto& set = r.options.discontinuity.lines;
        return set ? json_text(text_of_lines(*set)) : "null";
    };
    return out;
}

std::vector<OptionRow> rows_of_accuracy() {
    using O = SolveOptions;
    return {
        {.name = "--mesh-size",
         .value = positive("METRES", at(&O::mesh_size)),
         .does = "Longest edge of an element",
         .initial = "derived from --error",
         .when = judged,
         .group = group::accuracy,
         .support = {{every_standard | every_published}}},
        {.name = "--min-area",
         .value = positive("M2", at(&O::min_area)),
         .does = "Area below which no element is split, m^2",
         .initial = "derived from --error; published forms: 1/65536 of the area of all surfaces",
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
         .does = "Maximum number of sweeps, Krylov steps or shots",
         .initial = "depends on the method",
         .group = group::accuracy,
         .support = {{every_standard | every_published | tasks}}},
        {.name = "--epsilon",
         .value = positive("R", at(&O::epsilon)),
         .does = "Tolerance for the total link error (relative RMS); links are then refined pair by pair",
         .initial = "derived from --error",
         .group = group::accuracy,
         .support = all_links()},
    };
}

std::vector<OptionRow> rows_of_method() {
    using O = SolveOptions;
    return {
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
         .initial = "auto: if the scene has many polygons",
         .group = group::method,
         .support = links_of_hierarchies() + Support{{every_published | tasks, "off"}}},
        {.name = "--oracle",
         .value = either(oracle_names, at(&O::oracle), classical_oracle_names, at(&ClassicalOptions::oracle)),
         .does = "Criterion by which links are refined: the error of the transported light, form factor, power, or the "
                 "difference of the kernel from its interpolant of the basis",
         .initial = "transport",
         .group = group::method,
         .support = links_of_hierarchies("transport|ff|bf") + Support{{published_links}, {tasks, "transport|ff|bf"}},
         .needs = {{"--threshold", "ff|bf|kernel", Form::published}}},
        {.name = "--keep-links",
         .value = flag(at(&O::keep_links)),
         .does = "Write the links of a hierarchy into the solution, for export --links and view",
         .group = group::method,
         .support = links_of_hierarchies()},
    };
}

std::vector<OptionRow> rows_of_running() {
    using R = SolveRequest;
    using O = SolveOptions;
    return {
        {.name = "--max-units",
         .value = count(at(&O::max_units), 8),
         .does = "Maximum number of units in each network of growing cells",
         .initial = "derived from --error",
         .group = group::method,
         .support = {{standard({growing_cells})}}},
        {.name = "--seed",
         .value = count(at(&O::seed), 0),
         .does = "Seed of all random numbers",
         .initial = "1",
         .when = "Other seeds show how much of an error is noise; rays of direct light at points do not depend on "
                 "the seed",
         .group = group::method},
        {.name = "--schedule",
         .value = choice(schedule_names, at(&O::schedule)),
         .does = "How tasks are distributed to threads; the result does not depend on it",
         .initial = "stealing",
         .group = group::method,
         .section = "-"},
        {.name = "--vtkhdf",
         .value = on_off(at(&R::vtkhdf)),
         .does = "Also store the mesh that export writes in the group /VTKHDF of the solution, for ParaView",
         .initial = "on",
         .when = "off makes the file about half as large",
         .group = group::method,
         .section = "-"},
        {.name = "--trace",
         .value = text("FILE", at(&R::trace)),
         .does = "Write time, thread and data of every task (Chrome trace format, .json)",
         .group = group::method,
         .one_process = "*",
         .section = "-"},
    };
}

std::vector<OptionRow> rows_of_visibility() {
    using O = SolveOptions;
    return {
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
         .does = "How form factors are computed; vertex and middle, points at which elements receive shots, select the "
                 "published form",
         .initial = "depends on the method",
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
         .initial = "derived from --error",
         .group = group::visibility,
         .support = {{standard({matrix}), "", has_hemicubes, "with --form-factors hemicube"},
                     {published({matrix, progressive})}}},
    };
}

std::vector<OptionRow> rows_of_shadows() {
    return {
        {.name = "--dm-sources",
         .value = secondary_sources(),
         .does = "Also mesh along shadows of reflected light: of the N surfaces that reflect the most, or of those "
                 "that reflect at least a power (20W)",
         .group = group::shadows,
         .support = {{discontinuities}},
         .excludes = {{"--bounces 0"}},
         .section = "discontinuity"},
        {.name = "--dm-lines",
         .value = shadow_lines(),
         .does = "Shadow lines that the mesh follows: all; the N with the largest change of light times length; or all "
                 "on the surfaces of some materials or objects, separated by commas or on the lines of a file, and "
                 "none on others",
         .initial = "auto: those that the requested error needs",
         .when = "The mesh is as accurate with fewer lines, but has more triangles",
         .group = group::shadows,
         .support = {{standard({discontinuity})}},
         .section = "discontinuity"},
        {.name = "--error-largest",
         .value = positive("R", at(&DiscontinuityChoice::largest_error), 1),
         .does = "Requested largest error of the mesh anywhere, as a share of the brightest reflected light",
         .initial = "5/3 of --error-interpolant",
         .group = group::shadows,
         .support = {{standard({discontinuity})}},
         .section = "discontinuity"},
        {.name = "--eee",
         .value = choice(three_edge_names, at(&DiscontinuityChoice::three_edges)),
         .does = "Follow the curved shadow lines that three edges cause together (EEE events)",
         .initial = "auto: those that may bound an umbra",
         .group = group::shadows,
         .support = {{discontinuities}},
         .section = "discontinuity"},
        {.name = "--dm-quality",
         .value = choice(mesh_quality_names, at(&DiscontinuityChoice::quality)),
         .does = "Shape of triangles: delaunay adds points until all angles exceed 20.7 degrees, rivara only bisects",
         .initial = "rivara",
         .group = group::shadows,
         .support = {{discontinuities}},
         .excludes = {{"--triangulation longest|shortest|heuristic", "delaunay"}},
         .section = "discontinuity"},
        {.name = "--dm-element",
         .value = choice(mesh_element_names, at(&DiscontinuityChoice::element)),
         .does = "Functions on triangles: quadratic, or cubic with continuous tangent planes where light is smooth",
         .initial = "quadratic",
         .group = group::shadows,
         .support = {{standard({discontinuity})}, {local_passes, "quadratic"}},
         .section = "discontinuity"},
    };
}

}  // namespace

std::vector<OptionRow> for_experts() {
    return joined({rows_of_accuracy(), rows_of_method(), rows_of_running(), rows_of_visibility(), rows_of_shadows()});
}

}  // namespace exitance::option_rows
