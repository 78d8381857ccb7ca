#include "exitance/evaluate/interpolant.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "exitance/base/error_share.hpp"
#include "exitance/base/loop_progress.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/basis/element_fit.hpp"
#include "exitance/basis/misfit_along.hpp"
#include "exitance/evaluate/interpolant_error.hpp"
#include "exitance/mesh/adaptive.hpp"
#include "exitance/mesh/element_locator.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/solution/continuous.hpp"

namespace exitance {
namespace {

class Interpolation {
  public:
    Interpolation(const Stage& stage, const DirectProjection& direct, const ElementFunction& indirect,
                  const Spectrum& direct_share, const InterpolantOptions& options)
        : stage_(stage),
          direct_(direct),
          indirect_(indirect),
          direct_weight_(Spectrum(1.0) - direct_share),
          options_(options) {
        out_.tree = direct.tree;
        const auto elements = static_cast<double>(direct.tree.size() + indirect.tree.size());
        max_elements_ = std::max(options.always_allowed, static_cast<std::size_t>(options.max_growth * elements));
    }

    /// After a stop request, remaining leaves are restricted from their parents.
    ElementFunction run(InterpolantReport& report, const StopRequest& stop) {
        std::vector<ElementId> active = out_.tree.leaves();
        for (int round = 0;; ++round) {
            fitted_.resize(out_.tree.size());
            locator_.emplace(indirect_.tree, stage_.scene.regions().size());
            find_even_noise();
            constexpr std::size_t grain = 8;
            LoopProgress progress({options_.progress, fraction_before_round(round), fraction_before_round(round + 1),
                                   std::to_string(active.size()) + " elements"},
                                  own_count(active.size(), grain));
            shared_ranges_of(
                fitted_.span(), active.size(), grain,
                [&](std::size_t begin, std::size_t end) {
                    DirectFitRoom room;
                    for (std::size_t i = begin; i < end; ++i) {
                        const ElementId e = active[i];
                        if (is_renewed(e) && stop.requested()) continue;
                        fitted_[e] = round > 0 && stop.requested()
                                         ? Fit(inherited_fit(out_.tree, e, fitted_[out_.tree.parent(e)].as_direct()))
                                         : fit(e, room);
                        progress.add_one();
                    }
                },
                [&](std::size_t i) -> Fit& { return fitted_[active[i]]; },
                {"interpolate", [&](std::size_t i) { return out_.tree.region(active[i]).value; }});
            locator_.reset();  // frees memory for the next step
            double misfit = error();
            report.interrupted = stop.requested();
            const bool last = round == options_.max_depth || report.interrupted || out_.tree.size() >= max_elements_;
            if (misfit <= options_.tolerance || last) {
                ElementFunction continuous = join(stop);
                misfit = error();
                if (misfit <= options_.tolerance || last) {
                    if (!stop.requested()) report.error = measured_error(continuous);
                    report.interrupted |= stop.requested();
                    return continuous;
                }
            }
            active = split_largest(misfit);
        }
    }

  private:
    /// Largest factor on the squared noise of small leaves. Derived from a noise of at most twice the tolerance, which
    /// neighbours average out where their light is continuous.
    static constexpr double max_noise = 4;

    /// The parts of a fit that are stored, in single precision.
    struct Fit {
        std::array<std::array<float, bands>, 4> corners;
        double misfit_squared = 0;
        std::array<float, 2> misfit_along = {};
        float noise_squared = 0;  ///< Part of `misfit_squared`.
        /// True if rays found no light on an element of a scene with several rooms. Its noise is then the light of
        /// features that they may have missed, which neither smaller elements nor more rays reduce notably: dark rooms
        /// consist of such elements. It is no reason for refinement; the measured error contains such features.
        bool is_dark = false;

        Fit() = default;
        explicit Fit(const DirectFit& fit)
            : misfit_squared(fit.misfit_squared),
              misfit_along{static_cast<float>(fit.misfit_along[0]), static_cast<float>(fit.misfit_along[1])},
              noise_squared(static_cast<float>(fit.noise_squared)) {
            for (std::size_t i = 0; i < corners.size(); ++i)
                for (std::size_t k = 0; k < bands; ++k) corners[i][k] = static_cast<float>(fit.corners[i][k]);
        }
        /// Mean square of the error that refinement can reduce, (W/m^2)^2.
        double reducible_squared() const {
            return std::max(0.0, misfit_squared - (is_dark ? static_cast<double>(noise_squared) : 0));
        }
        DirectFit as_direct() const {
            DirectFit out;
            out.misfit_squared = misfit_squared, out.noise_squared = static_cast<double>(noise_squared);
            for (std::size_t i = 0; i < corners.size(); ++i)
                for (std::size_t k = 0; k < bands; ++k) out.corners[i][k] = static_cast<double>(corners[i][k]);
            return out;
        }
    };

