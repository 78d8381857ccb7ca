#include "exitance/direct/small_sources.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/polygon.hpp"
#include "exitance/visibility/glazed_part.hpp"
#include "exitance/visibility/pyramid.hpp"

namespace exitance {
namespace {

constexpr double max_penumbra = 0.25;  ///< Width in extents of a polygon; derived from the three points of a rule.
/// In extents of a polygon: light from within this distance may peak between the polygon's quadrature points.
constexpr double nearness = 2;

/// Distance of the two corners farthest apart.
double extent_of(std::span<const Point> outline) {
    double squared = 0;
    for (const Point& p : outline)
        for (const Point& q : outline) squared = std::max(squared, squared_norm(q - p));
    return std::sqrt(squared);
}

double distance_to_farthest(const Point& x, std::span<const Point> corners) {
    double squared = 0;
    for (const Point& p : corners) squared = std::max(squared, squared_norm(p - x));
    return std::sqrt(squared);
}

/// Lower bound on the distance of a convex polygon: the distance to its bounding box.
double distance_to_box(const Point& x, std::span<const Point> corners) {
    Box box;
    for (const Point& p : corners) box.add(p);
    return norm(max(max(box.lo - x, x - box.hi), Vec3{}));
}

}  // namespace

/// A source, reduced to its centre.
class SmallSources::Centre {
  public:
    Centre(const DirectLight& direct, const ReceiverLight::Source& source, const Polygon& on,
           DirectLight::Workspace& scratch)
        : direct_(direct), emitter_(&direct.emitters()[source.emitter]) {
        const Occluders& occluders = direct.occluders();
        const std::span<const Point> corners = occluders.corners(source.piece);
        at = centroid(corners);
        if (!direct.looks_far(source.emitter)) {
            area_ = norm(area_vector(corners));
            return;
        }
        const Point middle = centroid(on.outline);
        set_far(normalized(at - occluders.middle()), middle);
        parallel_ = emitter_->exitance * visible_form_factor(occluders, direct.receiver(middle, on.n, on.own),
                                                             source.piece, {}, scratch, emitter_->radiance);
    }

    Centre(const DirectLight& direct, const Beam& beam, const Polygon& on) : direct_(direct), beam_{beam.light, 0, 0} {
        const PunctualLight& light = direct.scene().lights()[beam.light];
        at = light.position;
        if (light.is_directional()) set_far(-light.direction, centroid(on.outline));
    }

    /// Returns the unoccluded irradiance, through panes, at a place of the polygon.
    Spectrum light_at(const Point& x, const Polygon& on) const {
        const SurfacePoint receiver = direct_.receiver(x, on.n, on.own);
        if (!emitter_) return direct_.beams().irradiance(receiver, std::span(&beam_, 1), {});
        Spectrum out = parallel_;
        if (!is_far) {
            const Vec3 d = receiver.x - at;
            // product of the cosines, times the squared distance
            const double cosines = dot(emitter_->plane.n, d) * -dot(on.n, d);
            if (!(cosines > 0)) return {};
            const double squared = squared_norm(d);
            out = (area_ * cosines / (pi * squared * squared) * emitter_->radiance.towards(x, at)) * emitter_->exitance;
        }
        const std::span<const Pane> panes = direct_.occluders().scene().panes();
        return panes.empty() ? out : out * transmission_between(panes, receiver.x, at);
    }

    Point at;             ///< Centre of the source; if it is far, a point so far away that the view is parallel.
    bool is_far = false;  ///< True for the sun and parallel light.
    const DirectLight::Emitter* emitter() const { return emitter_; }

  private:
    /// At this distance, shadows differ from those of parallel light by 1e-5 of the polygon's extent.
    void set_far(const Vec3& towards, const Point& middle) {
        // distance in scene sizes, derived from rounding, which at this distance moves shadows by 1e-9
        constexpr double far = 1e5;
        is_far = true;
        at = middle + far * direct_.occluders().scene().size() * towards;
    }

