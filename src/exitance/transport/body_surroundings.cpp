#include "exitance/transport/body_surroundings.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/form_factors/hemisphere.hpp"
#include "exitance/mesh/adaptive.hpp"
#include "exitance/scene/bodies.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {
namespace {

/// A body is small if its radius is at most this share of the scene's size; larger ones are ground. Derived from the
/// surroundings of a body, which then reach over at most a quarter of the scene.
constexpr double small_body = 0.125;
/// Surroundings with at most this share of a room's area are a room of their own. Derived from sums of squares: the
/// error of a part with a larger share is at most twice that of the room.
constexpr double max_share = 0.25;
/// Maximum number of bodies with surroundings. Derived from the number of elements around them: some thousands in a
/// coarse mesh.
constexpr std::size_t max_bodies = 64;

double radius_around(const Point& centre, std::span<const Point> corners, double radius) {
    for (const Point& corner : corners) radius = std::max(radius, norm(corner - centre));
    return radius;
}

/// Box about a ball, larger by more than the rounding error of distances.
Box box_about(const Point& centre, double radius) {
    constexpr double rounding = 1e-12;  // derived from double precision
    const double size = std::max({std::abs(centre.x), std::abs(centre.y), std::abs(centre.z), radius});
    const double r = radius + rounding * size;
    Box box;
    box.add(centre - Vec3{r, r, r}), box.add(centre + Vec3{r, r, r});
    return box;
}

/// Returns, for every body, the share of its light that reaches the sky: four rays from each of at most 64 pieces.
std::vector<double> shares_to_sky(const Stage& stage, const SceneBodies& bodies) {
    constexpr std::size_t pieces_of_body = 64, rays = 4;
    std::vector<std::vector<std::size_t>> of_body(bodies.all.size());
    for (std::size_t k = 0; k < stage.pieces.size(); ++k)
        of_body[bodies.of(stage.scene, stage.pieces[k].region)].push_back(k);
    std::vector<double> out(of_body.size());
    parallel_for(out.size(), 1, [&](std::size_t b) {
        const ScrambledSobol points(b);
        double all = 0, to_sky = 0;  // m^2
        const std::size_t stride = (of_body[b].size() + pieces_of_body - 1) / pieces_of_body;
        std::uint32_t k = 0;
        for (std::size_t i = 0; i < of_body[b].size(); i += stride) {
            const Piece& piece = stage.pieces[of_body[b][i]];
            const Frame frame(stage.scene.regions()[piece.region].plane.n);
            std::array<Vec3, rays> directions;
            std::array<RayHit, rays> hits;
            for (Vec3& w : directions) w = cosine_direction(frame, points(k, 0), points(k, 1)), ++k;
            stage.tracer.nearest(directions, piece.patch.centre(), piece.region, hits);
            for (const RayHit& hit : hits)
                all += piece.patch.area(), to_sky += hit.surface.is_none() ? piece.patch.area() : 0;
        }
        out[b] = all > 0 ? to_sky / all : 0;
    });
    return out;
}

}  // namespace

