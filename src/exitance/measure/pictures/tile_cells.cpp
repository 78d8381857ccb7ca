#include <algorithm>
#include <ranges>

#include "exitance/base/random.hpp"
#include "exitance/measure/pictures/tile_light.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {
namespace {

/// Allowed relative error of a pixel's light: invisible next to its neighbours.
constexpr double pixel_error = 0.004;
constexpr std::uint32_t cell_side = 4;  ///< Pixels; light may be interpolated between the corners of a cell.
constexpr double even = 0.04;           ///< Relative difference of the corners below which light is interpolated.

/// Share of the picture's brightness: darker pixels have the absolute accuracy of a pixel with this light.
constexpr double dim = 0.25;

}  // namespace

/// True if clusters of emitters are faster for spots of one region, tested at three of them. Only if there are too many
/// emitters to evaluate each; otherwise it is better to exclude certainly hidden emitters first (`share_rays`).
bool TileLight::suits_clusters(std::span<const Spot> spots) {
    constexpr std::size_t min_sources = 1000;
    const Stage& stage = light_.stage();
    const bool possible = stage.clustered.is_possible() && stage.clustered.tree().sources().size() > min_sources;
    if (!possible || squared(direct_share_) == 0) return false;
    const RegionId region = spots.front().region;
    const Normal& n = stage.scene.regions()[region].plane.n;
    const std::size_t last = spots.size() - 1;
    return std::ranges::any_of(std::array{std::size_t{0}, last / 2, last}, [&](std::size_t i) {
        return stage.clustered.pays(points_[spots[i].first], n, region, {.relative = pixel_error}, clustered_);
    });
}

/// Finds blocks that use shared rays: those with too many partly hidden sources for exact light. Returns true if there
/// are any.
bool TileLight::share_rays(std::span<const Spot> spots, const ReceiverLight* whole) {
    constexpr std::ptrdiff_t max_exact = 24;
    const auto has_many_shadows = [&](const ReceiverLight* light) {
        return light && std::ranges::count_if(light->sources, [](const auto& s) { return s.count > 0; }) > max_exact;
    };
    if (squared(direct_share_) == 0 || !shared_.is_possible() || !has_many_shadows(whole)) return false;
    constexpr std::size_t places = 16;
    std::vector<Point> some;
    const std::size_t step = std::max<std::size_t>(1, spots.size() / places);
    for (std::size_t i = step / 2; i < spots.size(); i += step) some.push_back(points_[spots[i].first]);
    shared_.choose(*whole, some, hash(seed_, static_cast<std::uint64_t>(Stream::direct), spots.front().pixel));
    bool any = false;
    visit_blocks(spots, [&](std::size_t block, std::size_t begin, std::size_t end) {
        const Point& middle = points_[spots[(begin + end) / 2].first];
        by_rays_[block] = has_many_shadows(known_[block]) &&
                          shared_.share(*known_[block], middle, accuracy(0), shared_parts_[block], visibility_);
        any |= by_rays_[block];
    });
    return any;
}

/// Required accuracy of direct light at a pixel that also has other light `rest`, W/m^2.
LightAccuracy TileLight::accuracy(double rest) const {
    constexpr unsigned most_rays = 1024;
    return {pixel_error, pixel_error * (rest + dim * brightness_), most_rays};
}

const Spot* TileLight::spot_at(std::span<const Spot> spots, int x, int y) const {
    const std::uint32_t found = spot_at_[static_cast<std::size_t>(y * tile_side + x)];
    return found == 0 ? nullptr : &spots[found - 1];
}

/// Direct light at one point of a spot, by clusters of emitters or by shared rays; computed once per pixel.
Spectrum TileLight::light_by_rays(const Spot& spot) {
    const std::size_t pixel = pixel_of(spot);
    if (is_stopped()) return {};
    if (is_found_[pixel]) return found_[pixel];
    const Stage& stage = light_.stage();
    Point at = points_[spot.first];
    if (spot.count == samples_) {  // otherwise the centre may be hidden behind another surface in the pixel
        at = Point();
        for (std::uint32_t i = 0; i < spot.count; ++i) at += points_[spot.first + i] / spot.count;
    }
    const LightAccuracy asked = accuracy(mean(spot.irradiance));  // light found so far
    const Normal& n = stage.scene.regions()[spot.region].plane.n;
    const auto block = static_cast<std::size_t>(block_of(spot));
    constexpr int side = 4;  // pixels of such a square use different sets of rays
    const auto set = static_cast<std::uint32_t>(spot.y % side * side + spot.x % side);
    const ClusteredLight::Estimate found = by_rays_[block]
                                               ? shared_.at(shared_parts_[block], at, set, asked, visibility_)
                                               : stage.clustered.by_clusters(at, n, spot.region, asked, clustered_);
    is_found_[pixel] = 1, noise_[pixel] = std::sqrt(found.variance);
    return found_[pixel] = direct_share_ * found.irradiance;
}

