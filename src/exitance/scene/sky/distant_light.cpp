#include "exitance/scene/sky/distant_light.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

/// Number of sides of the polygon that represents a disc. A polygon of equal area deviates from the circle by at most
/// 0.14% of the radius, so that penumbras have an error of at most 3e-4 of the full light.
constexpr int disc_sides = 48;

/// Facets along an edge of the cube if light depends on direction: small enough for fast clipping of shadows.
constexpr int facets_per_edge = 2;

/// Adds a part of a face of the cube: from `corner` along u and v, which are counter-clockwise seen from inside.
void add_face(const DistantLight::Dome& dome, const Vec3& corner, const Vec3& u, const Vec3& v, int nu, int nv,
              std::vector<DistantFacet>& out) {
    for (int i = 0; i < nu; ++i)
        for (int k = 0; k < nv; ++k) {
            const auto at = [&](int a, int b) {
                return corner + (static_cast<double>(a) / nu) * u + (static_cast<double>(b) / nv) * v;
            };
            DistantFacet facet;
            facet.corners = {at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)};
            facet.n = normalized(cross(u, v));
            facet.exitance = dome.irradiance, facet.is_dome = true;
            if (!dome.model.is_uniform()) {
                facet.sky = &dome.model;
                facet.smooth_width = 1;
                for (const Vec3& c : facet.corners)
                    facet.smooth_width = std::min(facet.smooth_width, dome.model.smooth_width(normalized(c)));
                const Vec3 middle = 0.5 * (facet.corners[0] + facet.corners[2]);
                facet.smooth_width = std::min(facet.smooth_width, dome.model.smooth_width(normalized(middle)));
            }
            out.push_back(std::move(facet));
        }
}

void add_dome(const DistantLight::Dome& dome, std::vector<DistantFacet>& out) {
    const bool coarse = dome.model.is_uniform() && dome.model.below;
    const int n = coarse ? 1 : facets_per_edge, half = coarse ? 1 : facets_per_edge / 2;
    if (dome.model.below)
        add_face(dome, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, n, n, out);
    else
        add_face(dome, {-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, n, n, out);
    const double z = dome.model.below ? -1 : 0;
    const Vec3 up{0, 0, 1};
    add_face(dome, {1, 1, z}, {0, -2, 0}, up, n, half, out);   // the side x = 1 of the box, seen from inside
    add_face(dome, {-1, -1, z}, {0, 2, 0}, up, n, half, out);  // the side x = -1
    add_face(dome, {-1, 1, z}, {2, 0, 0}, up, n, half, out);   // the side y = 1
    add_face(dome, {1, -1, z}, {-2, 0, 0}, up, n, half, out);  // the side y = -1
}

DistantFacet facet_of(const DistantLight::Disc& disc) {
    DistantFacet facet;
    const Frame frame(disc.towards);
    constexpr double step = 2 * pi / disc_sides;
    const double radius = std::tan(disc.half_angle) * std::sqrt(step / std::sin(step));
    for (int i = 0; i < disc_sides; ++i) {
        const double angle = -i * step;  // clockwise about the direction is counter-clockwise seen from inside
        facet.corners.push_back(disc.towards + (radius * std::cos(angle)) * frame.u +
                                (radius * std::sin(angle)) * frame.v);
    }
    facet.n = -disc.towards;
    // Form factor of the polygon from a plane that faces it, by the sum over its edges: E = M F.
    double factor = 0;
    for (int i = 0; i < disc_sides; ++i) {
        const Vec3 &a = facet.corners[static_cast<std::size_t>(i)],
                   &b = facet.corners[static_cast<std::size_t>((i + 1) % disc_sides)];
        const Vec3 axis = cross(b, a);
        factor += std::atan2(norm(axis), dot(a, b)) * dot(disc.towards, axis) / norm(axis);
    }
    facet.exitance = (2 * pi / std::abs(factor)) * disc.irradiance;
    return facet;
}

}  // namespace

void DistantLight::append(const DistantLight& more) {
    domes.insert(domes.end(), more.domes.begin(), more.domes.end());
    discs.insert(discs.end(), more.discs.begin(), more.discs.end());
}

Spectrum DistantLight::radiosity(const Vec3& w, bool with_discs) const {
    Spectrum sum;
    for (const Dome& dome : domes)
        if (dome.model.below == (w.z < 0)) sum += dome.model.relative(w) * dome.irradiance;
    if (!with_discs) return sum;
    for (const Disc& disc : discs) {
        const double sine = std::sin(disc.half_angle);
        if (dot(w, disc.towards) >= std::cos(disc.half_angle)) sum += disc.irradiance / (sine * sine);
    }
    return sum;
}

bool DistantLight::is_sane() const {
    const auto is_light = [](const Spectrum& s) {
        return std::all_of(s.value.begin(), s.value.end(), [](double v) { return v >= 0 && v <= 1e30; });
    };
    return std::all_of(domes.begin(), domes.end(),
                       [&](const Dome& d) { return d.model.is_sane() && is_light(d.irradiance); }) &&
           std::all_of(discs.begin(), discs.end(), [&](const Disc& d) {
               return std::abs(norm(d.towards) - 1) < 1e-6 && d.half_angle > 0 && d.half_angle <= widest_disc &&
                      is_light(d.irradiance);
           });
}

std::vector<DistantFacet> distant_facets(const DistantLight& light) {
    std::vector<DistantFacet> out;
    for (const DistantLight::Dome& dome : light.domes)
        if (max(dome.irradiance) > 0) add_dome(dome, out);
    for (const DistantLight::Disc& disc : light.discs)
        if (max(disc.irradiance) > 0) out.push_back(facet_of(disc));
    return out;
}

}  // namespace exitance
