#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/base/random.hpp"
#include "exitance/gather/local_pass.hpp"
#include "exitance/mesh/element_locator.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {
namespace {

/// Residuals of a polynomial at places of an element, by the strip of the element in which they lie.
class Strips {
  public:
    static constexpr std::size_t count = 8;  // derived from the number of places: eight in each strip

    void add(double coordinate, double residual) {
        Strip& strip = strips_[static_cast<std::size_t>(std::clamp(coordinate * count, 0.0, count - 0.5))];
        strip.sum += residual, strip.squares += residual * residual, strip.places += 1;
    }
    /// Mean square of the strips' means minus the part that is due to chance: the variation across the strips.
    double between() const {
        double out = 0, places = 0;
        for (const Strip& s : strips_) {
            if (s.places < 2) continue;
            const double mean = s.sum / s.places, spread = s.squares / s.places - mean * mean;
            out += s.places * mean * mean - s.places * spread / (s.places - 1), places += s.places;
        }
        return places > 0 ? std::max(0.0, out / places) : 0;
    }

  private:
    struct Strip {
        double sum = 0, squares = 0, places = 0;
    };
    std::array<Strip, count> strips_;
};

}  // namespace

bool LocalPass::is_suspect(ElementId e) const {
    for (; !e.is_none(); e = tree_.parent(e))
        if (e.value < suspect_.size() && suspect_[e]) return true;
    return false;
}

/// Measures the misfit of an element's polynomial at many places, and sets it if it is larger than the misfit at the
/// nodes of the fit.
void LocalPass::check_strips(ElementId e, SampledElement& sampled, const ReflectedLight& b,
                             const LocalPassDemand& demand, Workspace& w) const {
    // Derived from a feature that covers a twentieth of the element: at least one place is on it with a probability of
    // 24/25, and its misfit exceeds the noise.
    constexpr unsigned places = 64, rays = 64;
    const RegionId region = tree_.region(e);
    const Normal& n = stage_.scene.regions()[region].plane.n;
    const Spectrum& rho = stage_.scene.material(region).reflectance;
    const SampledFunction polynomial(tree_, e, sampled);
    const std::uint64_t key = hash(seed_, static_cast<std::uint64_t>(Stream::gather), e.value, ~std::uint64_t{1});
    const ScrambledSobol random(key);
    double misfit = 0, noise = 0;
    std::array<Strips, 2> strips;
    for (unsigned k = 0; k < places; ++k) {
        const Vec2 uv = tree_.uniform(e, random(k, 0), random(k, 1));
        const Point x = tree_.patch(e).at(uv);
        const Gathered g = gather_reflected(stage_, x, n, region, rays, hash(key, k), b, w.rays);
        if (is_hidden(e, x, g)) continue;
        const Spectrum residual = rho * (g.irradiance - polynomial.at(uv));
        misfit += mean(residual * residual) / places, noise += spread_.gain() * mean(rho * rho * g.quarters) / places;
        strips[0].add(uv.x, mean(residual)), strips[1].add(uv.y, mean(residual));
    }
    sampled.rays += rays * places;
    const double allowed = allowed_misfit(e, sampled.light, demand);
    // The mean noise of 64 places varies by a quarter, so that a misfit above twice its expected value is no noise.
    if (!(misfit > allowed * allowed + 2 * noise)) return;
    // The misfit includes the polynomial's own noise, as in `fit_gathered`.
    sampled.misfit_squared = std::max(sampled.misfit_squared, misfit + noise_misfit_bound * sampled.noise_in_misfit);
    for (std::size_t k = 0; k < 2; ++k) sampled.misfit_along[k] = strips[k].between();
}

/// Returns the leaves that share a border with a leaf, on the same region.
std::vector<ElementId> LocalPass::beside(ElementId e, const ElementLocator& locator) const {
    constexpr double side = 6;  // derived from three points per side, in the middle of each third
    constexpr std::array<double, 3> along{1 / side, 0.5, 1 - 1 / side};
    constexpr double outside = 0.02;  // share of the width; derived from neighbours at least a fiftieth as wide
    std::vector<ElementId> out;
    for (const double t : along)
        for (const Vec2 uv : {Vec2{t, -outside}, Vec2{t, 1 + outside}, Vec2{-outside, t}, Vec2{1 + outside, t}}) {
            const ElementId found = locator.find(tree_.region(e), tree_.patch(e).at(uv)).element;
            if (!found.is_none() && found != e) out.push_back(found);
        }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

/// Examines the leaves at rough places with more rays and, while the examined leaves are rough, also the leaves next to
/// them. A feature that a few points of the certificate hit is thus followed along its whole length. The misfit of
/// these leaves is then known, and their children are examined in the same way. Returns the number of rays.
std::size_t LocalPass::follow_rough_places(const ReflectedLight& b, const LocalPassDemand& demand) {
    if (demand.rough_places.empty() || !demand.elements.empty()) return 0;
    const ElementLocator locator(tree_, stage_.scene.regions().size());
    suspect_.resize(tree_.size());
    std::vector<ElementId> wave;
    const auto add = [&](ElementId e) {
        if (!suspect_[e] && sampled_[e].place_rays > 0) suspect_[e] = 1, wave.push_back(e);
    };
    for (const RoughPlace& place : demand.rough_places)
        if (const ElementId e = locator.find(place.region, place.at).element; !e.is_none()) add(e);
    std::size_t rays = 0;
    while (!wave.empty()) {
        const std::vector<ElementId> now = std::exchange(wave, {});
        std::vector<SampledElement> found(now.size());
        shared_ranges(
            now.size(), 1,
            [&](std::size_t begin, std::size_t end) {
                Workspace workspace;
                for (std::size_t i = begin; i < end; ++i) {
                    found[i] = sampled_[now[i]];
                    check_strips(now[i], found[i], b, demand, workspace);
                }
            },
            [&](std::size_t i) -> SampledElement& { return found[i]; }, {"gather"});
        for (std::size_t i = 0; i < now.size(); ++i) {
            rays += found[i].rays - sampled_[now[i]].rays;
            sampled_[now[i]] = found[i];
            if (is_too_rough(now[i], found[i], demand))
                for (const ElementId e : beside(now[i], locator)) add(e);
        }
    }
    return rays;
}

}  // namespace exitance
