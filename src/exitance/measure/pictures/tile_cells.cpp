#include <algorithm>
#include <ranges>

#include "exitance/base/random.hpp"
#include "exitance/measure/pictures/tile_light.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {
namespace {

/// Allowed relative error of a pixel's light: invisible next to its neighbours.
constexpr double pixel_error = 0.008;
constexpr std::uint32_t cell_side = 4;  ///< Pixels; light may be interpolated between the corners of a cell.
constexpr double even = 0.04;           ///< Relative difference of the corners below which light is interpolated.

/// Share of the picture's brightness: darker pixels have the absolute accuracy of a pixel with this light.
constexpr double dim = 0.25;

}  // namespace

/// Decides between exact light and rays for spots of one region. If exact light is cheaper, prepares it for all spots:
/// sets `whole`, or leaves it null if the spots have no area.
bool TileLight::rays_are_cheaper(std::span<const Spot> spots, const ReceiverLight*& whole) {
    if (is_stopped() || squared(direct_share_) == 0) return false;
    const Stage& stage = light_.stage();
    const RegionId region = spots.front().region;
    const Normal& n = stage.scene.regions()[region].plane.n;
    if (stage.place_light.is_mirrored()) return true;
    const double rays = RayLight::rays_for(pixel_error);
    if (!outline(spots))
        return !stage.direct.irradiance_within(points_[spots.front().first], n, region, rays, visibility_);
    if (static_cast<double>(spots.size()) * rays < stage.place_light.work_of_preparing()) return true;
    const DirectLight::WorthCounting worth = PlaceLight::worth_counting(rays);
    stage.direct.prepare(outline_, n, region, whole_, visibility_, worth);
    if (whole_.has_crowded()) return true;
    whole = &whole_;
    return false;
}

/// Required accuracy of direct light at a pixel that also has other light `rest`, W/m^2.
LightAccuracy TileLight::accuracy(double rest) const {
    constexpr unsigned max_rays = 1024;
    return {pixel_error, pixel_error * (rest + dim * brightness_), max_rays};
}

const Spot* TileLight::spot_at(std::span<const Spot> spots, int x, int y) const {
    const std::uint32_t found = spot_at_[static_cast<std::size_t>(y * tile_side + x)];
    return found == 0 ? nullptr : &spots[found - 1];
}

/// Direct light at one point of a spot by rays; computed once per pixel.
Spectrum TileLight::light_by_rays(const Spot& spot) {
    const std::size_t pixel = pixel_of(spot);
    if (is_stopped()) return {};
    if (by_pixel_.is_known[pixel]) return by_pixel_.light[pixel];
    const Stage& stage = light_.stage();
    Point at = points_[spot.first];
    if (spot.count == samples_) {  // otherwise the centre may be hidden behind another surface in the pixel
        at = Point();
        for (std::uint32_t i = 0; i < spot.count; ++i) at += points_[spot.first + i] / spot.count;
    }
    const Normal& n = stage.scene.regions()[spot.region].plane.n;
    LightAccuracy asked = accuracy(mean(spot.irradiance));  // accuracy relative to the light found so far
    // A part of a pixel may have more noise than the pixel.
    const double looser = std::sqrt(static_cast<double>(samples_) / spot.count);
    asked.relative *= looser, asked.absolute *= looser;
    const RayLight::Estimate found = stage.place_light.by_rays(at, n, spot.region, asked, place_);
    return by_pixel_.set(pixel, direct_share_ * found.irradiance, std::sqrt(found.variance));
}

/// Direct light of a pixel that differs from its neighbours, mean over a few of its samples. Independent noise allows
/// each sample twice the error.
Spectrum TileLight::light_of_samples(const Spot& spot) {
    constexpr std::uint32_t most = 4;
    const std::uint32_t count = std::min(most, spot.count);
    LightAccuracy asked = accuracy(mean(spot.irradiance));
    const double looser = std::sqrt(static_cast<double>(count));
    asked.relative *= looser, asked.absolute *= looser;
    const Stage& stage = light_.stage();
    const Normal& n = stage.scene.regions()[spot.region].plane.n;
    Spectrum sum;
    for (std::uint32_t i = 0; i < count && !is_stopped(); ++i)
        sum += stage.place_light.by_rays(points_[spot.first + i], n, spot.region, asked, place_).irradiance;
    return direct_share_ * sum / count;
}