    /// Allowed mean square of the rays' noise on a leaf, in the unit of the squared tolerance. Small leaves, such as
    /// those along shadow edges, matter little to the whole, and most rays are theirs.
    double noise_on(ElementId e) const {
        const double of_area = std::sqrt(even_noise_area_ / out_.tree.area(e));
        return options_.tolerance * options_.tolerance * std::clamp(of_area, 1.0, max_noise);
    }
    void find_even_noise() {
        std::vector<double> areas;
        for (ElementId e : out_.tree.leaves()) areas.push_back(out_.tree.area(e));
        even_noise_area_ = even_noise_area(areas);
    }

    /// Fits direct light, as projected or, on new leaves, computed again, plus indirect light.
    Fit fit(ElementId e, DirectFitRoom& room) const {
        const Patch& patch = out_.tree.patch(e);
        const RegionId region = out_.tree.region(e);
        const double counts = options_.light_in.empty() ? 1 : relative_weight(e);
        DirectFit out = e.value < direct_.tree.size() && !is_renewed(e)
                            ? direct_.fit[e]
                            : fit_direct_light(stage_, out_.tree, e, noise_on(e) / counts, room);
        const bool is_dark = !options_.light_in.empty() && !(max(out.mean) > 0);
        for (Spectrum& corner : out.corners) corner *= direct_weight_;
        out.mean *= direct_weight_;
        const double of_direct = max(direct_weight_ * direct_weight_);
        out.misfit_squared *= of_direct, out.noise_squared *= of_direct;
        const std::vector<WeightedPlace> rule = element_rule(out_.tree, e, RuleOrder::fine);
        std::vector<Spectrum> value(rule.size());
        for (std::size_t i = 0; i < rule.size(); ++i) {
            value[i] = indirect_.at(locator_->find(region, patch.at(rule[i].uv)));
            out.mean += rule[i].weight * value[i];
        }
        const ElementFit indirect(out_.tree, e, rule, value);
        for (int i = 0; i < patch.corner_count(); ++i) out.corners[static_cast<std::size_t>(i)] += indirect.corner(i);
        const Spectrum w = light_weight(stage_.scene.material(region));
        for (std::size_t i = 0; i < rule.size(); ++i) {
            value[i] = w * (value[i] - indirect.at(rule[i].uv));
            out.misfit_squared += rule[i].weight * squared(value[i]) / static_cast<double>(bands);
        }
        out.misfit_squared *= counts, out.noise_squared *= counts;
        const std::array<double, 2> along = misfit_along(out_.tree, e, rule, value, Degree::straight);
        for (std::size_t k = 0; k < 2; ++k) out.misfit_along[k] = counts * (of_direct * out.misfit_along[k] + along[k]);
        Fit found(out);
        found.is_dark = is_dark;
        return found;
    }

    /// Returns the continuous function nearest to all fits, and adds its distance from them to their misfits.
    ElementFunction join(const StopRequest& stop) {
        ElementFunction apart;
        apart.tree = out_.tree;
        apart.first_value.resize(out_.tree.size());
        for (ElementId e : out_.tree.leaves()) {
            apart.first_value[e] = static_cast<std::uint32_t>(apart.values.size());
            for (int i = 0; i < out_.tree.patch(e).corner_count(); ++i)
                apart.values.push_back(fitted_[e].corners[static_cast<std::size_t>(i)]);
        }
        // Computing nodes of a large mesh takes time; after a stop request the result is discontinuous.
        ElementFunction out =
            stop.requested() ? apart : nearest_continuous(apart, stage_.scene, stage_.contacts, &stop);
        // Total light is not negative. Only changed values are written, so that shared pages stay shared.
        for (auto& value : out.values)
            for (float& of_band : value)
                if (of_band < 0) of_band = 0;
        share_on_node(std::span(out.values));
        shared_ranges_of(
            fitted_.span(), apart.tree.size(), 64,
            [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                    const ElementId e(i);
                    if (!apart.tree.is_leaf(e)) continue;
                    // The step that was made continuous contains the noise of both fits. It is no misfit, so subtract
                    // it.
                    const double step = squared_step(apart, out, e) - static_cast<double>(fitted_[e].noise_squared);
                    fitted_[e].misfit_squared += std::max(0.0, step);
                }
            },
            [&](std::size_t i) -> double& { return fitted_[ElementId(i)].misfit_squared; }, {"interpolate"});
        return out;
    }

    /// Mean square of w (a - b) on a leaf of a, which is a leaf or a fan of b.
    double squared_step(const ElementFunction& a, const ElementFunction& b, ElementId e) const {
        const Patch& whole = a.tree.patch(e);
        const Spectrum w = light_weight(stage_.scene.material(a.tree.region(e)));
        const auto on = [&](ElementId part) {
            double sum = 0;
            for (const WeightedPlace& place : element_rule(b.tree, part, RuleOrder::nodes)) {
                const Spectrum there = a.at({e, whole.coordinates(b.tree.patch(part).at(place.uv))});
                sum += place.weight * squared(w * (there - b.at({part, place.uv}))) / static_cast<double>(bands);
            }
            return b.tree.area(part) / b.tree.area(e) * sum;
        };
        double sum = b.tree.is_leaf(e) ? on(e) : 0;
        for (ElementId part : b.tree.children(e)) sum += on(part);
        return options_.light_in.empty() ? sum : relative_weight(e) * sum;
    }

