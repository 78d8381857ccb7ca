#include "exitance/direct/possible_sources.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include "exitance/base/parallel.hpp"
#include "exitance/base/polygon.hpp"

namespace exitance {
namespace {

constexpr std::size_t min_group_size = 8;  ///< Smaller groups of regions are not tested together.
/// Share of the total area; larger regions are tested individually. Chosen: half of it and twice it take the same
/// time, measured by `exitance solve carpet.obj --error 0.1` (carpet u=12 v=13 cuts=1 books=0).
constexpr double large_region_share = 1e-5;
constexpr std::size_t min_job_count = 256;  ///< Number of groups to distribute to threads.

double min_distance(const Box& a, const Box& b) {
    double squared = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double gap = std::max({0.0, a.lo[k] - b.hi[k], b.lo[k] - a.hi[k]});
        squared += gap * gap;
    }
    return std::sqrt(squared);
}

double highest(std::span<const Point> points, const Plane& plane) {
    double out = -HUGE_VAL;
    for (const Point& p : points) out = std::max(out, plane.signed_distance(p));
    return out;
}

std::array<Point, 8> corners_of(const Box& box) {
    std::array<Point, 8> out;
    for (std::size_t i = 0; i < 8; ++i)
        out[i] = {i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y, i & 4 ? box.hi.z : box.lo.z};
    return out;
}

}  // namespace

/// Divides the regions recursively into groups and excludes hidden sources for each group.
class PossibleSources::Divider {
  public:
    Divider(const DirectLight& direct, double negligible, const StopRequest& stop,
            Field<RegionId, std::vector<Source>>& out)
        : direct_(direct), occluders_(direct.occluders()), negligible_(negligible), stop_(stop), out_(out) {
        const Scene& scene = occluders_.scene();
        for (const Region& region : scene.regions()) {
            Box& box = boxes_.emplace_back();
            for (const auto& loop : region.loops)
                for (const Point& p : loop) box.add(p);
            area_ += region.area;
        }
        for (std::uint32_t e = 0; e < direct_.emitters().size(); ++e)
            for (const PieceId piece : direct_.emitters()[e].pieces) {
                Emitting& s = sources_.emplace_back();
                s.name = {e, piece}, s.corners = occluders_.corners(piece);
                s.area = norm(area_vector(s.corners)), s.centre = centroid(s.corners);
                for (const Point& p : s.corners) s.box.add(p);
            }
    }

    void run() {
        std::vector<std::uint32_t> order(boxes_.size());
        std::iota(order.begin(), order.end(), 0u);
        Group all{order, {}};
        all.sources.resize(sources_.size());
        std::iota(all.sources.begin(), all.sources.end(), 0u);
        std::vector<Group> jobs{all};
        // Split level by level, into the same groups as divide() would make, until there are enough for all threads.
        while (jobs.size() < min_job_count) {
            std::vector<Group> next;
            for (Group& job : jobs) {
                if (job.regions.size() <= min_group_size) {
                    next.push_back(std::move(job));
                    continue;
                }
                auto [first, second] = halves(job);
                next.push_back(std::move(first)), next.push_back(std::move(second));
            }
            if (next.size() == jobs.size()) break;
            parallel_for(next.size(), 1, [&](std::size_t i) { keep_seen(next[i]); });
            jobs = std::move(next);
        }
        parallel_for(jobs.size(), 1, [&](std::size_t i) { divide(jobs[i]); });
    }

  private:
    struct Emitting {
        DirectLight::SourceName name;
        std::span<const Point> corners;
        Box box;
        Point centre;
        double area = 0;
    };
    struct Group {
        std::span<std::uint32_t> regions;
        std::vector<std::uint32_t> sources;
    };

    Box box_of(std::span<const std::uint32_t> regions) const {
        Box out;
        for (const std::uint32_t r : regions) out.add(boxes_[r].lo), out.add(boxes_[r].hi);
        return out;
    }

    std::pair<Group, Group> halves(const Group& group) const {
        const auto centre = [&](std::uint32_t r) { return boxes_[r].centre(); };
        Box centres;
        for (const std::uint32_t r : group.regions) centres.add(centre(r));
        const Vec3 extent = centres.hi - centres.lo;
        const std::size_t axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const auto middle = group.regions.begin() + static_cast<std::ptrdiff_t>(group.regions.size() / 2);
        std::nth_element(group.regions.begin(), middle, group.regions.end(), [&](std::uint32_t a, std::uint32_t b) {
            return std::pair(centre(a)[axis], a) < std::pair(centre(b)[axis], b);
        });
        return {{{group.regions.begin(), middle}, group.sources}, {{middle, group.regions.end()}, group.sources}};
    }

