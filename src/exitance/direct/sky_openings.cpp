#include "exitance/direct/sky_openings.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

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
constexpr int few_rays = 4;               ///< Maximum number of escaping rays of a place that sees little of the sky.
constexpr std::size_t ways_of_place = 2;  ///< Maximum number of escaping rays of a place that are followed.
/// Limits on the openings that are found, and on the cells into which they are divided.
constexpr std::size_t max_openings = 128, max_cells = 512;
constexpr std::size_t max_attempts = 512;  ///< Maximum number of escaping rays that are followed in the whole scene.
/// Limit on the rays that find which openings are hidden from the parts of the scene.
constexpr std::size_t max_aimed = 262144;

/// Openings are searched only if more than this share of the first places sees no sky. Chosen: half of it and twice
/// it give the same light, measured by `exitance solve house.obj --error 0.1` for a house below a picture of the sky.
constexpr double few_dark_places = 1.0 / 64;

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
double mean_square_hidden(std::span<const SearchPlace> places, std::uint32_t n, std::uint64_t SearchPlace::*arriving,
                          const MissedSquare& before) {
    const std::uint64_t first = (std::uint64_t{1} << n) - 1;
    double sum = before.places * before.mean, count = before.places;
    for (const SearchPlace& place : places) {
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
std::vector<double> hidden_after(std::span<const SearchPlace> places, std::uint64_t SearchPlace::*arriving,
                                 const std::vector<double>* all = nullptr) {
    constexpr double places_like_all = 16;
    std::vector<double> out;
    for (std::uint32_t n = 2; n <= SkySearch::rays_of_place / 2; n *= 2) {
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
    if (cells_.empty()) return 0;
    const std::vector<bool>& is_hidden = parts_[part_at(x)].is_hidden;
    std::vector<std::pair<double, std::uint32_t>> best;
    for (std::uint32_t i = 0; i < cells_.size(); ++i) {
        const bool is_indoors = dot(cells_[i].corner - x, cells_[i].n) > 0;
        const double share = is_indoors && !is_hidden[opening_of_cell_[i]] ? share_of(cells_[i], x, n) : 0;
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
                         std::span<const SunDisc> suns) {
    if (sky.empty()) return;
    SkySearch search(occluders, tracer, sky, suns);
    constexpr std::uint32_t first_rays = 16;
    std::vector<SearchPlace> places = search.places(first_places);
    for (SearchPlace& place : places) search.cast_to_sky(place, first_rays);
    const auto dark = std::count_if(places.begin(), places.end(), [](const SearchPlace& p) { return p.sky == 0; });
    if (static_cast<double>(dark) <= few_dark_places * static_cast<double>(places.size())) return;

    places = search.places(max_places);
    for (SearchPlace& place : places) {
        search.cast_to_sky(place, SkySearch::rays_of_place);
        if (!suns.empty()) search.cast_to_suns(place);
    }
    const std::vector<PortalCell> openings = find_openings(search, places);
    std::vector<std::span<SearchPlace>> places_of_part;
    divide(0, places, places_of_part);
    parts_.resize(places_of_part.size());
    const std::size_t every = 1 + openings.size() * places.size() / max_aimed;
    for (std::size_t p = 0; p < parts_.size(); ++p)
        parts_[p].is_hidden = hidden_openings(search, places_of_part[p], openings, every);

    const std::vector<double> sky_of_all = hidden_after(places, &SearchPlace::sky);
    const std::vector<double> sun_of_all = hidden_after(places, &SearchPlace::sun);
    for (std::size_t p = 0; p < parts_.size(); ++p) {
        parts_[p].sky.rms = hidden_after(places_of_part[p], &SearchPlace::sky, &sky_of_all);
        if (!suns.empty()) parts_[p].sun.rms = hidden_after(places_of_part[p], &SearchPlace::sun, &sun_of_all);
    }
}

/// Finds openings, and divides them into cells.
std::vector<PortalCell> SkyOpenings::find_openings(SkySearch& search, std::span<const SearchPlace> places) {
    std::vector<SkySearch::Escape> ways;
    for (const SearchPlace& place : places) {
        if (std::popcount(place.sky) > few_rays) continue;
        std::uint64_t left = place.sky;
        for (std::size_t i = 0; i < ways_of_place && left != 0; ++i, left &= left - 1)
            ways.push_back({place.x, search.direction(place, static_cast<std::uint32_t>(std::countr_zero(left)))});
    }
    std::vector<PortalCell> openings;
    for (std::size_t attempt = 1; attempt <= max_attempts && !ways.empty() && openings.size() < max_openings;
         ++attempt) {
        const SkySearch::Escape way = ways[hash(attempt) % ways.size()];
        const PortalCell found = search.opening(way);
        if (!(found.area > 0)) continue;
        std::erase_if(ways,
                      [&](const SkySearch::Escape& other) { return passes_near(other.from, other.direction, found); });
        add_portal_cells(found, max_cells, cells_);
        opening_of_cell_.resize(cells_.size(), static_cast<std::uint32_t>(openings.size()));
        openings.push_back(found);
    }
    return openings;
}

/// Returns for each opening whether it is hidden from a part of the scene: none of the rays that the places cast
/// through it arrives, and none of their rays to the sky passes through it. Removes from `places` the arriving rays
/// that pass through an opening. every  of so many consecutive places, one casts rays through each group of 64 openings
std::vector<bool> SkyOpenings::hidden_openings(SkySearch& search, std::span<SearchPlace> places,
                                               std::span<const PortalCell> openings, std::size_t every) const {
    std::vector<SkySearch::Seen> seen(openings.size());
    constexpr std::size_t at_once = 64;
    for (std::size_t i = 0; i < places.size(); ++i)
        for (std::size_t first = i % every * at_once; first < openings.size(); first += every * at_once) {
            const std::size_t count = std::min(at_once, openings.size() - first);
            search.cast_through(places[i], openings.subspan(first, count), std::span(seen).subspan(first, count));
        }
    for (SearchPlace& place : places)
        for (std::uint64_t left = place.sky; left != 0; left &= left - 1) {
            const auto k = static_cast<std::uint32_t>(std::countr_zero(left));
            const Vec3 w = search.direction(place, k);
            for (std::size_t c = 0; c < cells_.size(); ++c) {
                if (dot(cells_[c].corner - place.x, cells_[c].n) <= 0 || !passes_near(place.x, w, cells_[c], 0))
                    continue;
                seen[opening_of_cell_[c]].arrived += 1;
                place.sky &= ~(std::uint64_t{1} << k);
            }
        }
    std::vector<bool> out;
    for (const SkySearch::Seen& opening : seen) out.push_back(opening.rays > 0 && opening.arrived == 0);
    return out;
}

/// Divides places at the median of their longest extent until there are few enough for a part.
void SkyOpenings::divide(std::uint32_t node, std::span<SearchPlace> places,
                         std::vector<std::span<SearchPlace>>& places_of_part) {
    constexpr std::size_t max_of_part = 256;  // enough for a mean, few enough for a room of a house to have its own
    Box box;
    for (const SearchPlace& place : places) box.add(place.x);
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k)
        if (box.hi[k] - box.lo[k] > box.hi[axis] - box.lo[axis]) axis = k;
    if (places.size() <= max_of_part || !(box.hi[axis] > box.lo[axis])) {
        divisions_[node] = {.first = static_cast<std::uint32_t>(places_of_part.size())};
        places_of_part.push_back(places);
        return;
    }
    const std::size_t half = places.size() / 2;
    std::nth_element(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(half), places.end(),
                     [&](const SearchPlace& p, const SearchPlace& q) { return p.x[axis] < q.x[axis]; });
    const auto first = static_cast<std::uint32_t>(divisions_.size());
    divisions_[node] = {axis, places[half].x[axis], first};
    divisions_.resize(first + 2);
    divide(first, places.first(half), places_of_part);
    divide(first + 1, places.subspan(half), places_of_part);
}

std::uint32_t SkyOpenings::part_at(const Point& x) const {
    std::uint32_t node = 0;
    while (divisions_[node].axis)
        node = divisions_[node].first + (x[*divisions_[node].axis] < divisions_[node].at ? 0 : 1);
    return divisions_[node].first;
}

}  // namespace exitance
