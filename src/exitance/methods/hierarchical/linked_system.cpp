#include "exitance/methods/hierarchical/linked_system.hpp"

#include "exitance/base/parallel.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/solve/conserving_transport.hpp"

namespace exitance {

void LinkedSystem::set_links(Links near, std::optional<ClusterLinks> far) {
    near_.emplace(std::move(near));
    far_ = std::move(far);
}

/// Transmission of light through panes, between the given elements.
PassedLight LinkedSystem::passed_between(std::span<const ElementId> ends) const {
    const NodalBasis& basis = sites_.basis();
    return {input_.stage.scene,
            sites_.tree(),
            ends,
            sites_.nodes(),
            basis.order() - 1,
            [&](ElementId e, const Point& x, std::span<double> factors) {
                const Patch frame = sites_.frame(e);
                basis.interpolate(frame.shape, frame.coordinates(x), factors);
            }};
}

SolveReport LinkedSystem::solve(const NodalField& rhs, NodalField& x, bool closed) {
    const ElementTree& tree = sites_.tree();
    const ClusterLinks* const far = far_ ? &*far_ : nullptr;
    const ElementPart part = linked_part(sites_, *near_, far);
    const LinkOperator one_sided(sites_, *near_, far, part);
    const PassedLight passed = passed_between(part.ends);
    const PassingTransport F(one_sided, passed);
    const std::size_t n = sites_.nodes();
    std::vector<Spectrum> rho(F.size()), first(F.size()), value(F.size());
    std::vector<double> area(F.size());
    parallel_for(part.ends.size(), 256, [&](std::size_t i) {
        const ElementId e = part.ends[i];
        for (std::size_t k = 0; k < n; ++k) {
            rho[i * n + k] = input_.stage.scene.material(tree.region(e)).reflectance;
            first[i * n + k] = rhs.node(e, k);
            value[i * n + k] = x.node(e, k);
            area[i * n + k] = tree.area(e) * sites_.weight(e, k);
        }
    });
    const Relaxation asked = input_.options.relaxation.value_or(Relaxation::gmres);
    // Gauss-Seidel does not apply, since all links are gathered at once; nor does cg, since higher orders are not
    // symmetric.
    const bool all_at_once = asked == Relaxation::jacobi || asked == Relaxation::chebyshev;
    const Relaxation method = all_at_once ? asked : Relaxation::gmres;
    ConservingTransport conserving(F, area);
    const SolveReport report = solve_conserving({conserving, rho, first, area}, conserving, closed, method, value,
                                                {.residual = calibrated::linked_residual * input_.knobs.residual,
                                                 .max_iterations = input_.knobs.max_iterations,
                                                 .request = &input_.stop});
    scale_ = conserving.scale();
    x.clear();
    parallel_for(part.ends.size(), 256, [&](std::size_t i) {
        for (std::size_t k = 0; k < n; ++k)
            x.set_node(part.ends[i], k, value[i * n + k] - first[i * n + k]);  // the values of rho F x
    });
    x.push();
    const std::vector<ElementId> ends = sites_.ends();
    parallel_for(ends.size(), 256, [&](std::size_t i) {
        for (std::size_t k = 0; k < n; ++k) x.set_node(ends[i], k, rhs.node(ends[i], k) + x.node(ends[i], k));
    });
    x.pull();
    return report;
}

void LinkedSystem::gather(const NodalField& b, NodalField& E) const {
    near_->gather(b, E);
    if (far_) far_->add_to(E, b);
    E.push();
    if (!input_.stage.scene.has_diffusing_panes()) return;
    const std::vector<ElementId> ends = sites_.ends();
    const std::size_t n = sites_.nodes();
    std::vector<Spectrum> met(ends.size() * n);
    for (std::size_t i = 0; i < met.size(); ++i) met[i] = E.node(ends[i / n], i % n);
    passed_between(ends).meet(std::span(met));
    for (std::size_t i = 0; i < met.size(); ++i) E.set_node(ends[i / n], i % n, met[i]);
}

}  // namespace exitance
