#include "exitance/measure/glare/field_of_view.hpp"

#include <algorithm>

#include "exitance/base/parallel.hpp"
#include "exitance/direct/beams.hpp"
#include "exitance/measure/glare/glare_rules.hpp"
#include "exitance/scene/point_opening.hpp"
#include "exitance/transport/stage.hpp"
#include "exitance/visibility/glazed_part.hpp"

namespace exitance {
namespace {

constexpr double coarse_extent = 0.1, fine_extent = 0.0125, sky_extent = 0.02;  ///< Radians.

/// True if a surface is a face of the cube that represents a luminaire without extent.
bool is_point_opening(const Surface& surface) {
    constexpr double rounding = 1e-6;
    return surface.area <= point_opening_size * point_opening_size * (1 + rounding);
}

}  // namespace

FieldOfView::FieldOfView(const RadiosityFunction& light, const SurfacePoint& eye, const LightUnit& lux)
    : light_(light), eye_(eye), lux_(lux) {
    for (const std::string& group : light.solution().scene.groups()) names_.push_back(group);
    add_surfaces(), add_sky(), add_lights();
    evaluate(surfaces_);
    add_up();
    constexpr double negligible_share = 1e-4;
    const double negligible = negligible_share * 2 * pi * mean_;
    surfaces_ = refined(std::move(surfaces_), [&](const SurfaceTriangle& t) { return t.variation() > negligible; });
    add_up();
}

/// Sums over the parts: the mean luminance, and reflected light.
void FieldOfView::add_up() {
    double sum = 0;
    for (const GlarePart& part : apart_) sum += part.luminance * part.solid_angle;
    reflected_ = 0;
    for (const SurfaceTriangle& t : surfaces_) {
        const std::array<ViewTriangle, 4> quarters = t.shape.quarters();
        for (std::size_t k = 0; k < 4; ++k) {
            const double angle = quarters[k].solid_angle();
            sum += t.luminance[k] * angle;
            reflected_ += t.reflected[k] * angle * std::max(0.0, dot(quarters[k].middle(), eye_.n));
        }
    }
    mean_ = sum / (2 * pi);
}

bool FieldOfView::SurfaceTriangle::varies(double threshold) const {
    const auto above = std::count_if(luminance.begin(), luminance.end(), [&](double L) { return L > threshold; });
    return above > 0 && above < 4;
}

bool FieldOfView::SurfaceTriangle::is_coarse() const {
    return shape.extent() > 2 * fine_extent;
}

double FieldOfView::SurfaceTriangle::variation() const {
    const auto [least, most] = std::minmax_element(luminance.begin(), luminance.end());
    return (*most - *least) * shape.solid_angle();
}

std::uint32_t FieldOfView::origin_of(const std::string& name) {
    names_.push_back(name);
    return static_cast<std::uint32_t>(names_.size() - 1);
}

void FieldOfView::add_surfaces() {
    const Occluders& occluders = light_.stage().occluders;
    const Scene& scene = light_.solution().scene;
    std::vector<PieceId> pieces;
    for (const RegionId region : scene.regions().ids())
        for (const PieceId piece : occluders.pieces(region)) pieces.push_back(piece);
    const std::vector<std::vector<ViewTriangle>> found = visible_triangles(occluders, eye_, pieces, coarse_extent);
    for (std::size_t i = 0; i < pieces.size(); ++i)
        for (const ViewTriangle& t : found[i]) surfaces_.push_back({t, occluders.pieces()[pieces[i]].surface, {}, {}});
}

void FieldOfView::add_sky() {
    const Occluders& occluders = light_.stage().occluders;
    const Scene& scene = light_.solution().scene;
    if (scene.distant().empty()) return;
    const std::uint32_t sky = origin_of("sky"), sun = origin_of("sun");
    const std::vector<DistantFacet> facets = distant_facets(scene.distant());
    std::vector<PieceId> pieces;
    for (const PieceId piece : occluders.distant_pieces()) pieces.push_back(piece);
    const std::vector<std::vector<ViewTriangle>> found = visible_triangles(occluders, eye_, pieces, sky_extent);
    const double beyond_panes = 2 * (norm(eye_.x - scene.box().centre()) + scene.size());
    for (std::size_t i = 0; i < facets.size(); ++i)
        for (const ViewTriangle& t : found[i]) {
            const Normal towards = t.middle();
            const Spectrum exitance =
                facets[i].is_dome ? scene.distant().radiosity(towards, false) : facets[i].exitance;
            const Spectrum passing = transmission_between(scene.panes(), eye_.x, eye_.x + beyond_panes * towards);
            apart_.push_back({towards, lux_(passing * exitance) / pi, t.solid_angle(), facets[i].is_dome ? sky : sun});
        }
}

void FieldOfView::add_lights() {
    for (const PunctualLight& lamp : light_.solution().scene.lights()) {
        const Vec3 d = lamp.is_directional() ? Vec3() - lamp.direction : lamp.position - eye_.x;
        if (!(dot(d, eye_.n) > 0)) continue;
        const Normal towards = normalized(d);
        const std::vector<PunctualLight> one{lamp};
        const double illuminance = lux_(Beams(one, light_.stage().occluders).irradiance({eye_.x, towards, RegionId()}));
        if (!(illuminance > 0)) continue;
        const double angle = lamp.is_directional() ? sun_disc_solid_angle : small_source_area / dot(d, d);
        apart_.push_back({towards, illuminance / angle, angle, origin_of(lamp.name.empty() ? "light" : lamp.name)});
    }
}

/// Evaluates the luminance of every quarter in its middle.
void FieldOfView::evaluate(std::vector<SurfaceTriangle>& triangles) const {
    const Scene& scene = light_.solution().scene;
    std::vector<ProbePoint> points;
    for (const SurfaceTriangle& t : triangles) {
        const Normal& n = scene.regions()[scene.surfaces()[t.surface].region].plane.n;
        for (const ViewTriangle& quarter : t.shape.quarters()) {
            const Normal w = quarter.middle();
            points.push_back({eye_.x + (dot(n, quarter.corners[0]) / dot(n, w)) * w, n});
        }
    }
    const std::vector<Light> there = light_.at(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!there[i].on_surface) continue;
        SurfaceTriangle& t = triangles[i / 4];
        const Spectrum M = scene.material(t.surface).exitance;
        const RelativeRadiance relative = scene.relative_radiance(scene.surfaces()[t.surface].region);
        const Spectrum passing = transmission_between(scene.panes(), eye_.x, points[i].x) / pi;
        t.reflected[i % 4] = lux_(passing * (there[i].radiosity - M));
        t.luminance[i % 4] = t.reflected[i % 4] + lux_(passing * (relative.towards(eye_.x, points[i].x) * M));
    }
}

