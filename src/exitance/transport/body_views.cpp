#include "exitance/transport/body_views.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/form_factors/met_directions.hpp"
#include "exitance/mesh/element_locator.hpp"

namespace exitance {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// Parts of an element, one around each node of its fit.
constexpr std::size_t cells_along = 3, cells = cells_along * cells_along;
std::size_t cell_of(Vec2 uv) {
    const auto along = [](double u) {
        return static_cast<std::size_t>(std::clamp(u * cells_along, 0.0, cells_along - 0.5));
    };
    return along(uv.x) * cells_along + along(uv.y);
}

/// Pieces of one body, with the sums of their areas up to and including each.
struct BodyPieces {
    std::vector<std::uint32_t> pieces;
    std::vector<double> area_up_to;
};

std::vector<BodyPieces> pieces_by_body(const Stage& stage, const SceneBodies& bodies) {
    std::vector<BodyPieces> out(bodies.all.size());
    for (std::uint32_t p = 0; p < stage.pieces.size(); ++p) {
        const RegionId region = stage.pieces[p].region;
        if (stage.is_unlit(region) || !(max(stage.scene.material(region).reflectance) > 0)) continue;
        BodyPieces& of = out[bodies.of(stage.scene, region)];
        of.area_up_to.push_back((of.pieces.empty() ? 0 : of.area_up_to.back()) + stage.pieces[p].patch.area());
        of.pieces.push_back(p);
    }
    return out;
}

/// Rays from points that are spread evenly over a body, and their hits.
struct BodyRays {
    std::vector<Point> origins;
    std::vector<Vec3> directions;
    std::vector<RayHit> hits;
};

void look_from(const Stage& stage, const BodyPieces& body, std::uint32_t number, std::uint64_t seed, BodyRays& w,
               std::vector<BodyViews::Hit>& out) {
    constexpr std::uint32_t rays = BodyViews::rays_per_body;
    if (body.pieces.empty()) return;
    const ScrambledSobol random(hash(seed, static_cast<std::uint64_t>(Stream::mesh), number));
    std::uint32_t k = 0;
    for (std::size_t i = 0; i < body.pieces.size() && k < rays; ++i) {
        const Piece& piece = stage.pieces[body.pieces[i]];
        w.origins.clear(), w.directions.clear();
        for (; k < rays && (k + 0.5) * body.area_up_to.back() <= rays * body.area_up_to[i]; ++k) {
            w.origins.push_back(piece.patch.at(uniform_in_shape(piece.patch.shape, random(k, 0), random(k, 1))));
            w.directions.push_back(met_direction(stage.scene, piece.region, stage.scene.regions()[piece.region].plane.n,
                                                 random(k, 2), random(k, 3)));
        }
        if (w.origins.empty()) continue;
        w.hits.assign(w.origins.size(), {});
        stage.tracer.nearest(w.origins, w.directions, piece.region, w.hits, Mirrored::followed);
        const double weight = mean(stage.scene.material(piece.region).reflectance) / rays;
        for (std::size_t r = 0; r < w.hits.size(); ++r)
            if (const RayHit& hit = w.hits[r]; !hit.surface.is_none() && hit.front)
                out.push_back({number, hit.region, place_of(stage.scene, hit, w.origins[r], w.directions[r]),
                               hit.distance, weight});
    }
}

}  // namespace

BodyViews::BodyViews(const Stage& stage, const SceneBodies& bodies, std::uint64_t seed) : bodies_(&bodies) {
    const std::vector<BodyPieces> pieces = pieces_by_body(stage, bodies);
    std::vector<std::vector<Hit>> of_body(pieces.size());
    parallel_ranges(pieces.size(), 1, [&](std::size_t first, std::size_t last) {
        BodyRays workspace;
        for (std::size_t b = first; b < last; ++b)
            look_from(stage, pieces[b], static_cast<std::uint32_t>(b), seed, workspace, of_body[b]);
    });
    for (const std::vector<Hit>& hits : of_body) hits_.insert(hits_.end(), hits.begin(), hits.end());
}

namespace {

/// Direct light that each body reflects itself, mean over its area, W/m^2.
std::vector<double> own_light(const Stage& stage, const BodyViews& views, const DirectProjection& light) {
    std::vector<double> flux(views.bodies().all.size()), area(flux.size());
    for (ElementId e : light.tree.leaves()) {
        const RegionId region = light.tree.region(e);
        if (stage.is_unlit(region)) continue;
        const std::uint32_t body = views.bodies().of(stage.scene, region);
        area[body] += light.tree.area(e);
        flux[body] += light.tree.area(e) * mean(stage.scene.material(region).reflectance * light.fit[e].mean);
    }
    for (std::size_t b = 0; b < flux.size(); ++b) flux[b] = area[b] > 0 ? flux[b] / area[b] : 0;
    return flux;
}

}  // namespace

