#include "exitance/transport/direct_projection.hpp"

#include <algorithm>
#include <string>

#include "exitance/base/error_share.hpp"
#include "exitance/base/loop_progress.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/mesh/adaptive.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/transport/body_views.hpp"
#include "exitance/transport/direct_fit.hpp"
#include "exitance/transport/fit_together.hpp"
#include "exitance/transport/narrow_places.hpp"

namespace exitance {
namespace {

/// Seconds after a stop request during which rays are still cast. Derived from the delay that users hardly notice.
constexpr double time_for_rays = 0.2;

/// Sum of light_weight() times E_dir over the leaves' area, W.
double weighted_flux(const Stage& stage, const ElementTree& tree, std::span<const ElementId> leaves,
                     const Field<ElementId, DirectFit>& fit) {
    double flux = 0;
    for (ElementId e : leaves)
        flux += tree.area(e) * mean(light_weight(stage.scene.material(tree.region(e))) * fit[e].mean);
    return flux;
}

/// Mean of w E_dir of each room, W/m^2, but at least a hundredth of the scene's; of all surfaces if the scene is one
/// room.
std::vector<double> light_by_room(const Stage& stage, const DirectProjection& light,
                                  const std::vector<ElementId>& leaves) {
    const std::size_t rooms = stage.rooms.count();
    std::vector<double> flux(std::max<std::size_t>(1, rooms));
    double all = 0;
    for (ElementId e : leaves) {
        const double own =
            light.tree.area(e) * mean(light_weight(stage.scene.material(light.tree.region(e))) * light.fit[e].mean);
        flux[rooms > 0 ? stage.rooms.of(light.tree, e) : 0] += own, all += own;
    }
    // Chosen: half of it and twice it give the same light, measured by `exitance solve door.obj --error 0.02`.
    constexpr double min_share_of_mean = 0.01;
    for (std::size_t room = 0; room < flux.size(); ++room)
        flux[room] = std::max(flux[room] / (rooms > 0 ? stage.rooms.area(room) : stage.area),
                              min_share_of_mean * all / stage.area);
    return flux;
}

/// Squared error that an element of each room may have, (W/m^2)^2 m^2; empty if the scene is one room. Each room is
/// treated as if it were the whole scene.
std::vector<double> shares_by_room(const Stage& stage, const DirectProjection& light,
                                   const std::vector<ElementId>& leaves, double tolerance) {
    const std::size_t rooms = stage.rooms.count();
    if (rooms == 0) return {};
    const std::vector<double> light_of = light_by_room(stage, light, leaves);
    std::vector<double> out(rooms), elements(rooms);
    for (ElementId e : leaves) elements[stage.rooms.of(light.tree, e)] += 1;
    for (std::size_t room = 0; room < rooms; ++room) {
        const double allowed = tolerance * light_of[room];
        out[room] = allowed * allowed * stage.rooms.area(room) / std::max(1.0, elements[room]);
    }
    return out;
}

/// Returns the part of an element's squared error that splitting would reduce, without noise, (W/m^2)^2 m^2.
double error_of_shape(const DirectProjection& light, ElementId e) {
    return light.tree.area(e) * std::max(0.0, light.fit[e].misfit_squared - light.fit[e].noise_squared);
}

/// Returns the smallest squared error for which a leaf is split if most elements are whole polygons, see
/// share_of_crowd(). `bound`: bound on the sum of the leaves' squared errors, (W/m^2)^2 m^2.
double share_in_crowd(const DirectProjection& light, double bound) {
    std::vector<double> errors;
    for (ElementId e : light.tree.leaves()) errors.push_back(error_of_shape(light, e));
    return share_of_crowd(std::move(errors), bound);
}

/// Fits direct light on elements and splits each until its error is at most its share.
class Projector {
  public:
    Projector(const Stage& stage, const DirectProjectionOptions& options, const StopRequest& stop)
        : stage_(stage), options_(options), stop_(stop), out_{stage.make_elements(options.mesh, &stop), {}} {}

    /// Returns an empty projection if it gives up.
    DirectProjection run() {
        std::vector<ElementId> active = out_.tree.leaves();
        mean_area_ = stage_.area / static_cast<double>(active.size());
        many_ = are_many(active.size());
        // Noise is neglected on small elements, and on large ones it need not decrease with the number of small ones.
        is_crowd_ = stage_.rooms.count() == 0 && stage_.is_crowd(active.size());
        // In scenes of many elements, or if exact light is expensive, the limit on errors is needed before the first
        // fits.
        if (active.size() > few_elements || has_open_sky())
            share_ = share_of(mean_weighted_light(stage_, out_.tree, active, stop_));
        for (int depth = 0; !active.empty(); ++depth) {
            find_smoothing(active, depth);
            fit_all(active, depth);
            if (options_.may_give_up && stop_.requested()) return {};
            if (depth == 0 && !many_)
                share_ = share_of(weighted_flux(stage_, out_.tree, active, out_.fit) / stage_.area);
            if (depth == 0) share_in_ = shares_by_room(stage_, out_, active, options_.tolerance);
            if (depth == 0 && options_.bodies && !stop_.requested())
                needs_.emplace(stage_, *options_.bodies, out_, options_.body_tolerance,
                               light_by_room(stage_, out_, active));
            if (depth > 0 && needs_) needs_->follow(out_.tree);
            if (depth == options_.max_depth || stop_.requested()) break;
            active = cut(active);
        }
        out_.tree.shrink_to_fit(), out_.fit.shrink_to_fit();
        share_on_node(out_.tree);
        return std::move(out_);
    }