/// Cuts triangles into their quarters until none is to be cut or all are fine.
template <class IsToCut>
std::vector<FieldOfView::SurfaceTriangle> FieldOfView::refined(std::vector<SurfaceTriangle> triangles,
                                                               const IsToCut& is_to_cut) const {
    std::vector<SurfaceTriangle> out, next;
    while (!triangles.empty()) {
        next.clear();
        for (const SurfaceTriangle& t : triangles) {
            if (!t.is_coarse() || !is_to_cut(t))
                out.push_back(t);
            else
                for (const ViewTriangle& quarter : t.shape.quarters()) next.push_back({quarter, t.surface, {}, {}});
        }
        evaluate(next);
        triangles.swap(next);
    }
    return out;
}

GlarePart FieldOfView::part_of(const ViewTriangle& t, SurfaceId s, double luminance) const {
    const Surface& surface = light_.solution().scene.surfaces()[s];
    GlarePart out{t.middle(), luminance, t.solid_angle(), surface.group.value};
    if (is_point_opening(surface)) {
        // The mean projected area of the cube is that of 1.5 of its faces [CIE147].
        const double larger = small_source_area / (1.5 * point_opening_size * point_opening_size);
        out.solid_angle *= larger, out.luminance /= larger;
    }
    return out;
}

std::vector<GlarePart> FieldOfView::brighter_than(double threshold) const {
    std::vector<GlarePart> out;
    const auto add = [&](const GlarePart& part) {
        if (part.luminance > threshold && part.solid_angle > 0) out.push_back(part);
    };
    for (const GlarePart& part : apart_) add(part);
    for (const SurfaceTriangle& t : refined(surfaces_, [&](const SurfaceTriangle& t) { return t.varies(threshold); })) {
        const std::array<ViewTriangle, 4> quarters = t.shape.quarters();
        for (std::size_t k = 0; k < 4; ++k) add(part_of(quarters[k], t.surface, t.luminance[k]));
    }
    return out;
}

}  // namespace exitance
