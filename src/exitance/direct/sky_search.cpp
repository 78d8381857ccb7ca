#include "exitance/direct/sky_search.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "exitance/base/polygon.hpp"
#include "exitance/base/random.hpp"

namespace exitance {
namespace {

// The sizes of the search below are compromises between its time and the smallest openings that it finds. They were
// chosen by trial and not measured by a command.

constexpr unsigned directions_of_point = 64;  ///< Directions that measure how much of the sky a point sees.
/// The rim of an opening is looked for at this number of azimuths, each in this number of steps from its middle to the
/// horizon. Bisections then refine the position of the rim, and that of the opening along a ray.
constexpr unsigned azimuths = 48, steps_of_azimuth = 24, halvings = 16;

/// A point at which at least this share of all directions leads to the sky is at an opening. Derived from the plane of
/// a window above a ground, where the share is a quarter: half of that marks a point just indoors.
constexpr double seen_at_opening = 1.0 / 8;

/// Points of a rim that are farther away than this multiple of the distance of the nearest quarter of them belong to
/// objects outdoors, such as the horizon.
constexpr double farthest_rim = 4;

/// Returns the rectangle of an opening, from points of its rim relative to `from`; one of area 0 if these points do not
/// determine it.
/// farthest  points at more than this multiple of the distance of the nearest quarter are ignored
PortalCell rectangle_of_rim(const Point& from, const Vec3& outwards, std::vector<Vec3> rim, double farthest) {
    constexpr std::size_t fewest = 12;  // points from which a rectangle can be found
    // Cosine below which points are too near the horizon to be projected; derived from the distance of such points, a
    // thousand times that of the plane.
    constexpr double edge_on = 1e-3;
    if (rim.size() < fewest) return {};
    std::vector<double> distances;
    for (const Vec3& p : rim) distances.push_back(norm(p));
    const auto quarter = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 4);
    std::nth_element(distances.begin(), quarter, distances.end());
    const double most = farthest * *quarter;
    std::erase_if(rim, [&](const Vec3& p) { return norm(p) > most; });
    if (rim.size() < fewest) return {};
    const Vec3 middle = std::accumulate(rim.begin(), rim.end(), Vec3()) / static_cast<double>(rim.size());
    Vec3 area;
    for (std::size_t k = 0; k < rim.size(); ++k) area += cross(rim[k] - middle, rim[(k + 1) % rim.size()] - middle);
    if (!(norm(area) > 0)) return {};
    const Normal n = normalized(dot(area, outwards) < 0 ? -area : area);
    const double height = dot(middle, n);
    if (!(height > 0)) return {};
    const Frame frame(n);
    std::vector<Vec2> points;
    for (const Vec3& p : rim) {  // `rim` is relative to the point from which the rim was seen
        const double along = dot(p, n);
        if (along < edge_on * norm(p)) continue;
        const Vec3 q = height / along * p - middle;
        points.push_back({dot(q, frame.u), dot(q, frame.v)});
    }
    return points.size() < fewest ? PortalCell() : rectangle_around(from + middle, frame, points);
}

}  // namespace

std::uint64_t SkySearch::key(const SearchPlace& place, std::uint64_t of) {
    const auto bits = [](double c) { return std::bit_cast<std::uint64_t>(c); };
    return hash(bits(place.x.x), bits(place.x.y), bits(place.x.z), place.own.value, of);
}