BodySurroundings::BodySurroundings(const Stage& stage) {
    const Scene& scene = stage.scene;
    if (scene.distant().domes.empty()) return;
    const SceneBodies bodies = find_bodies(scene);
    std::vector<double> radius(bodies.all.size());
    for (SurfaceId s : scene.surfaces().ids()) {
        double& r = radius[bodies.body[s]];
        r = radius_around(bodies.all[bodies.body[s]].centre, scene.outline(s), r);
    }
    // Share of a body's light that reaches the sky, from which it is outdoors. Derived from two cases: a house whose
    // inner walls belong to it sends a quarter of its light to the sky, and furniture behind windows a few percent.
    constexpr double min_share_to_sky = 0.1;
    const std::vector<double> to_sky = shares_to_sky(stage, bodies);
    double of_ground = 0, all = 0;  // m^2
    struct Found {
        Ball ball;
        SurfaceId body;
    };
    std::vector<Found> found;
    for (std::size_t b = 0; b < radius.size(); ++b) {
        const bool is_ground = radius[b] > small_body * scene.size();
        all += bodies.all[b].area, of_ground += is_ground ? bodies.all[b].area : 0;
        if (!is_ground && to_sky[b] >= min_share_to_sky)
            found.push_back({{bodies.all[b].centre, 2 * radius[b]}, bodies.all[b].first});
    }
    if (2 * of_ground < all) return;
    std::stable_sort(found.begin(), found.end(),
                     [](const Found& a, const Found& b) { return a.ball.radius > b.ball.radius; });
    double around = 0;  // area of a ground within the balls, m^2
    for (const Found& next : found) {
        if (balls_.size() == max_bodies) break;
        // such as a bench beside a house
        if (std::any_of(balls_.begin(), balls_.end(), [&](const Ball& b) { return holds(b, next.ball.centre); }))
            continue;
        balls_.push_back(next.ball), bodies_.push_back(next.body), around += pi * next.ball.radius * next.ball.radius;
    }
    if (around > max_share * all) balls_.clear(), bodies_.clear();
    std::vector<Box> boxes;
    for (const Ball& ball : balls_) boxes.push_back(box_about(ball.centre, ball.radius));
    tree_ = Bvh(boxes);
}

bool BodySurroundings::holds(const Ball& ball, const Point& x) {
    return norm(x - ball.centre) <= ball.radius;
}

bool BodySurroundings::contain(const Point& x) const {
    return tree_.visit_box(box_about(x, 0), [&](std::uint32_t b) { return holds(balls_[b], x); });
}

void BodySurroundings::refine(ElementTree& tree, const StopRequest* stop) const {
    // Largest extent of an element over the radius of the ball. Derived from the number of elements: some 50 of them
    // cover the ground within a ball.
    constexpr double coarsest = 0.25;
    if (are_empty()) return;
    std::vector<ElementId> open = tree.leaves();
    while (!open.empty() && !(stop && stop->requested())) {
        const ElementId e = open.back();
        open.pop_back();
        const Point centre = tree.patch(e).at(tree.centre(e));
        const double extent = radius_around(centre, tree.outline(e), 0);
        const bool is_coarse = tree_.visit_box(box_about(centre, extent), [&](std::uint32_t b) {
            const Ball& ball = balls_[b];
            return extent > coarsest * ball.radius && norm(centre - ball.centre) <= ball.radius + extent;
        });
        if (is_coarse)
            for (ElementId child : refine_element(tree, e)) open.push_back(child);
    }
}

BodySurroundings::Division BodySurroundings::divide(std::span<const std::size_t> room_of, std::size_t rooms,
                                                    const CoarseElements& in) const {
    Division out{{room_of.begin(), room_of.end()}, rooms};
    if (are_empty()) return out;
    struct Room {
        double all = 0, near = 0, to_sky = 0;  // m^2
    };
    std::vector<Room> sums(rooms);
    std::vector<std::uint8_t> is_near(room_of.size());
    for (std::size_t i = 0; i < room_of.size(); ++i) {
        const ElementId e = in.numbering.leaves[i];
        const double area = in.tree.area(e);
        const auto rays = static_cast<double>(std::max<std::size_t>(in.rows.hits(i).size(), 1));
        is_near[i] = contain(in.tree.patch(e).at(in.tree.centre(e))) ? 1 : 0;
        Room& room = sums[room_of[i]];
        room.all += area, room.near += is_near[i] * area, room.to_sky += area * in.escaped[i] / rays;
    }
    std::vector<std::size_t> near_room(rooms);  // room of the near part of each room; the room itself if undivided
    for (std::size_t r = 0; r < rooms; ++r) {
        const Room& room = sums[r];
        const bool is_divided =
            room.near > 0 && room.near <= max_share * room.all && room.to_sky >= outdoors * room.all;
        near_room[r] = is_divided ? out.rooms++ : r;
    }
    for (std::size_t i = 0; i < room_of.size(); ++i)
        if (is_near[i]) out.room_of[i] = near_room[room_of[i]];
    return out;
}

}  // namespace exitance
