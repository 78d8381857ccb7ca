#include "exitance/scene/joining/weld.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "exitance/base/limits.hpp"
#include "exitance/base/random.hpp"
#include "exitance/scene/joining/hash_chains.hpp"

namespace exitance {
namespace {

std::uint64_t cell_hash(double i, double j, double k) {
    const auto bits = [](double number) { return std::bit_cast<std::uint64_t>(number); };
    return hash(bits(i), bits(j), bits(k));
}

}  // namespace

std::vector<std::uint32_t> weld(std::span<const Point> points, double tolerance) {
    // Cells are wider than the tolerance, so that few points are near a wall and need a search in neighbouring cells,
    // but narrow enough to contain few distinct points. Cell numbers are doubles: where they have no digits left, the
    // points have none for the tolerance either.
    const double width = std::max(16 * tolerance, min_divisor);

    HashChains chains(points.size());
    std::vector<std::uint32_t> placed;  // point of each entry of the chains
    std::vector<std::uint32_t> out(points.size());
    const double to_cell = 1 / width, margin = tolerance * to_cell;
    // Shifted by half a cell, since scenes have many round coordinates.
    const auto number = [&](double coordinate, double aside) {
        const double cells = std::floor(coordinate * to_cell + 0.5 + aside);
        return std::isfinite(cells) ? cells : coordinate;
    };
    const auto hash_of = [&](const Point& p) { return cell_hash(number(p.x, 0), number(p.y, 0), number(p.z, 0)); };
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        out[i] = i;
        const std::size_t soon = i + HashChains::ahead;
        if (soon < points.size() && is_finite(points[soon])) chains.prefetch(hash_of(points[soon]));
        const Point& p = points[i];
        if (!is_finite(p)) continue;
        // Along each axis one or two cells are within the tolerance.
        double reached[3][2];
        int count[3];
        for (std::size_t a = 0; a < 3; ++a) {
            reached[a][0] = number(p[a], -margin), reached[a][1] = number(p[a], margin);
            count[a] = reached[a][0] == reached[a][1] ? 1 : 2;
        }
        std::uint32_t best = i;
        const auto look_into = [&](std::uint64_t cell) {
            for (std::uint32_t e = chains.first(cell); e != HashChains::end; e = chains.next(e))
                if (placed[e] < best && squared_norm(points[placed[e]] - p) <= tolerance * tolerance) best = placed[e];
        };
        for (int a = 0; a < count[0]; ++a)
            for (int b = 0; b < count[1]; ++b)
                for (int c = 0; c < count[2]; ++c) look_into(cell_hash(reached[0][a], reached[1][b], reached[2][c]));
        out[i] = best;
        if (best != i) continue;
        chains.add(hash_of(p));
        placed.push_back(i);
    }
    return out;
}

}  // namespace exitance
