#include "exitance/view_factors/face_sampler.hpp"

#include "exitance/base/triangulation.hpp"

namespace exitance {

FaceSampler::FaceSampler(const Scene& scene, SurfaceId s) : normal_(scene.surfaces()[s].normal) {
    const std::span<const Point> outline = scene.outline(s);
    for (const auto& piece : convex_pieces(outline, normal_))
        for (std::size_t k = 1; k + 1 < piece.size(); ++k) {
            const Point& o = outline[piece[0]];
            const Vec3 a = outline[piece[k]] - o, b = outline[piece[k + 1]] - o;
            area_ += 0.5 * std::max(0.0, dot(normal_, cross(a, b)));
            triangles_.push_back({o, a, b, area_});
        }
    for (const Point& p : outline) box_.add(p);
}

}  // namespace exitance
