#include "exitance/scene/sky/sky_window.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/scene/emission_profile.hpp"

namespace exitance {
namespace {

/// Radians: a rule of degree 4 has an error of 1e-4 of a pane's transmission at this width.
constexpr double glass_smooth_width = 0.8;
constexpr int directions_per_row = 9;  ///< Number of sampled directions out of the window, per row of a half plane.

}  // namespace

double relative_radiance(const SkyWindow& window, const Vec3& w) {
    return window.relative(w);
}

double smooth_width(const SkyWindow& window) {
    return window.smooth_width();
}

bool shows_picture(const SkyWindow& window) {
    return window.shows_picture();
}

SkyWindow::Half::Half(const SkyModel& model, double irradiance)
    : sky(&model),
      scale(irradiance),
      is_uniform(model.is_uniform()),
      has_tables(!model.intermediate && !model.blends_ground && !model.picture) {
    if (is_uniform || !has_tables) return;
    // Tabulate the two factors of `SkyModel::value`, each with the other one constant.
    SkyModel height = model, sun = model;
    height.c = height.e = 0, height.f0 = 1;
    sun.a = sun.g = 0;
    const Frame frame(model.sun);
    for (int i = 0; i <= steps + 1; ++i) {
        const double x = std::min(1.0, static_cast<double>(i) / steps), y = std::sqrt(1 - x * x);
        by_height[static_cast<std::size_t>(i)] = static_cast<float>(model.scale * height.value({y, 0, x}));
        by_sun[static_cast<std::size_t>(i)] =
            static_cast<float>(sun.value((1 - 2 * x * x) * model.sun + (2 * x * y) * frame.u));
    }
    // Negative values are replaced by 0, but the product of two negative factors would be positive: use no tables then.
    for (const Table* table : {&by_height, &by_sun})
        has_tables = has_tables && std::all_of(table->begin(), table->end(), [](float v) { return v > 0; });
}

SkyWindow::SkyWindow(const Pane& pane, const DistantLight& light, std::size_t band)
    : n_(pane.n), width_(glass_smooth_width) {
    for (int i = 0; i <= steps + 1; ++i)
        through_[static_cast<std::size_t>(i)] =
            static_cast<float>(pane.transmission(std::min(1.0, static_cast<double>(i) / steps))[band]);
    for (const DistantLight::Dome& dome : light.domes)
        if (dome.irradiance[band] > 0) halves_.emplace_back(dome.model, dome.irradiance[band]);
    const Frame frame(-n_);
    double sum = 0;
    for (int i = 0; i < directions_per_row; ++i)
        for (int k = 0; k < directions_per_row; ++k) {
            const double x = (2.0 * i + 1) / directions_per_row - 1, y = (2.0 * k + 1) / directions_per_row - 1;
            const double out = std::sqrt(std::max(0.04, 1 - x * x - y * y));
            const Vec3 w = normalized(frame.to_world(x, y, out));
            sum += relative(w) / (directions_per_row * directions_per_row);
            for (const Half& half : halves_)
                if (half.sky->below == (w.z < 0)) width_ = std::min(width_, half.sky->smooth_width(w));
        }
    reference_ = sum;
    if (sum > 0)
        for (Half& half : halves_) half.scale /= sum;
}

}  // namespace exitance
