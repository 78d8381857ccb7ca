#include "exitance/lab/growing_cells/surface_pool.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

/// Length that a unit difference of normals counts as, relative to the scene's size.
constexpr double pool_turn_by_size = 0.5;

double coordinate(const SurfacePoint& p, std::size_t axis, double normal_scale) {
    return axis < 3 ? p.x[axis] : normal_scale * p.n[axis - 3];
}

}  // namespace

SurfacePool::SurfacePool(const Stage& stage, std::size_t count, std::uint64_t seed)
    : in_plane_(1e-5 * stage.scene.size()) {
    const std::vector<Piece> pieces = stage.lit_pieces();
    for (const Piece& piece : pieces) area_ += piece.patch.area();
    const std::size_t n = std::bit_ceil(std::max<std::size_t>(count, 1));
    const ScrambledSobol sobol(hash(seed, static_cast<std::uint64_t>(Stream::mesh), 1));
    points_.reserve(n);
    double before = 0;
    std::size_t piece = 0;
    for (std::uint32_t k = 0; k < n && !pieces.empty(); ++k) {
        const double wanted = area_ * (k + sobol(k, 0)) / static_cast<double>(n);
        while (piece + 1 < pieces.size() && before + pieces[piece].patch.area() <= wanted)
            before += pieces[piece].patch.area(), ++piece;
        const Patch& patch = pieces[piece].patch;
        points_.push_back({patch.at(uniform_in_shape(patch.shape, sobol(k, 1), sobol(k, 2))),
                           stage.scene.regions()[pieces[piece].region].plane.n, pieces[piece].region});
    }
    sort(0, points_.size(), pool_turn_by_size * stage.scene.size());
}

void SurfacePool::sort(std::size_t first, std::size_t count, double normal_scale) {
    if (count < 2) return;
    std::size_t widest = 0;
    double extent = -1;
    for (std::size_t axis = 0; axis < 6; ++axis) {
        double lo = HUGE_VAL, hi = -HUGE_VAL;
        for (std::size_t i = first; i < first + count; ++i) {
            const double v = coordinate(points_[i], axis, normal_scale);
            lo = std::min(lo, v), hi = std::max(hi, v);
        }
        if (hi - lo > extent) extent = hi - lo, widest = axis;
    }
    const auto begin = points_.begin() + static_cast<std::ptrdiff_t>(first);
    const auto half = static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(begin, begin + half, begin + static_cast<std::ptrdiff_t>(count),
                     [&](const SurfacePoint& a, const SurfacePoint& b) {
                         return coordinate(a, widest, normal_scale) < coordinate(b, widest, normal_scale);
                     });
    sort(first, count / 2, normal_scale);
    sort(first + count / 2, count - count / 2, normal_scale);
}

std::uint32_t SurfacePool::near(std::uint32_t i, double width, double u) const {
    const double wanted = pi * width * width / area_each();
    std::size_t block = 1;
    while (static_cast<double>(block) < wanted && block < points_.size()) block *= 2;
    const std::size_t first = i / block * block;
    return static_cast<std::uint32_t>(first + static_cast<std::size_t>(u * static_cast<double>(block)));
}

}  // namespace exitance
