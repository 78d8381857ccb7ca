#include "exitance/methods/hierarchy.hpp"

#include <fmt/format.h>

#include <cmath>

#include "exitance/accuracy/tolerance_law.hpp"
#include "exitance/core/memory.hpp"
#include "exitance/core/parallel.hpp"
#include "exitance/links/cluster_refiner.hpp"
#include "exitance/links/leaf_links.hpp"
#include "exitance/links/link_refiner.hpp"
#include "exitance/mesh/adaptive.hpp"
#include "exitance/mesh/element_tree_archive.hpp"
#include "exitance/methods/constant_elements.hpp"
#include "exitance/methods/importance.hpp"
#include "exitance/methods/light/light_below.hpp"
#include "exitance/methods/light/nodal_light.hpp"
#include "exitance/methods/linked_by_rays.hpp"
#include "exitance/methods/linked_system.hpp"
#include "exitance/methods/plan/choice.hpp"
#include "exitance/reconstruct/element_gather.hpp"
#include "exitance/transport/open_share.hpp"
#include "exitance/transport/ray_rows.hpp"
#include "exitance/transport/rooms.hpp"

namespace exitance {
namespace {

bool is_polynomial(HierarchyBasis kind) {
    return kind == HierarchyBasis::multiwavelet2 || kind == HierarchyBasis::multiwavelet3;
}

/// Where nothing is said, so many pieces are worth clusters above them; which are judged by their error.
bool wants_clusters(const MethodInput& input) {
    constexpr std::size_t many_pieces = 500;
    const SolveOptions& o = input.options;
    return o.clusters.value_or(input.direct.tree.roots().size() > many_pieces && o.oracle == LinkOracle::transport);
}

/// Clusters look at elements before links come to them; and from the means of flatlets nothing below is read.
LinkSites::Held held_by(const MethodInput& input, HierarchyBasis kind) {
    const bool has_means = kind == HierarchyBasis::flatlet2 || kind == HierarchyBasis::flatlet3;
    return wants_clusters(input) || has_means ? LinkSites::Held::all : LinkSites::Held::roots;
}

class Hierarchy {
  public:
    /// `held`: by all elements, or by those that links come to.
    Hierarchy(const MethodInput& input, HierarchyBasis kind, LinkSites::Held held)
        : input_(input),
          is_polynomial_(is_polynomial(kind)),
          basis_(kind),
          light_{.tree = input.direct.tree},
          sites_(input.stage, light_.tree, basis_, held),
          once_(sites_, [this](ElementId leaf) { return reflected_once(leaf); }),
          first_(sites_),
          b_(sites_),
          refiner_(light_.tree, sites_,
                   [this](const std::vector<ElementId>& parents, Field<ElementId, double>& roughness) {
                       find_light_below(parents, roughness);
                   }),
          system_(input, sites_) {}

