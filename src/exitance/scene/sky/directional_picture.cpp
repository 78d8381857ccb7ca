#include "exitance/scene/sky/directional_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/base/check.hpp"
#include "exitance/scene/sky/picture_pixels.hpp"
#include "exitance/scene/sky/picture_suns.hpp"
#include "exitance/scene/sky/sky_picture.hpp"

namespace exitance {
namespace {

/// Calls f(cell, share) for the cells from 0 on that overlap the range [low, high), in units of cells.
template <class F>
void for_overlaps(double low, double high, const F& f) {
    for (double cell = std::floor(low); cell < high; ++cell) {
        const double share = std::min(high, cell + 1) - std::max(low, cell);
        if (share > 0) f(static_cast<std::ptrdiff_t>(cell), share);
    }
}

/// Averages a row of the picture over the columns of a SkyPicture.
void average_row(const DirectionalPicture& picture, const PicturePixels& at, std::size_t row,
                 std::vector<Spectrum>& out) {
    constexpr auto columns = static_cast<std::ptrdiff_t>(SkyPicture::columns);
    out.assign(SkyPicture::columns, Spectrum());
    for (std::size_t c = 0; c < picture.width; ++c) {
        const float* const value = &picture.radiance[(row * picture.width + c) * bands];
        for_overlaps(at.left_turn(c + 1) * columns, at.left_turn(c) * columns, [&](std::ptrdiff_t cell, double share) {
            Spectrum& to = out[static_cast<std::size_t>((cell % columns + columns) % columns)];
            for (std::size_t b = 0; b < bands; ++b) to[b] += share * value[b];
        });
    }
}

/// Returns the tables of the picture, one per band: the mean radiance of each cell, weighted by solid angle.
std::array<std::vector<double>, bands> tables_of(const DirectionalPicture& picture, double rotation) {
    const PicturePixels at(picture, rotation);
    std::array<std::vector<double>, bands> out;
    for (auto& table : out) table.resize(SkyPicture::size);
    std::vector<double> weight(SkyPicture::rows);
    std::vector<Spectrum> means;
    // rows are counted from the nadir upwards
    const auto sine = [](double row) { return -std::cos(row * SkyPicture::cell_angle); };
    constexpr auto rows = static_cast<double>(SkyPicture::rows);
    for (std::size_t r = 0; r < picture.height; ++r) {
        average_row(picture, at, r, means);
        const double top = rows - rows * static_cast<double>(r) / static_cast<double>(picture.height);
        const double bottom = top - rows / static_cast<double>(picture.height);
        for_overlaps(std::max(0.0, bottom), top, [&](std::ptrdiff_t row, double) {
            const auto cell = static_cast<std::size_t>(row);
            if (cell >= SkyPicture::rows) return;
            const double low = std::max(bottom, static_cast<double>(row)), high = std::min(top, row + 1.0);
            const double w = sine(high) - sine(low);
            weight[cell] += w;
            for (std::size_t c = 0; c < SkyPicture::columns; ++c)
                for (std::size_t b = 0; b < bands; ++b) out[b][cell * SkyPicture::columns + c] += w * means[c][b];
        });
    }
    for (auto& table : out)
        for (std::size_t i = 0; i < table.size(); ++i) table[i] /= weight[i / SkyPicture::columns];
    return out;
}

/// Adds the dome of a table above or below the horizon; `irradiance` is that of a horizontal plane.
void add_dome_of(const std::shared_ptr<const SkyPicture>& table, bool is_below, const Spectrum& irradiance,
                 DistantLight& out) {
    DistantLight::Dome dome;
    dome.model.picture = table, dome.model.below = is_below;
    if (max(irradiance) > 0 && dome.model.normalize()) dome.irradiance = irradiance, out.domes.push_back(dome);
}

}  // namespace

Spectrum horizontal_irradiance(const DirectionalPicture& picture, bool is_below) {
    const PicturePixels at(picture, 0);
    Spectrum sum;
    for (std::size_t r = 0; r < picture.height; ++r) {
        double upper = at.upper_sine(r), lower = at.upper_sine(r + 1);
        (is_below ? upper : lower) = is_below ? std::min(0.0, upper) : std::max(0.0, lower);
        if (!(upper > lower)) continue;
        const double weight = pi / static_cast<double>(picture.width) * std::abs(upper * upper - lower * lower);
        for (std::size_t i = r * picture.width; i < (r + 1) * picture.width; ++i)
            for (std::size_t b = 0; b < bands; ++b) sum[b] += weight * picture.radiance[i * bands + b];
    }
    return sum;
}

DistantLight light_of_picture(DirectionalPicture picture, double rotation) {
    EXI_CHECK(picture.width > 0 && picture.height > 0);
    EXI_CHECK(picture.radiance.size() == picture.width * picture.height * bands);
    DistantLight out;
    out.discs = take_suns(picture, rotation);
    std::array<std::vector<double>, bands> tables = tables_of(picture, rotation);
    const bool is_grey = std::all_of(tables.begin(), tables.end(), [&](const auto& t) { return t == tables[0]; });
    const std::array<Spectrum, 2> irradiance{horizontal_irradiance(picture, false),
                                             horizontal_irradiance(picture, true)};
    for (std::size_t b = 0; b < (is_grey ? 1 : bands); ++b) {
        const auto table = std::make_shared<const SkyPicture>(std::move(tables[b]));
        for (const bool is_below : {false, true}) {
            Spectrum of_band;
            of_band[b] = irradiance[is_below][b];
            add_dome_of(table, is_below, is_grey ? irradiance[is_below] : of_band, out);
        }
    }
    return out;
}

}  // namespace exitance
