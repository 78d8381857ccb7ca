#include "exitance/scene/pane.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/polygon.hpp"
#include "exitance/base/triangulation.hpp"

namespace exitance {
namespace {

/// Reflectances of one glass face for both polarisations.
struct Fresnel {
    double across, along, cos_inside;
};

Fresnel fresnel(double cosine, double index) {
    const double c = std::clamp(cosine, 0.0, 1.0), inside = std::sqrt(1 - (1 - c * c) / (index * index));
    const double across = (c - index * inside) / (c + index * inside),
                 along = (index * c - inside) / (index * c + inside);
    return {across * across, along * along, inside};
}

double through(double r, double t) {
    return t * (1 - r) * (1 - r) / (1 - r * r * t * t);
}

double back(double r, double t) {
    return r < 1 ? r * (1 + t * through(r, t)) : 1;
}

}  // namespace

Spectrum Pane::transmission(double cosine) const {
    const Fresnel f = fresnel(cosine, index);
    Spectrum out;
    if (!(cosine > 0)) return out;
    for (std::size_t b = 0; b < bands; ++b) {
        if (b > 0 && transmissivity[b] == transmissivity[b - 1]) {  // most glass is grey, and pow() is expensive
            out[b] = out[b - 1];
            continue;
        }
        const double t = std::pow(transmissivity[b], 1 / f.cos_inside);
        out[b] = 0.5 * (through(f.across, t) + through(f.along, t));
    }
    return out;
}

Spectrum Pane::reflection(double cosine) const {
    const Fresnel f = fresnel(cosine, index);
    Spectrum out;
    for (std::size_t b = 0; b < bands; ++b) {
        const double t = std::pow(transmissivity[b], 1 / f.cos_inside);
        out[b] = 0.5 * (back(f.across, t) + back(f.along, t));
    }
    return out;
}

bool Pane::is_sane() const {
    return corners.size() >= 3 && std::abs(norm(n) - 1) < 1e-6 && index >= 1 && index <= 4 &&
           std::all_of(transmissivity.value.begin(), transmissivity.value.end(),
                       [](double v) { return v >= 0 && v <= 1; }) &&
           std::all_of(corners.begin(), corners.end(), [](const Point& p) { return is_finite(p); });
}

Spectrum transmissivity_of(const Spectrum& transmittance, double index) {
    // T = t (1 - r)^2 / (1 - r^2 t^2) solved for t.
    const double r = fresnel(1, index).across, q = (1 - r) * (1 - r);
    Spectrum out;
    for (std::size_t b = 0; b < bands; ++b) {
        const double T = std::max(0.0, transmittance[b]);
        out[b] = std::min(1.0, 2 * T / (std::sqrt(q * q + 4 * T * T * r * r) + q));
    }
    return out;
}

std::vector<Pane> convex_panes(const std::vector<Pane>& panes) {
    std::vector<Pane> out;
    for (const Pane& pane : panes) {
        const Vec3 area = area_vector(pane.corners);
        if (!(norm(area) > 0)) continue;
        const Normal n = normalized(area);
        for (const std::vector<std::uint32_t>& piece : convex_pieces(pane.corners, n)) {
            Pane part = pane;
            part.n = n, part.corners.clear();
            for (const std::uint32_t i : piece) part.corners.push_back(pane.corners[i]);
            if (norm(area_vector(part.corners)) > 0) out.push_back(std::move(part));
        }
    }
    return out;
}

}  // namespace exitance
