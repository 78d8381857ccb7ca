#include "exitance/scene/inside_out.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "exitance/scene/hull.hpp"

namespace exitance {
namespace {

constexpr double corner_tolerance = 1e-6;  ///< Relative to the scene's size: nearer corners are equal.

/// A connected part of space, with the face sides that bound it.
struct Space {
    std::vector<FaceSide> walls;        ///< Sides of faces that have this space on one side only.
    std::vector<std::uint32_t> sheets;  ///< Faces with this space on both sides.
    double volume = 0;                  ///< m^3; negative if the space is outside of the walls.
    Box box;
    bool is_sure = true;

    bool is_cavity() const { return is_sure && volume > 0 && !walls.empty(); }
};

class BodyFinder {
  public:
    explicit BodyFinder(const BodyFaces& in)
        : in_(in),
          borders_(bordered(in), corner_tolerance * in.size),
          turned_(in.outlines.size()),
          box_of_face_(in.outlines.size()) {
        for (std::size_t f = 0; f < in.outlines.size(); ++f) box_of_face_[f] = box_of(in.outlines[f]);
        face_tree_ = Bvh(box_of_face_);
        find_emitters();
        find_spaces();
    }
    std::vector<InsideOut> run();

  private:
    static std::vector<BorderedFace> bordered(const BodyFaces& in) {
        std::vector<BorderedFace> out;
        for (std::size_t f = 0; f < in.outlines.size(); ++f)
            out.push_back({.loops = {in.outlines[f]}, .triangles = {}, .n = in.normals[f]});
        return out;
    }
    void find_emitters();
    void find_spaces();
    void measure(Space& space) const;
    bool is_front(const FaceSide& side) const { return side.is_front != turned_[side.face]; }
    double share_of_fronts(std::size_t space);
    double count_fronts(const Space& space) const;
    void turn(const std::vector<std::uint32_t>& faces);
    bool holds(std::size_t space, const Point& p);
    Point point_within(const Space& space) const;
    std::optional<std::size_t> space_around(std::size_t space);
    bool holds_light(std::size_t space);
    bool holds_faces(std::size_t space);
    Point place_of_light(std::uint32_t f) const;
    std::vector<std::uint32_t> cavities_around(const Point& p) const;
    bool is_in_any_cavity(const Point& p);
    bool has_light_outside();
    bool is_alone(std::size_t space);
    bool is_inward_body(std::size_t space);
    bool is_outward_room(std::size_t space);