BodyNeeds::BodyNeeds(const Stage& stage, const BodyViews& views, const DirectProjection& light,
                     std::span<const double> tolerance, std::span<const double> light_of_room)
    : views_(views), regions_(stage.scene.regions().size()), at_(views.hits().size()) {
    follow(light.tree);
    allowed_ = own_light(stage, views, light);
    for (std::size_t i = 0; i < at_.size(); ++i) {
        const BodyViews::Hit& hit = views.hits()[i];
        allowed_[hit.body] +=
            hit.weight * mean(stage.scene.material(hit.region).reflectance * light.fit[at_[i].element].mean);
    }
    room_light_.assign(allowed_.size(), light_of_room[0]);
    for (std::size_t b = 0; b < room_light_.size() && stage.rooms.count() > 0; ++b) {
        const SurfaceId first = views.bodies().all[b].first;
        const RegionId region = stage.scene.surfaces()[first].region;
        room_light_[b] = light_of_room[stage.rooms.at(region, centroid(stage.scene.outline(first)))];
    }
    for (std::size_t b = 0; b < allowed_.size(); ++b) {
        const double reference = std::max(allowed_[b], min_body_light * room_light_[b]);
        allowed_[b] = reference > 0 ? tolerance[b] * reference : unlimited;
    }
    find_limits(light.tree);
}

void BodyNeeds::follow(const ElementTree& tree) {
    const auto is_known = [&](const ElementTree::Place& at) {
        return !at.element.is_none() && tree.is_leaf(at.element);
    };
    if (!std::all_of(at_.begin(), at_.end(), is_known)) {
        const ElementLocator locator(tree, regions_);
        parallel_ranges(at_.size(), 1024, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                if (!is_known(at_[i])) at_[i] = locator.find(views_.hits()[i].region, views_.hits()[i].y);
        });
    }
    if (!allowed_.empty()) find_limits(tree);
}

namespace {

/// Unbiased estimate of the square of a form factor times reflectances, from the rays of a body that hit a cell: the
/// sum over pairs of different rays. The squares of single rays are left out: a single ray carries no information about
/// the size of a cell, and elements would be split without end.
class SquaredWeight {
  public:
    void add(double weight) { sum_ += weight, squares_ += weight * weight; }
    double value() const { return std::max(0.0, sum_ * sum_ - squares_); }

  private:
    double sum_ = 0, squares_ = 0;
};

}  // namespace

void BodyNeeds::find_limits(const ElementTree& tree) {
    const std::span<const BodyViews::Hit> hits = views_.hits();
    std::vector<std::uint32_t> first = {0};  // hit of every body, and the number of hits
    for (std::uint32_t i = 1; i < hits.size(); ++i)
        if (hits[i].body != hits[i - 1].body) first.push_back(i);
    if (!hits.empty()) first.push_back(static_cast<std::uint32_t>(hits.size()));
    std::vector<std::vector<ElementLimits>> found(first.size() - 1);
    parallel_for(found.size(), 1, [&](std::size_t k) { found[k] = limits_of_body(tree, first[k], first[k + 1]); });
    max_ = Field<ElementId, Limits>(tree.size());
    const auto lower = [](double& limit, double to) { limit = std::min(limit, to); };
    for (const std::vector<ElementLimits>& of_body : found)
        for (const auto& [e, limits] : of_body) {
            lower(max_[e].everywhere, limits.everywhere);
            lower(max_[e].in_a_cell, limits.in_a_cell);
            lower(max_[e].in_a_near_cell, limits.in_a_near_cell);
        }
}

/// Returns the limits that one body demands of the elements that it sees. Its hits are [first, last).
std::vector<BodyNeeds::ElementLimits> BodyNeeds::limits_of_body(const ElementTree& tree, std::uint32_t first,
                                                                std::uint32_t last) const {
    const std::span<const BodyViews::Hit> hits = views_.hits();
    const std::uint32_t body = hits[first].body;
    // indices of the body's hits; those on the same element are consecutive
    std::vector<std::uint32_t> of_body(last - first);
    std::iota(of_body.begin(), of_body.end(), first);
    std::sort(of_body.begin(), of_body.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::pair(at_[a].element.value, a) < std::pair(at_[b].element.value, b);
    });
    std::vector<ElementLimits> out;
    for (std::size_t k = 0; k < of_body.size();) {
        const ElementId e = at_[of_body[k]].element;
        // Rays that hit the cells of the element: all, and those from nearer than its width.
        std::array<SquaredWeight, cells> all{}, near{};
        for (; k < of_body.size() && at_[of_body[k]].element == e; ++k) {
            const BodyViews::Hit& hit = hits[of_body[k]];
            const std::size_t cell = cell_of(at_[of_body[k]].uv);
            all[cell].add(hit.weight);
            if (hit.distance * hit.distance < tree.area(e)) near[cell].add(hit.weight);
        }
        const auto largest = [](const std::array<SquaredWeight, cells>& of) {
            double largest_value = 0;
            for (const SquaredWeight& w : of) largest_value = std::max(largest_value, w.value());
            return std::sqrt(largest_value);
        };
        double squares = 0;
        for (const SquaredWeight& w : all) squares += w.value();
        out.push_back({e,
                       {.everywhere = allowed_[body] / std::sqrt(cells * squares),
                        .in_a_cell = allowed_[body] / largest(all),
                        .in_a_near_cell = allowed_[body] / (room_light_[body] * largest(near))}});
    }
    return out;
}

double BodyNeeds::allowed_squared(ElementId e) const {
    return e.value < max_.size() ? max_[e].everywhere * max_[e].everywhere : unlimited;
}

bool BodyNeeds::hides_too_much(ElementId e, const DirectFit& fit, const Spectrum& weight) const {
    return e.value < max_.size() && (mean(weight * fit.mean) > max_[e].in_a_cell || max_[e].in_a_near_cell < 1);
}

}  // namespace exitance
