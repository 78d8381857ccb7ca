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
    const double to_cell = 1 / cell, margin = tolerance * to_cell;
    // Half a cell of room at the box's sides, since walls lie there.
    const auto place = [&](const Point& p, std::size_t a) { return (p[a] - box.lo[a]) * to_cell + 0.5; };
    const auto hash_of = [&](const Point& p) {
        const auto number = [&](std::size_t a) { return static_cast<std::int64_t>(place(p, a)); };
        return cell_hash(number(0), number(1), number(2));
    };
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        out[i] = i;
        const std::size_t soon = i + HashChains::ahead;
        if (soon < points.size() && is_finite(points[soon])) chains.prefetch(hash_of(points[soon]));
        const Point& p = points[i];
        if (!is_finite(p)) continue;
        std::int64_t lo[3], hi[3];
        for (std::size_t a = 0; a < 3; ++a) {
            lo[a] = static_cast<std::int64_t>(place(p, a) - margin);
            hi[a] = static_cast<std::int64_t>(place(p, a) + margin);
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
        chains.add(hash_of(p));
        placed.push_back(i);
    }
    return out;
}

}  // namespace exitance
