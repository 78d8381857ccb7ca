#include "exitance/methods/hierarchy.hpp"

#include <fmt/format.h>

#include <cmath>

#include "exitance/core/memory.hpp"
#include "exitance/core/parallel.hpp"
#include "exitance/mesh/element_tree_archive.hpp"
#include "exitance/methods/importance.hpp"
#include "exitance/methods/linked_by_rays.hpp"
#include "exitance/methods/linked_system.hpp"
#include "exitance/methods/nodal_light.hpp"
#include "exitance/solve/conserving_transport.hpp"
#include "exitance/transport/cluster_refiner.hpp"
#include "exitance/transport/leaf_links.hpp"
#include "exitance/transport/link_refiner.hpp"
#include "exitance/transport/open_share.hpp"
#include "exitance/transport/ray_rows.hpp"
#include "exitance/transport/rooms.hpp"

namespace exitance {
namespace {

/// Where so much light passes in the open, links give it as exactly as it is asked for. Elsewhere they only find what
/// the elements reflect, and rays gather that: from a place that sees many things in part, rays over the hemisphere say
/// more than as many between pairs.
constexpr double mostly_open = 0.9;

bool is_polynomial(HierarchyBasis kind) {
    return kind == HierarchyBasis::multiwavelet2 || kind == HierarchyBasis::multiwavelet3;
}

class Hierarchy {
  public:
    Hierarchy(const MethodInput& input, HierarchyBasis kind)
        : input_(input),
          is_polynomial_(is_polynomial(kind)),
          basis_(kind),
          light_{.tree = input.direct.tree},
          sites_(input.stage, light_.tree, basis_),
          direct_(sites_),
          first_(sites_),
          b_(sites_),
          refiner_(light_.tree, sites_),
          system_(input, sites_) {}

    GlobalLight solve() {
        if (wants_clusters()) make_clusters();
        project_direct();
        b_ = first_;
        light_.delivers = delivers();
        // By the light that is reflected once, at first; then by all of it.
        constexpr double links_in_a_sum = 300;
        const bool somewhere = !input_.options.importance.empty();  // else light is as good everywhere
        const double coarse = somewhere ? 128 : 8;
        double demand = input_.knobs.link_error * light_norm();
        const double first = coarse * demand / std::sqrt(links_in_a_sum);
        LinkTolerance tolerance = tolerance_of(first);
        tolerance.oracle = input_.options.oracle;
        tolerance.hidden = hidden();
        tolerance.strongest = first_strength(first);
        constexpr int most_rounds = 8;
        int round = 0;
        const auto state = [&](auto& a) {
            a(round, tolerance, light_.tree, light_.report);
            for (NodalField* field : {&direct_, &first_, &b_}) field->archive_state(a);
            refiner_.archive_state(a);
            if (far_) far_->archive_state(a);
        };
        SafePoints safe_points = input_.safe_points;
        if (safe_points.resume(state)) sites_.update();
        for (; round < most_rounds; ++round) {
            safe_points.pass(state);
            input_.progress.phase("link");
            const double judged_by = light_norm();
            refine(tolerance);
            relax();
            // What links miss grows with the light, of which the first round knows but one reflection. Where rays
            // correct it, that does not matter.
            const double missed = light_.delivers ? error() * light_norm() / judged_by : error();
            demand = input_.knobs.link_error * (light_.delivers || input_.options.smoothing ? 1 : gathers_forgive) *
                     light_norm();
            input_.progress.note(
                fmt::format("{} links, {} of clusters ({:.0f}% of their light in the open), {} elements, {} rays; "
                            "their error {:.3f}% "
                            "of {:.3f}%",
                            refiner_.size(), far_ ? far_->size() : 0, 100 * open_share(), light_.tree.size(), rays(),
                            100 * missed / light_norm(), 100 * demand / light_norm()));
            light_.limited_by_memory = refiner_.is_limited();
            if (input_.stop.requested() || light_.limited_by_memory) break;
            const bool weighed = round > 0 || !somewhere;
            if (weighed && missed <= demand) break;
            const double factor = std::clamp(0.8 * demand / missed, 0.1, 0.8);
            tolerance.error *= factor, tolerance.interpolation *= factor, tolerance.strongest *= factor;
        }
        if (light_.delivers)
            conserve();
        else if (!input_.stop.requested())
            correct_by_rays();
        hand_over();
        return std::move(light_);
    }

