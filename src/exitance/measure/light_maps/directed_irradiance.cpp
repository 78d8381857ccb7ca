#include "exitance/measure/light_maps/directed_irradiance.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

const double cos_tilt = std::sqrt(0.5), sin_tilt = std::sqrt(0.5);

Vec3 mean_slope(const DirectedIrradiance& light) {
    return {mean(light.slope[0]), mean(light.slope[1]), mean(light.slope[2])};
}

}  // namespace

Spectrum DirectedIrradiance::at(const Normal& m) const {
    return constant + m.x * slope[0] + m.y * slope[1] + m.z * slope[2];
}

DirectedIrradiance& DirectedIrradiance::operator+=(const DirectedIrradiance& o) {
    constant += o.constant;
    for (std::size_t axis = 0; axis < 3; ++axis) slope[axis] += o.slope[axis];
    return *this;
}

DirectedIrradiance& DirectedIrradiance::operator*=(double factor) {
    constant *= factor;
    for (Spectrum& s : slope) s *= factor;
    return *this;
}

Normal tilted(const Frame& frame, std::size_t k) {
    const double sign = k % 2 == 0 ? 1 : -1;
    return k < 2 ? frame.to_world(sign * sin_tilt, 0, cos_tilt) : frame.to_world(0, sign * sin_tilt, cos_tilt);
}

DirectedIrradiance fit_irradiance(const Frame& frame, const Spectrum& own,
                                  const std::array<Spectrum, tilted_count>& at_tilted) {
    Spectrum middle;
    for (const Spectrum& E : at_tilted) middle += 1.0 / tilted_count * E;
    const Spectrum along = 1 / (1 - cos_tilt) * (own - middle);
    const Spectrum u = 0.5 / sin_tilt * (at_tilted[0] - at_tilted[1]);
    const Spectrum v = 0.5 / sin_tilt * (at_tilted[2] - at_tilted[3]);
    DirectedIrradiance out{own - along, {}};
    for (std::size_t axis = 0; axis < 3; ++axis)
        out.slope[axis] = frame.u[axis] * u + frame.v[axis] * v + frame.n[axis] * along;
    return out;
}

void constrain(DirectedIrradiance& light, const Normal& n, const Spectrum& irradiance) {
    const Spectrum own = light.at(n);
    for (std::size_t b = 0; b < bands; ++b) {
        const double factor = own[b] > 0 ? std::min(irradiance[b] / own[b], 2.0) : 0;
        const double rest = irradiance[b] - factor * std::max(own[b], 0.0);
        light.constant[b] = factor * light.constant[b] + 0.5 * rest;
        for (std::size_t axis = 0; axis < 3; ++axis)
            light.slope[axis][b] = factor * light.slope[axis][b] + 0.5 * rest * n[axis];
    }
}

void align_to_dominant(DirectedIrradiance& light, const Normal& n) {
    const Spectrum own = light.at(n);
    const Vec3 slope = mean_slope(light);
    const Vec3 vector = slope + (mean(own) - dot(slope, n)) * n;
    const Normal d = norm(vector) > 0 ? normalized(vector) : n;
    const Frame frame(n);
    double squares = 0;
    Spectrum products;
    for (std::size_t k = 0; k < tilted_count; ++k) {
        const Vec3 step = tilted(frame, k) - n;
        const double along = dot(d, step);
        squares += along * along;
        for (std::size_t axis = 0; axis < 3; ++axis) products += along * step[axis] * light.slope[axis];
    }
    const double cosine = dot(d, n);
    for (std::size_t b = 0; b < bands; ++b) {
        // Up to this slope, the constant part own - along * cosine is not negative.
        const double most = cosine > 0 ? own[b] / cosine : HUGE_VAL;
        const double along = std::clamp(products[b] / squares, 0.0, std::max(most, 0.0));
        light.constant[b] = own[b] - along * cosine;
        for (std::size_t axis = 0; axis < 3; ++axis) light.slope[axis][b] = along * d[axis];
    }
}

DirectedIrradiance directed_at(const LightMap& map, std::size_t texel) {
    DirectedIrradiance out;
    for (std::size_t b = 0; b < bands; ++b) {
        out.constant[b] = static_cast<double>(map.directed[0][texel][b]);
        for (std::size_t axis = 0; axis < 3; ++axis)
            out.slope[axis][b] = static_cast<double>(map.directed[axis + 1][texel][b]);
    }
    return out;
}

void store_directed(const DirectedIrradiance& light, std::size_t texel, LightMap& map) {
    for (std::size_t b = 0; b < bands; ++b) {
        map.directed[0][texel][b] = static_cast<float>(light.constant[b]);
        for (std::size_t axis = 0; axis < 3; ++axis)
            map.directed[axis + 1][texel][b] = static_cast<float>(light.slope[axis][b]);
    }
}

void continue_directed(std::span<const std::size_t> others, const Spectrum& irradiance, std::size_t texel,
                       LightMap& map) {
    if (!map.has_directions()) return;
    DirectedIrradiance sum;
    Spectrum whole;
    for (const std::size_t other : others) sum += directed_at(map, other), whole += map.at(other);
    for (std::size_t b = 0; b < bands; ++b) {
        const double factor = whole[b] > 0 ? irradiance[b] / whole[b] : 0;
        sum.constant[b] *= factor;
        for (Spectrum& s : sum.slope) s[b] *= factor;
    }
    store_directed(sum, texel, map);
}

std::array<Spectrum, 4> radiance_of(const DirectedIrradiance& light) {
    const Harmonics<double> Y = harmonics_at({1, 0, 0});  // its entries 0 and 3 are the norms of degrees 0 and 1
    const double zero = 1 / (irradiance_factors[0] * Y[0]), one = 1 / (irradiance_factors[1] * Y[3]);
    return {zero * light.constant, one * light.slope[1], one * light.slope[2], one * light.slope[0]};
}

DominantDirection dominant_direction(const DirectedIrradiance& light) {
    const Vec3 slope = mean_slope(light);
    const double length = norm(slope), whole = std::max(mean(light.constant), 0.0) + length;
    if (!(length > 0)) return {{0, 0, 1}, 0};
    return {slope / length, length / whole};
}

}  // namespace exitance
