#include "exitance/measure/light_maps/unwrap.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "exitance/base/triangulation.hpp"
#include "exitance/measure/light_maps/common_corners.hpp"
#include "exitance/measure/light_maps/face_charts.hpp"

namespace exitance {
namespace {

/// A chart with its extent in metres along its frame.
struct FramedChart {
    FaceChart faces;
    ChartFrame frame;
    double left = HUGE_VAL, bottom = HUGE_VAL, width = 0, height = 0;
};

std::vector<FramedChart> find_framed_charts(const Scene& scene) {
    std::vector<FramedChart> out;
    for (FaceChart& faces : find_face_charts(scene)) {
        const ChartFrame frame = smallest_frame(scene, faces);
        FramedChart chart{std::move(faces), frame};
        double right = -HUGE_VAL, top = -HUGE_VAL;
        for (const RegionId r : chart.faces.regions)
            for (const std::vector<Point>& loop : scene.regions()[r].loops)
                for (const Point& p : loop) {
                    const double x = dot(frame.right, p), y = dot(frame.up, p);
                    chart.left = std::min(chart.left, x), chart.bottom = std::min(chart.bottom, y);
                    right = std::max(right, x), top = std::max(top, y);
                }
        chart.width = right - chart.left, chart.height = top - chart.bottom;
        out.push_back(std::move(chart));
    }
    return out;
}

/// Number of texels that a length touches; touching within rounding does not count.
double texels_of(double length, double density) {
    constexpr double rounding = 1e-6;  // texels; derived from the precision of coordinates
    return std::max(1.0, std::ceil(length * density - rounding));
}

/// Packs the charts into one map. None if they do not fit.
std::optional<std::vector<Chart>> packed(std::span<const FramedChart> charts, double density, MapSize size,
                                         int padding) {
    std::vector<Chart> out;
    double area = 0;
    for (const FramedChart& chart : charts) {
        const double width = texels_of(chart.width, density), height = texels_of(chart.height, density);
        area += (width + 2 * padding) * (height + 2 * padding);
        if (width + 2 * padding > size.width || height + 2 * padding > size.height) return std::nullopt;
        Chart box;
        box.width = static_cast<int>(width), box.height = static_cast<int>(height);
        out.push_back(box);
    }
    if (area > static_cast<double>(size.texels())) return std::nullopt;
    const std::vector<MapSize> sizes = pack_charts(out, padding, size.height, size.width);
    if (sizes.size() > 1 || sizes[0].width > size.width || sizes[0].height > size.height) return std::nullopt;
    return out;
}

/// The highest density at which the charts fit, to within 1%: `fits` is too low or right, `too_dense` too high.
double densest(std::span<const FramedChart> charts, double fits, double too_dense, MapSize size, int padding) {
    constexpr double enough = 1.01;  // derived from the space that a packing wastes, which is more than 1%
    while (too_dense > enough * fits) {
        const double middle = std::sqrt(fits * too_dense);
        (packed(charts, middle, size, padding) ? fits : too_dense) = middle;
    }
    return fits;
}

Error does_not_fit(std::size_t charts, MapSize size, const char* option) {
    return {ErrorCode::usage,
            fmt::format("the {} charts of the scene do not fit into {} x {} texels", charts, size.width, size.height),
            option, "choose a larger --size or a smaller --density or --padding"};
}

Unwrapped::Projection projection(const FramedChart& chart, const Chart& box, double density) {
    return {density * chart.frame.right,
            -density * chart.frame.up,
            {box.x - density * chart.left, box.y + density * (chart.bottom + chart.height)}};
}

/// Linear map of a region from texels of its chart's box to its plane.
Chart region_chart(const Region& region, const FramedChart& chart, const Chart& box, double density) {
    const Normal &n = region.plane.n, &axis = chart.faces.axis;
    const auto in_plane = [&](const Vec3& d) { return d - dot(n, d) / dot(n, axis) * axis; };
    Chart out = box;
    out.du = in_plane(chart.frame.right) / density, out.dv = in_plane(-1 * chart.frame.up) / density;
    out.skew = dot(out.du, out.dv);
    const Point& corner = region.loops.front().front();
    const double x = (dot(chart.frame.right, corner) - chart.left) * density;
    const double y = (chart.bottom + chart.height - dot(chart.frame.up, corner)) * density;
    out.origin = corner + (0.5 - x) * out.du + (0.5 - y) * out.dv;
    return out;
}

}  // namespace

Result<Unwrapped> unwrap(const Scene& scene, const UnwrapOptions& options) {
    const std::vector<FramedChart> charts = find_framed_charts(scene);
    const double asked = options.density > 0 ? options.density : automatic_density(scene);
    double area = 0;
    for (const FramedChart& chart : charts) area += chart.width * chart.height;
    Unwrapped out;
    out.padding = options.padding, out.size = options.size;
    double fits = asked;
    if (out.size.width > 0) {
        // Begin with the density at which the charts would fill the whole map, and halve it until they fit.
        fits = std::sqrt(static_cast<double>(out.size.texels()) / area);
        constexpr int max_halvings = 40;
        for (int k = 0; !packed(charts, fits, out.size, out.padding); fits /= 2)
            if (++k > max_halvings) return does_not_fit(charts.size(), out.size, "--size");
    } else {
        constexpr int smallest_side = 16, largest_automatic = 4096;
        const int most = options.density > 0 ? options.most : largest_automatic;
        int side = smallest_side;
        while (side < most && !packed(charts, fits, {side, side}, out.padding)) side *= 2;
        out.size = {side, side};
        if (options.density > 0 && !packed(charts, fits, out.size, out.padding))
            return does_not_fit(charts.size(), out.size, "--density");
        constexpr int max_halvings = 20;
        for (int k = 0; !packed(charts, fits, out.size, out.padding); fits /= 2)
            if (++k > max_halvings) return does_not_fit(charts.size(), out.size, "--padding");
    }
    constexpr double at_most = 4;  // upper limit: a quarter of the map's sides would do at this ratio
    out.density = densest(charts, fits, at_most * fits, out.size, out.padding);
    const std::vector<Chart> boxes = *packed(charts, out.density, out.size, out.padding);
    out.charts = charts.size();
    out.regions.resize(scene.regions().size()), out.chart_of.resize(scene.regions().size());
    for (std::size_t c = 0; c < charts.size(); ++c) {
        out.projections.push_back(projection(charts[c], boxes[c], out.density));
        for (const RegionId r : charts[c].faces.regions) {
            const Region& region = scene.regions()[r];
            Chart& chart = out.regions[r.value];
            chart = region_chart(region, charts[c], boxes[c], out.density);
            chart.region = r, out.chart_of[r.value] = static_cast<std::uint32_t>(c);
            if (r != charts[c].faces.regions.front()) chart.room = {};
            const double scale = dot(region.plane.n, charts[c].faces.axis);
            out.smallest_scale = std::min(out.smallest_scale, scale);
            out.filled += scale * region.area * out.density * out.density;
        }
    }
    out.filled /= static_cast<double>(out.size.texels());
    return out;
}

UvSet uv_set_of(const Scene& scene, const Unwrapped& unwrapped) {
    UvSet set;
    set.file = scene.file(), set.name = "TEXCOORD_1";
    for (const std::string& group : scene.groups()) set.objects.push_back(group);
    const CommonCorners corners(scene);
    for (const SurfaceId s : scene.surfaces().ids()) {
        const Surface& face = scene.surfaces()[s];
        const std::span<const Point> outline = scene.outline(s);
        for (const auto& [i, j, k] : triangulate(outline, face.normal)) {
            UvTriangle t{
                s, face.group.value, {corners.at(outline[i]), corners.at(outline[j]), corners.at(outline[k])}, {}};
            for (std::size_t n = 0; n < 3; ++n) t.place[n] = unwrapped.place(face.region, t.corner[n]);
            set.triangles.push_back(t);
        }
    }
    return set;
}

LightMaps as_region_charts(const Unwrapped& unwrapped, const UvLightMaps& light) {
    LightMaps out;
    out.density = unwrapped.density, out.padding = unwrapped.padding;
    out.charts = unwrapped.regions;
    for (const UvLightMap& map : light.maps) out.maps.push_back(map.light);
    out.texels = light.texels;
    out.curved = light.curved;
    return out;
}

}  // namespace exitance
