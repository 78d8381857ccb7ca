#if EXITANCE_EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "exitance/base/check.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/visibility/glass/ray_fates.hpp"
#include "exitance/visibility/narrow_gaps.hpp"
#include "exitance/visibility/traced_scene.hpp"

namespace exitance {
namespace {

constexpr std::size_t width = 16;  ///< Rays per packet; Embree splits it on machines with narrower vectors.
/// Part of a segment at its end where nothing blocks; derived from TracedScene::lift.
constexpr double end_margin = 1e-6;
constexpr int retries = 8;  ///< Maximum number of restarts past a ray's own region; one is rarely needed.

/// Owns a reference-counted Embree object and releases it.
template <class Handle, void (*release)(Handle)>
class Owned {
  public:
    explicit Owned(Handle handle) : handle_(handle) { EXI_CHECK(handle != nullptr); }
    ~Owned() { release(handle_); }
    Owned(const Owned&) = delete;
    Owned& operator=(const Owned&) = delete;
    operator Handle() const { return handle_; }

  private:
    Handle handle_;
};

#if EXITANCE_EMBREE_MAJOR == 3

RTCIntersectContext make_context() {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return context;
}

/// Traces the rays whose entry of `valid` is -1 to their first hits.
void trace_nearest(std::span<const int, width> valid, RTCScene scene, RTCRayHit16& packet) {
    RTCIntersectContext context = make_context();
    rtcIntersect16(valid.data(), scene, &context, &packet);
}

/// Sets the far end of each blocked ray to minus infinity; rays whose entry of `valid` is 0 are skipped.
void trace_occluded(std::span<const int, width> valid, RTCScene scene, RTCRay16& packet) {
    RTCIntersectContext context = make_context();
    rtcOccluded16(valid.data(), scene, &context, &packet);
}

#else

/// Traces the rays whose entry of `valid` is -1 to their first hits.
void trace_nearest(std::span<const int, width> valid, RTCScene scene, RTCRayHit16& packet) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect16(valid.data(), scene, &packet, &arguments);
}

/// Sets the far end of each blocked ray to minus infinity; rays whose entry of `valid` is 0 are skipped.
void trace_occluded(std::span<const int, width> valid, RTCScene scene, RTCRay16& packet) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcOccluded16(valid.data(), scene, &packet, &arguments);
}

#endif

template <class Rays>
void set_ray(Rays& rays, std::size_t lane, const Float3& origin, const Float3& direction, float near, float far) {
    rays.org_x[lane] = origin.x, rays.org_y[lane] = origin.y, rays.org_z[lane] = origin.z;
    rays.dir_x[lane] = direction.x, rays.dir_y[lane] = direction.y, rays.dir_z[lane] = direction.z;
    rays.tnear[lane] = near, rays.tfar[lane] = far;
    rays.time[lane] = 0, rays.mask[lane] = 0xffffffffu, rays.id[lane] = 0, rays.flags[lane] = 0;
}

/// Data of the panes for Embree's filter function, which is called per triangle.
struct Glass {
    RayFates fates;
    std::vector<std::uint32_t> pane_of = {};  ///< Per triangle.
};

void filter_glass(const RTCFilterFunctionNArguments* arguments) {
    const auto& glass = *static_cast<const Glass*>(arguments->geometryUserPtr);
    RTCRayN* ray = arguments->ray;
    for (unsigned i = 0, n = arguments->N; i < n; ++i) {
        if (arguments->valid[i] != -1) continue;
        const std::array origin{RTCRayN_org_x(ray, n, i), RTCRayN_org_y(ray, n, i), RTCRayN_org_z(ray, n, i)};
        const std::array d{RTCRayN_dir_x(ray, n, i), RTCRayN_dir_y(ray, n, i), RTCRayN_dir_z(ray, n, i)};
        if (glass.fates(origin, d, glass.pane_of[RTCHitN_primID(arguments->hit, n, i)]) == RayFate::passes)
            arguments->valid[i] = 0;
    }
}

}  // namespace

struct RayTracer::Content : TracedScene {
    Owned<RTCDevice, rtcReleaseDevice> device;
    Owned<RTCScene, rtcReleaseScene> rtc;
    std::vector<SurfaceId> surface_of;  ///< Per triangle.
    OpposedFaces opposed;               ///< Tables for sheets whose two sides have different outlines.
    NarrowGaps gaps;                    ///< Places where rays must start lower, because another face is close above.
    Glass glass;

