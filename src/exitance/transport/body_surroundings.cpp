#include "exitance/transport/body_surroundings.hpp"

#include <algorithm>
#include <array>

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
    std::vector<Ball> found;
    for (std::size_t b = 0; b < radius.size(); ++b) {
        const bool is_ground = radius[b] > small_body * scene.size();
        all += bodies.all[b].area, of_ground += is_ground ? bodies.all[b].area : 0;
        if (!is_ground && to_sky[b] >= min_share_to_sky) found.push_back({bodies.all[b].centre, 2 * radius[b]});
    }
    if (2 * of_ground < all) return;
    std::stable_sort(found.begin(), found.end(), [](const Ball& a, const Ball& b) { return a.radius > b.radius; });
    double around = 0;  // area of a ground within the balls, m^2
    for (const Ball& ball : found) {
        if (balls_.size() == max_bodies) break;
        if (contain(ball.centre)) continue;  // such as a bench beside a house
        balls_.push_back(ball), around += pi * ball.radius * ball.radius;
    }
    if (around > max_share * all) balls_.clear();
}

bool BodySurroundings::contain(const Point& x) const {
    return std::any_of(balls_.begin(), balls_.end(),
                       [&](const Ball& ball) { return norm(x - ball.centre) <= ball.radius; });
}

void BodySurroundings::refine(ElementTree& tree) const {
    // Largest extent of an element over the radius of the ball. Derived from the number of elements: some 50 of them
    // cover the ground within a ball.
    constexpr double coarsest = 0.25;
    std::vector<ElementId> open = tree.leaves();
    while (!open.empty()) {
        const ElementId e = open.back();
        open.pop_back();
        const Point centre = tree.patch(e).at(tree.centre(e));
        const double extent = radius_around(centre, tree.outline(e), 0);
        const bool is_coarse = std::any_of(balls_.begin(), balls_.end(), [&](const Ball& ball) {
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
    for (std::size_t r = 0; r < rooms; ++r) {
        if (sums[r].near == 0 || sums[r].near > max_share * sums[r].all || sums[r].to_sky < outdoors * sums[r].all)
            continue;
        for (std::size_t i = 0; i < room_of.size(); ++i)
            if (room_of[i] == r && is_near[i]) out.room_of[i] = out.rooms;
        ++out.rooms;
    }
    return out;
}

}  // namespace exitance