    /// All pairs of leaves as they are, in place of what a hierarchy would link.
    GlobalLight solve_on_leaves() {
        project_direct();
        b_ = first_;
        input_.progress.phase("link");
        light_.numbering = LeafNumbering(light_.tree);
        // As many links as there are at most, each of one error, come to the one asked for.
        const double demand = input_.knobs.link_error * light_norm();
        LinkTolerance tolerance = tolerance_of(demand / static_cast<double>(light_.numbering.leaves.size()));
        LeafLinks found = link_leaves(sites_, b_, tolerance, input_.stop);
        system_.set_links(std::move(found.links));
        input_.progress.note(
            fmt::format("{} links between {} leaves ({:.0f}% of their light in the open), {} rays; error of rules and "
                        "visibility {:.3f}%",
                        system_.size(), light_.numbering.leaves.size(), 100 * found.open_share, found.rays,
                        100 * found.error / light_norm()));
        light_.rays += found.rays;
        light_.form_factors += found.form_factors;
        light_.delivers = is_polynomial_ && found.open_share > mostly_open;
        input_.progress.phase("solve");
        solve_on_links(first_, b_);
        hand_over();
        return std::move(light_);
    }

  private:
    /// Where nothing is said, so many pieces are worth clusters above them; which are judged by their error.
    bool wants_clusters() const {
        constexpr std::size_t many_pieces = 500;
        const SolveOptions& o = input_.options;
        return o.clusters.value_or(light_.tree.roots().size() > many_pieces && o.oracle == LinkOracle::transport);
    }

    void make_clusters() {
        const Rooms rooms = find_rooms(input_.stage, light_.tree, input_.options.seed);
        light_.rays += rooms.rays;
        clusters_.emplace(light_.tree, rooms.of_root);
        far_.emplace(sites_, *clusters_);
    }

    /// Where links are judged by their strength, what they may have in the first round; it falls with the error.
    double first_strength(double error) const {
        constexpr double of_form_factors = 10, of_light = 0.1;
        return input_.options.oracle == LinkOracle::form_factor ? of_form_factors * error / light_norm()
                                                                : of_light * error * std::sqrt(input_.stage.area);
    }

    LinkTolerance tolerance_of(double error) const {
        return {.error = error,
                .interpolation = error,
                .systematic = systematic(),
                .most_links = most_links(),
                .least_area = input_.options.min_area.value_or(1e-7 * input_.stage.area),
                .fractional = input_.options.visibility == VisibilityKind::fractional,
                .quadrature = input_.options.visibility == VisibilityKind::quadrature,
                .triage = input_.options.triage,
                .seed = input_.options.seed};
    }

    /// Do polynomials give the light as exactly as it is asked for? That the scene decides, not how far its links are
    /// refined: attempts of one solve do not take turns.
    bool delivers() const {
        if (!is_polynomial_) return false;
        const LeafNumbering numbering(light_.tree);
        const ElementLocator locator(light_.tree, input_.stage.scene.regions().size());
        std::vector<Spectrum> light;
        for (ElementId e : numbering.leaves) light.push_back(mean_over(sites_, first_, e));
        return exitance::open_share(input_.stage, light_.tree, numbering, locator, light, input_.options.seed) >
               mostly_open;
    }

    /// Bilinear sources hide most from near receivers, all with one sign. Where rays correct it, that does not matter.
    double hidden() const {
        constexpr double little = 0.5, by_bilinear = 1.5;
        return light_.delivers && basis_.order() == 2 ? by_bilinear : little;
    }

    /// How much larger the error of light may be that is gathered once more.
    static constexpr double gathers_forgive = 4;
    const Material& material(ElementId e) const { return input_.stage.scene.material(light_.tree.region(e)); }

