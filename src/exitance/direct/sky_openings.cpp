#include "exitance/direct/sky_openings.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "exitance/base/polygon.hpp"
#include "exitance/base/random.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/visibility/portal_aim.hpp"

namespace exitance {
namespace {

// The sizes of the search below are compromises between its time and the smallest openings that it finds. They were
// chosen by trial and not measured by a command.

/// Places from which the sky is looked for: in the first test whether a search is worthwhile, and in the search.
constexpr std::size_t first_places = 512, max_places = 8192;
/// Parts into which openings near a place are cut: every ray to the sky is compared with all of them.
constexpr std::size_t max_parts = 12;
constexpr std::uint32_t rays_of_place = 64;  ///< Number of rays per place to the sky; as many go to all suns together.
constexpr int few_rays = 4;               ///< Maximum number of escaping rays of a place that sees little of the sky.
constexpr std::size_t ways_of_place = 2;  ///< Maximum number of escaping rays of a place that are followed.
/// Limits on the openings that are found, and on the cells into which they are divided.
constexpr std::size_t max_openings = 128, max_cells = 512;
constexpr std::size_t max_attempts = 512;     ///< Maximum number of escaping rays that are followed in the whole scene.
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

/// Openings are searched only if more than this share of the first places sees no sky. Chosen: half of it and twice
/// it give the same light, measured by `exitance solve house.obj --error 0.1` for a house below a picture of the sky.
constexpr double few_dark_places = 1.0 / 64;

struct SearchPlace {
    Point x;
    Normal n;
    RegionId own;
    std::uint64_t sky = 0;  ///< Bit k: ray k to the sky arrives.
    std::uint64_t sun = 0;
};

/// A ray from a place to the sky.
struct Escape {
    Point from;
    Vec3 direction;
};

/// Casts the rays of the search.
class SkySearch {
  public:
    SkySearch(const Occluders& occluders, const RayTracer& tracer, const SkyTree& sky,
              std::span<const SkyOpenings::Sun> suns)
        : occluders_(occluders), tracer_(tracer), sky_(sky), suns_(suns), size_(occluders.scene().size()) {}

    std::vector<SearchPlace> places(std::size_t count) const;
    void cast_to_sky(SearchPlace& place, std::uint32_t rays);
    void cast_to_suns(SearchPlace& place);
    /// Direction of ray k to the sky from a place.
    Vec3 direction(const SearchPlace& place, std::uint32_t k);
    /// The opening through which a ray escapes; of area 0 if its rim is not found.
    PortalCell opening(const Escape& way);

  private:
    static std::uint64_t key(const SearchPlace& place, std::uint64_t of) {
        const auto bits = [](double c) { return std::bit_cast<std::uint64_t>(c); };
        return hash(bits(place.x.x), bits(place.x.y), bits(place.x.z), place.own.value, of);
    }
    double reach(const Point& x) const { return 2 * (size_ + norm(x - occluders_.middle())); }
    std::uint64_t arriving(std::size_t count);
    double seen_share(const Point& at);
    Point before_opening(const Escape& way);
    template <class IsOpen>
    std::vector<Vec3> rim(const Point& from, const Frame& frame, const IsOpen& is_open);

