#include "exitance/error/area_samples.hpp"

#include <algorithm>

#include "exitance/base/random.hpp"
#include "exitance/mesh/pieces.hpp"

namespace exitance {
namespace {

/// Maps a uniform point of the unit square to the patch; for triangles, folds the square at its diagonal.
Point uniform_point(const Patch& patch, double u, double v) {
    return patch.is_triangle() && u + v > 1 ? patch.at(1 - u, 1 - v) : patch.at(u, v);
}

}  // namespace

std::vector<ProbePoint> points_uniform_in_area(const Scene& scene, std::size_t count, std::uint64_t seed) {
    const std::vector<Piece> pieces = cut_into_pieces(scene);
    std::vector<double> area_up_to;
    double area = 0;
    for (const Piece& piece : pieces) area_up_to.push_back(area += piece.patch.area());

    std::vector<ProbePoint> points;
    points.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        RandomStream random(seed, Stream::reference, i);
        const double at = area * (static_cast<double>(i) + random.uniform()) / static_cast<double>(count);
        const auto piece =
            static_cast<std::size_t>(std::upper_bound(area_up_to.begin(), area_up_to.end(), at) - area_up_to.begin());
        const auto& [region, patch] = pieces[std::min(piece, pieces.size() - 1)];
        const double u = random.uniform(), v = random.uniform();
        points.push_back({uniform_point(patch, u, v), scene.regions()[region].plane.n});
    }
    return points;
}

}  // namespace exitance