/// Places on all polygons: half of them spread by area, half of them evenly over polygons.
std::vector<SearchPlace> SkySearch::places(std::size_t count) const {
    std::vector<PieceId> pieces;
    std::vector<double> before{0};
    for (std::uint32_t i = 0; i < occluders_.pieces().size(); ++i) {
        const PieceId piece(i);
        if (occluders_.is_distant(piece) || occluders_.is_window(piece)) continue;
        if (occluders_.enclosure().holds(occluders_.pieces()[piece].region)) continue;
        pieces.push_back(piece);
        before.push_back(before.back() + norm(area_vector(occluders_.corners(piece))));
    }
    std::vector<SearchPlace> out;
    if (!(before.back() > 0)) return out;
    const ScrambledSobol points(hash(static_cast<std::uint64_t>(Stream::direct), count));
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t half = count / 2;
        const double share = (static_cast<double>(i % half) + 0.5) / static_cast<double>(half);
        std::size_t k = static_cast<std::size_t>(share * static_cast<double>(pieces.size()));
        if (i < half)
            k = static_cast<std::size_t>(std::upper_bound(before.begin() + 1, before.end() - 1, share * before.back()) -
                                         before.begin()) -
                1;
        const ConvexPiece& piece = occluders_.pieces()[pieces[k]];
        const double area = before[k + 1] - before[k];
        if (!(area > 0)) continue;
        const auto number = static_cast<std::uint32_t>(i);
        out.push_back({uniform_on(occluders_.corners(pieces[k]), area, points(number, 0), points(number, 1)),
                       piece.plane.n, piece.region});
    }
    return out;
}

std::uint64_t SkySearch::arriving(std::size_t count) {
    tracer_.occluded(from_, to_, std::span(blocked_).first(count));
    std::uint64_t out = 0;
    for (std::size_t k = 0; k < count; ++k)
        if (!blocked_[k]) out |= std::uint64_t{1} << number_[k];
    from_.clear(), to_.clear(), number_.clear();
    return out;
}

Vec3 SkySearch::direction(const SearchPlace& place, std::uint32_t k) {
    const ScrambledSobol points(key(place, 0));
    sky_.aim(place.n, aim_);
    return sky_.direction(aim_, points(k, 0), points(k, 1)).w;
}

void SkySearch::cast_to_sky(SearchPlace& place, std::uint32_t rays) {
    sky_.aim(place.n, aim_);
    if (!(aim_.weight[0] > 0)) return;
    for (std::uint32_t k = 0; k < rays; ++k) {
        const Vec3 w = direction(place, k);
        if (dot(w, place.n) <= 0) continue;
        number_.push_back(k);
        from_.push_back({place.x, place.own}), to_.push_back({place.x + reach(place.x) * w, RegionId()});
    }
    place.sky = arriving(from_.size());
}

void SkySearch::cast_to_suns(SearchPlace& place) {
    const ScrambledSobol points(key(place, 1));
    for (std::uint32_t k = 0; k < rays_of_place; ++k) {
        const SunDisc& sun = suns_[k % suns_.size()];
        const Vec3 d = sun.seen->at(points(k, 0), points(k, 1)) - sun.from;
        if (dot(d, place.n) <= 0) continue;
        number_.push_back(k);
        from_.push_back({place.x, place.own}), to_.push_back({place.x + reach(place.x) / norm(d) * d, RegionId()});
    }
    place.sun = arriving(from_.size());
}

void SkySearch::cast_through(const SearchPlace& place, std::span<const PortalCell> openings, std::span<Seen> out) {
    const ScrambledSobol points(key(place, 2));
    for (std::uint32_t k = 0; k < openings.size(); ++k) {
        const PortalCell& opening = openings[k];
        const Vec3 d = opening.corner + points(k, 0) * opening.u + points(k, 1) * opening.v - place.x;
        if (dot(d, place.n) <= 0 || dot(d, opening.n) <= 0) continue;
        out[k].rays += 1;
        number_.push_back(k);
        from_.push_back({place.x, place.own}), to_.push_back({place.x + reach(place.x) / norm(d) * d, RegionId()});
    }
    for (std::uint64_t left = arriving(from_.size()); left != 0; left &= left - 1)
        out[static_cast<std::size_t>(std::countr_zero(left))].arrived += 1;
}

double SkySearch::seen_share(const Point& at) {
    static const std::vector<Vec3> directions = directions_all_around(directions_of_point);
    hits_.resize(directions.size());
    tracer_.nearest(directions, at, RegionId(), hits_);
    const auto seen =
        std::count_if(hits_.begin(), hits_.end(), [](const RayHit& hit) { return hit.surface.is_none(); });
    return static_cast<double>(seen) / directions_of_point;
}