    const Occluders& occluders_;
    const RayTracer& tracer_;
    const SkyTree& sky_;
    std::span<const SkyOpenings::Sun> suns_;
    double size_;
    SkyTree::Aim aim_;
    std::vector<RayEnd> from_, to_;
    std::vector<std::uint32_t> number_;
    std::vector<RayHit> hits_;
    std::array<bool, rays_of_place> blocked_{};
};

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
        const SkyOpenings::Sun& sun = suns_[k % suns_.size()];
        const Vec3 d = sun.seen->at(points(k, 0), points(k, 1)) - sun.from;
        if (dot(d, place.n) <= 0) continue;
        number_.push_back(k);
        from_.push_back({place.x, place.own}), to_.push_back({place.x + reach(place.x) / norm(d) * d, RegionId()});
    }
    place.sun = arriving(from_.size());
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

/// Share of rays of density cos / pi about n that lead from x to a parallelogram before it. Exact where the distant
/// form does not hold: near the parallelogram, and where the horizon of x cuts it.
double share_of(const PortalCell& cell, const Point& x, const Normal& n) {
    if (const double distant = PortalAim::form_factor(cell, x, n); distant > 0) return distant;
    const Vec3 to = cell.corner - x;
    return std::abs(contour_sum(n, std::array{to, to + cell.u, to + cell.u + cell.v, to + cell.v}));
}

/// Places and a mean square of what rays miss at them.
struct MissedSquare {
    double mean = 0, places = 0;
};

/// Returns the mean square of the share of rays n to 2n that escape, over places where rays 0 to n - 1 were blocked,
/// and over the places that `before` stands for.
template <class Place>
double mean_square_hidden(std::span<Place> places, std::uint32_t n, std::uint64_t Place::*arriving,
                          const MissedSquare& before) {
    const std::uint64_t first = (std::uint64_t{1} << n) - 1;
    double sum = before.places * before.mean, count = before.places;
    for (const Place& place : places) {
        const std::uint64_t bits = place.*arriving;
        if ((bits & first) != 0) continue;
        const double found = std::popcount((bits >> n) & first);
        sum += found * (found - 1) / (1.0 * n * (n - 1.0)), count += 1;
    }
    return sum / count;
}

/// Root mean squares for n = 2, 4, ... rays. At all places together one more escaping ray is assumed, so that the
/// result is above 0. A part of them (`all` is then their result) counts with some places that miss as much as all do,
/// since it may have few places that found nothing.
template <class Place>
std::vector<double> hidden_after(std::span<Place> places, std::uint64_t Place::*arriving,
                                 const std::vector<double>* all = nullptr) {
    constexpr double places_like_all = 16;
    std::vector<double> out;
    for (std::uint32_t n = 2; n <= rays_of_place / 2; n *= 2) {
        const double one_ray = 1.0 / n, of_all = all ? (*all)[out.size()] : one_ray;
        const MissedSquare before{of_all * of_all, all ? places_like_all : 1};
        out.push_back(std::min(one_ray, std::sqrt(mean_square_hidden(places, n, arriving, before))));
    }
    return out;
}

}  // namespace

double SkyOpenings::Hidden::after(std::uint32_t n) const {
    const auto doublings = static_cast<std::size_t>(std::bit_width(n));  // the bit width b fulfils n >= 2^(b - 1)
    if (rms.empty() || doublings < 2) return 1.0 / std::max(n, 1u);
    const std::size_t last = std::min(doublings - 2, rms.size() - 1);
    return rms[last] * static_cast<double>(2u << last) / n;
}

double SkyOpenings::choose(const Point& x, const Normal& n, std::vector<PortalCell>& out) const {
    out.clear();
    std::vector<std::pair<double, std::uint32_t>> best;
    for (std::uint32_t i = 0; i < cells_.size(); ++i) {
        const bool is_indoors = dot(cells_[i].corner - x, cells_[i].n) > 0;
        const double share = is_indoors ? share_of(cells_[i], x, n) : 0;
        if (share > 0) best.push_back({-share, i});
    }
    double left_out = 0;
    if (best.size() > PortalAim::max_targets) {
        std::nth_element(best.begin(), best.begin() + PortalAim::max_targets, best.end());
        for (std::size_t k = PortalAim::max_targets; k < best.size(); ++k) left_out -= best[k].first;
        best.resize(PortalAim::max_targets);
    }
    std::sort(best.begin(), best.end());
    std::vector<PortalCell> chosen, parts;
    for (const auto& [share, i] : best) chosen.push_back(cells_[i]);
    const std::size_t max = std::max(chosen.size(), max_parts);
    for (const PortalCell& cell : cut_near_cells(chosen, x, max, parts)) {
        if (PortalAim::can_be_aimed_at(cell, x, n))
            out.push_back(cell);
        else
            left_out += share_of(cell, x, n);
    }
    return left_out;
}