    /// As many as there is room for.
    std::size_t most_links() const {
        constexpr std::size_t unasked = 8'000'000'000;  // bytes
        const std::size_t used = peak_memory_bytes(),
                          limit = input_.options.memory_limit_bytes.value_or(used + unasked);
        constexpr std::size_t others_share = 2;  // meshes, gathers, files
        return (limit - std::min(limit, used)) / (others_share * LinkRefiner::bytes_a_link);
    }

    /// An error that is alike all over the receivers comes back from every reflection.
    double systematic() const {
        constexpr double within_a_sum = 2;
        double reflected = 0;
        for (ElementId e : light_.tree.roots()) reflected += light_.tree.area(e) * mean(material(e).reflectance);
        return within_a_sum * std::min(10.0, 1 / (1 - reflected / input_.stage.area));
    }

    /// Exact direct light as it was projected, at the nodes of leaves.
    void project_direct() {
        const std::vector<ElementId> leaves = light_.tree.leaves();
        parallel_for(leaves.size(), 64, [&](std::size_t i) {
            const ElementId e = leaves[i];
            const Patch& patch = light_.tree.patch(e);
            for (std::size_t k = 0; k < sites_.nodes(); ++k) {
                const Spectrum E = sites_.nodes() == 1 ? input_.direct.fit[e].mean
                                                       : input_.direct.at({e, patch.coordinates(sites_.node(e, k))});
                direct_.set_node(e, k, E);
                first_.set_node(e, k, material(e).reflectance * E);
            }
        });
        direct_.pull();
        first_.pull();
    }

    /// Mean over the surfaces of the light that elements reflect, times the root of their area, W/m^2 m: what the
    /// errors of links are relative to.
    double light_norm() const {
        double sum = 0;
        for (ElementId e : light_.tree.roots())
            for (std::size_t k = 0; k < sites_.nodes(); ++k)
                sum += light_.tree.area(e) * sites_.weight(e, k) * mean(b_.node(e, k));
        return sum / std::sqrt(input_.stage.area);
    }

    void refine(const LinkTolerance& tolerance) {
        NodalField* const also[] = {&direct_, &first_};
        if (!far_) return refiner_.refine(b_, also, tolerance, input_.progress, input_.stop);
        const std::vector<LinkPair> near = far_->refine(b_, tolerance, input_.stop);
        refiner_.refine(near, b_, also, tolerance, input_.progress, input_.stop);
    }

    /// Of links of elements and of clusters.
    double error() const { return std::hypot(refiner_.error(), far_ ? far_->error() : 0); }
    std::size_t rays() const { return refiner_.rays() + (far_ ? far_->rays() : 0); }
    /// How much of the light that links carry meets nothing on its way, certainly.
    double open_share() const {
        const double light = refiner_.light() + (far_ ? far_->light() : 0);
        return light > 0 ? refiner_.open_light() / light : 1;
    }

    /// b = first + rho F b, from the b that there is.
    void relax() {
        input_.progress.phase("solve");
        light_.numbering = LeafNumbering(light_.tree);
        system_.set_links(refiner_.make_links(), far_ ? std::optional(far_->make_links()) : std::nullopt);
        solve_on_links(first_, b_);
        if (!input_.options.importance.empty()) find_importance();
    }

    /// How much errors of elements count at the points that are looked at: by reciprocity the same links bear it,
    /// w = w_0 + F rho w. Solved for rho w, which obeys the equation of light: v = rho w_0 + rho F v.
    void find_importance() {
        const std::vector<Spectrum> points =
            looked_at(input_.stage, light_.tree, light_.numbering, input_.options.importance, input_.options.seed);
        const std::vector<ElementId>& leaves = light_.numbering.leaves;
        NodalField source(sites_), w(sites_);
        for (std::size_t i = 0; i < leaves.size(); ++i)
            for (std::size_t k = 0; k < sites_.nodes(); ++k)
                source.set_node(leaves[i], k, material(leaves[i]).reflectance * points[i]);
        source.pull();
        NodalField v = source;
        system_.solve(source, v);
        system_.gather(v, w);
        Field<ElementId, double> importance(light_.tree.size(), 0.0);
        double total = 0;
        for (std::size_t i = 0; i < leaves.size(); ++i) {
            const double here = mean(points[i] + mean_over(sites_, w, leaves[i]));
            importance[leaves[i]] = light_.tree.area(leaves[i]) * std::max(0.0, here);
            total += importance[leaves[i]];
        }
        for (std::size_t e = importance.size(); e-- > 0;)
            for (ElementId child : light_.tree.children(ElementId(e))) importance[ElementId(e)] += importance[child];
        constexpr double least = 1e-6;
        for (ElementId e : importance.ids())
            importance[e] = std::max(least, importance[e] / total * input_.stage.area / light_.tree.area(e));
        refiner_.set_importance(std::move(importance));
    }

