#include "exitance/transport/light_openings.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "exitance/base/parallel.hpp"

namespace exitance {
namespace {

/// Largest area of an opening, as a share of the smaller side's walls. Chosen: half of it and twice it give the same
/// rooms, measured by `exitance solve office.obj --error 0.02`.
constexpr double max_opening = 0.1;
/// Largest area of an opening relative to the openings that the neighbouring cuts would have.
constexpr double max_ratio_to_neighbours = 0.5;
/// Distance of the neighbouring cuts, as a share of the smaller side's walls. Chosen: half of it and twice it give
/// the same rooms, measured by `exitance solve office.obj --error 0.02`.
constexpr double neighbour_distance = 0.2;
/// Number of iterations; each averages the previous values with those after a reflection. If an opening is a twentieth
/// of the walls, a third of the difference between its two sides is left after them.
constexpr int steps = 60;

/// Flux that a leaf of exitance 1 W/m^2 sends to the sky, W.
double sent_to_sky(const Flow& flow, std::uint32_t leaf) {
    return flow.area[leaf] * share_to_sky(flow, leaf);
}

double sent_to_sky(const Flow& flow, const LeafNumbers& leaves) {
    double sum = 0;
    for (std::uint32_t i : leaves) sum += sent_to_sky(flow, i);
    return sum;
}

/// Mean of x over the leaves, weighted by the flux that each sends to the sky.
double mean_towards_sky(const Flow& flow, const LeafNumbers& leaves, const std::vector<double>& x) {
    double sum = 0, all = 0;
    for (std::uint32_t i : leaves) {
        const double sent = sent_to_sky(flow, i);
        sum += sent * x[i], all += sent;
    }
    return all > 0 ? sum / all : 0;
}

/// Iterates reflection within a part from `flow.start`, and returns the differences that decay slowest: mean 0, largest
/// absolute value 1.
std::vector<double> slow_difference(const Flow& flow, const LeafNumbers& leaves, std::uint16_t part) {
    std::vector<double> x = flow.start, next(flow.area.size());
    for (int step = 0; step < steps; ++step) {
        const double sky = mean_towards_sky(flow, leaves, x);
        parallel_for(leaves.size(), 256, [&](std::size_t k) {
            const std::uint32_t i = leaves[k];
            double sum = 0;
            std::size_t met = 0;
            for (std::uint32_t j : flow.rows.hits(i))
                if (j != RayRows::missed && flow.part[j] == part) sum += x[j], ++met;
            sum += flow.to_sky[i] * sky, met += flow.to_sky[i];
            next[i] = met > 0 ? 0.5 * (x[i] + sum / static_cast<double>(met)) : x[i];
        });
        double mean = 0, area = 0, largest = 0;
        for (std::uint32_t i : leaves) mean += flow.area[i] * next[i], area += flow.area[i];
        for (std::uint32_t i : leaves) x[i] = next[i] - mean / area, largest = std::max(largest, std::abs(x[i]));
        for (std::uint32_t i : leaves) x[i] /= largest > 0 ? largest : 1;
    }
    return x;
}

/// Opening between the first leaves of an order and the others, m^2, for every position of the cut. Measured from the
/// side with the smaller area: the few rays of a leaf on the larger side rarely find the opening.
struct Cuts {
    /// Per k: area of the first k + 1 leaves, and the opening between them and the others.
    std::vector<double> area, opening;
};

Cuts sweep(const Flow& flow, const LeafNumbers& order, std::uint16_t part) {
    std::vector<std::uint32_t> rank(flow.area.size());
    for (std::size_t k = 0; k < order.size(); ++k) rank[order[k]] = static_cast<std::uint32_t>(k);
    const std::size_t n = order.size();
    // Light from a leaf to one of higher (lower) rank crosses all cuts between them. Lost rays leave through an
    // opening, too.
    std::vector<double> up(n + 1), down(n + 1), lost(n), to_sky(n);
    double all_lost = 0, all_to_sky = 0;
    for (std::size_t k = 0; k < n; ++k) {
        const auto hits = flow.rows.hits(order[k]);
        const double each = flow.area[order[k]] / static_cast<double>(hits.size());
        for (std::uint32_t j : hits) {
            if (j == RayRows::missed || flow.part[j] != part) continue;
            const std::size_t other = rank[j];
            if (other > k) up[k] += each, up[other] -= each;
            if (other < k) down[other] += each, down[k] -= each;
        }
        lost[k] = flow.lost[order[k]] * each;
        to_sky[k] = sent_to_sky(flow, order[k]);
        all_lost += lost[k], all_to_sky += to_sky[k];
    }
    Cuts out{std::vector<double>(n), std::vector<double>(n)};
    double area = 0, total = 0, u = 0, d = 0, lost_below = 0, to_sky_below = 0;
    for (std::uint32_t i : order) total += flow.area[i];
    for (std::size_t k = 0; k < n; ++k) {
        area += flow.area[order[k]], u += up[k], d += down[k], lost_below += lost[k], to_sky_below += to_sky[k];
        const bool is_small = 2 * area <= total;
        // The sky is assigned to the side that sends more light to it. Only the light that the other side sends to the
        // sky crosses the cut.
        const double outwards =
            (is_small ? lost_below : all_lost - lost_below) + std::min(to_sky_below, all_to_sky - to_sky_below);
        out.area[k] = area;
        out.opening[k] = (is_small ? u : d) + outwards;
    }
    return out;
}

/// True if the opening at a cut is narrower than those at neighbouring cuts. Along a corridor all have the
/// same size.
bool is_narrow(const Cuts& cuts, std::size_t k, double smaller) {
    for (const double off : {-neighbour_distance, neighbour_distance}) {
        const auto at = std::lower_bound(cuts.area.begin(), cuts.area.end(), cuts.area[k] + off * smaller);
        const auto other = static_cast<std::size_t>(at - cuts.area.begin());
        if (other + 1 < cuts.area.size() && other != k &&
            cuts.opening[other] * max_ratio_to_neighbours < cuts.opening[k])
            return false;
    }
    return true;
}

/// Number of leaves before the acceptable cut that has the largest area on its smaller side; 0 if there is no such cut.
std::size_t best_cut(const Cuts& cuts) {
    const std::size_t n = cuts.area.size();
    const double total = cuts.area.back();
    std::size_t best = 0;
    double most = 0;
    for (std::size_t k = 0; k + 1 < n; ++k) {
        const double smaller = std::min(cuts.area[k], total - cuts.area[k]);
        if (smaller <= most || cuts.opening[k] >= max_opening * smaller || !is_narrow(cuts, k, smaller)) continue;
        best = k + 1, most = smaller;
    }
    return best;
}

/// Moves each leaf to the side that most of its rays hit. An order from few rays puts some leaves on the wrong side of
/// a cut, where they would be judged by the light of the other room. The sky belongs to the side that sends more light
/// to it. Returns nullopt if a side has no leaves left.
std::optional<OpeningBetween> by_what_is_seen(const Flow& flow, OpeningBetween sides, std::uint16_t part) {
    constexpr int max_sweeps = 8;
    std::vector<std::uint8_t> is_large(flow.area.size());
    for (std::uint32_t i : sides.large) is_large[i] = 1;
    const int sky = sent_to_sky(flow, sides.large) > sent_to_sky(flow, sides.small) ? 1 : -1;
    LeafNumbers all = sides.small;
    all.insert(all.end(), sides.large.begin(), sides.large.end());
    std::sort(all.begin(), all.end());
    for (int sweep = 0; sweep < max_sweeps; ++sweep) {
        std::vector<std::uint8_t> next = is_large;
        for (std::uint32_t i : all) {
            int towards_large = 0;
            for (std::uint32_t j : flow.rows.hits(i))
                if (j != RayRows::missed && flow.part[j] == part) towards_large += is_large[j] ? 1 : -1;
            towards_large += sky * static_cast<int>(flow.to_sky[i]);
            if (towards_large != 0) next[i] = towards_large > 0 ? 1 : 0;
        }
        if (std::exchange(is_large, next) == next) break;
    }
    OpeningBetween out;
    double small = 0, large = 0;  // m^2
    for (std::uint32_t i : all) {
        (is_large[i] ? out.large : out.small).push_back(i);
        (is_large[i] ? large : small) += flow.area[i];
    }
    if (out.small.empty() || out.large.empty()) return std::nullopt;
    if (small > large) std::swap(out.small, out.large);
    return out;
}

}  // namespace

double share_to_sky(const Flow& flow, std::uint32_t leaf) {
    return static_cast<double>(flow.to_sky[leaf]) / static_cast<double>(flow.rows.hits(leaf).size());
}

std::optional<OpeningBetween> find_opening(const Flow& flow, const LeafNumbers& leaves, std::uint16_t part) {
    LeafNumbers order = leaves;
    const std::vector<double> x = slow_difference(flow, order, part);
    std::sort(order.begin(), order.end(), [&](auto i, auto j) { return x[i] != x[j] ? x[i] < x[j] : i < j; });
    const Cuts cuts = sweep(flow, order, part);
    const std::size_t cut = best_cut(cuts);
    if (cut == 0) return std::nullopt;
    const auto middle = order.begin() + static_cast<std::ptrdiff_t>(cut);
    return by_what_is_seen(flow, {{order.begin(), middle}, {middle, order.end()}}, part);
}

}  // namespace exitance