/// Interpolates light between the corners of a cell of pixels. Returns false if it is not uniform or differs at the
/// centre.
bool TileLight::interpolate(std::span<Spot> spots, int x0, int y0, int x1, int y1) {
    const std::array<const Spot*, 4> corners = {spot_at(spots, x0, y0), spot_at(spots, x1, y0), spot_at(spots, x0, y1),
                                                spot_at(spots, x1, y1)};
    if (!std::ranges::all_of(corners, [&](const Spot* s) { return s && s->count == samples_; })) return false;
    std::array<Spectrum, 4> E;
    double least = HUGE_VAL, most = 0, noise = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        E[i] = light_by_rays(*corners[i]);
        noise = std::max(noise, noise_[pixel_of(*corners[i])]);
        const double there = mean(E[i] + corners[i]->irradiance);
        least = std::min(least, there), most = std::max(most, there);
    }
    constexpr double max_deviations =
        3;  // standard deviations: a difference due to noise is no reason for a smaller cell
    const double all = most + dim * brightness_;
    if (most - least > std::max(even * all, max_deviations * noise)) return false;
    const auto between = [&](int x, int y) {
        const double u = static_cast<double>(x - x0) / (x1 - x0), v = static_cast<double>(y - y0) / (y1 - y0);
        return (1 - v) * ((1 - u) * E[0] + u * E[1]) + v * ((1 - u) * E[2] + u * E[3]);
    };
    const int x = (x0 + x1) / 2, y = (y0 + y1) / 2;
    const Spot* middle = spot_at(spots, x, y);
    if (!middle ||
        std::abs(mean(light_by_rays(*middle) - between(x, y))) > std::max(alike * all, max_deviations * noise))
        return false;
    for (int k = y0; k <= y1; ++k)
        for (int i = x0; i <= x1; ++i) {
            const auto pixel = static_cast<std::size_t>(k * tile_side + i);
            const Spot* spot = spot_at(spots, i, k);
            if (!spot || is_found_[pixel] || spot->count != samples_) continue;
            found_[pixel] = between(i, k), noise_[pixel] = noise, is_found_[pixel] = 1;
        }
    return true;
}

/// Computes the pixels of a cell, corners included: by interpolation, or by its quarters.
void TileLight::fill(std::span<Spot> spots, int x0, int y0, int x1, int y1) {
    if (x1 - x0 <= 1 || y1 - y0 <= 1 || interpolate(spots, x0, y0, x1, y1)) return;
    const int x = (x0 + x1) / 2, y = (y0 + y1) / 2;
    fill(spots, x0, y0, x, y), fill(spots, x, y0, x1, y);
    fill(spots, x0, y, x, y1), fill(spots, x, y, x1, y1);
}

void TileLight::fill_all(std::span<Spot> spots) {
    constexpr int last = tile_side - 1, side = cell_side;
    for (int y = 0; y < last; y += side)
        for (int x = 0; x < last; x += side) fill(spots, x, y, std::min(x + side, last), std::min(y + side, last));
    for (Spot& spot : spots) {
        if (spot_at_[pixel_of(spot)] == 0) continue;
        spot.irradiance += light_by_rays(spot);
        spot_at_[pixel_of(spot)] = 0, is_found_[pixel_of(spot)] = 0;
    }
}

/// Evaluates all spots of one region with many small emitters. Shadows are usually soft there, so that light is
/// computed at the corners of cells, and in between only where it varies.
void TileLight::evaluate_by_clusters(std::span<Spot> spots) {
    for (std::size_t i = 0; i < spots.size(); ++i) {
        spots[i].irradiance = elements(spots[i]);
        spot_at_[pixel_of(spots[i])] = static_cast<std::uint32_t>(i + 1);
    }
    fill_all(spots);
}

/// Like evaluate_by_clusters(), for the spots of the blocks found by `share_rays`.
void TileLight::evaluate_by_shared_rays(std::span<Spot> spots) {
    visit_blocks(spots, [&](std::size_t block, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && by_rays_[block]; ++i) {
            spots[i].irradiance = elements(spots[i]);
            spot_at_[pixel_of(spots[i])] = static_cast<std::uint32_t>(i + 1);
        }
    });
    fill_all(spots);
}

}  // namespace exitance