  private:
    // With few elements, few emitters, or large emitters, all emitters are evaluated on all elements.
    // The fits of the first mesh then determine the error share of an element.
    static constexpr std::size_t few_elements = 2000, few_emitters = 8;

    /// True if exact light may need integrals over many parts of the sky: those behind each pane, and those between
    /// other surfaces.
    bool has_open_sky() const {
        const auto is_open_sky = [](const DirectLight::Emitter& emitter) {
            return emitter.sky == DirectLight::Emitter::Sky::open;
        };
        const std::vector<DirectLight::Emitter>& emitters = stage_.direct.emitters();
        return std::any_of(emitters.begin(), emitters.end(), is_open_sky);
    }

    /// True if a cut through the tree of emitters is cheaper than all of them.
    bool has_many_sources() const {
        constexpr std::size_t many_sources = 1000;
        return stage_.place_light.rays().emitters().sources().size() > many_sources;
    }

    bool are_many(std::size_t elements) const {
        // Share of all area above which emitters are no small sources. Chosen: half of it and twice it give the same
        // light, measured by `exitance solve furniture.obj --error 0.02`.
        constexpr double max_emitting_share = 0.25;
        double emitting = 0;
        for (const DirectLight::Emitter& emitter : stage_.direct.emitters())
            if (!emitter.region.is_none()) emitting += stage_.scene.regions()[emitter.region].area;
        return elements > few_elements && stage_.direct.emitters().size() > few_emitters &&
               (emitting < max_emitting_share * stage_.area || has_many_sources()) && !stage_.scene.has_light_apart();
    }

    /// Squared error that an element of mean area may have, by the mean of w E_dir, (W/m^2)^2 m^2.
    double share_of(double mean_light) const {
        const double allowed = options_.tolerance * mean_light;
        return allowed * allowed * mean_area_;
    }

    double allowed_on(ElementId e) const {  // (W/m^2)^2 m^2
        if (share_in_.empty()) return smoothing_[e] * share_;
        const double relative = stage_.rooms.importance(out_.tree, e) / stage_.rooms.weight(out_.tree, e);
        return smoothing_[e] * share_in_[stage_.rooms.of(out_.tree, e)] / relative;
    }

    /// Distance smooths the light that elements reflect, so that their error may be several times the requested one
    /// (`calibrated::direct_tolerance`). Where it arrives unsmoothed, it may not. In crowds, errors are judged
    /// together, and most elements are smaller than the distances between them.
    void find_smoothing(const std::vector<ElementId>& active, int depth) {
        smoothing_.resize(out_.tree.size(), 1);
        if (is_crowd_) return;
        const double smoothed = 1 / (calibrated::direct_tolerance * calibrated::direct_tolerance);
        const std::vector<float> unsmoothed =
            unsmoothed_shares(stage_, out_.tree, active, stop_,
                              {options_.progress, fraction_before_round(depth), before_fits(depth),
                               std::to_string(active.size()) + " elements"});
        for (std::size_t i = 0; i < active.size(); ++i)
            smoothing_[active[i]] = static_cast<float>(smoothed / (smoothed + (1 - smoothed) * unsmoothed[i]));
    }

    /// Fraction of the projection that is done before the fits of a round, for the progress. They take most of its
    /// time.
    static double before_fits(int depth) {
        return fraction_before_round(depth) + (fraction_before_round(depth + 1) - fraction_before_round(depth)) / 4;
    }

    NoiseAllowed noise_on(ElementId e) const {
        const double of_area =
            share_ * std::min(1.0, stage_.area / (ErrorShare::max_even_count * out_.tree.area(e))) / mean_area_;
        const double even = allowed_on(e) / out_.tree.area(e);
        if (!is_crowd_) return {even};
        return {std::max(even, of_area), std::sqrt(share_ / mean_area_) / options_.tolerance,
                stage_.area / ErrorShare::min_count};
    }

    /// Number of rays to weak sources. The estimated flux is most accurate if rays are spread evenly over all area.
    unsigned rays_of(ElementId e) const {
        constexpr double max_rays = 1024;
        const double rays = rays_an_element * out_.tree.area(e) / mean_area_;
        return static_cast<unsigned>(std::clamp(rays, static_cast<double>(rays_an_element), max_rays));
    }

