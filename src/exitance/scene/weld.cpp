#include "exitance/scene/weld.hpp"

#include <cmath>

#include "exitance/core/random.hpp"
#include "exitance/scene/hash_chains.hpp"

namespace exitance {
namespace {

std::uint64_t cell_hash(std::int64_t i, std::int64_t j, std::int64_t k) {
    return hash(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j), static_cast<std::uint64_t>(k));
}

}  // namespace

std::vector<std::uint32_t> weld(std::span<const Point> points, double tolerance) {
    Box box;
    for (const Point& p : points)
        if (is_finite(p)) box.add(p);
    // Cells much wider than the tolerance: few points lie so close to a wall that a neighbour has to be asked too.
    // And not too narrow for the box, lest cell numbers overflow.
    const double extent = std::max({box.size().x, box.size().y, box.size().z, 0.0});
    const double cell = std::max({64 * tolerance, extent * 0x1p-40, 1e-300});

    HashChains chains(points.size());
    std::vector<std::uint32_t> placed;  // entry of the chains -> point
    std::vector<std::uint32_t> out(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        out[i] = i;
        const Point& p = points[i];
        if (!is_finite(p)) continue;
        std::int64_t lo[3], hi[3], own[3];
        for (std::size_t a = 0; a < 3; ++a) {
            const double x = (p[a] - box.lo[a]) / cell, margin = tolerance / cell;
            lo[a] = static_cast<std::int64_t>(std::floor(x - margin));
            hi[a] = static_cast<std::int64_t>(std::floor(x + margin));
            own[a] = static_cast<std::int64_t>(std::floor(x));
        }
        std::uint32_t best = i;
        for (std::int64_t a = lo[0]; a <= hi[0]; ++a)
            for (std::int64_t b = lo[1]; b <= hi[1]; ++b)
                for (std::int64_t c = lo[2]; c <= hi[2]; ++c)
                    for (std::uint32_t e = chains.first(cell_hash(a, b, c)); e != HashChains::end; e = chains.next(e))
                        if (placed[e] < best && squared_norm(points[placed[e]] - p) <= tolerance * tolerance)
                            best = placed[e];
        out[i] = best;
        if (best != i) continue;
        chains.add(cell_hash(own[0], own[1], own[2]));
        placed.push_back(i);
    }
    return out;
}

}  // namespace exitance