SkyOpenings::SkyOpenings(const Occluders& occluders, const RayTracer& tracer, const SkyTree& sky,
                         std::span<const Sun> suns) {
    if (sky.empty()) return;
    SkySearch search(occluders, tracer, sky, suns);
    constexpr std::uint32_t first_rays = 16;
    std::vector<SearchPlace> places = search.places(first_places);
    for (SearchPlace& place : places) search.cast_to_sky(place, first_rays);
    const auto dark = std::count_if(places.begin(), places.end(), [](const SearchPlace& p) { return p.sky == 0; });
    if (static_cast<double>(dark) <= few_dark_places * static_cast<double>(places.size())) return;

    places = search.places(max_places);
    std::vector<Escape> ways;
    for (SearchPlace& place : places) {
        search.cast_to_sky(place, rays_of_place);
        if (!suns.empty()) search.cast_to_suns(place);
        if (std::popcount(place.sky) > few_rays) continue;
        std::uint64_t left = place.sky;
        for (std::size_t i = 0; i < ways_of_place && left != 0; ++i, left &= left - 1)
            ways.push_back({place.x, search.direction(place, static_cast<std::uint32_t>(std::countr_zero(left)))});
    }
    std::size_t attempts = 0, openings = 0;
    while (!ways.empty() && attempts++ < max_attempts && openings < max_openings) {
        const Escape way = ways[hash(attempts) % ways.size()];
        const PortalCell found = search.opening(way);
        if (!(found.area > 0)) continue;
        ++openings;
        std::erase_if(ways, [&](const Escape& other) { return passes_near(other.from, other.direction, found); });
        add_portal_cells(found, max_cells, cells_);
    }

    std::vector<Arrivals> arrivals;
    for (const SearchPlace& place : places) {
        std::uint64_t rest = place.sky;
        for (std::uint64_t left = place.sky; left != 0; left &= left - 1) {
            const auto k = static_cast<std::uint32_t>(std::countr_zero(left));
            const Vec3 w = search.direction(place, k);
            const bool is_known = std::any_of(cells_.begin(), cells_.end(), [&](const PortalCell& cell) {
                return dot(cell.corner - place.x, cell.n) > 0 && passes_near(place.x, w, cell, 0);
            });
            if (is_known) rest &= ~(std::uint64_t{1} << k);
        }
        arrivals.push_back({place.x, rest, place.sun});
    }
    const std::span<Arrivals> everywhere = arrivals;
    ScenePart all{{hidden_after(everywhere, &Arrivals::sky)}, {}};
    if (!suns.empty()) all.sun.rms = hidden_after(everywhere, &Arrivals::sun);
    parts_.clear();
    divide(0, everywhere, all);
}

/// Divides places at the median of their longest extent until there are few enough for a part.
void SkyOpenings::divide(std::uint32_t node, std::span<Arrivals> places, const ScenePart& all) {
    constexpr std::size_t places_of_part = 256;  // enough for a mean, few enough for a room of a house to have its own
    Box box;
    for (const Arrivals& place : places) box.add(place.x);
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k)
        if (box.hi[k] - box.lo[k] > box.hi[axis] - box.lo[axis]) axis = k;
    if (places.size() <= places_of_part || !(box.hi[axis] > box.lo[axis])) {
        ScenePart part{{hidden_after(places, &Arrivals::sky, &all.sky.rms)}, {}};
        if (!all.sun.rms.empty()) part.sun.rms = hidden_after(places, &Arrivals::sun, &all.sun.rms);
        divisions_[node] = {.first = static_cast<std::uint32_t>(parts_.size())};
        parts_.push_back(std::move(part));
        return;
    }
    const std::size_t half = places.size() / 2;
    std::nth_element(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(half), places.end(),
                     [&](const Arrivals& p, const Arrivals& q) { return p.x[axis] < q.x[axis]; });
    const auto first = static_cast<std::uint32_t>(divisions_.size());
    divisions_[node] = {axis, places[half].x[axis], first};
    divisions_.resize(first + 2);
    divide(first, places.first(half), all);
    divide(first + 1, places.subspan(half), all);
}

std::uint32_t SkyOpenings::part_at(const Point& x) const {
    std::uint32_t node = 0;
    while (divisions_[node].axis)
        node = divisions_[node].first + (x[*divisions_[node].axis] < divisions_[node].at ? 0 : 1);
    return divisions_[node].first;
}

}  // namespace exitance