    const BodyFaces& in_;
    Borders borders_;
    std::vector<std::array<std::uint32_t, 2>> space_of_;
    std::vector<Space> spaces_;
    std::vector<std::uint32_t> cavities_;     ///< Sorted by volume, the smallest first.
    std::vector<std::optional<Hull>> hulls_;  ///< Hulls of cavities, built on demand.
    std::vector<bool> turned_;
    std::vector<Box> box_of_face_;
    Bvh face_tree_;
    std::vector<std::uint32_t> emitters_;    ///< Faces that emit.
    Bvh emitter_tree_;                       ///< Boxes around the centroids of `emitters_`.
    Bvh cavity_tree_;                        ///< Boxes of `cavities_`.
    std::optional<bool> has_light_outside_;  ///< Result of `has_light_outside`; empty until needed, and after a turn.
    std::vector<std::optional<double>> fronts_;  ///< Results of `share_of_fronts`; empty until needed.
};

void BodyFinder::find_emitters() {
    const Vec3 beside = 10 * corner_tolerance * in_.size * Vec3{1, 1, 1};
    std::vector<Box> places;
    for (std::uint32_t f = 0; f < in_.emits.size(); ++f) {
        if (!in_.emits[f]) continue;
        const Point at = centroid(in_.outlines[f]);
        emitters_.push_back(f), places.push_back({at - beside, at + beside});
    }
    emitter_tree_ = Bvh(places);
}

void BodyFinder::find_spaces() {
    const Borders::Parts parts = borders_.parts();
    space_of_ = parts.part_of;
    spaces_.resize(parts.is_sure.size());
    hulls_.resize(spaces_.size()), fronts_.resize(spaces_.size());
    for (std::size_t k = 0; k < spaces_.size(); ++k) spaces_[k].is_sure = parts.is_sure[k];
    for (std::uint32_t f = 0; f < space_of_.size(); ++f) {
        if (space_of_[f][0] == space_of_[f][1]) {
            spaces_[space_of_[f][0]].sheets.push_back(f);
            continue;
        }
        for (const bool front : {false, true}) spaces_[space_of_[f][front ? 1 : 0]].walls.push_back({f, front});
    }
    for (std::uint32_t k = 0; k < spaces_.size(); ++k) {
        measure(spaces_[k]);
        if (spaces_[k].is_cavity()) cavities_.push_back(k);
    }
    std::sort(cavities_.begin(), cavities_.end(), [&](auto a, auto b) {
        return spaces_[a].volume < spaces_[b].volume || (spaces_[a].volume == spaces_[b].volume && a < b);
    });
    std::vector<Box> boxes;
    for (const std::uint32_t k : cavities_) boxes.push_back(spaces_[k].box);
    cavity_tree_ = Bvh(boxes);
}

void BodyFinder::measure(Space& space) const {
    for (const FaceSide& side : space.walls)
        space.box.add(box_of_face_[side.face].lo), space.box.add(box_of_face_[side.face].hi);
    if (space.walls.empty()) return;
    const Point middle = space.box.centre();
    double all = 0;
    for (const FaceSide& side : space.walls) {
        const std::vector<Point>& outline = in_.outlines[side.face];
        const double cone = dot(outline[0] - middle, area_vector(outline)) / 3;
        space.volume += side.is_front ? -cone : cone;
        all += norm(outline[0] - middle) * norm(area_vector(outline)) / 3;
    }
    constexpr double rounding = 1e-6;  // relative to the largest cones: the two sides of a sheet enclose no volume
    if (std::abs(space.volume) <= rounding * all) space.volume = 0;
}

double BodyFinder::share_of_fronts(std::size_t space) {
    if (!fronts_[space]) fronts_[space] = count_fronts(spaces_[space]);
    return *fronts_[space];
}

void BodyFinder::turn(const std::vector<std::uint32_t>& faces) {
    for (const std::uint32_t f : faces) {
        turned_[f] = true;
        for (const std::uint32_t space : space_of_[f]) fronts_[space].reset();
    }
    has_light_outside_.reset();
}

double BodyFinder::count_fronts(const Space& space) const {
    double fronts = 0, all = 0;
    for (const FaceSide& side : space.walls) {
        const double area = norm(area_vector(in_.outlines[side.face]));
        all += area, fronts += is_front(side) ? area : 0;
    }
    return all > 0 ? fronts / all : 0;
}

/// True if the point is in a cavity, or in an object inside it.
bool BodyFinder::holds(std::size_t space, const Point& p) {
    const Box& box = spaces_[space].box;
    for (std::size_t k = 0; k < 3; ++k)
        if (p[k] <= box.lo[k] || p[k] >= box.hi[k]) return false;
    std::optional<Hull>& hull = hulls_[space];
    if (!hull) {
        hull.emplace();
        for (const FaceSide& side : spaces_[space].walls)
            for (const Triangle& t : triangles_of(in_.outlines[side.face], in_.normals[side.face]))
                hull->add(side.is_front ? t : Triangle{t[0], t[2], t[1]});
        hull->finish();
    }
    return hull->winds_about(p);
}

/// Returns a point just inside of the walls, near the centre of the largest triangle.
Point BodyFinder::point_within(const Space& space) const {
    Point out;
    double largest = -1;
    for (const FaceSide& side : space.walls)
        for (const Triangle& t : triangles_of(in_.outlines[side.face], in_.normals[side.face])) {
            const double area = norm(cross(t[1] - t[0], t[2] - t[0]));
            if (area <= largest) continue;
            largest = area;
            const Vec3 inwards = side.is_front ? Vec3(in_.normals[side.face]) : -Vec3(in_.normals[side.face]);
            out = (t[0] + t[1] + t[2]) / 3 + 10 * corner_tolerance * in_.size * inwards;
        }
    return out;
}

/// The cavities whose boxes hold a point, the smallest cavity first.
std::vector<std::uint32_t> BodyFinder::cavities_around(const Point& p) const {
    std::vector<std::uint32_t> order;
    cavity_tree_.visit_box({p, p}, [&](std::uint32_t i) { order.push_back(i); });
    std::sort(order.begin(), order.end());
    for (std::uint32_t& i : order) i = cavities_[i];
    return order;
}

/// Returns the smallest other cavity that contains a cavity; nothing if it is in the open.
std::optional<std::size_t> BodyFinder::space_around(std::size_t space) {
    const Point p = point_within(spaces_[space]);
    for (const std::uint32_t k : cavities_around(p))
        if (k != space && spaces_[k].volume > spaces_[space].volume && holds(k, p)) return k;
    return std::nullopt;
}

/// Returns a point just in front of the middle of an emitting face, in its current orientation.
Point BodyFinder::place_of_light(std::uint32_t f) const {
    const Vec3 up = turned_[f] ? -Vec3(in_.normals[f]) : Vec3(in_.normals[f]);
    return centroid(in_.outlines[f]) + 10 * corner_tolerance * in_.size * up;
}

bool BodyFinder::holds_light(std::size_t space) {
    if (std::any_of(in_.lights.begin(), in_.lights.end(), [&](const Point& p) { return holds(space, p); })) return true;
    const auto sends_into = [&](std::uint32_t f) {
        if (space_of_[f][turned_[f] ? 0 : 1] == space) return true;
        return space_of_[f][0] != space && space_of_[f][1] != space && holds(space, place_of_light(f));
    };
    return emitter_tree_.visit_box(spaces_[space].box, [&](std::uint32_t i) { return sends_into(emitters_[i]); });
}

bool BodyFinder::holds_faces(std::size_t space) {
    if (!spaces_[space].sheets.empty()) return true;
    return face_tree_.visit_box(spaces_[space].box, [&](std::uint32_t f) {
        return space_of_[f][0] != space && space_of_[f][1] != space && holds(space, centroid(in_.outlines[f]));
    });
}

bool BodyFinder::is_in_any_cavity(const Point& p) {
    const std::vector<std::uint32_t> around = cavities_around(p);
    return std::any_of(around.begin(), around.end(), [&](std::uint32_t k) { return holds(k, p); });
}

/// True if light starts outside of all cavities.
bool BodyFinder::has_light_outside() {
    if (in_.has_light_from_afar) return true;
    if (!has_light_outside_)
        has_light_outside_ =
            std::any_of(in_.lights.begin(), in_.lights.end(), [&](const Point& p) { return !is_in_any_cavity(p); }) ||
            std::any_of(emitters_.begin(), emitters_.end(),
                        [&](std::uint32_t f) { return !is_in_any_cavity(place_of_light(f)); });
    return *has_light_outside_;
}

/// True if there is neither light nor a face outside of a cavity's walls.
bool BodyFinder::is_alone(std::size_t space) {
    if (in_.has_light_from_afar) return false;
    if (std::any_of(in_.lights.begin(), in_.lights.end(), [&](const Point& p) { return !holds(space, p); }))
        return false;
    for (std::uint32_t f = 0; f < in_.outlines.size(); ++f)
        if (space_of_[f][0] != space && space_of_[f][1] != space && !holds(space, centroid(in_.outlines[f])))
            return false;
    return true;
}

/// True if all fronts of a cavity's walls are inside, although their backs face air.
bool BodyFinder::is_inward_body(std::size_t k) {
    const Space& space = spaces_[k];
    if (!std::all_of(space.walls.begin(), space.walls.end(), [&](const FaceSide& s) { return is_front(s); }))
        return false;
    const std::size_t outside = space_of_[space.walls[0].face][space.walls[0].is_front ? 0 : 1];
    const Space& around = spaces_[outside];
    const bool is_one = std::all_of(space.walls.begin(), space.walls.end(), [&](const FaceSide& s) {
        return space_of_[s.face][s.is_front ? 0 : 1] == outside;
    });
    if (!is_one || !around.is_sure) return false;
    constexpr double majority = 0.5;
    // a cavity next to a room: its walls touch those of the room
    if (around.is_cavity()) return share_of_fronts(outside) > majority;
    if (!(around.volume <= -majority * space.volume)) return false;  // two sides of a thin wall, or an open model
    if (const auto room = space_around(k)) return share_of_fronts(*room) > majority;
    return share_of_fronts(outside) == 0 && has_light_outside() && !holds_light(k) && !holds_faces(k);
}

/// True if all fronts of a cavity's walls are outside, but the light is inside.
bool BodyFinder::is_outward_room(std::size_t k) {
    const Space& space = spaces_[k];
    if (std::any_of(space.walls.begin(), space.walls.end(), [&](const FaceSide& s) { return is_front(s); }))
        return false;
    return holds_light(k) || (!emitters_.empty() && is_alone(k));
}

std::vector<InsideOut> BodyFinder::run() {
    std::vector<InsideOut> out;
    // A body can be classified only if the bodies around it have the right orientation. Each round completes one level
    // of nesting, from the outside inwards.
    for (bool changed = true; std::exchange(changed, false);)
        for (auto k = cavities_.rbegin(); k != cavities_.rend(); ++k) {
            const bool is_room = is_outward_room(*k);
            if (!is_room && !is_inward_body(*k)) continue;
            InsideOut body{{}, is_room};
            for (const FaceSide& side : spaces_[*k].walls) body.faces.push_back(side.face);
            std::sort(body.faces.begin(), body.faces.end());
            const bool is_new = std::none_of(body.faces.begin(), body.faces.end(), [&](auto f) { return turned_[f]; });
            if (!is_new) continue;  // each face is turned at most once
            turn(body.faces);
            out.push_back(std::move(body));
            changed = true;
        }
    return out;
}

}  // namespace

void BodyFaces::add_lights(std::span<const PunctualLight> all, const DistantLight& distant) {
    has_light_from_afar = !distant.empty();
    for (const PunctualLight& light : all) {
        if (light.is_directional())
            has_light_from_afar = true;
        else
            lights.push_back(light.position);
    }
}

std::vector<InsideOut> find_inside_out(const BodyFaces& faces) {
    return BodyFinder(faces).run();
}

}  // namespace exitance
