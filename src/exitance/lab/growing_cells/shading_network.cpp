#include "exitance/lab/growing_cells/shading_network.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/lab/growing_cells/growing_cells.hpp"

namespace exitance {
namespace {

/// Length that a unit difference of normals counts as, relative to the scene's size.
constexpr double turn_by_size = 0.5;
constexpr std::size_t samples_per_unit = 60;  ///< Samples between two insertions.
constexpr std::size_t shading_thinnings = 4;  ///< Searches for idle units while a network doubles in size.
constexpr double idle_shading_share = 0.09;   ///< Threshold of [Fritzke94], relative to the mean number of signals.
constexpr std::size_t last_samples = 30;      ///< Samples per unit before the last search for idle units.
constexpr int max_rounds = 3;
constexpr double min_normal_length = 0.9;  ///< Length of the mean normal below which a cell is on a fold.
constexpr double width_by_area = 1.0;      ///< Width of a cell relative to the square root of its area.

std::array<double, 6> coordinates(const SurfacePoint& p, double scale) {
    return {p.x.x, p.x.y, p.x.z, scale * p.n.x, scale * p.n.y, scale * p.n.z};
}

/// The unit nearest to every point.
std::vector<GrowingCells::Unit> winners(const SurfacePool& pool, const GrowingCells& cells, double scale) {
    std::vector<GrowingCells::Unit> out(pool.size());
    parallel_for(pool.size(), 256, [&](std::size_t i) { out[i] = cells.winner(coordinates(pool[i], scale)); });
    return out;
}

struct UnitWins {
    Vec3 place, normal;
    double count = 0;
};

/// Sums of the points that every unit has won, in the order of the pool.
std::vector<UnitWins> gather(const SurfacePool& pool, const std::vector<GrowingCells::Unit>& won, std::size_t units) {
    std::vector<UnitWins> out(units);
    for (std::size_t i = 0; i < pool.size(); ++i) {
        UnitWins& g = out[won[i]];
        g.place += pool[i].x, g.normal += pool[i].n, g.count += 1;
    }
    return out;
}

/// Mean distance to a unit's neighbours on the same surface, metres: those of equal normal that are not above or below
/// it. 0 if there are none.
double edge_length(const GrowingCells& cells, GrowingCells::Unit u, const std::vector<UnitWins>& gathered) {
    double sum = 0, count = 0;
    const Vec3 at = gathered[u].place / gathered[u].count;
    for (const GrowingCells::Unit c : cells.complex().neighbours(u)) {
        if (gathered[c].count == 0) continue;
        if (dot(gathered[c].normal, gathered[u].normal) < min_normal_length * gathered[c].count * gathered[u].count)
            continue;
        constexpr double max_slope = 0.5;  // derived from the sine of 30 degrees, above min_normal_length's 26 degrees
        const Vec3 edge = gathered[c].place / gathered[c].count - at;
        if (std::abs(dot(normalized(gathered[u].normal), edge)) > max_slope * norm(edge)) continue;
        sum += norm(edge), count += 1;
    }
    return count > 0 ? sum / count : 0;
}

/// Moves a cell onto its surfaces if it won points of several parallel ones, so that their mean lies between them. A
/// cell that hovers has hardly any mass on a surface, and the system of the outputs would give it a huge one.
void put_on_surface(const SurfacePoint& nearest, CellLight::Cell& cell) {
    constexpr double max_height = 0.1;  // derived from a weight of exp(-0.01) at the foot; relative to the width
    if (std::abs(dot(nearest.n, cell.at - nearest.x)) > max_height * cell.width)
        cell.at = nearest.x, cell.n = nearest.n;
}

/// Index of the point nearest to the mean of those that each unit has won.
std::vector<std::uint32_t> nearest_won(const SurfacePool& pool, const std::vector<GrowingCells::Unit>& won,
                                       const std::vector<UnitWins>& gathered) {
    std::vector<std::uint32_t> out(gathered.size());
    std::vector<double> least(gathered.size(), HUGE_VAL);
    for (std::uint32_t i = 0; i < pool.size(); ++i) {
        const GrowingCells::Unit u = won[i];
        const double d = squared_norm(pool[i].x - gathered[u].place / gathered[u].count);
        if (d < least[u]) least[u] = d, out[u] = i;
    }
    return out;
}

/// Grows units on samples of the pool until there are `units` of them.
GrowingCells grow_units(const SurfacePool& pool, const std::function<std::uint32_t(double, double)>& draw, double scale,
                        std::size_t units, std::uint64_t seed, const StopRequest& stop) {
    RandomStream random(seed, Stream::mesh, 78);
    const auto sample = [&] {
        const double u = random.uniform(), v = random.uniform();
        return coordinates(pool[draw(u, v)], scale);
    };
    std::vector<double> corners;
    for (int i = 0; i < 3; ++i) {
        const auto at = sample();
        corners.insert(corners.end(), at.begin(), at.end());
    }
    GrowingCells cells({.simplex = 2, .dimension = 6}, corners);
    std::size_t since = 0;
    for (int look = 0; look < max_rounds && !stop.requested(); ++look) {
        // Long edges cross folds, and units that end up between surfaces win nothing and are removed.
        for (std::size_t tries = 0; cells.unit_count() < units && tries < 4 * units && !stop.requested(); ++tries) {
            for (std::size_t i = 0; i < samples_per_unit; ++i) cells.learn(sample(), {}, 1, 0);
            cells.insert();
            if (++since > 8 + cells.unit_count() / shading_thinnings)
                cells.remove_idle(idle_shading_share, false), since = 0;
        }
        cells.remove_idle(0, false);
        for (std::size_t i = 0; i < last_samples * units; ++i) cells.learn(sample(), {}, 1, 0);
        if (cells.remove_idle(idle_shading_share, false) == 0) break;
    }
    cells.refresh();
    return cells;
}

/// Regions of the points that are nearest to each cell and have its normal, which excludes walls at a fold.
std::vector<std::vector<RegionId>> find_own_regions(const SurfacePool& pool, const ShadingNetwork& network) {
    std::vector<std::vector<RegionId>> out(network.cells.size());
    for (std::size_t i = 0; i < pool.size(); ++i) {
        const std::uint32_t c = network.cell_of[i];
        if (dot(pool[i].n, network.cells[c].n) < min_normal_length) continue;
        std::vector<RegionId>& own = out[c];
        const auto at = std::lower_bound(own.begin(), own.end(), pool[i].region);
        if (at == own.end() || *at != pool[i].region) own.insert(at, pool[i].region);
    }
    return out;
}

}  // namespace

ShadingNetwork grow_shading_network(const SurfacePool& pool, const std::function<std::uint32_t(double, double)>& draw,
                                    std::size_t units, bool by_edges, double scene_size, std::uint64_t seed,
                                    const StopRequest& stop) {
    const double scale = turn_by_size * scene_size;
    GrowingCells cells = grow_units(pool, draw, scale, units, seed, stop);
    const std::vector<GrowingCells::Unit> won = winners(pool, cells, scale);
    const std::vector<UnitWins> gathered = gather(pool, won, cells.complex().unit_end());
    const std::vector<std::uint32_t> nearest = nearest_won(pool, won, gathered);
    ShadingNetwork out;
    constexpr std::uint32_t none = 0xffffffffu;
    std::vector<std::uint32_t> number(gathered.size(), none);
    for (GrowingCells::Unit u = 0; u < gathered.size(); ++u) {
        const UnitWins& g = gathered[u];
        if (g.count == 0 || norm(g.normal) < min_normal_length * g.count) continue;
        number[u] = static_cast<std::uint32_t>(out.cells.size());
        const double area = g.count * pool.area_each(), by_area = width_by_area * std::sqrt(area);
        const double by_edge = by_edges ? edge_length(cells, u, gathered) : 0;
        out.cells.push_back({g.place / g.count, normalized(g.normal), by_edge > 0 ? by_edge : by_area, {}, {}});
        if (by_edges) put_on_surface(pool[nearest[u]], out.cells.back());
    }
    if (out.cells.empty()) {  // Every unit is on a fold, as in a very small scene: use a single cell.
        out.cells.push_back({pool[0].x, pool[0].n, std::sqrt(pool.area()), {}, {}});
    }
    // Points of removed units go to the nearest cell in position and normal.
    out.cell_of.resize(pool.size());
    parallel_for(pool.size(), 64, [&](std::size_t i) {
        out.cell_of[i] = number[won[i]];
        if (out.cell_of[i] != none) return;
        double least = HUGE_VAL;
        for (std::uint32_t c = 0; c < out.cells.size(); ++c) {
            const Vec3 turn = out.cells[c].n - pool[i].n;
            const double d = squared_norm(out.cells[c].at - pool[i].x) + scale * scale * squared_norm(turn);
            if (d < least) least = d, out.cell_of[i] = c;
        }
    });
    out.area.assign(out.cells.size(), 0);
    for (const std::uint32_t c : out.cell_of) out.area[c] += pool.area_each();
    out.own_regions = find_own_regions(pool, out);
    const std::vector<GrowingCells::Unit> simplices = cells.complex().simplices();
    for (std::size_t i = 0; i + 2 < simplices.size(); i += 3) {
        const std::array<std::uint32_t, 3> t{number[simplices[i]], number[simplices[i + 1]], number[simplices[i + 2]]};
        if (t[0] != none && t[1] != none && t[2] != none) out.triangles.push_back(t);
    }
    return out;
}

}  // namespace exitance