    GlobalLight solve() {
        if (wants_clusters(input_)) make_clusters();
        light_.delivers = delivers();
        project_direct();
        // By the light that is reflected once, at first; then by all of it, unless rays correct what links miss.
        const bool somewhere = !input_.options.importance.empty();  // else light is as good everywhere
        if (!light_.delivers && !somewhere) refiner_.keep_light();
        double demand = input_.knobs.link_error * light_norm();
        const double first = (somewhere ? 16 : 1) * first_error(demand);
        LinkTolerance tolerance = tolerance_of(first);
        tolerance.oracle = input_.options.oracle;
        tolerance.residual_weight = residual_weight();
        tolerance.corrected = !light_.delivers;
        tolerance.strongest = first_strength(first);
        constexpr int most_rounds = 8;
        constexpr double nearly = 1.15;  // of what rays correct: another round takes more time than it is worth
        // Where links deliver light, what falls first is how much of it comes back from reflections.
        const double guess = light_.delivers ? 0.8 : 1.7;
        ToleranceLaw of_links(guess), of_receivers(guess);
        int round = 0;
        const auto state = [&](auto& a) {
            a(round, tolerance, light_.tree, light_.report);
            of_links.archive_state(a), of_receivers.archive_state(a);
            sites_.archive_state(a);
            for (NodalField* field : {&first_, &b_}) field->archive_state(a);
            refiner_.archive_state(a);
            if (far_) far_->archive_state(a);
        };
        SafePoints safe_points = input_.safe_points;
        safe_points.resume(state);
        for (; round < most_rounds; ++round) {
            safe_points.pass(state);
            input_.progress.phase("link");
            const double judged_by = light_norm();
            refine(tolerance);
            if (tolerance.gives_up && input_.stop.requested()) return std::move(light_);
            relax();
            // What links miss grows with the light, of which the first round knows but one reflection. Where rays
            // correct it, that does not matter.
            const double growth = light_.delivers ? light_norm() / judged_by : 1;
            const double by_link = growth * link_error(), by_receiver = growth * refiner_.interpolation_error(),
                         missed = std::hypot(by_link, by_receiver);
            demand = input_.knobs.link_error * share_of_links() * light_norm();
            input_.progress.note(
                fmt::format("{} links, {} of clusters ({:.0f}% of their light in the open), {} elements, {} rays; "
                            "their error {:.3f}% "
                            "of {:.3f}%",
                            refiner_.size(), far_ ? far_->size() : 0, 100 * open_share(), light_.tree.size(), rays(),
                            100 * missed / light_norm(), 100 * demand / light_norm()));
            light_.limited_by_memory = refiner_.is_limited();
            if (input_.stop.requested() || light_.limited_by_memory) break;
            // The first round knows nothing of importance, nor of what only reflections light.
            const bool knows_enough = round > 0 || (!somewhere && !light_.delivers);
            if (knows_enough && missed <= (light_.delivers ? 1 : nearly) * demand) break;
            // Each of the two may have half of what is allowed, squared, and what the other leaves.
            const auto beside = [&](double other) {
                return std::sqrt(demand * demand - std::min(other * other, 0.5 * demand * demand));
            };
            const double links = of_links.factor(by_link, beside(by_receiver)),
                         receivers = of_receivers.factor(by_receiver, beside(by_link));
            tolerance.error *= links, tolerance.interpolation *= receivers;
            tolerance.strongest *= std::min(links, receivers);
            if (!light_.delivers && !somewhere) b_ = first_;
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
    void make_clusters() {
        const Rooms rooms = find_rooms(input_.stage, light_.tree, input_.options.seed);
        light_.rays += rooms.rays;
        clusters_.emplace(light_.tree, rooms.of_root);
        far_.emplace(sites_, *clusters_);
    }

    /// That single links may have in the first round. The fewer there are in a sum, which is where little is asked for
    /// and where orders are high, the larger.
    double first_error(double demand) const {
        constexpr double fine = 0.00225, delivering = 0.3, of_order_three = 1.4;
        const double few = std::clamp(std::sqrt(input_.knobs.link_error / fine), 1.0, 2.0);
        return (light_.delivers ? delivering : basis_.order() == 3 ? of_order_three : 1) * few * demand;
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
                .gives_up = input_.may_give_up,
                .triage = input_.options.triage,
                .seed = input_.options.seed};
    }

    /// Are links alone asked for, or do polynomials give the light as exactly as it has to be? That the scene decides,
    /// not how far its links are refined: attempts of one solve do not take turns. In convex rooms sums (ElementGather)
    /// are surer where surfaces meet, unless very little error is asked for.
    bool delivers() const {
        if (input_.options.smoothing == false) return true;
        if (!is_polynomial_) return false;
        const bool sums = ElementGather::suits(input_.stage) && input_.options.error_target() > sums_reach;
        if (sums && !input_.options.epsilon) return false;
        const LeafNumbering numbering(light_.tree);
        const ElementLocator locator(light_.tree, input_.stage.scene.regions().size());
        std::vector<Spectrum> light;
        for (ElementId e : numbering.leaves) light.push_back(material(e).reflectance * input_.direct.fit[e].mean);
        return is_mostly_open(input_.stage, light_.tree, numbering, locator, light, input_.options.seed);
    }

    /// Bilinear sources hide most from near receivers, all with one sign. Where rays correct it, that does not matter.
    double residual_weight() const {
        constexpr double little = 0.5, by_bilinear = 1.5;
        return light_.delivers && basis_.order() == 2 ? by_bilinear : little;
    }

    /// How much larger the links' error may be than what the method's is to be: where rays correct the means of leaves,
    /// only how light varies within them is the links', and is gathered once more; where links deliver it, no gather
    /// takes a share of the error asked for.
    double share_of_links() const {
        constexpr double rays_correct = 8, without_gather = 1.7;
        if (light_.delivers) return input_.options.epsilon ? 1 : without_gather;
        return input_.options.smoothing ? 1 : rays_correct;
    }
    const Material& material(ElementId e) const { return input_.stage.scene.material(light_.tree.region(e)); }

    /// As many as there is room for.
    std::size_t most_links() const {
        constexpr std::size_t unasked = 8'000'000'000;  // bytes
        const std::size_t used = peak_memory_bytes(),
                          limit = input_.options.memory_limit_bytes.value_or(used + unasked);
        constexpr std::size_t others_share = 2;  // meshes, gathers, files
        constexpr std::size_t fields = 7;        // of light, and of what is solved for
        const std::size_t taken = used + fields * b_.memory_bytes();
        return (limit - std::min(limit, taken)) / (others_share * LinkRefiner::bytes_a_link);
    }

    /// An error that is alike all over the receivers comes back from every reflection, if rays do not correct it.
    double systematic() const {
        if (!light_.delivers) return 1;
        constexpr double within_a_sum = 2;
        double reflected = 0;
        for (ElementId e : light_.tree.roots()) reflected += light_.tree.area(e) * mean(material(e).reflectance);
        return within_a_sum * std::min(10.0, 1 / (1 - reflected / input_.stage.area));
    }

    /// rho E_dir, as projected on a leaf.
    NodalValues reflected_once(ElementId leaf) const {
        NodalValues E = projected_light(sites_, input_.direct, leaf);
        for (Spectrum& value : E) value = material(leaf).reflectance * value;
        return E;
    }

    void project_direct() {
        const std::vector<ElementId> ends = sites_.ends();
        Field<ElementId, double> roughness(light_.tree.size(), 0.0);
        const std::vector<FromBelow> found = once_.look_at(ends);
        for (std::size_t i = 0; i < ends.size(); ++i) {
            first_.set(ends[i], found[i].values);
            roughness[ends[i]] = std::sqrt(found[i].departure_squared);
        }
        first_.pull();
        b_ = first_;
        refiner_.set_roughness(std::move(roughness));
    }

    /// On the children of elements, where links come to them: below what they were held by, light is E_dir as projected
    /// and E_ind as their parent has it.
    void find_light_below(const std::vector<ElementId>& parents, Field<ElementId, double>& roughness) {
        first_.resize(), b_.resize();
        parallel_for(parents.size(), 1, [&](std::size_t i) {
            for (ElementId child : light_.tree.children(parents[i])) {
                const FromBelow found = once_.at(child);
                first_.set(child, found.values);
                roughness[child] = std::sqrt(found.departure_squared);
                const auto push = sites_.push(child);
                const std::size_t n = sites_.nodes();
                for (std::size_t k = 0; k < n; ++k) {
                    Spectrum b = found.values[k];
                    for (std::size_t j = 0; j < n; ++j)
                        b += static_cast<double>(push[k * n + j]) *
                             (b_.node(parents[i], j) - first_.node(parents[i], j));
                    b_.set_node(child, k, b);
                }
            }
        });
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
        NodalField* const also[] = {&first_};
        if (!far_) return refiner_.refine(b_, also, tolerance, input_.progress, input_.stop);
        const std::vector<LinkPair> near = far_->refine(b_, tolerance, input_.stop);
        refiner_.refine(near, b_, also, tolerance, input_.progress, input_.stop);
    }

    /// Of links of elements and of clusters.
    double link_error() const { return std::hypot(refiner_.link_error(), far_ ? far_->error() : 0); }
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

    /// What leaves hold, on all elements.
    template <class OfLeaf>
    NodalField pulled(const OfLeaf& of_leaf) const {
        const std::vector<ElementId> ends = sites_.ends();
        NodalField out(sites_);
        parallel_for(ends.size(), 1,
                     [&](std::size_t i) { out.set(ends[i], pull_from_leaves(sites_, ends[i], of_leaf).values); });
        out.pull();
        return out;
    }

    /// How much errors of elements count at the points that are looked at: by reciprocity the same links bear it,
    /// w = w_0 + F rho w. Solved for rho w, which obeys the equation of light: v = rho w_0 + rho F v.
    void find_importance() {
        const std::vector<Spectrum> points =
            looked_at(input_.stage, light_.tree, light_.numbering, input_.options.importance, input_.options.seed);
        const std::vector<ElementId>& leaves = light_.numbering.leaves;
        NodalField w(sites_);
        const NodalField source = pulled([&](ElementId leaf) {
            NodalValues out{};
            out.fill(material(leaf).reflectance * points[light_.numbering.number[leaf]]);
            return out;
        });
        NodalField v = source;
        system_.solve(source, v);
        system_.gather(v, w);
        Field<ElementId, double> importance(light_.tree.size(), 0.0);
        double total = 0;
        for (std::size_t i = 0; i < leaves.size(); ++i) {
            const double here = mean(points[i] + mean_over(sites_, w.values(leaves[i]), leaves[i]));
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

    /// b = rho (E_dir + F b) for the means of leaves by rays, which know no links, from the light that links give:
    /// those are up to some percent too dark in all places together, which no average over a hemisphere mends and which
    /// comes back from every reflection. How light varies within leaves they are left to tell.
    void correct_by_rays() {
        input_.progress.phase("correct");
        const std::vector<ElementId>& leaves = light_.numbering.leaves;
        NodalField F_b = gather();
        light_.direct.resize(leaves.size()), light_.reflected.resize(leaves.size());
        parallel_for(leaves.size(), 64, [&](std::size_t i) {
            const ElementId e = leaves[i];
            light_.direct[i] = mean_over(sites_, projected_light(sites_, input_.direct, e), e);
            light_.reflected[i] =
                material(e).reflectance * (light_.direct[i] + mean_over(sites_, indirect_light(F_b, e), e));
        });
        const ElementLocator locator(light_.tree, input_.stage.scene.regions().size());
        const RayRows rows(input_.stage, light_.tree, light_.numbering, locator, input_.knobs.solve_rays,
                           input_.options.seed);
        light_.rays += rows.rays();
        light_.kept = rows.kept();
        const std::size_t before = light_.report.iterations;
        relax_constant_elements(input_, rows, light_);
        light_.report.iterations += before;
        missed_ = Field<ElementId, Spectrum>(light_.tree.size());
        const auto find_missed = [&] {
            parallel_for(leaves.size(), 64, [&](std::size_t i) {
                missed_[leaves[i]] += light_.indirect[i] - mean_over(sites_, indirect_light(F_b, leaves[i]), leaves[i]);
            });
        };
        find_missed();
        b_ = pulled([&](ElementId leaf) {
            NodalValues out = projected_light(sites_, input_.direct, leaf);
            const NodalValues E_ind = indirect_light(F_b, leaf);
            for (std::size_t k = 0; k < sites_.nodes(); ++k) out[k] = material(leaf).reflectance * (out[k] + E_ind[k]);
            return out;
        });
        F_b = gather();
        find_missed();
    }

    /// F b by the links.
    NodalField gather() const {
        NodalField E(sites_);
        system_.gather(b_, E);
        return E;
    }

    /// E_ind of any element no larger than those that are held: F b, and what rays found it to miss.
    NodalValues indirect_light(const NodalField& F_b, ElementId e) const {
        NodalValues out = F_b.values(e);
        while (e.value >= missed_.size() && !missed_.empty()) e = light_.tree.parent(e);
        for (Spectrum& value : out) value = system_.scale() * value + (missed_.empty() ? Spectrum() : missed_[e]);
        return out;
    }

    /// Cuts leaves, for the sake of what is handed on, until linear functions hold what quadratic ones have found.
    void cut_for_delivery(const NodalLight& E) {
        const double allowed = 0.3 * input_.knobs.link_error * light_norm() / std::sqrt(input_.stage.area);
        std::vector<ElementId> active = light_.tree.leaves();
        constexpr int most_levels = 3;
        for (int level = 0; level < most_levels && !active.empty(); ++level) {
            const std::vector<ElementId> rough = rough_elements(sites_, E, active, allowed);
            for (ElementId e : rough) refine_element(light_.tree, e);
            active.clear();
            for (ElementId e : rough)
                for (ElementId child : light_.tree.children(e)) active.push_back(child);
        }
        light_.numbering = LeafNumbering(light_.tree);
        light_.kept.clear();  // was of other leaves
    }

    void hand_over() {
        // The mesh below the elements that are held is that of direct light.
        const std::size_t element_bytes = light_.tree.memory_bytes() * sites_.size() / light_.tree.size() +
                                          sites_.memory_bytes() + once_.memory_bytes() + refiner_.field_bytes() +
                                          2 * b_.memory_bytes();
        const NodalField F_b = gather();
        const NodalLight E = [&](ElementId e) { return indirect_light(F_b, e); };
        if (basis_.order() > 2 && (light_.delivers || input_.options.smoothing)) cut_for_delivery(E);
        write_nodal_light(sites_, E, input_.direct, light_);
        light_.links = system_.size();
        if (input_.options.keep_links) light_.kept_links = system_.links().list();
        light_.link_memory_bytes = system_.memory_bytes();
        light_.element_memory_bytes = element_bytes;
        light_.elements_by_level = sites_.count_by_level();
        light_.rays += rays();
        light_.form_factors = refiner_.form_factors();
    }

    const MethodInput& input_;
    bool is_polynomial_;
    NodalBasis basis_;
    GlobalLight light_;
    LinkSites sites_;
    LightBelow once_;       ///< rho E_dir.
    NodalField first_, b_;  ///< rho E_dir, and all reflected light.
    LinkRefiner refiner_;
    LinkedSystem system_;
    std::optional<ClusterTree> clusters_;  ///< None where every piece is linked to every other to begin with.
    std::optional<ClusterRefiner> far_;
    Field<ElementId, Spectrum> missed_;  ///< By the links, of E_ind; of every leaf, or empty.
};

}  // namespace

namespace {

/// Does what was asked for say how links are to be found or judged, or deliver what they hold?
bool asks_for_judged_links(const SolveOptions& o) {
    return o.basis || o.epsilon || o.oracle != LinkOracle::transport || !o.importance.empty() || o.smoothing ||
           !o.triage || o.visibility != VisibilityKind::automatic || o.clusters || o.min_area;
}

}  // namespace

bool links_outgrow_memory(std::size_t pieces, const SolveOptions& options) {
    constexpr double see_each_other = 0.5;
    const double pairs = see_each_other * std::pow(static_cast<double>(pieces), 2);
    return options.memory_limit_bytes &&
           pairs * LinkRefiner::bytes_a_link > static_cast<double>(*options.memory_limit_bytes);
}

GlobalLight solve_hierarchy(const MethodInput& input, HierarchyBasis kind) {
    if (!asks_for_judged_links(input.options))
        if (std::optional<GlobalLight> light = solve_linked_by_rays(input, is_polynomial(kind)))
            return std::move(*light);
    return Hierarchy(input, kind, held_by(input, kind)).solve();
}

GlobalLight solve_galerkin(const MethodInput& input, HierarchyBasis kind) {
    return Hierarchy(input, kind, LinkSites::Held::all).solve_on_leaves();
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