    /// x = rhs + rho F x.
    void solve_on_links(const NodalField& rhs, NodalField& x, bool closed = false) {
        const std::size_t before = light_.report.iterations;
        light_.report = system_.solve(rhs, x, closed);
        light_.report.iterations += before;
    }

    /// In a closed scene nothing of what is reflected may be lost.
    void conserve() {
        const ElementLocator locator(light_.tree, input_.stage.scene.regions().size());
        if (!is_closed(input_.stage, light_.tree, light_.numbering, locator, input_.options.seed)) return;
        input_.progress.phase("solve");
        solve_on_links(first_, b_, true);
        input_.progress.note(fmt::format("links lose {:.4f}% of the light", 100 * (mean(system_.scale()) - 1)));
    }

    /// Defect correction: rays, which know no links, find what these miss of F b in the mean of every leaf, and b = rho
    /// (E_dir + missed + F b) is solved once more. Coarse links are up to some percent too dark in all places together,
    /// which no average over a hemisphere mends; two steps of this do.
    void correct_by_rays() {
        input_.progress.phase("correct");
        const ElementLocator locator(light_.tree, input_.stage.scene.regions().size());
        const RayRows rows(input_.stage, light_.tree, light_.numbering, locator, input_.knobs.solve_rays,
                           input_.options.seed);
        const std::vector<double> area = leaf_areas(light_.tree, light_.numbering);
        light_.kept = rows.kept();
        ConservingTransport conserving(rows, area, light_.kept);
        const std::vector<ElementId>& leaves = light_.numbering.leaves;
        std::vector<Spectrum> b(leaves.size()), E(leaves.size());
        missed_.assign(leaves.size(), Spectrum());
        NodalField first = first_;
        constexpr int steps = 2;
        for (int step = 0; step < steps && !input_.stop.requested(); ++step) {
            for (std::size_t i = 0; i < leaves.size(); ++i) b[i] = mean_over(sites_, b_, leaves[i]);
            conserving.conserve(b);
            conserving.gather(b, E);
            const NodalField found = gather();
            for (std::size_t i = 0; i < leaves.size(); ++i) {
                const Spectrum missed = E[i] - mean_over(sites_, found, leaves[i]),
                               rho = material(leaves[i]).reflectance;
                missed_[i] += missed;
                for (std::size_t k = 0; k < sites_.nodes(); ++k)
                    first.set_node(leaves[i], k, first.node(leaves[i], k) + rho * missed);
            }
            first.pull();
            solve_on_links(first, b_);
        }
        light_.rays += rows.rays();
    }

    /// E_ind of leaves, by the links, and by what rays found them to miss.
    NodalField gather() const {
        NodalField E(sites_);
        system_.gather(b_, E);
        parallel_for(light_.numbering.leaves.size(), 256, [&](std::size_t i) {
            const ElementId e = light_.numbering.leaves[i];
            for (std::size_t k = 0; k < sites_.nodes(); ++k) E.set_node(e, k, system_.scale() * E.node(e, k));
        });
        for (std::size_t i = 0; i < missed_.size(); ++i) {
            const ElementId e = light_.numbering.leaves[i];
            for (std::size_t k = 0; k < sites_.nodes(); ++k) E.set_node(e, k, E.node(e, k) + missed_[i]);
        }
        return E;
    }