    explicit Content(const Scene& s)
        : TracedScene(s),
          device(rtcNewDevice(nullptr)),
          rtc(rtcNewScene(device)),
          opposed(s, other_side, lift_off),
          gaps(narrow_gaps()),
          glass{RayFates(s.panes(), frame)} {
        attach(surfaces(surface_of), nullptr);
        if (!s.panes().empty()) attach(panes(glass.pane_of), &glass);  // the second geometry
        rtcSetSceneFlags(rtc, RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(rtc, RTC_BUILD_QUALITY_MEDIUM);
        // The order of triangles in a leaf, and so which of two equally near ones is hit, depends on the number of
        // build threads. A single thread always builds the same tree.
        run_alone([&] { rtcJoinCommitScene(rtc); });
    }

    void attach(const Triangles& all, Glass* filter) {
        const Owned<RTCGeometry, rtcReleaseGeometry> geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
        void* vertex_buffer = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                      sizeof(Float3), all.corners.size());
        void* index_buffer = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                     sizeof(all.triangles[0]), all.triangles.size());
        std::copy(all.corners.begin(), all.corners.end(), static_cast<Float3*>(vertex_buffer));
        std::copy(all.triangles.begin(), all.triangles.end(), static_cast<std::array<std::uint32_t, 3>*>(index_buffer));
        if (filter) {
            rtcSetGeometryUserData(geometry, filter);
            rtcSetGeometryIntersectFilterFunction(geometry, filter_glass);
            rtcSetGeometryOccludedFilterFunction(geometry, filter_glass);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(rtc, geometry);
    }

    /// Fills a hit from a lane. Returns false if the ray hit its own region and must be continued from there.
    bool read(const RTCRayHit16& packet, std::size_t lane, const Point& origin, const Vec3& direction, RegionId own,
              RayHit& hit) const {
        hit = RayHit();
        if (packet.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) return true;
        if (packet.hit.geomID[lane] != 0) {  // stopped by glass: treated like the back of any surface
            hit.surface = SurfaceId(0), hit.region = faces[hit.surface].region;
            hit.distance = packet.ray.tfar[lane], hit.is_glass = true;
            return true;
        }
        hit.surface = surface_of[packet.hit.primID[lane]];
        // Embree finds either side of a sheet; the hit is the side that faces the ray.
        if (other_side.size() > 0 && !other_side[hit.surface].is_none() &&
            dot(faces[hit.surface].normal, direction) > 0)
            hit.surface = other_side[hit.surface];
        const TracedFace& face = faces[hit.surface];
        if (face.region == own && !own.is_none()) return false;
        hit.region = face.region;
        const double slope = dot(face.normal, direction);
        const double distance = dot(face.normal, face.corner - origin) / slope;
        const double found = packet.ray.tfar[lane];
        // Nearly in the surface's plane the quotient is meaningless; use Embree's distance. Derived from its single
        // precision: otherwise, Embree's distance is more accurate than that.
        constexpr double max_difference = 1e-3;
        hit.distance = std::abs(distance - found) <= max_difference * found ? distance : found;
        hit.front = slope < 0;
        return hit.front || !opposed.has(hit.surface) || turn_over(origin, direction, own, hit);
    }

    /// If a back was hit and an opposed face at the same place faces the ray, replaces the hit by that face. Returns
    /// false if it belongs to the ray's own region, so that the ray must be continued from there.
    bool turn_over(const Point& origin, const Vec3& direction, RegionId own, RayHit& hit) const {
        const SurfaceId facing = opposed.facing(origin + hit.distance * direction, direction);
        if (facing.is_none()) return true;
        hit.surface = facing, hit.region = faces[facing].region, hit.front = true;
        return hit.region != own || own.is_none();
    }

    /// Faces so close above the start of a ray that the ray would usually start beyond them.
    struct Ceiling {
        SurfaceId cover;  ///< Face that is stacked on the start, so that no ray leaves it; none if there is none.
        double height = HUGE_VAL;  ///< Height of the lowest other face, metres.
        bool is_close() const { return !cover.is_none() || height < HUGE_VAL; }
    };
    Ceiling ceiling(const RayEnd& start) const {
        if (!gaps.has(start.region)) return {};
        const SurfaceId cover = gaps.cover(start.x, start.region);
        return {cover, cover.is_none() ? gaps.height(start.x, start.region) : 0};
    }

    /// Start of a ray that must start below a close face.
    Point start_below(const Ceiling& close, const RayEnd& start) const {
        // A ray that no other end may see starts behind its own region.
        const double height = close.cover.is_none() ? raised(start.region) + 0.5 * close.height : -lift_off;
        return start.x + height * scene->regions()[start.region].plane.n;
    }

