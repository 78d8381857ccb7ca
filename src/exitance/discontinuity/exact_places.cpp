#include "exitance/discontinuity/exact_places.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {
namespace {

constexpr std::size_t place_count = 1'000;

}  // namespace

ExactPlaces::ExactPlaces(const Stage& stage, const Spectrum& direct_weight, const LightAt& indirect, std::uint64_t seed,
                         const StopRequest& stop)
    : stage_(stage), places_(place_count) {
    const ScrambledSobol sobol(hash(seed, static_cast<std::uint64_t>(Stream::certificate)));
    for (const Piece& piece : stage_.pieces) area_ += piece.patch.area();
    std::size_t p = 0;
    double passed = stage_.pieces.empty() ? 0 : stage_.pieces[0].patch.area();
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const auto n = static_cast<std::uint32_t>(i);
        const double at = area_ * (static_cast<double>(i) + sobol(n, 2)) / static_cast<double>(places_.size());
        while (passed < at && p + 1 < stage_.pieces.size()) passed += stage_.pieces[++p].patch.area();
        const Patch& patch = stage_.pieces[p].patch;
        places_[i].region = stage_.pieces[p].region;
        places_[i].at = patch.at(uniform_in_shape(patch.shape, sobol(n, 0), sobol(n, 1)));
    }
    parallel_ranges(places_.size(), 16, [&](std::size_t first, std::size_t last) {
        DirectLight::Workspace workspace;
        for (std::size_t i = first; i < last && !stop.requested(); ++i) {
            Place& place = places_[i];
            const Normal& n = stage_.scene.regions()[place.region].plane.n;
            if (!stage_.occluders.is_covered(place.at, n, place.region))
                place.light = direct_weight * stage_.direct.irradiance(place.at, n, place.region, workspace);
            if (indirect) place.light += indirect(place.region, place.at);
        }
    });
    reflects_ = std::any_of(stage_.scene.materials().begin(), stage_.scene.materials().end(),
                            [](const Material& m) { return max(m.reflectance) > 0; });
    double weighted = 0, plain = 0;
    for (const Place& place : places_) {
        weighted += mean(stage_.scene.material(place.region).reflectance * place.light);
        plain += mean(place.light);
        largest_ = std::max(largest_, mean(weight(place.region) * place.light));
    }
    mean_ = (weighted > 0 ? weighted : plain) / static_cast<double>(places_.size());
}

Spectrum ExactPlaces::weight(RegionId r) const {
    return reflects_ ? light_weight(stage_.scene.material(r)) : Spectrum(1.0);
}

double ExactPlaces::error(const LightAt& light) const {
    const double sum = parallel_sum<double>(places_.size(), [&](std::size_t i) {
        const Place& p = places_[i];
        return squared(weight(p.region) * (p.light - light(p.region, p.at))) / static_cast<double>(bands);
    });
    return std::sqrt(sum / static_cast<double>(places_.size()));
}

}  // namespace exitance
