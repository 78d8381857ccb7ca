#include "exitance/cli/discontinuity_arguments.hpp"

#include "exitance/cli/option_kinds.hpp"

namespace exitance {
namespace {

/// "8": so many; "20W": those that send out so much.
SecondarySources read_sources(const std::string& word) {
    const char* const name = "--dm-sources";
    if (word.ends_with("W")) {
        const double power = read_number(name, word.substr(0, word.size() - 1));
        if (!(power > 0)) throw CLI::ValidationError(name, fmt::format("must be above 0 W, not {}", word));
        return {.power = power};
    }
    const double count = read_number(name, word);
    if (count != std::floor(count) || count < 0 || count > 1e6)
        throw CLI::ValidationError(
            name, fmt::format("must be a whole number of surfaces, or a power such as 20W, not {}", word));
    return {.count = static_cast<std::size_t>(count)};
}

}  // namespace

void declare_discontinuity(CLI::App& app, SolveOptions& options) {
    DiscontinuityChoice& o = options.discontinuity;
    const char* const group = "Discontinuity meshing";
    app.add_option_function<std::string>(
           "--dm-sources", [&o](const std::string& w) { o.sources = read_sources(w); },
           "Cut along shadows of reflected light, too: of the N surfaces that reflect the most, or of those that "
           "reflect at least so many watts (20W)")
        ->type_name("N|POWER")
        ->group(group);
    add_choice(app, "--eee", three_edge_names, o.three_edges,
               "Curves of three edges; default auto: where they may bound an umbra")
        ->group(group);
    add_choice(app, "--triangulation", triangulation_choices, o.triangulation,
               "Of the faces between curves: Delaunay's (default), or the thesis's on convex receivers")
        ->group(group);
    add_choice(app, "--premesh", premesh_names, o.premesh,
               "With longest, shortest, heuristic: curves that bound half-shadows or a coarse grid before others")
        ->group(group);
    add_choice(
        app, "--dm-quality", mesh_quality_names, o.quality,
        "Shape of triangles: as bisection leaves it (rivara, default), or by points added until angles are above "
        "20.7 degrees (delaunay)")
        ->group(group);
    add_choice(app, "--dm-element", mesh_element_names, o.element,
               "On triangles: quadratic (default), or cubics whose tangent planes agree but across edges where light "
               "jumps or has a kink (clough-tocher)")
        ->group(group);
    add_choice(app, "--dm-structure", structure_names, o.structure,
               "What may hide a source is found by shafts and a tree of boxes (bvh, default), or by orderings of a BSP "
               "tree and shadow volumes, one by one (bsp) or merged into one tree a source (bsp-merged)")
        ->group(group);
    add_switch(app, "--layers", o.layers, "One compressed mesh a source, to be added up, in place of one for all")
        ->group(group);
}

Result<void> check_discontinuity(const SolveOptions& options) {
    const DiscontinuityChoice& o = options.discontinuity;
    if (!o.any()) return {};
    const char* const name = o.sources         ? "--dm-sources"
                             : o.three_edges   ? "--eee"
                             : o.triangulation ? "--triangulation"
                             : o.premesh       ? "--premesh"
                             : o.quality       ? "--dm-quality"
                             : o.element       ? "--dm-element"
                             : o.structure     ? "--dm-structure"
                                               : "--layers";
    if (options.method != Method::discontinuity)
        return Error{ErrorCode::usage, "is obeyed by --method discontinuity alone", name,
                     "exitance solve SCENE -o S.h5 --method discontinuity"};
    if (o.element == MeshElement::clough_tocher && options.local_pass.value_or(LocalPassRule::e) != LocalPassRule::e)
        return Error{ErrorCode::usage, "has no elements but quadratic ones for --local-pass a to d", "--dm-element",
                     "leave --dm-element or --local-pass out"};
    if (o.layers && options.local_pass.value_or(LocalPassRule::e) != LocalPassRule::e)
        return Error{ErrorCode::usage, "keeps direct light apart, which --local-pass a to d does not", "--layers",
                     "leave --layers or --local-pass out"};
    if (o.layers == true && o.element == MeshElement::clough_tocher)
        return Error{ErrorCode::usage, "holds quadratic elements alone", "--layers",
                     "leave --layers or --dm-element out"};
    if (o.sources && options.bounces == 0)
        return Error{ErrorCode::usage, "asks for shadows of reflected light, of which --bounces 0 leaves none",
                     "--dm-sources", "leave --bounces 0 or --dm-sources out"};
    const bool by_tree = o.triangulation && *o.triangulation != TriangulationScheme::delaunay;
    if (o.premesh && *o.premesh != Premesh::off && !by_tree)
        return Error{ErrorCode::usage, "orders what a tree of lines takes; Delaunay's triangulation takes all at once",
                     "--premesh", "choose --triangulation longest, shortest or heuristic, too"};
    if (o.quality == MeshQuality::delaunay && by_tree)
        return Error{ErrorCode::usage, "refines Delaunay's triangulation, not that of a tree", "--dm-quality",
                     "leave --triangulation or --dm-quality out"};
    return {};
}

}  // namespace exitance
