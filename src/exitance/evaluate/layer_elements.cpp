#include "exitance/evaluate/layer_elements.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/basis/element_fit.hpp"
#include "exitance/basis/misfit_along.hpp"
#include "exitance/mesh/adaptive.hpp"
#include "exitance/mesh/element_locator.hpp"
#include "exitance/solve/solve_options.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {
namespace {

/// The elements of a tree as they were before leaves were split into fans.
ElementTree without_fans(const ElementTree& from) {
    ElementTree out;
    Field<ElementId, ElementId> copy(from.size());
    for (const ElementId e : from.ids()) {
        if (from.parent(e).is_none()) copy[e] = out.add_root(from.region(e), from.patch(e));
        const Cut kind = from.cut_of(e);
        if (copy[e].is_none() || kind == Cut::none || kind == Cut::fan) continue;
        ElementId child =
            kind == Cut::line ? out.split_by_line(copy[e], from.line(e)) : out.split(copy[e], kind, from.ratio(e));
        if (child.is_none()) continue;
        for (const ElementId of_parent : from.children(e)) copy[of_parent] = child, child = ElementId(child.value + 1);
    }
    return out;
}

class LayerElements {
  public:
    explicit LayerElements(const Solution& solution)
        : solution_(solution),
          locator_(solution.indirect.tree, solution.scene.regions().size()),
          exact_share_(Spectrum(1) - solution.direct_share),
          tolerance_(solution.statistics.relative_error_estimate_interpolant.value_or(default_error)) {
        out_.tree = without_fans(solution.indirect.tree);
        max_elements_ = std::max(always_allowed, out_.tree.size() + solution.layers->triangle_count());
    }

    ElementFunction run() {
        std::vector<ElementId> fresh = out_.tree.leaves();
        for (int round = 0; round < max_rounds && !fresh.empty(); ++round) {
            fits_.resize(out_.tree.size());
            parallel_for(fresh.size(), 8, [&](std::size_t i) { fits_[fresh[i]] = fit(fresh[i]); });
            fresh = round + 1 < max_rounds ? split_largest() : std::vector<ElementId>();
        }
        out_.first_value.resize(out_.tree.size());
        for (const ElementId e : out_.tree.leaves()) {
            out_.first_value[e] = static_cast<std::uint32_t>(out_.values.size());
            for (int k = 0; k < out_.tree.patch(e).corner_count(); ++k)
                out_.add_value(fits_[e].corners[static_cast<std::size_t>(k)]);
        }
        return std::move(out_);
    }

  private:
    static constexpr int max_rounds = 13;  // derived from plain elements (InterpolantOptions::max_depth)
    static constexpr std::size_t always_allowed = 20'000;  // derived from plain elements (InterpolantOptions)

    struct Fit {
        std::array<Spectrum, 4> corners = {};
        double light = 0;           ///< Mean of w E over the element, W/m^2; see light_weight().
        double misfit_squared = 0;  ///< Mean of (w (E - polynomial))^2.
        std::array<double, 2> along = {};
    };

    Fit fit(ElementId e) const {
        const Patch& patch = out_.tree.patch(e);
        const RegionId region = out_.tree.region(e);
        const Spectrum w = light_weight(solution_.scene.material(region));
        const std::vector<WeightedPlace> rule = element_rule(out_.tree, e, RuleOrder::fine);
        std::vector<Spectrum> value(rule.size());
        Fit out;
        for (std::size_t i = 0; i < rule.size(); ++i) {
            const Point x = patch.at(rule[i].uv);
            value[i] = exact_share_ * solution_.layers->at(solution_.scene, region, x) +
                       solution_.indirect.at(locator_.find(region, x));
            out.light += rule[i].weight * mean(w * value[i]);
        }
        const ElementFit polynomial(out_.tree, e, rule, value);
        for (int k = 0; k < patch.corner_count(); ++k) {
            Spectrum& corner = out.corners[static_cast<std::size_t>(k)];
            corner = polynomial.corner(k);
            for (std::size_t b = 0; b < bands; ++b) corner[b] = std::max(0.0, corner[b]);  // light is not negative
        }
        for (std::size_t i = 0; i < rule.size(); ++i) {
            value[i] = w * (value[i] - polynomial.at(rule[i].uv));
            out.misfit_squared += rule[i].weight * squared(value[i]) / static_cast<double>(bands);
        }
        out.along = misfit_along(out_.tree, e, rule, value, Degree::straight);
        return out;
    }

    /// Splits the leaves whose squared misfit exceeds an even share of the allowed one, the largest first if there
    /// would be too many elements. Returns the new leaves; none if the misfit is small enough.
    std::vector<ElementId> split_largest() {
        const std::vector<ElementId> leaves = out_.tree.leaves();
        const auto misfit = [&](ElementId e) { return out_.tree.area(e) * fits_[e].misfit_squared; };
        double sum = 0, light = 0, area = 0;
        for (const ElementId e : leaves) {
            sum += misfit(e);
            light += out_.tree.area(e) * fits_[e].light, area += out_.tree.area(e);
        }
        const double allowed = area > 0 ? tolerance_ * tolerance_ * light * light / area : 0;
        std::vector<ElementId> rough, fresh;
        if (!(sum > allowed) || out_.tree.size() >= max_elements_) return fresh;
        const double share = allowed / static_cast<double>(leaves.size()) * std::min(1.0, 2 * std::sqrt(allowed / sum));
        for (const ElementId e : leaves)
            if (misfit(e) > share) rough.push_back(e);
        constexpr std::size_t max_parts = 4;  // number of parts into which one leaf is split at most
        const std::size_t room = (max_elements_ - out_.tree.size()) / max_parts + 1;
        if (rough.size() > room) {
            std::stable_sort(rough.begin(), rough.end(),
                             [&](ElementId a, ElementId b) { return misfit(a) > misfit(b); });
            rough.resize(room);
            std::sort(rough.begin(), rough.end());
        }
        for (const ElementId e : rough) {
            const Cut only = sufficient_cut(fits_[e].misfit_squared, fits_[e].along, share / out_.tree.area(e));
            for (const ElementId child : refine_element(out_.tree, e, only)) fresh.push_back(child);
        }
        return fresh;
    }

    const Solution& solution_;
    const ElementLocator locator_;
    const Spectrum exact_share_;
    const double tolerance_;
    std::size_t max_elements_ = 0;
    ElementFunction out_;
    Field<ElementId, Fit> fits_;
};

}  // namespace

ElementFunction elements_of_layers(const Solution& solution) {
    return LayerElements(solution).run();
}

}  // namespace exitance