    /// Cuts leaves, for the sake of what is handed on, until linear functions hold what quadratic ones have found.
    void cut_for_delivery(NodalField& E) {
        const double allowed = 0.3 * input_.knobs.link_error * light_norm() / std::sqrt(input_.stage.area);
        std::vector<ElementId> active = light_.tree.leaves();
        constexpr int most_levels = 3;
        for (int level = 0; level < most_levels && !active.empty(); ++level) {
            const std::vector<ElementId> rough = rough_elements(sites_, E, active, allowed);
            NodalField* const also[] = {&b_, &direct_, &first_};
            refiner_.cut_elements(rough, E, also);
            active.clear();
            for (ElementId e : rough)
                for (ElementId child : light_.tree.children(e)) active.push_back(child);
        }
        light_.numbering = LeafNumbering(light_.tree);
        light_.kept.clear();  // was of other leaves
    }

    void hand_over() {
        NodalField E = gather();
        if (basis_.order() > 2 && (light_.delivers || input_.options.smoothing)) cut_for_delivery(E);
        write_nodal_light(sites_, direct_, E, input_.direct, light_);
        light_.links = system_.size();
        if (input_.options.keep_links) light_.kept_links = system_.links().list();
        light_.link_memory_bytes = system_.memory_bytes();
        light_.element_memory_bytes = light_.tree.memory_bytes() + sites_.memory_bytes() + 3 * b_.memory_bytes();
        light_.rays += rays();
        light_.form_factors = refiner_.form_factors();
    }

    const MethodInput& input_;
    bool is_polynomial_;
    NodalBasis basis_;
    GlobalLight light_;
    LinkSites sites_;
    NodalField direct_, first_, b_;  ///< E_dir, rho E_dir, and all reflected light.
    LinkRefiner refiner_;
    LinkedSystem system_;
    std::optional<ClusterTree> clusters_;  ///< None where every piece is linked to every other to begin with.
    std::optional<ClusterRefiner> far_;
    std::vector<Spectrum> missed_;  ///< By the links, of E_ind; of every leaf, or empty.
};

}  // namespace

namespace {

/// Does what was asked for say how links are to be found or judged, or deliver what they hold?
bool asks_for_judged_links(const SolveOptions& o) {
    return o.basis || o.epsilon || o.oracle != LinkOracle::transport || !o.importance.empty() || o.smoothing ||
           !o.triage || o.visibility != VisibilityKind::automatic || o.clusters || o.min_area;
}

}  // namespace

GlobalLight solve_hierarchy(const MethodInput& input, HierarchyBasis kind) {
    if (!asks_for_judged_links(input.options)) {
        const std::optional<double> delivering = is_polynomial(kind) ? std::optional(mostly_open) : std::nullopt;
        if (std::optional<GlobalLight> light = solve_linked_by_rays(input, delivering)) return std::move(*light);
    }
    return Hierarchy(input, kind).solve();
}

GlobalLight solve_galerkin(const MethodInput& input, HierarchyBasis kind) {
    return Hierarchy(input, kind).solve_on_leaves();
}

/// Hierarchical radiosity [Hanrahan91]: constant elements, links between levels.
GlobalLight solve_hierarchical(const MethodInput& input) {
    return solve_hierarchy(input, HierarchyBasis::haar);
}

/// Wavelet radiosity [Gortler93]: the same with the basis asked for, multiwavelets of order 2 when none is.
GlobalLight solve_wavelet(const MethodInput& input) {
    switch (input.options.basis.value_or(BasisKind::multiwavelet2)) {
        case BasisKind::haar:
            return solve_hierarchy(input, HierarchyBasis::haar);
        case BasisKind::flatlet2:
            return solve_hierarchy(input, HierarchyBasis::flatlet2);
        case BasisKind::flatlet3:
            return solve_hierarchy(input, HierarchyBasis::flatlet3);
        case BasisKind::multiwavelet3:
            return solve_hierarchy(input, HierarchyBasis::multiwavelet3);
        default:
            return solve_hierarchy(input, HierarchyBasis::multiwavelet2);
    }
}

}  // namespace exitance