    const DirectLight& direct_;
    const DirectLight::Emitter* emitter_ = nullptr;  ///< The source; null for a light without extent.
    Beam beam_;                                      ///< The light without extent, without blockers.
    double area_ = 0;                                ///< m^2
    Spectrum parallel_;                              ///< Irradiance by the unoccluded sun, W/m^2.
};

/// True if the penumbrae of a source are narrow compared with the polygon.
bool SmallSources::is_sharp(const ReceiverLight::Source& source, const Polygon& on, const ReceiverLight& light) const {
    const Occluders& occluders = direct_->occluders();
    const std::span<const Point> corners = occluders.corners(source.piece);
    const Point centre = centroid(corners), middle = centroid(on.outline);
    const double width = 2 * distance_to_farthest(centre, corners), most = max_penumbra * extent_of(on.outline);
    const bool is_far = direct_->looks_far(source.emitter);
    if (!is_far && width > most) return false;
    const double reach = distance_to_farthest(centre, on.outline);
    const auto blockers = std::span(light.candidates).subspan(source.first, source.count);
    return std::all_of(blockers.begin(), blockers.end(), [&](PieceId p) {
        if (is_far)
            return width * distance_to_farthest(middle, occluders.corners(p)) <=
                   most * norm(centre - occluders.middle());
        const double near = distance_to_box(centre, occluders.corners(p));
        return width * (reach - near) <= most * near;
    });
}

/// True unless the source is certain to be seen whole, and from so far that the points of a rule suffice.
bool SmallSources::may_be_missed(const ReceiverLight::Source& source, const Polygon& on,
                                 const ReceiverLight& light) const {
    if (source.is_crowded) return false;
    if (source.count == 0) {
        if (direct_->looks_far(source.emitter)) return false;
        const Point centre = centroid(direct_->occluders().corners(source.piece));
        if (norm(centre - centroid(on.outline)) > nearness * extent_of(on.outline)) return false;
    }
    return is_sharp(source, on, light);
}

/// Finds the small sources, each with its possible blockers.
void SmallSources::prepare(const Polygon& on, Workspace& room) const {
    const Occluders& occluders = direct_->occluders();
    const double most = max_penumbra * extent_of(on.outline);
    room.named_.clear();
    for (std::uint32_t e = 0; e < direct_->emitters().size(); ++e) {
        const DirectLight::Emitter& emitter = direct_->emitters()[e];
        if (emitter.sky != DirectLight::Emitter::Sky::none || !direct_->shines_on(emitter, on.own)) continue;
        if (!direct_->looks_far(e) && 2 * emitter.radius > most && emitter.pieces.size() == 1) continue;
        for (const PieceId piece : emitter.pieces) {
            const std::span<const Point> corners = occluders.corners(piece);
            if (direct_->looks_far(e) || 2 * distance_to_farthest(centroid(corners), corners) <= most)
                room.named_.push_back({e, piece});
        }
    }
    ReceiverLight& light = room.light_;
    direct_->prepare(on.outline, on.n, on.own, room.named_, light, room.exact_,
                     [](const DirectLight::SourceName&) { return max_blockers; });
    std::erase_if(light.sources,
                  [&](const ReceiverLight::Source& source) { return !may_be_missed(source, on, light); });
    // Each source is evaluated separately.
    for (ReceiverLight::Source& source : light.sources) source.in_batch = false;
    light.open.clear(), light.open_light.clear();
    const Beams& beams = direct_->beams();
    if (beams.empty()) return;
    beams.prepare(on.outline, on.n, on.own, light.beams, light.candidates);
    std::erase_if(light.beams, [&](const Beam& beam) {
        const PunctualLight& lamp = direct_->scene().lights()[beam.light];
        const bool is_near =
            !lamp.is_directional() && norm(lamp.position - centroid(on.outline)) < nearness * extent_of(on.outline);
        return (beam.count == 0 && !is_near) || beam.count > max_blockers;
    });
}

/// Subtracts the part of the polygon that a blocker hides from the centre.
bool SmallSources::cut(const Centre& centre, const Polygon& on, PieceId blocker, Workspace& room) const {
    const Occluders& occluders = direct_->occluders();
    const ConvexPiece& piece = occluders.pieces()[blocker];
    const DirectLight::Emitter* emitter = centre.emitter();
    if (occluders.is_own(piece.region, on.own) || (emitter && piece.region == emitter->region)) return true;
    const std::span<const Point> corners = occluders.corners(blocker);
    const double facing = dot(piece.plane.n, centre.at - corners[0]);
    if (std::abs(facing) <= occluders.rounding()) return true;  // seen edge-on
    const auto keep = [&](const Plane& plane) {
        double highest = -HUGE_VAL;
        for (const Point& p : room.part_) highest = std::max(highest, plane.signed_distance(p));
        if (highest <= occluders.rounding()) return false;
        clip(room.part_, plane, room.rest_);
        room.part_.swap(room.rest_);
        return room.part_.size() >= 3;
    };
    room.part_.assign(corners.begin(), corners.end());
    const Point& foot = on.outline[0];
    if (!keep({on.n, dot(on.n, foot)})) return true;
    if (!centre.is_far && !keep({-on.n, -dot(on.n, centre.at)})) return true;
    if (!centre.is_far && emitter && !keep(emitter->plane)) return true;
    room.corners_.clear(), room.planes_.clear();
    for (const Point& p : room.part_) room.corners_.push_back(p - centre.at);
    if (!add_pyramid(room.corners_, facing, room.planes_)) return true;
    return room.lit_.cut(room.planes_, room.lit_.bounds(room.corners_));
}

namespace {

/// Integral over a triangle by three points, exact for polynomials of degree 2, subdivided until it is small compared
/// with the distance of the point `near`, if there is one.
template <class Light>
Spectrum integral(const Point& a, const Point& b, const Point& c, const Point* near, int levels, const Light& light) {
    // largest extent relative to the distance; derived from the rule's error, which is then below 1%
    constexpr double max_extent = 0.5;
    const double squared = std::max({squared_norm(b - a), squared_norm(c - b), squared_norm(a - c)});
    const Point ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a), middle = (1.0 / 3) * (a + b + c);
    if (near && levels > 0 && squared > max_extent * max_extent * squared_norm(middle - *near))
        return integral(a, ab, ca, near, levels - 1, light) + integral(ab, b, bc, near, levels - 1, light) +
               integral(ca, bc, c, near, levels - 1, light) + integral(ab, bc, ca, near, levels - 1, light);
    // Sample inside the triangle, not on its edges: these may be the shadows of a pane's edges.
    const double area = 0.5 * norm(cross(b - a, c - a));
    return (area / 3) * (light(0.5 * (a + middle)) + light(0.5 * (b + middle)) + light(0.5 * (c + middle)));
}

}  // namespace

