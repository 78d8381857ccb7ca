#include "exitance/methods/hierarchical/hierarchy.hpp"

#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/transport/piece_groups.hpp"

namespace exitance {

Hierarchy::Hierarchy(const MethodInput& input, HierarchyBasis kind, LinkSites::Held held)
    : input(input),
      is_polynomial(kind == HierarchyBasis::multiwavelet2 || kind == HierarchyBasis::multiwavelet3),
      basis(kind),
      light{.tree = input.direct.tree},
      sites(input.stage, light.tree, basis, held),
      reflected_direct_below(sites, [this](ElementId leaf) { return reflected_once(leaf); }),
      reflected_direct(sites),
      radiosity(sites),
      refiner(light.tree, sites,
              [this](const std::vector<ElementId>& parents, Field<ElementId, double>& roughness) {
                  find_light_below(parents, roughness);
              }),
      system(input, sites) {}

void Hierarchy::make_clusters() {
    const PieceGroups groups = find_piece_groups(input.stage, light.tree, input.options.seed);
    light.work.rays += groups.rays;
    clusters.emplace(light.tree, groups.of_root);
    far.emplace(sites, *clusters);
}

/// rho E_dir as projected on a leaf.
NodalValues Hierarchy::reflected_once(ElementId leaf) const {
    NodalValues E = projected_light(sites, input.direct, leaf);
    for (Spectrum& value : E) value = material(leaf).reflectance * value;
    return E;
}

void Hierarchy::project_direct() {
    const std::vector<ElementId> ends = sites.ends();
    Field<ElementId, double> roughness(light.tree.size(), 0.0);
    const std::vector<FromBelow> found = reflected_direct_below.look_at(ends);
    for (std::size_t i = 0; i < ends.size(); ++i) {
        reflected_direct.set(ends[i], found[i].values);
        roughness[ends[i]] = std::sqrt(found[i].departure_squared);
    }
    reflected_direct.pull();
    radiosity = reflected_direct;
    refiner.set_roughness(std::move(roughness));
}

/// Computes light on the children of elements when these get links: E_dir as projected, and E_ind of the parent.
void Hierarchy::find_light_below(const std::vector<ElementId>& parents, Field<ElementId, double>& roughness) {
    reflected_direct.resize(), radiosity.resize();
    parallel_for(parents.size(), 1, [&](std::size_t i) {
        const ElementId parent = parents[i];
        for (ElementId child : light.tree.children(parent)) {
            const FromBelow found = reflected_direct_below.at(child);
            reflected_direct.set(child, found.values);
            roughness[child] = std::sqrt(found.departure_squared);
            const auto push = sites.push(child);
            const std::size_t n = sites.nodes();
            for (std::size_t k = 0; k < n; ++k) {
                Spectrum b = found.values[k];
                for (std::size_t j = 0; j < n; ++j)
                    b += static_cast<double>(push[k * n + j]) *
                         (radiosity.node(parent, j) - reflected_direct.node(parent, j));
                radiosity.set_node(child, k, b);
            }
        }
    });
}

double Hierarchy::light_norm() const {
    double sum = 0;
    for (ElementId e : light.tree.roots())
        for (std::size_t k = 0; k < sites.nodes(); ++k)
            sum += light.tree.area(e) * sites.weight(e, k) * mean(radiosity.node(e, k));
    return sum / std::sqrt(input.stage.area);
}

void Hierarchy::refine(const LinkTolerance& tolerance) {
    NodalField* const also[] = {&reflected_direct};
    if (far) {
        const std::vector<LinkPair> near = far->refine(radiosity, tolerance, input.stop);
        refiner.refine(near, radiosity, also, tolerance, input.progress, input.stop);
    } else {
        refiner.refine(radiosity, also, tolerance, input.progress, input.stop);
    }
    refine_panes_alike();
}

/// Refines elements of diffusing panes so that both sides have elements of similar size: light that arrives on one side
/// leaves from the other as well.
void Hierarchy::refine_panes_alike() {
    const Scene& scene = input.stage.scene;
    if (!scene.has_diffusing_panes()) return;
    NodalField* const also[] = {&reflected_direct};
    constexpr double max_area_ratio = 0.75;  // share of the area behind; derived from cuts, which leave a half or less
    const double least = input.options.min_area.value_or(calibrated::min_link_area * input.stage.area);
    while (!input.stop.requested()) {
        const std::vector<ElementId> ends = sites.ends();
        const PassedLight passed(scene, light.tree, ends);
        std::vector<ElementId> opened, cut;
        for (std::size_t i = 0; i < ends.size(); ++i) {
            const double area = light.tree.area(ends[i]);
            bool finer = false;
            passed.visit_behind(
                i, [&](std::uint32_t j, double) { finer = finer || light.tree.area(ends[j]) < max_area_ratio * area; });
            if (finer && !light.tree.is_leaf(ends[i])) opened.push_back(ends[i]);
            if (finer && light.tree.is_leaf(ends[i]) && area > 2 * least) cut.push_back(ends[i]);
        }
        if (opened.empty() && cut.empty()) break;
        refiner.open(opened);
        refiner.cut_elements(cut, radiosity, also);
    }
}

double Hierarchy::open_share() const {
    const double carried = refiner.light() + (far ? far->light() : 0);
    return carried > 0 ? refiner.open_light() / carried : 1;
}

void Hierarchy::relax(bool closed) {
    const std::size_t before = light.report.iterations;
    light.report = system.solve(reflected_direct, radiosity, closed);
    light.report.iterations += before;
}

NodalField Hierarchy::pulled(const std::function<NodalValues(ElementId leaf)>& of_leaf) const {
    const std::vector<ElementId> ends = sites.ends();
    NodalField out(sites);
    parallel_for(ends.size(), 1,
                 [&](std::size_t i) { out.set(ends[i], pull_from_leaves(sites, ends[i], of_leaf).values); });
    out.pull();
    return out;
}

NodalField Hierarchy::gather() const {
    NodalField E(sites);
    system.gather(radiosity, E);
    return E;
}

NodalValues Hierarchy::indirect_light(const NodalField& F_b, ElementId e) const {
    NodalValues out = F_b.values(e);
    while (e.value >= missed.size() && !missed.empty()) e = light.tree.parent(e);
    for (Spectrum& value : out) value = system.scale() * value + (missed.empty() ? Spectrum() : missed[e]);
    return out;
}

}  // namespace exitance
