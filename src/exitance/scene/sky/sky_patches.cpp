#include "exitance/scene/sky/sky_patches.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/scene/sky/perez_sky.hpp"

namespace exitance {
namespace {

constexpr std::array<std::size_t, 7> tregenza{30, 30, 24, 24, 18, 12, 6};

/// Returns a direction; the azimuth is clockwise from y.
Normal direction(double altitude, double azimuth) {
    return {std::cos(altitude) * std::sin(azimuth), std::cos(altitude) * std::cos(azimuth), std::sin(altitude)};
}

}  // namespace

SkyPatches::SkyPatches(int m) {
    const auto division = static_cast<std::size_t>(std::max(1, m));
    height_ = 0.5 * pi / (static_cast<double>(tregenza.size() * division) + 0.5);
    middle_.push_back({0, 0, -1}), solid_angle_.push_back(2 * pi), horizontal_.push_back(0);
    const auto squared = [](double v) { return v * v; };
    for (std::size_t row = 0; row < tregenza.size() * division; ++row) {
        const std::size_t count = tregenza[row / division] * division;
        first_.push_back(middle_.size()), in_row_.push_back(count);
        const double omega =
            2 * pi / static_cast<double>(count) * (std::sin(altitude(row + 1)) - std::sin(altitude(row)));
        for (std::size_t k = 0; k < count; ++k) {
            middle_.push_back(
                direction(altitude(row) + 0.5 * height_, 2 * pi * static_cast<double>(k) / static_cast<double>(count)));
            solid_angle_.push_back(omega);
            horizontal_.push_back(pi / static_cast<double>(count) *
                                  (squared(std::sin(altitude(row + 1))) - squared(std::sin(altitude(row)))));
        }
    }
    first_.push_back(middle_.size());
    middle_.push_back({0, 0, 1}), solid_angle_.push_back(2 * pi * (1 - std::sin(altitude(in_row_.size()))));
    horizontal_.push_back(pi * squared(std::cos(altitude(in_row_.size()))));
    make_points();
    make_facets();
}

std::size_t SkyPatches::of(const Vec3& w) const {
    if (w.z < 0) return 0;
    const auto row = static_cast<std::size_t>(std::asin(std::min(1.0, w.z)) / height_);
    if (row >= in_row_.size()) return first_.back();
    const auto count = static_cast<double>(in_row_[row]);
    const double turn = std::atan2(w.x, w.y) / (2 * pi);  // azimuth as a share of the circle, -1/2 to 1/2
    const double at = std::floor((turn < 0 ? turn + 1 : turn) * count + 0.5);
    return first_[row] + static_cast<std::size_t>(at) % in_row_[row];
}

/// All rows are split at the borders of all rows, so that neighbouring facets share their corners.
void SkyPatches::make_facets() {
    DistantLight ground;
    SkyModel below = uniform_sky();
    below.below = true;
    ground.domes.push_back({below, Spectrum(pi)});
    facets_ = distant_facets(ground);
    for (DistantFacet& facet : facets_) facet.sky = nullptr;
    patch_of_facet_.assign(facets_.size(), 0);
    std::vector<double> cuts;
    for (const std::size_t count : in_row_)
        for (std::size_t k = 0; k < count; ++k)
            cuts.push_back(2 * pi * (static_cast<double>(k) + 0.5) / static_cast<double>(count));
    std::sort(cuts.begin(), cuts.end());
    constexpr double same = 1e-9;
    cuts.erase(std::unique(cuts.begin(), cuts.end(), [](double a, double b) { return b - a < same; }), cuts.end());
    const auto add = [&](std::vector<Vec3> corners, std::size_t patch) {
        Vec3 area;
        for (std::size_t i = 2; i < corners.size(); ++i)
            area += cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
        facets_.push_back({std::move(corners), normalized(area), Spectrum(pi)});
        patch_of_facet_.push_back(static_cast<std::uint32_t>(patch));
    };
    const auto next = [&](std::size_t i) { return i + 1 < cuts.size() ? cuts[i + 1] : cuts[0] + 2 * pi; };
    for (std::size_t row = 0; row < in_row_.size(); ++row) {
        const double low = altitude(row), high = altitude(row + 1);
        for (std::size_t i = 0; i < cuts.size(); ++i) {
            const double a = cuts[i], b = next(i);
            add({direction(low, a), direction(low, b), direction(high, b), direction(high, a)},
                of(direction(0.5 * (low + high), 0.5 * (a + b))));
        }
    }
    std::vector<Vec3> cap;
    for (const double a : cuts) cap.push_back(direction(altitude(in_row_.size()), a));
    add(std::move(cap), first_.back());
}

void SkyPatches::make_points() {
    for (std::size_t row = 0; row < in_row_.size(); ++row)
        for (std::size_t k = 0; k < in_row_[row]; ++k)
            for (int i = 0; i < points_across; ++i)
                for (int j = 0; j < points_across; ++j)
                    points_.push_back(direction(altitude(row) + (i + 0.5) / points_across * height_,
                                                2 * pi * (static_cast<double>(k) + (j - 1) / (1.0 * points_across)) /
                                                    static_cast<double>(in_row_[row])));
}

std::vector<double> SkyPatches::mean_values(const SkyModel& sky) const {
    std::vector<double> out(size());
    const bool product = is_product(sky);
    auto point = points_.begin();
    for (std::size_t row = 0; row < in_row_.size(); ++row) {
        std::array<double, points_across> phi{}, weight{};  // values at the heights of the points
        double all = 0;
        for (std::size_t i = 0; i < points_across; ++i) {
            const double h = altitude(row) + (static_cast<double>(i) + 0.5) / points_across * height_;
            weight[i] = std::cos(h), phi[i] = gradation(sky, std::sin(h));
            for (int j = 0; j < points_across; ++j) all += weight[i];
        }
        for (std::size_t k = 0; k < in_row_[row]; ++k) {
            double sum = 0;
            for (std::size_t i = 0; i < points_across; ++i)
                for (int j = 0; j < points_across; ++j, ++point)
                    sum +=
                        weight[i] *
                        (product ? std::max(0.0, phi[i] * indicatrix(sky, std::clamp(dot(*point, sky.sun), -1.0, 1.0)))
                                 : sky.value(*point));
            out[first_[row] + k] = sum / all;
        }
    }
    out[first_.back()] = sky.value({0, 0, 1});
    return out;
}

}  // namespace exitance