/// Finds the fragments of the polygon that see the centre. Returns false if there are none.
bool SmallSources::find_lit(const Centre& centre, const Polygon& on, std::span<const PieceId> blockers,
                            Workspace& room) const {
    room.part_.assign(on.outline.begin(), on.outline.end());
    if (!centre.is_far && centre.emitter()) {  // keep the part of the polygon in front of the source
        clip(room.part_, centre.emitter()->plane, room.rest_);
        room.part_.swap(room.rest_);
    }
    const bool is_in_front = dot(on.n, centre.at - on.outline[0]) > direct_->occluders().rounding();
    if (room.part_.size() < 3 || !is_in_front) return false;
    room.corners_.clear();
    for (const Point& p : room.part_) room.corners_.push_back(p - centre.at);
    room.lit_.begin(room.corners_);
    return std::all_of(blockers.begin(), blockers.end(), [&](PieceId p) { return cut(centre, on, p, room); });
}

Spectrum SmallSources::mean_of(const Centre& centre, const Polygon& on, std::span<const PieceId> blockers,
                               Workspace& room) const {
    if (!find_lit(centre, on, blockers, room)) return {};
    constexpr int max_levels = 8;
    Spectrum sum;
    for (std::size_t i = 0; i < room.lit_.size(); ++i) {
        room.lit_.corners(i, room.corners_);
        const auto corner = [&](std::size_t k) { return centre.at + room.corners_[k]; };
        for (std::size_t k = 2; k < room.corners_.size(); ++k)
            sum += integral(corner(0), corner(k - 1), corner(k), centre.is_far ? nullptr : &centre.at, max_levels,
                            [&](const Point& x) { return centre.light_at(x, on); });
    }
    return (1 / norm(area_vector(on.outline))) * sum;
}

/// Calls visit(centre, blockers) for every small source of the polygon.
template <class Visit>
void SmallSources::visit_centres(const Polygon& on, Workspace& room, const Visit& visit) const {
    prepare(on, room);
    const ReceiverLight& light = room.light_;
    const auto blockers_of = [&](const auto& source) {
        return std::span(light.candidates).subspan(source.first, source.count);
    };
    for (const ReceiverLight::Source& source : light.sources)
        visit(Centre(*direct_, source, on, room.exact_), blockers_of(source));
    for (const Beam& beam : light.beams) visit(Centre(*direct_, beam, on), blockers_of(beam));
}

SmallSources::Missed SmallSources::missed(const Polygon& on, Workspace& room) const {
    Missed out;
    if (!direct_->occluders().scene().behind(on.own).is_none()) return out;
    visit_centres(on, room, [&](const Centre& centre, std::span<const PieceId> blockers) {
        const Spectrum E = mean_of(centre, on, blockers, room);
        out.irradiance += E;
        if (centre.is_far) out.parallel += E;
    });
    for (std::size_t i = 0; i < on.places.size() && !room.light_.is_dark(); ++i) {
        Spectrum parallel;
        out.irradiance -= on.weights[i] * direct_->irradiance(room.light_, on.places[i], room.exact_, &parallel);
        out.parallel -= on.weights[i] * parallel;
    }
    return out;
}

std::vector<Point> SmallSources::lit_places(const Polygon& on, Workspace& room) const {
    std::vector<Point> out;
    visit_centres(on, room, [&](const Centre& centre, std::span<const PieceId> blockers) {
        if (!(max(mean_of(centre, on, blockers, room)) > 0)) return;
        double largest = 0;
        Point middle;
        for (std::size_t i = 0; i < room.lit_.size(); ++i) {
            room.lit_.corners(i, room.corners_);
            const double area = norm(area_vector(room.corners_));
            if (area <= largest) continue;
            largest = area, middle = centre.at + centroid(room.corners_);
        }
        if (largest > 0) out.push_back(middle);
    });
    return out;
}

}  // namespace exitance