    /// Finds the first hit of a ray that starts below a close face.
    void trace_below(const Ceiling& close, const RayEnd& start, const Vec3& direction, RayHit& hit) const {
        if (close.cover.is_none()) {
            trace_in_gap(close, start, direction, hit);
        } else {
            hit = RayHit();
            hit.surface = close.cover, hit.region = faces[close.cover].region, hit.distance = 0;
        }
    }

    /// Double precision decides whether the ray meets the close face, and single precision whether it meets another one
    /// before.
    void trace_in_gap(const Ceiling& close, const RayEnd& from, const Vec3& direction, RayHit& hit) const {
        const auto& [origin, own] = from;
        const NarrowGaps::Met met = gaps.first(origin, direction, own);
        const Point start = start_below(close, from);
        float past = 0;
        RayHit other;
        for (int attempt = 0; attempt < retries; ++attempt) {
            alignas(64) RTCRayHit16 packet;
            alignas(64) std::array<int, width> valid{};
            valid[0] = -1;
            set_ray(packet.ray, 0, local(start), local_direction(direction), past, HUGE_VALF);
            packet.hit.geomID[0] = RTC_INVALID_GEOMETRY_ID;
            trace_nearest(valid, rtc, packet);
            const bool is_other = read(packet, 0, origin, direction, own, other);
            if (is_other && (packet.hit.geomID[0] != 0 || !gaps.decides(origin, own, other.surface))) break;
            other = RayHit();
            past = std::nextafter(packet.ray.tfar[0] * (1 + 0x1p-20f), HUGE_VALF);
            if (past > met.distance) break;
        }
        hit = other;
        if (met.surface.is_none() || other.distance < met.distance) return;
        hit = RayHit();
        hit.surface = met.surface, hit.region = faces[met.surface].region;
        hit.distance = met.distance, hit.front = met.front;
    }

    /// True if anything is between a point below a close face and another point.
    bool is_blocked_below(const Ceiling& close, const RayEnd& x, const RayEnd& other) const {
        const Ceiling above_other = ceiling(other);
        if (!close.cover.is_none() || !above_other.cover.is_none()) return true;
        const Point end = above_other.is_close() ? start_below(above_other, other) : other.x + offset(other.region);
        RayHit hit;
        trace_below(close, x, end - x.x, hit);
        const bool at_end = hit.front && !other.region.is_none() && hit.region == other.region;
        return !at_end && hit.distance < 1 - end_margin;
    }

    bool is_mirrored(const RTCRayHit16& packet, std::size_t lane) const {
        if (packet.hit.geomID[lane] != 1) return false;
        const auto& [ray, hit] = packet;
        return glass.fates({ray.org_x[lane], ray.org_y[lane], ray.org_z[lane]},
                           {ray.dir_x[lane], ray.dir_y[lane], ray.dir_z[lane]},
                           glass.pane_of[hit.primID[lane]]) == RayFate::is_mirrored;
    }

    /// Continues the rays of a packet that panes have reflected; another pane stops them.
    template <class Origin>
    void follow_mirrored(const RTCRayHit16& packet, std::size_t count, const Origin& origin, const Vec3* directions,
                         RayHit* hits) const {
        alignas(64) RTCRayHit16 onward;
        alignas(64) std::array<int, width> valid{};
        std::array<Point, width> from;
        std::array<Vec3, width> along;
        std::array<double, width> way;
        bool any = false;
        for (std::size_t i = 0; i < count; ++i) {
            if (!is_mirrored(packet, i)) continue;
            const Pane& pane = scene->panes()[glass.pane_of[packet.hit.primID[i]]];
            const double slope = dot(pane.n, directions[i]);
            way[i] = dot(pane.n, pane.corners[0] - origin(i)) / slope;
            from[i] = origin(i) + way[i] * directions[i], along[i] = directions[i] - 2 * slope * pane.n;
            const Vec3 off = (slope < 0 ? lift_off : -lift_off) * pane.n;
            set_ray(onward.ray, i, local(from[i] + off), local_direction(along[i]), 0, HUGE_VALF);
            onward.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
            valid[i] = -1, any = true;
        }
        if (!any) return;
        trace_nearest(valid, rtc, onward);
        for (std::size_t i = 0; i < count; ++i) {
            if (valid[i] == 0) continue;
            read(onward, i, from[i], along[i], RegionId(), hits[i]);
            hits[i].distance += way[i];
            hits[i].mirror = static_cast<std::int32_t>(glass.pane_of[packet.hit.primID[i]]);
        }
    }

    template <class Start>
    void nearest(std::span<const Vec3> directions, const Start& start, bool same, std::span<RayHit> hits,
                 Mirrored mirrored) const;
    template <class Ends>
    std::size_t occluded(std::span<bool> blocked, const Ends& ends) const;

