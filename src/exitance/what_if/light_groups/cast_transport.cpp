#include "exitance/what_if/light_groups/cast_transport.hpp"

#include <algorithm>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/basis/element_fit.hpp"
#include "exitance/gather/gather.hpp"
#include "exitance/mesh/element_locator.hpp"

namespace exitance {
namespace {

/// Rays that hit one element, and the contribution of its light to the corners of the receiver.
struct Met {
    std::uint32_t element = 0;
    std::uint32_t rays = 0;
    std::array<double, 4> weight{};
    bool is_parted = false;  ///< True if some descendant has a separate entry in the row.

    void add(const Met& other) {
        rays += other.rays;
        for (std::size_t c = 0; c < 4; ++c) weight[c] += other.weight[c];
    }
};

/// Computes rows of stored transport, one after the other. Each thread has its own object.
class RowMaker {
  public:
    RowMaker(const Stage& stage, const Solution& solution, const TransportLayout& layout, const ElementLocator& locator,
             const CastDemand& demand)
        : stage_(stage),
          tree_(solution.indirect.tree),
          sources_(solution.interpolant.tree),
          layout_(layout),
          locator_(locator),
          demand_(demand) {}

    /// `rays`: number from every sample point. Returns the total number of rays.
    std::size_t make(ElementId receiver, unsigned rays, std::vector<Met>& row) {
        const std::vector<WeightedPlace> places = element_rule(tree_, receiver, RuleOrder::fine);
        cast(receiver, places, rays);
        count(receiver, places, rays);
        const std::size_t all = places.size() * rays;
        merge(static_cast<std::uint32_t>(std::max(1.0, demand_.form_factor * static_cast<double>(all))));
        row = std::move(row_);
        return all;
    }

  private:
    /// Casts the rays of all sample points; their hits are left in the workspace.
    void cast(ElementId e, const std::vector<WeightedPlace>& places, unsigned rays) {
        static const PointwiseLight unread([](RegionId, const Point&) { return Spectrum(); });
        const RegionId region = tree_.region(e);
        gather_places_.clear();
        std::vector<GrowingGather> fresh(places.size());
        std::vector<GrowingGather*> growing;
        for (GrowingGather& one : fresh) growing.push_back(&one);
        for (std::size_t i = 0; i < places.size(); ++i)
            gather_places_.push_back(
                {tree_.patch(e).at(places[i].uv),
                 hash(demand_.seed, static_cast<std::uint64_t>(Stream::rows), std::uint64_t(0x6c67), e.value, i)});
        grow_together(stage_, gather_places_, stage_.scene.regions()[region].plane.n, region, rays, unread, growing,
                      workspace_);
    }

    /// Counts hits per element, in descending order of elements.
    void count(ElementId e, const std::vector<WeightedPlace>& places, unsigned rays) {
        // contribution of a value at a sample point to the corners, by the nearest polynomial
        const ElementPolynomials polynomials(tree_, e, places, false);
        std::array<ElementPolynomials::Values, 4> at_corner{};
        const auto corners = static_cast<std::size_t>(tree_.patch(e).corner_count());
        for (std::size_t c = 0; c < corners; ++c)
            at_corner[c] = polynomials.at(tree_.patch(e).corner_uv(static_cast<int>(c)));
        std::vector<std::array<double, 4>> brings(places.size());
        for (std::size_t i = 0; i < places.size(); ++i) {
            const ElementPolynomials::Values here = polynomials.at(places[i].uv);
            for (std::size_t c = 0; c < corners; ++c)
                for (std::size_t k = 0; k < polynomials.size(); ++k)
                    brings[i][c] += places[i].weight / rays * here[k] * at_corner[c][k];
        }
        met_.clear();
        for (std::size_t k = 0; k < workspace_.fronts.size(); ++k) {
            const auto& [y, region] = workspace_.fronts[k];
            const ElementId leaf = locator_.find(region, y).element;
            if (leaf.is_none()) continue;
            const ElementId base = layout_.number[leaf] == TransportLayout::none ? sources_.parent(leaf) : leaf;
            met_.push_back({base.value, 1, brings[workspace_.share[k] / 4]});
        }
        std::sort(met_.begin(), met_.end(), [](const Met& a, const Met& b) { return a.element > b.element; });
        std::size_t last = 0;
        for (std::size_t k = 1; k < met_.size(); ++k) {
            if (met_[k].element == met_[last].element)
                met_[last].add(met_[k]);
            else
                met_[++last] = met_[k];
        }
        if (!met_.empty()) met_.resize(last + 1);
    }

    /// Merges siblings into their parent, or keeps them in the row. Works from the highest element number, so that
    /// children come before their parents.
    void merge(std::uint32_t max_rays) {
        row_.clear(), above_.clear();
        std::size_t next = 0;
        const auto by_element = [](const Met& a, const Met& b) { return a.element < b.element; };
        while (next < met_.size() || !above_.empty()) {
            siblings_.clear();
            const auto highest = [&] {
                const std::uint32_t a = next < met_.size() ? met_[next].element : 0;
                return std::max(a, above_.empty() ? 0 : above_.front().element);
            };
            const ElementId parent = sources_.parent(ElementId(highest()));
            const std::uint32_t first = parent.is_none() ? highest() : sources_.children(parent).front().value;
            while (next < met_.size() && met_[next].element >= first) siblings_.push_back(met_[next++]);
            while (!above_.empty() && above_.front().element >= first) {
                std::pop_heap(above_.begin(), above_.end(), by_element);
                siblings_.push_back(above_.back()), above_.pop_back();
            }
            Met whole{parent.value, 0, {}, false};
            for (const Met& m : siblings_) whole.add(m), whole.is_parted |= m.is_parted;
            if (!parent.is_none() && !whole.is_parted && whole.rays <= max_rays && all_are_met(parent, whole.rays)) {
                above_.push_back(whole);
            } else {
                for (const Met& m : siblings_)
                    if (!m.is_parted) row_.push_back(m);
                if (parent.is_none()) continue;
                above_.push_back({parent.value, 0, {}, true});
            }
            std::push_heap(above_.begin(), above_.end(), by_element);
        }
        std::reverse(row_.begin(), row_.end());
    }