    /// Factor on squared errors if rooms are judged separately.
    double relative_weight(ElementId e) const {
        const double light = options_.light_in[stage_.rooms.of(out_.tree, e)];
        return stage_.rooms.weight(out_.tree, e) / (light * light);
    }

    double measured_error(const ElementFunction& continuous) const {
        std::vector<InterpolatedLeaf> leaves;
        for (ElementId e : out_.tree.leaves()) {
            const double weight = options_.light_in.empty() ? 1 : relative_weight(e);
            leaves.push_back({e, fitted_[e].reducible_squared() / weight});
        }
        return interpolant_error(stage_, continuous, leaves, {indirect_, direct_weight_}, options_.seed);
    }

    /// RMS error by the fits' own misfits, as far as refinement can reduce it.
    double error() const {
        double sum = 0;
        for (ElementId e : out_.tree.leaves()) sum += out_.tree.area(e) * fitted_[e].reducible_squared();
        return std::sqrt(sum / stage_.area);
    }

    /// True if the direct light of a leaf of the direct projection is computed again, with less noise.
    bool is_renewed(ElementId e) const { return e.value < renewed_.size() && renewed_[e.value]; }

    /// True if a leaf's error is mostly noise of rays in its projected direct light: below a sky, or in dark rooms,
    /// since the projection allows it relative to the light of the whole. Parts of the leaf would have it as well.
    bool is_noisy(ElementId e) const {
        const Fit& fit = fitted_[e];
        return e.value < direct_.tree.size() && !is_renewed(e) &&
               static_cast<double>(fit.noise_squared) > 0.5 * fit.misfit_squared;
    }

    /// Splits the leaves whose squared error exceeds an even share of the allowed one, the largest errors first if
    /// there would be too many elements. Returns the leaves to fit: new ones, and those that need less noise instead.
    std::vector<ElementId> split_largest(double error) {
        const std::vector<ElementId> leaves = out_.tree.leaves();
        const double allowed = options_.tolerance * options_.tolerance * stage_.area;
        const double share =
            allowed / static_cast<double>(leaves.size()) * std::min(1.0, 2 * options_.tolerance / error);
        const auto error_of = [&](ElementId e) { return out_.tree.area(e) * fitted_[e].reducible_squared(); };
        std::vector<ElementId> rough;
        for (ElementId e : leaves)
            if (error_of(e) > share) rough.push_back(e);
        constexpr std::size_t max_parts = 4;  // number of parts into which one leaf is split at most
        const std::size_t room = (max_elements_ - std::min(max_elements_, out_.tree.size())) / max_parts + 1;
        if (rough.size() > room) {
            std::stable_sort(rough.begin(), rough.end(),
                             [&](ElementId a, ElementId b) { return error_of(a) > error_of(b); });
            rough.resize(room);
            std::sort(rough.begin(), rough.end());
        }
        std::vector<ElementId> fresh;
        for (ElementId e : rough) {
            if (is_noisy(e)) {
                renewed_.resize(direct_.tree.size());
                renewed_[e.value] = 1;
                fresh.push_back(e);
                continue;
            }
            const auto& [u, v] = fitted_[e].misfit_along;
            const Cut only = sufficient_cut(fitted_[e].misfit_squared, {u, v}, share / out_.tree.area(e));
            for (ElementId child : refine_element(out_.tree, e, only)) fresh.push_back(child);
        }
        return fresh;
    }

    const Stage& stage_;
    const DirectProjection& direct_;
    const ElementFunction& indirect_;
    const Spectrum direct_weight_;
    const InterpolantOptions& options_;
    /// Locates elements of the indirect light; set only while leaves are fitted.
    std::optional<ElementLocator> locator_;
    std::size_t max_elements_ = 0;
    double even_noise_area_ = 0;  ///< Area of leaves that have the noise of the tolerance, m^2.
    ElementFunction out_;
    Field<ElementId, Fit> fitted_;
    std::vector<std::uint8_t> renewed_;  ///< 1 for elements of the direct projection to renew; empty: none.
};

}  // namespace

ElementFunction make_interpolant(const Stage& stage, const DirectProjection& direct, const ElementFunction& indirect,
                                 const Spectrum& direct_share, const InterpolantOptions& options,
                                 InterpolantReport& report, const StopRequest& stop) {
    return Interpolation(stage, direct, indirect, direct_share, options).run(report, stop);
}

}  // namespace exitance