    /// Restarts a ray just past its own region, which it hit because of rounding.
    void retry(const Point& origin, const Vec3& direction, RegionId own, float past, RayHit& hit) const {
        for (int attempt = 0; attempt < retries; ++attempt) {
            alignas(64) RTCRayHit16 packet;
            alignas(64) std::array<int, width> valid{};
            valid[0] = -1;
            past = std::nextafter(past * (1 + 0x1p-20f), HUGE_VALF);
            set_ray(packet.ray, 0, local(origin + offset(own)), local_direction(direction), past, HUGE_VALF);
            packet.hit.geomID[0] = RTC_INVALID_GEOMETRY_ID;
            trace_nearest(valid, rtc, packet);
            if (read(packet, 0, origin, direction, own, hit)) return;
            past = packet.ray.tfar[0];
        }
        hit = RayHit();
    }
};

RayTracer::RayTracer(const Scene& scene) : content_(std::make_unique<const Content>(scene)) {}
RayTracer::~RayTracer() = default;
RayTracer::RayTracer(RayTracer&&) noexcept = default;
RayTracer& RayTracer::operator=(RayTracer&&) noexcept = default;

std::size_t RayTracer::triangle_count() const {
    return content_->surface_of.size();
}

std::span<const SurfaceId> RayTracer::opposed_faces() const {
    return content_->opposed.faces();
}

/// start(i): where ray i starts, with the region that it is lifted off; `same` if that is the same for all rays.
template <class Start>
void RayTracer::Content::nearest(std::span<const Vec3> directions, const Start& start, bool same,
                                 std::span<RayHit> hits, Mirrored mirrored) const {
    EXI_CHECK(hits.size() == directions.size());
    if (directions.empty()) return;
    const auto lifted = [&](const RayEnd& s) { return local(s.x + offset(s.region)); };
    alignas(64) RTCRayHit16 packet;
    alignas(64) std::array<int, width> valid;
    valid.fill(-1);
    // Write data that all packets share only once: Embree changes only the far end and the hit.
    const RayEnd shared = start(0);
    const Ceiling above_shared = ceiling(shared);
    for (std::size_t i = 0; i < width; ++i) set_ray(packet.ray, i, lifted(shared), {}, 0, HUGE_VALF);
    for (std::size_t first = 0; first < directions.size(); first += width) {
        const std::size_t count = std::min(width, directions.size() - first);
        std::fill(valid.begin() + static_cast<std::ptrdiff_t>(count), valid.end(), 0);
        for (std::size_t i = 0; i < count; ++i) {
            const Float3 direction = local_direction(directions[first + i]);
            packet.ray.dir_x[i] = direction.x, packet.ray.dir_y[i] = direction.y, packet.ray.dir_z[i] = direction.z;
            packet.ray.tfar[i] = HUGE_VALF;
            packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        }
        for (std::size_t i = 0; i < count && !same; ++i) {
            const Float3 at = lifted(start(first + i));
            packet.ray.org_x[i] = at.x, packet.ray.org_y[i] = at.y, packet.ray.org_z[i] = at.z;
        }
        trace_nearest(valid, rtc, packet);
        for (std::size_t i = 0; i < count; ++i) {
            const RayEnd from = start(first + i);
            const Vec3& direction = directions[first + i];
            const Ceiling above = same ? above_shared : ceiling(from);
            if (above.is_close()) {
                trace_below(above, from, direction, hits[first + i]);
                packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;  // excludes the ray from follow_mirrored()
            } else if (!read(packet, i, from.x, direction, from.region, hits[first + i])) {
                retry(from.x, direction, from.region, packet.ray.tfar[i], hits[first + i]);
            }
        }
        if (mirrored == Mirrored::followed && !glass.pane_of.empty())
            follow_mirrored(
                packet, count, [&](std::size_t i) { return start(first + i).x; }, &directions[first], &hits[first]);
    }
}

std::size_t RayTracer::nearest(std::span<const Point> origins, std::span<const Vec3> directions, RegionId own,
                               std::span<RayHit> hits, Mirrored mirrored) const {
    EXI_CHECK(origins.size() == directions.size() || origins.size() == 1);
    const bool shared = origins.size() == 1;
    const RegionId behind = content_->scene->behind(own);
    const auto side_of = [&](const Vec3& direction) {
        return !behind.is_none() && dot(direction, content_->scene->regions()[own].plane.n) < 0 ? behind : own;
    };
    const auto start = [&](std::size_t i) { return RayEnd{origins[shared ? 0 : i], side_of(directions[i])}; };
    content_->nearest(directions, start, shared && behind.is_none(), hits, mirrored);
    return directions.size();
}