    /// True if every child is hit, or is so small that it may be missed by this number of rays.
    bool all_are_met(ElementId parent, std::uint32_t rays) const {
        constexpr double min_expected_rays = 3;  // expected number of hits: the probability of none is one in twenty
        for (const ElementId child : sources_.children(parent)) {
            const bool is_met =
                std::any_of(siblings_.begin(), siblings_.end(), [&](const Met& m) { return m.element == child.value; });
            if (!is_met && rays * sources_.area(child) > min_expected_rays * sources_.area(parent)) return false;
        }
        return true;
    }

    const Stage& stage_;
    const ElementTree &tree_, &sources_;
    const TransportLayout& layout_;
    const ElementLocator& locator_;
    const CastDemand& demand_;
    GatherWorkspace workspace_;
    std::vector<GatherPlace> gather_places_;
    std::vector<Met> met_, siblings_, row_;
    std::vector<Met> above_;  ///< A heap of elements that replace their children.
};

/// Mean square of rho (f - polynomial) on an element, with the polynomial nearest to f at the points of a rule.
double misfit_squared(const Solution& solution, ElementId e) {
    const ElementFunction& f = solution.indirect;
    const std::vector<WeightedPlace> places = element_rule(f.tree, e, RuleOrder::finer);
    std::vector<Spectrum> values;
    for (const WeightedPlace& place : places) values.push_back(f.at(f.tree.leaf_at(e, place.uv)));
    const ElementFit fit(f.tree, e, places, values);
    const Spectrum& rho = solution.scene.material(f.tree.region(e)).reflectance;
    double sum = 0;
    for (std::size_t i = 0; i < places.size(); ++i)
        sum += places[i].weight * squared(rho * (values[i] - fit.at(places[i].uv))) / static_cast<double>(bands);
    return sum;
}

}  // namespace

std::vector<std::uint32_t> choose_receivers(const Solution& solution, double straight) {
    const ElementTree& tree = solution.indirect.tree;
    Field<ElementId, std::uint8_t> is_whole(tree.size(), 0);
    for (std::size_t i = tree.size(); i-- > 0;) {
        const ElementId e(i);
        if (is_base(tree, e)) {
            is_whole[e] = 1;
            continue;
        }
        const IdRange<ElementId> children = tree.children(e);
        const bool may_be = !children.empty() && std::all_of(children.begin(), children.end(),
                                                             [&](ElementId child) { return is_whole[child] != 0; });
        is_whole[e] = may_be && misfit_squared(solution, e) <= straight * straight;
    }
    std::vector<std::uint32_t> out;
    Field<ElementId, std::uint8_t> is_below(tree.size(), 0);
    for (const ElementId e : tree.ids()) {
        const ElementId parent = tree.parent(e);
        is_below[e] = !parent.is_none() && (is_below[parent] || is_whole[parent]);
        if (!is_below[e] && is_whole[e]) out.push_back(e.value);
    }
    return out;
}

KeptTransport cast_transport(const Stage& stage, const Solution& solution, std::vector<std::uint32_t> receivers,
                             const TransportLayout& layout, const CastDemand& demand, const StopRequest& stop) {
    KeptTransport out;
    out.receiver = std::move(receivers);
    const ElementTree& tree = solution.indirect.tree;
    const std::size_t n = out.receiver.size();
    double area = 0;
    for (const std::uint32_t e : out.receiver) area += tree.area(ElementId(e));
    const ElementLocator locator(solution.interpolant.tree, solution.scene.regions().size());
    std::vector<std::vector<Met>> rows(n);
    std::vector<std::size_t> cast(n, 0);
    parallel_ranges(n, 16, [&](std::size_t begin, std::size_t end) {
        RowMaker maker(stage, solution, layout, locator, demand);
        for (std::size_t i = begin; i < end && !stop.requested(); ++i) {
            const ElementId e(out.receiver[i]);
            const unsigned rays = std::max(4u, demand.rays.rays(tree.area(e), area / static_cast<double>(n)));
            cast[i] = maker.make(e, rays, rows[i]);
        }
    });
    for (std::size_t i = 0; i < n; ++i) {
        out.rays += cast[i];
        out.first.push_back(static_cast<std::uint32_t>(out.source.size()));
        for (const Met& met : rows[i]) {
            out.source.push_back(met.element);
            auto& weight = out.weight.emplace_back();
            for (std::size_t c = 0; c < 4; ++c) weight[c] = static_cast<float>(met.weight[c]);
        }
    }
    out.first.push_back(static_cast<std::uint32_t>(out.source.size()));
    return out;
}

}  // namespace exitance
