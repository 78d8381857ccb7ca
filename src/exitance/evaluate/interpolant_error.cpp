#include "exitance/evaluate/interpolant_error.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "exitance/base/random.hpp"
#include "exitance/calibration/error_budget.hpp"
#include "exitance/mesh/element_locator.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {
namespace {

/// Chooses leaves for the places at which the error is measured: with a density that grows with the expected error, by
/// positions in the running sum of area times density over the leaves.
class Places {
  public:
    Places(const ElementTree& tree, std::span<const InterpolatedLeaf> leaves) : leaves_(leaves) {
        double area = 0, square = 0;
        for (const InterpolatedLeaf& leaf : leaves)
            area += tree.area(leaf.element), square += tree.area(leaf.element) * leaf.expected;
        before_.reserve(leaves.size() + 1);
        before_.push_back(0);
        for (const InterpolatedLeaf& leaf : leaves) {
            density_.push_back(square > 0 ? 0.5 + 0.5 * leaf.expected * area / square : 1);
            before_.push_back(before_.back() + tree.area(leaf.element) * density_.back());
        }
        area_ = area;
    }

    struct Chosen {
        ElementId element;
        double weight;  ///< Weight of a place there in a mean over the area; 1 in the mean over all places.
    };
    /// The leaf at `share` of the running sum, in [0, 1).
    Chosen at(double share) const {
        const auto above = std::upper_bound(before_.begin() + 1, before_.end() - 1, share * before_.back());
        const auto i = static_cast<std::size_t>(above - before_.begin() - 1);
        return {leaves_[i].element, before_.back() / (area_ * density_[i])};
    }

  private:
    std::span<const InterpolatedLeaf> leaves_;
    std::vector<double> density_, before_;
    double area_ = 0;
};

bool reflects(const Scene& scene) {
    return std::any_of(scene.regions().begin(), scene.regions().end(),
                       [&](const Region& region) { return max(scene.materials()[region.material].reflectance) > 0; });
}

/// The fit evaluates at least nine places per leaf and per ancestor, so the cost of these places is small in
/// comparison. At the maximum, the standard error of the mean square is some percent.
std::size_t count_of_places(std::size_t leaves) {
    constexpr std::size_t min_places = 1024, max_places = 4096, leaves_a_place = 8;
    return std::clamp(leaves / leaves_a_place, min_places, max_places);
}

/// Returns the RMS error that the fits expect, W/m^2.
double expected_error(const ElementTree& tree, std::span<const InterpolatedLeaf> leaves) {
    double area = 0, square = 0;
    for (const InterpolatedLeaf& leaf : leaves)
        area += tree.area(leaf.element), square += tree.area(leaf.element) * leaf.expected;
    return std::sqrt(square / area);
}

/// Returns the mean of the values, but at least its standard error: an error that the noise of rays may hide.
double mean_or_uncertainty(const std::vector<double>& values) {
    const auto count = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
    double spread = 0;
    for (const double value : values) spread += (value - mean) * (value - mean);
    return std::max(mean, std::sqrt(spread / (count * (count - 1))));
}

}  // namespace

double interpolant_error(const Stage& stage, const ElementFunction& interpolant,
                         std::span<const InterpolatedLeaf> leaves, const InterpolatedLight& light, std::uint64_t seed) {
    if (leaves.empty()) return 0;
    const ElementTree& tree = interpolant.tree;
    const Places places(tree, leaves);
    const ElementLocator locator(light.indirect.tree, stage.scene.regions().size());
    const bool is_black = !reflects(stage.scene);
    const ScrambledSobol random(hash(seed, static_cast<std::uint64_t>(Stream::certificate), 2));
    std::vector<double> square(count_of_places(leaves.size()));
    // Light of dark places need not be more accurate than the error that is measured.
    LightAccuracy accuracy = point_accuracy(1);
    accuracy.absolute = ErrorBudget::independent_share * expected_error(tree, leaves);
    shared_ranges(
        square.size(), 8,
        [&](std::size_t begin, std::size_t end) {
            PlaceLight::Workspace workspace;
            for (std::size_t k = begin; k < end; ++k) {
                const auto i = static_cast<std::uint32_t>(k);
                const auto [e, weight] =
                    places.at((static_cast<double>(k) + random(i, 0)) / static_cast<double>(square.size()));
                const RegionId region = tree.region(e);
                const Normal& n = stage.scene.regions()[region].plane.n;
                const Vec2 uv = tree.uniform(e, random(i, 1), random(i, 2));
                const Point x = tree.patch(e).at(uv);
                if (stage.occluders.is_covered(x, n, region)) continue;
                const PlaceLight::Estimate direct = stage.place_light.at(x, n, region, accuracy, workspace);
                const Spectrum exact =
                    light.direct_weight * direct.irradiance + light.indirect.at(locator.find(region, x));
                const Spectrum counts = is_black ? Spectrum(1.0) : stage.scene.material(region).reflectance;
                const Spectrum off = counts * (exact - interpolant.at(tree.leaf_at(e, uv)));
                // The noise of rays is no error of the interpolant.
                const Spectrum noise = counts * light.direct_weight * direct.standard_error();
                square[k] = weight * (squared(off) - squared(noise)) / static_cast<double>(bands);
            }
        },
        [&](std::size_t k) -> double& { return square[k]; }, {"interpolant error"});
    return std::sqrt(mean_or_uncertainty(square));
}

}  // namespace exitance
