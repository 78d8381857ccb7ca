#include "exitance/form_factors/met_directions.hpp"

#include "exitance/form_factors/hemisphere.hpp"

namespace exitance {

Vec3 met_direction(const Scene& scene, RegionId own, const Normal& n, double a, double b) {
    if (scene.behind(own).is_none()) return cosine_direction(Frame(n), a, b);
    // Divides the stratified range of `a` between both sides of the pane.
    const double through = scene.material(own).through;
    if (a >= through) return cosine_direction(Frame(n), (a - through) / (1 - through), b);
    const Vec3 w = cosine_direction(Frame(n), a / through, b);
    return w - 2 * dot(w, n) * n;
}

void met_directions(const Scene& scene, RegionId own, const Normal& n, std::span<const double> a,
                    std::span<const double> b, std::span<Vec3> directions) {
    if (scene.behind(own).is_none()) return cosine_directions(Frame(n), a, b, directions);
    for (std::size_t i = 0; i < directions.size(); ++i) directions[i] = met_direction(scene, own, n, a[i], b[i]);
}

}  // namespace exitance