    DirectFit fit(ElementId e, int depth, DirectFitRoom& room) const {
        if (stop_.requested() && depth > 0) return inherited_fit(out_.tree, e, out_.fit[out_.tree.parent(e)]);
        if (stop_.requested() && stop_.seconds_overdue() < time_for_rays)
            return fit_by_rays(stage_, out_.tree, e, room);
        if (stop_.requested()) return {};  // dark: even rays would take too long
        if (many_) return fit_strong_light(stage_, out_.tree, e, noise_on(e), rays_of(e), room);
        return fit_all_light(stage_, out_.tree, e, noise_on(e), room);
    }

    void fit_all(std::vector<ElementId> active, int depth) {
        if (depth == 0 && is_crowd_ && !many_ && !stop_.requested() && may_fit_together(stage_))
            active = fit_together(
                stage_, out_.tree, active, stage_.small_area(active.size()), [&](ElementId e) { return noise_on(e); },
                out_.fit, stop_);
        found_.assign(active.size(), {});
        constexpr std::size_t grain = 8;
        LoopProgress progress({options_.progress, before_fits(depth), fraction_before_round(depth + 1),
                               std::to_string(active.size()) + " elements"},
                              own_count(active.size(), grain));
        shared_ranges_of(
            std::span(found_), active.size(), grain,
            [&](std::size_t begin, std::size_t end) {
                DirectFitRoom room;
                for (std::size_t i = begin; i < end; ++i) {
                    if (options_.may_give_up && stop_.requested()) return;
                    found_[i] = fit(active[i], depth, room);
                    progress.add_one();
                }
            },
            [&](std::size_t i) -> DirectFit& { return found_[i]; },
            {"direct light", [&](std::size_t i) { return out_.tree.region(active[i]).value; }});
        out_.fit.resize(out_.tree.size());
        for (std::size_t i = 0; i < active.size(); ++i) out_.fit[active[i]] = found_[i];
    }

    /// Splits the elements whose error exceeds their share, and returns the new elements.
    std::vector<ElementId> cut(const std::vector<ElementId>& active) {
        const double least = is_crowd_ ? share_in_crowd(out_, share_ * stage_.area / mean_area_) : 0;
        std::vector<ElementId> fresh;
        for (ElementId e : active) {
            if (out_.tree.size() >= options_.max_elements) break;
            const double area = out_.tree.area(e);
            const double of_bodies = needs_ ? area * needs_->allowed_squared(e) : HUGE_VAL;
            const double error = is_crowd_ ? error_of_shape(out_, e) : area * out_.fit[e].misfit_squared,
                         allowed = std::min(std::max(least, allowed_on(e)), of_bodies);
            if (error <= allowed && !hides_too_much(e)) continue;
            if (options_.min_area && area < 2 * *options_.min_area) continue;
            const Cut only =
                error > allowed ? sufficient_cut(error / area, out_.fit[e].misfit_along, allowed / area) : Cut::none;
            for (ElementId child : refine_element(out_.tree, e, only)) fresh.push_back(child);
        }
        return fresh;
    }

    bool hides_too_much(ElementId e) const {
        return needs_ &&
               needs_->hides_too_much(e, out_.fit[e], light_weight(stage_.scene.material(out_.tree.region(e))));
    }

    const Stage& stage_;
    const DirectProjectionOptions& options_;
    const StopRequest& stop_;
    DirectProjection out_;
    std::optional<BodyNeeds> needs_;  ///< Set after the first fits.
    double mean_area_ = 0;
    bool many_ = false, is_crowd_ = false;
    double share_ = 0;              ///< Squared error that an element may have if the scene is one room, (W/m^2)^2 m^2.
    std::vector<double> share_in_;  ///< Like `share_`, for each room; used if there are several.
    /// Factor on the squared error that an element may have: 1 if distance smooths the light that it reflects.
    Field<ElementId, float> smoothing_;
    std::vector<DirectFit> found_;
};

}  // namespace

DirectProjection direct_light_on(const Stage& stage, const ElementTree& tree) {
    DirectProjection out{.tree = tree, .fit = Field<ElementId, DirectFit>(tree.size())};
    const std::vector<ElementId> leaves = tree.leaves();
    parallel_ranges(leaves.size(), 16, [&](std::size_t first, std::size_t last) {
        DirectFitRoom room;
        for (std::size_t i = first; i < last; ++i)
            out.fit[leaves[i]] = fit_direct_light(stage, tree, leaves[i], 0, room);
    });
    return out;
}

DirectProjection project_direct_light(const Stage& stage, const DirectProjectionOptions& options,
                                      const StopRequest& stop) {
    return Projector(stage, options, stop).run();
}

}  // namespace exitance