/// The first point of the ray where an eighth of all directions leads to the sky.
Point SkySearch::before_opening(const Escape& way) {
    constexpr int doublings = 20;
    double near = 0, far = 0x1p-18 * size_;
    for (int i = 0; i < doublings && seen_share(way.from + far * way.direction) < seen_at_opening; ++i)
        near = far, far *= 2;
    for (unsigned i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (near + far);
        (seen_share(way.from + middle * way.direction) < seen_at_opening ? near : far) = middle;
    }
    return way.from + far * way.direction;
}

/// Finds the border of the open directions around frame.n: for each azimuth the first hit that is not open, relative
/// to `from`. Azimuths without one are left out.
template <class IsOpen>
std::vector<Vec3> SkySearch::rim(const Point& from, const Frame& frame, const IsOpen& is_open) {
    const auto tilted = [&](unsigned azimuth, double angle) {
        const double phi = 2 * pi * azimuth / azimuths;
        return frame.to_world(std::sin(angle) * std::cos(phi), std::sin(angle) * std::sin(phi), std::cos(angle));
    };
    const auto is_passed = [&](std::size_t k, const Vec3& w) {
        return hits_[k].surface.is_none() || is_open(hits_[k].distance * w);
    };
    constexpr double step = 0.5 * pi / steps_of_azimuth;
    std::vector<Vec3> directions;
    for (unsigned a = 0; a < azimuths; ++a)
        for (unsigned k = 1; k <= steps_of_azimuth; ++k) directions.push_back(tilted(a, k * step));
    hits_.resize(directions.size());
    tracer_.nearest(directions, from, RegionId(), hits_);
    std::vector<Vec3> found(azimuths);
    std::vector<double> open(azimuths), blocked(azimuths);
    for (unsigned a = 0; a < azimuths; ++a) {
        unsigned k = 0;
        while (k < steps_of_azimuth && is_passed(a * steps_of_azimuth + k, directions[a * steps_of_azimuth + k])) ++k;
        open[a] = k * step, blocked[a] = (k + 1) * step;
        if (k < steps_of_azimuth)
            found[a] = hits_[a * steps_of_azimuth + k].distance * directions[a * steps_of_azimuth + k];
    }
    directions.resize(azimuths), hits_.resize(azimuths);
    for (unsigned i = 0; i < halvings; ++i) {
        for (unsigned a = 0; a < azimuths; ++a) directions[a] = tilted(a, 0.5 * (open[a] + blocked[a]));
        tracer_.nearest(directions, from, RegionId(), hits_);
        for (unsigned a = 0; a < azimuths; ++a) {
            const bool passes = is_passed(a, directions[a]);
            (passes ? open[a] : blocked[a]) = 0.5 * (open[a] + blocked[a]);
            if (!passes) found[a] = hits_[a].distance * directions[a];
        }
    }
    std::erase(found, Vec3());
    return found;
}

PortalCell SkySearch::opening(const Escape& way) {
    // Distance from which the whole rim is seen, as a share of the opening's size. Chosen: half of it takes 4% more
    // rays and twice it 8% fewer, measured by `exitance solve house.obj --error 0.1` for a house below a picture of
    // the sky.
    constexpr double before = 0.25;
    const Point first = before_opening(way);
    const std::vector<Vec3> first_rim = rim(first, Frame(way.direction), [](const Vec3&) { return false; });
    const PortalCell seen = rectangle_of_rim(first, way.direction, first_rim, farthest_rim);
    if (!(seen.area > 0)) return {};
    // Seen from close to the opening's middle, nothing hides its rim, and everything beyond its plane is outdoors.
    const double step = before * std::sqrt(seen.area);
    const Point from = seen.corner + 0.5 * (seen.u + seen.v) - step * seen.n;
    const auto is_outdoors = [&](const Vec3& hit) { return dot(hit, seen.n) > 2 * step; };
    PortalCell out = rectangle_of_rim(from, seen.n, rim(from, Frame(seen.n), is_outdoors), HUGE_VAL);
    out.light = 1;
    return out.area > 0 && passes_near(way.from, way.direction, out) ? out : PortalCell();
}

}  // namespace exitance
