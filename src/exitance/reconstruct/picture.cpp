#include "exitance/reconstruct/picture.hpp"

#include "exitance/core/parallel.hpp"
#include "exitance/mesh/element_locator.hpp"

namespace exitance {
namespace {

/// Point i of n in the unit square, (i + 1/2) / n against the bits of i reversed: no two of n = 2^k share a row or a
/// column of n (Hammersley's points).
Vec2 place_in_pixel(int i, int n) {
    double bits = 0, digit = 0.5;
    for (int k = i; k > 0; k /= 2, digit /= 2) bits += digit * (k % 2);
    return {(i + 0.5) / n, bits + 0.5 / n};
}

/// The first surfaces along the rays of rows [first, last), pixel by pixel, sample by sample.
std::vector<RayHit> trace_rows(const RayTracer& tracer, const Camera& camera, PictureSize size, int first, int last,
                               int samples, std::vector<Vec3>& directions) {
    const CameraRays rays(camera, size);
    const std::size_t per_row = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(samples);
    directions.resize(per_row * static_cast<std::size_t>(last - first));
    std::vector<RayHit> hits(directions.size());
    parallel_for(static_cast<std::size_t>(last - first), 1, [&](std::size_t row) {
        Vec3* direction = directions.data() + row * per_row;
        for (int x = 0; x < size.width; ++x)
            for (int s = 0; s < samples; ++s) {
                const Vec2 p = place_in_pixel(s, samples);
                *direction++ = rays.direction(x + p.x, first + static_cast<int>(row) + p.y);
            }
        tracer.nearest(std::span(directions).subspan(row * per_row, per_row), camera.eye, RegionId(),
                       std::span(hits).subspan(row * per_row, per_row));
    });
    return hits;
}

bool is_front(const RayHit& hit) { return !hit.surface.is_none() && hit.front; }

/// For each hit the point whose light it shows. Of a pixel's hits on one region every fourth is such a point: within a
/// pixel light varies less than what is seen.
std::vector<std::uint32_t> choose_points(const Scene& scene, const Point& eye, std::span<const Vec3> directions,
                                         std::span<const RayHit> hits, std::size_t samples,
                                         std::vector<SeenPoint>& points) {
    constexpr std::uint32_t shared_by = 4;
    std::vector<std::uint32_t> point_of(hits.size()), rank(hits.size());
    points.clear();
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (!is_front(hits[i])) continue;
        const RegionId region = scene.surfaces()[hits[i].surface].region;
        const std::size_t first = i - i % samples;
        std::size_t before = i;  // the hit before this one on the same region of the same pixel, or `i`
        for (std::size_t k = i; k-- > first && before == i;)
            if (is_front(hits[k]) && scene.surfaces()[hits[k].surface].region == region) before = k;
        rank[i] = before == i ? 0 : (rank[before] + 1) % shared_by;
        if (rank[i] != 0) {
            point_of[i] = point_of[before];
            continue;
        }
        point_of[i] = static_cast<std::uint32_t>(points.size());
        points.push_back({eye + hits[i].distance * directions[i], region});
    }
    return point_of;
}

Pixel develop(const Scene& scene, std::span<const RayHit> hits, std::span<const std::uint32_t> point_of,
              std::span<const Light> light) {
    Pixel pixel;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (hits[i].surface.is_none()) continue;
        (hits[i].front ? pixel.front : pixel.back) += 1;
        if (!hits[i].front) continue;
        pixel.emits |= scene.material(hits[i].surface).emits();
        pixel.radiosity += light[point_of[i]].radiosity;
        pixel.irradiance += light[point_of[i]].irradiance;
    }
    if (pixel.front > 0) pixel.radiosity *= 1 / pixel.front, pixel.irradiance *= 1 / pixel.front;
    const auto all = static_cast<float>(hits.size());
    pixel.front /= all, pixel.back /= all;
    return pixel;
}

/// How many rows are traced before their light is asked for: enough work for all threads, in 100 MB or so.
int rows_at_once(PictureSize size, int samples) {
    return std::max(1, static_cast<int>(500000 / (static_cast<double>(size.width) * samples)));
}

}  // namespace

Picture take_picture(const Scene& scene, const RadiosityFunction& light, const RayTracer& tracer, const Camera& camera,
                     PictureSize size, int samples) {
    Picture picture{size, {}};
    picture.pixels.reserve(size.pixels());
    const int rows = rows_at_once(size, samples);
    std::vector<Vec3> directions;
    std::vector<SeenPoint> points;
    for (int first = 0; first < size.height; first += rows) {
        const int last = std::min(first + rows, size.height);
        const std::vector<RayHit> hits = trace_rows(tracer, camera, size, first, last, samples, directions);
        const auto n = static_cast<std::size_t>(samples);
        const std::vector<std::uint32_t> point_of = choose_points(scene, camera.eye, directions, hits, n, points);
        const std::vector<Light> values = light.at(std::span<const SeenPoint>(points));
        for (std::size_t i = 0; i < hits.size(); i += n)
            picture.pixels.push_back(
                develop(scene, std::span(hits).subspan(i, n), std::span(point_of).subspan(i, n), values));
    }
    return picture;
}

std::vector<bool> element_edges(const Solution& solution, const RayTracer& tracer, const Camera& camera,
                                PictureSize size) {
    const ElementLocator locator(solution.interpolant.tree, solution.scene.regions().size());
    std::vector<Vec3> directions;
    const std::vector<RayHit> hits = trace_rows(tracer, camera, size, 0, size.height, 1, directions);
    std::vector<ElementId> seen(hits.size());
    parallel_for(hits.size(), 256, [&](std::size_t i) {
        if (!is_front(hits[i])) return;
        const RegionId region = solution.scene.surfaces()[hits[i].surface].region;
        seen[i] = locator.find(region, camera.eye + hits[i].distance * directions[i]).element;
    });
    std::vector<bool> edges(hits.size());
    const auto width = static_cast<std::size_t>(size.width);
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const bool right = (i + 1) % width != 0 && seen[i] != seen[i + 1];
        const bool below = i + width < seen.size() && seen[i] != seen[i + width];
        edges[i] = right || below;
    }
    return edges;
}

}  // namespace exitance