/// Interpolates light between the corners of a cell of pixels. Returns false if it is not uniform or differs at the
/// centre.
template <class LightAt>
bool TileLight::interpolate(std::span<Spot> spots, const Cell& cell, const CellRule& rule, PixelLight& out,
                            const LightAt& light_at) {
    const auto [x0, y0, x1, y1] = cell;
    const std::array<const Spot*, 4> corners = {spot_at(spots, x0, y0), spot_at(spots, x1, y0), spot_at(spots, x0, y1),
                                                spot_at(spots, x1, y1)};
    if (!std::ranges::all_of(corners, [&](const Spot* s) { return s && s->count == samples_; })) return false;
    std::array<Spectrum, 4> E;
    double least = HUGE_VAL, most = 0, noise = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        E[i] = light_at(*corners[i]);
        noise = std::max(noise, out.noise[pixel_of(*corners[i])]);
        const double there = mean(E[i] + corners[i]->irradiance);
        least = std::min(least, there), most = std::max(most, there);
    }
    constexpr double max_deviations =  // standard deviations: a difference due to noise is no reason for a smaller cell
        3;
    const double all = most + dim * brightness_;
    if (most - least > std::max(rule.even * all, max_deviations * noise)) return false;
    const auto between = [&](double u, double v) {
        return (1 - v) * ((1 - u) * E[0] + u * E[1]) + v * ((1 - u) * E[2] + u * E[3]);
    };
    const double to_u = 1.0 / (x1 - x0), to_v = 1.0 / (y1 - y0);
    const auto agrees_at = [&](int x, int y) {
        const Spot* spot = spot_at(spots, x, y);
        return spot && std::abs(mean(light_at(*spot) - between((x - cell.x0) * to_u, (y - cell.y0) * to_v))) <=
                           std::max(rule.middle * all, max_deviations * noise);
    };
    const int x = (x0 + x1) / 2, y = (y0 + y1) / 2;
    if (!agrees_at(x, y)) return false;
    if (rule.checks_edges && !(agrees_at(x, y0) && agrees_at(x, y1) && agrees_at(x0, y) && agrees_at(x1, y)))
        return false;
    for (int k = y0; k <= y1; ++k)
        for (int i = x0; i <= x1; ++i) {
            const auto pixel = static_cast<std::size_t>(k * tile_side + i);
            const Spot* spot = spot_at(spots, i, k);
            if (!spot || out.is_known[pixel] || spot->count != samples_) continue;
            out.set(pixel, between((i - x0) * to_u, (k - y0) * to_v), noise);
            out.is_interpolated[pixel] = 1;
        }
    return true;
}

/// Computes the pixels of a cell, corners included: by interpolation, or by its quarters.
template <class LightAt>
void TileLight::fill(std::span<Spot> spots, const Cell& cell, const CellRule& rule, PixelLight& out,
                     const LightAt& light_at) {
    const auto [x0, y0, x1, y1] = cell;
    if (x1 - x0 <= 1 || y1 - y0 <= 1 || interpolate(spots, cell, rule, out, light_at)) return;
    const int x = (x0 + x1) / 2, y = (y0 + y1) / 2;
    fill(spots, {x0, y0, x, y}, rule, out, light_at), fill(spots, {x, y0, x1, y}, rule, out, light_at);
    fill(spots, {x0, y, x, y1}, rule, out, light_at), fill(spots, {x, y, x1, y1}, rule, out, light_at);
}

/// Splits the prepared light of a block into the part that no shadow edge crosses and the rest.
void TileLight::split_block(std::size_t block) {
    const ReceiverLight* known = known_[block];
    SplitLight& out = split_[block];
    const auto is_open = [](const ReceiverLight::Source& source) { return source.count == 0; };
    out.is_split = interpolation_ > 0 && known && known->behind.empty() && squared(direct_share_) > 0 &&
                   std::ranges::any_of(known->sources, is_open);
    if (!out.is_split) return;
    out.open = out.shadowed = *known;
    std::erase_if(out.open.sources, [&](const ReceiverLight::Source& source) { return !is_open(source); });
    out.open.beams.clear();
    std::erase_if(out.shadowed.sources, is_open);
    out.shadowed.open.clear(), out.shadowed.open_light.clear();
}

/// Light at the centre of a pixel from the emitters that the whole of its block sees; computed once per pixel.
Spectrum TileLight::open_light(const Spot& spot, std::size_t block) {
    const std::size_t pixel = pixel_of(spot);
    if (is_stopped()) return {};
    if (by_pixel_.is_known[pixel]) return by_pixel_.light[pixel];
    return by_pixel_.set(pixel, light_.stage().direct.irradiance(split_[block].open, centre_of(spot), visibility_), 0);
}

