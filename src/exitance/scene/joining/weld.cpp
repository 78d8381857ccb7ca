#include "exitance/scene/joining/weld.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

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
    // Cells wider than the tolerance: few points lie so close to a wall that a neighbour has to be asked too; but not
    // so wide that many places that differ have room in one. They are numbered in doubles: where these have no digits
    // left for cells, neither have points for the tolerance.
    const double width = std::max(16 * tolerance, 1e-300);

    HashChains chains(points.size());
    std::vector<std::uint32_t> placed;  // entry of the chains -> point
    std::vector<std::uint32_t> out(points.size());
    const double to_cell = 1 / width, margin = tolerance * to_cell;
    // Half a cell aside, since walls lie at round numbers.
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
        // Within reach lies one cell an axis, or two.
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