    void divide(Group& group) {
        if (group.regions.size() <= min_group_size || stop_.requested()) {
            for (const std::uint32_t r : group.regions) finish(RegionId(r), group.sources);
            return;
        }
        auto [first, second] = halves(group);
        for (Group* half : {&first, &second}) keep_seen(*half), divide(*half);
    }

    void keep_seen(Group& group) const {
        if (group.regions.size() < min_group_size || stop_.requested()) return;
        const std::array<Point, 8> corners = corners_of(box_of(group.regions));
        RegionCover cover;
        std::erase_if(group.sources, [&](std::uint32_t s) {
            const Plane& plane = direct_.emitters()[sources_[s].name.emitter].plane;
            return highest(corners, plane) <= occluders_.rounding() || is_hidden(corners, sources_[s], cover);
        });
    }

    /// True if one region separates the convex hull of these points from all of a source and covers all lines between
    /// them. Tests only regions on the segment between their centres.
    bool is_hidden(std::span<const Point> from, const Emitting& source, RegionCover& cover) const {
        Point middle = from[0];
        for (const Point& p : from) middle = middle + (p - from[0]) / static_cast<double>(from.size());
        constexpr std::size_t max_tested = 12;
        // Derived from coplanar_share: nearer points may be counted as lying in the plane.
        constexpr double apart = 4 * coplanar_share;
        const double slack = apart * occluders_.scene().size();
        std::size_t tested = 0;
        bool hidden = false;
        RegionId last;
        occluders_.visit_segment(Occluders::Size::large, middle, source.centre - middle, [&](PieceId p) {
            const RegionId r = occluders_.pieces()[p].region;
            if (r.is_none() || r == last) return false;
            last = r;
            const Region& region = occluders_.scene().regions()[r];
            const double side = region.plane.signed_distance(middle) > 0 ? 1 : -1;
            const auto is_off_plane = [&](std::span<const Point> points, double sign) {
                return std::all_of(points.begin(), points.end(),
                                   [&](const Point& x) { return sign * region.plane.signed_distance(x) > slack; });
            };
            if (!is_off_plane(from, side) || !is_off_plane(source.corners, -side)) return false;
            cover.begin(region, occluders_.rounding());
            bool crosses = true;
            for (const Point& x : from)
                for (const Point& y : source.corners) crosses = crosses && cover.add(x, y);
            hidden = crosses && cover.covers();
            return hidden || ++tested == max_tested;
        });
        return hidden;
    }

    /// Computes the bounds of the sources of one region.
    void finish(RegionId r, const std::vector<std::uint32_t>& sources) {
        const Region& region = occluders_.scene().regions()[r];
        const Box& box = boxes_[r.value];
        std::vector<Point> corners;
        for (const auto& loop : region.loops) corners.insert(corners.end(), loop.begin(), loop.end());
        RegionCover cover;
        const bool is_large = region.area >= large_region_share * area_;
        std::vector<Source>& out = out_[r];
        for (const std::uint32_t s : sources) {
            const Emitting& source = sources_[s];
            const DirectLight::Emitter& emitter = direct_.emitters()[source.name.emitter];
            const double rise = highest(source.corners, region.plane), fall = highest(corners, emitter.plane);
            if (!direct_.shines_on(emitter, r) || rise <= 0 || fall <= 0) continue;
            if (is_large && !stop_.requested() && is_hidden(corners, source, cover)) continue;
            const double d = min_distance(box, source.box);
            const double F = d > 0 ? source.area / (pi * d * d) * std::min(1.0, rise / d) * std::min(1.0, fall / d) : 1;
            out.push_back({source.name, std::min(1.0, F) * mean(emitter.exitance)});
        }
        std::sort(out.begin(), out.end(), [](const Source& a, const Source& b) {
            return std::tuple(a.bound, a.name.piece.value) < std::tuple(b.bound, b.name.piece.value);
        });
        double dropped = 0;
        std::size_t first = 0;
        while (first < out.size() && dropped + out[first].bound <= negligible_) dropped += out[first++].bound;
        out.erase(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(first));
        out.shrink_to_fit();
    }

    const DirectLight& direct_;
    const Occluders& occluders_;
    double negligible_, area_ = 0;
    const StopRequest& stop_;
    Field<RegionId, std::vector<Source>>& out_;
    std::vector<Box> boxes_;
    std::vector<Emitting> sources_;
};

PossibleSources::PossibleSources(const DirectLight& direct, double negligible, const StopRequest& stop)
    : of_region_(direct.occluders().scene().regions().size()) {
    Divider(direct, negligible, stop, of_region_).run();
}

bool PossibleSources::suits(const DirectLight& direct) {
    const Scene& scene = direct.occluders().scene();
    return !scene.has_light_apart() && scene.panes().empty() && !scene.has_directed_emission() &&
           !scene.has_diffusing_panes();
}

}  // namespace exitance