/// Interpolates the open part of the light of a block between pixels, where it is uniform. Other pixels stay unknown.
void TileLight::fill_open(std::span<Spot> spots, std::size_t block) {
    constexpr double steepest = 0.06;  // slope of light; derived from steps of 1% per pixel
    const CellRule rule{steepest, interpolation_};
    constexpr int across = tile_side / block_side;
    const int x = static_cast<int>(block) % across * block_side, y = static_cast<int>(block) / across * block_side;
    fill(spots, {x, y, x + block_side - 1, y + block_side - 1}, rule, by_pixel_,
         [&](const Spot& spot) { return open_light(spot, block); });
}

/// Light at the centre of a pixel from all emitters that something may block in its block; computed once per pixel.
Spectrum TileLight::shadowed_light(const Spot& spot) {
    const std::size_t pixel = pixel_of(spot);
    if (is_stopped()) return {};
    if (shadowed_.is_known[pixel]) return shadowed_.light[pixel];
    const SplitLight& split = split_[static_cast<std::size_t>(block_of(spot))];
    return shadowed_.set(pixel,
                         split.shadowed.is_dark()
                             ? Spectrum()
                             : light_.stage().direct.irradiance(split.shadowed, centre_of(spot), visibility_),
                         0);
}

/// Interpolates the shadowed part of direct light in small cells, where nine pixels of the cell agree.
void TileLight::fill_shadowed(std::span<Spot> spots) {
    constexpr int last = tile_side - 1, side = cell_side;
    constexpr double steepest = 0.03;  // slope of light; derived from shadow edges, where light changes faster
    const CellRule rule{steepest, interpolation_, true};
    const auto light_at = [&](const Spot& spot) { return shadowed_light(spot); };
    const auto is_split_at = [&](int x, int y) {
        return split_[static_cast<std::size_t>(y / block_side * (tile_side / block_side) + x / block_side)].is_split;
    };
    for (int y = 0; y < last; y += side)
        for (int x = 0; x < last; x += side) {
            const Cell cell{x, y, std::min(x + side, last), std::min(y + side, last)};
            if (is_split_at(cell.x0, cell.y0) && is_split_at(cell.x1, cell.y0) && is_split_at(cell.x0, cell.y1) &&
                is_split_at(cell.x1, cell.y1))
                fill(spots, cell, rule, shadowed_, light_at);
        }
}

void TileLight::fill_all(std::span<Spot> spots) {
    constexpr int last = tile_side - 1, side = cell_side;
    constexpr CellRule rule{even, alike};
    const auto by_rays = [&](const Spot& spot) { return light_by_rays(spot); };
    for (int y = 0; y < last; y += side)
        for (int x = 0; x < last; x += side)
            fill(spots, {x, y, std::min(x + side, last), std::min(y + side, last)}, rule, by_pixel_, by_rays);
    std::vector<Spectrum>& rest = rest_;
    rest.resize(spots.size());
    for (std::size_t i = 0; i < spots.size(); ++i)
        rest[i] = spots[i].irradiance, spots[i].irradiance += light_by_rays(spots[i]);
    settled_.assign(spots.size(), 1);
    for (std::size_t i = 0; i < spots.size(); ++i)
        settled_[i] = spots[i].count < samples_ || samples_ == 1 || !differs_from_neighbours(spots, i);
    for (std::size_t i = 0; i < spots.size(); ++i) {
        Spot& spot = spots[i];
        spot_at_[pixel_of(spot)] = 0, by_pixel_.is_known[pixel_of(spot)] = 0;
        if (settled_[i]) continue;
        spot.irradiance = rest[i];
        spot.irradiance += light_of_samples(spot);
    }
}

/// Evaluates all spots of one region by rays. Light is computed at the corners of cells, and in between only where it
/// varies.
void TileLight::evaluate_by_rays(std::span<Spot> spots) {
    for (std::size_t i = 0; i < spots.size(); ++i) {
        spots[i].meshed.reset();
        spots[i].irradiance = spots[i].elements = elements(spots[i]);
        spot_at_[pixel_of(spots[i])] = static_cast<std::uint32_t>(i + 1);
    }
    fill_all(spots);
}

}  // namespace exitance