std::size_t RayTracer::nearest(std::span<const RayEnd> origins, std::span<const Vec3> directions,
                               std::span<RayHit> hits, Mirrored mirrored) const {
    EXI_CHECK(origins.size() == directions.size());
    content_->nearest(
        directions, [&](std::size_t i) { return origins[i]; }, false, hits, mirrored);
    return directions.size();
}

std::size_t RayTracer::nearest(std::span<const Vec3> directions, const Point& origin, RegionId own,
                               std::span<RayHit> hits, Mirrored mirrored) const {
    return nearest(std::span(&origin, 1), directions, own, hits, mirrored);
}

/// ends(i): both ends of ray i.
template <class Ends>
std::size_t RayTracer::Content::occluded(std::span<bool> blocked, const Ends& ends) const {
    alignas(64) RTCRay16 packet;
    alignas(64) std::array<int, width> valid;
    for (std::size_t first = 0; first < blocked.size(); first += width) {
        const std::size_t count = std::min(width, blocked.size() - first);
        valid.fill(0), std::fill_n(valid.begin(), count, -1);
        for (std::size_t i = 0; i < count; ++i) {
            const auto [from, to] = ends(first + i);
            const Point a = from.x + offset(from.region), b = to.x + offset(to.region);
            set_ray(packet, i, local(a), local_direction(b - a), 0, 1);
        }
        // Builds of Embree with assertions also check the rays of lanes that are not valid.
        for (std::size_t i = count; i < width; ++i) set_ray(packet, i, {}, {}, 0, 1);
        trace_occluded(valid, rtc, packet);
        for (std::size_t i = 0; i < count; ++i) {
            blocked[first + i] = packet.tfar[i] < 0;
            const auto [from, to] = ends(first + i);
            if (const Ceiling above = ceiling(from); above.is_close())
                blocked[first + i] = is_blocked_below(above, from, to);
            else if (const Ceiling above_other = ceiling(to); above_other.is_close())
                blocked[first + i] = is_blocked_below(above_other, to, from);
        }
    }
    return blocked.size();
}

std::size_t RayTracer::occluded(std::span<const Point> from, std::span<const Point> to, RegionId receiver,
                                RegionId source, std::span<bool> blocked) const {
    EXI_CHECK(from.size() == to.size() && blocked.size() == to.size());
    return content_->occluded(blocked, [&](std::size_t i) {
        return std::pair{RayEnd{from[i], receiver}, RayEnd{to[i], source}};
    });
}

std::size_t RayTracer::occluded(std::span<const RayEnd> from, std::span<const RayEnd> to,
                                std::span<bool> blocked) const {
    EXI_CHECK(from.size() == to.size() && blocked.size() == to.size());
    return content_->occluded(blocked, [&](std::size_t i) { return std::pair{from[i], to[i]}; });
}

RayEnds RayTracer::ray_ends(std::span<const Point> points, RegionId region) const {
    EXI_CHECK(points.size() == RayEnds::size);
    const Vec3 lifted = content_->offset(region);
    RayEnds ends;
    for (std::size_t k = 0; k < RayEnds::size; ++k) {
        const RayEnd end{points[k], region};
        const Content::Ceiling above = content_->ceiling(end);
        const Float3 p = content_->local(above.is_close() ? content_->start_below(above, end) : points[k] + lifted);
        ends.x[k] = p.x, ends.y[k] = p.y, ends.z[k] = p.z;
    }
    return ends;
}

std::uint32_t RayTracer::occluded(const RayEnds& from, const RayEnds& to) const {
    static_assert(RayEnds::size == width);
    alignas(64) RTCRay16 packet;
    alignas(64) std::array<int, width> valid;
    for (std::size_t k = 0; k < width; ++k) {
        packet.org_x[k] = from.x[k], packet.org_y[k] = from.y[k], packet.org_z[k] = from.z[k];
        packet.dir_x[k] = to.x[k] - from.x[k], packet.dir_y[k] = to.y[k] - from.y[k];
        packet.dir_z[k] = to.z[k] - from.z[k];
        packet.tnear[k] = 0, packet.tfar[k] = 1, packet.time[k] = 0;
        packet.mask[k] = 0xffffffffu, packet.id[k] = 0, packet.flags[k] = 0;
        valid[k] = -1;
    }
    trace_occluded(valid, content_->rtc, packet);
    std::uint32_t blocked = 0;
    for (std::size_t k = 0; k < width; ++k) blocked |= static_cast<std::uint32_t>(packet.tfar[k] < 0) << k;
    return blocked;
}

}  // namespace exitance
