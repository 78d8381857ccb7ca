#include "exitance/error/certificate_places.hpp"

#include "exitance/base/parallel.hpp"
#include "exitance/calibration/numbers.hpp"

namespace exitance {
namespace {

/// Maps a number in [0, 1) such that the density is higher by 1 / share near both ends. Elements have their largest
/// errors at edges and next to corners and contacts, where light varies faster than any polynomial.
struct TowardsEnds {
    double at, share;

    explicit TowardsEnds(double s) : at(s * s * (3 - 2 * s)), share(6 * s * (1 - s)) {}
};

/// Divides the running sum of the leaves' weights into `count` equal strata. Calls visit(k, leaf) with the leaf that
/// contains a random point of stratum k. `total`: sum of the weights of all `leaves` leaves.
template <class WeightOf, class Visit>
void for_strata(const ScrambledSobol& points, std::size_t count, std::size_t leaves, double total,
                const WeightOf& weight_of, const Visit& visit) {
    double before = 0;
    std::size_t leaf = 0;
    for (std::uint32_t k = 0; k < count; ++k) {
        const double wanted = total * (k + points(k, 0)) / static_cast<double>(count);
        while (leaf + 1 < leaves && before + weight_of(leaf) <= wanted) before += weight_of(leaf++);
        visit(k, leaf);
    }
}

}  // namespace

std::vector<WeightedSample> stratified_places(const Stage& stage, const ElementTree& tree,
                                              const Field<ElementId, std::uint8_t>& narrow,
                                              const CertificateOptions& options, std::uint64_t seed) {
    const Field<ElementId, LocalPassReport::Leaf>* const known = options.leaves;
    const std::vector<ElementId> leaves = tree.leaves();
    // If every room has its own allowed error, the points are equally dense in all rooms, and the error of a leaf is
    // weighted by the allowed error of its room.
    struct Leaf {
        double counted, error;
    };
    std::vector<Leaf> own(leaves.size());
    parallel_for(leaves.size(), 1024, [&](std::size_t i) {
        const ElementId e = leaves[i];
        const double allowed = options.allowed_in.empty() ? 1 : options.allowed_in[stage.rooms.of(tree, e)];
        own[i] = {stage.counted_area(tree, e),
                  known ? std::pow(LocalPassReport::known(*known, tree, e).expected_error / allowed, 2) : 0};
    });
    double area = 0, error = 0, in_gaps = 0;
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        area += own[i].counted;
        error += own[i].counted * own[i].error;
        in_gaps += narrow[leaves[i]] ? own[i].counted : 0;
    }
    constexpr double unlit_density = 0.1;  // density of points on unlit sides, relative to others; given by few points
    const double mean_error = error / area;
    const double share = calibrated::narrow_points;
    const double of_narrow = in_gaps > 0 ? share / (1 - share) * area / in_gaps : 0;
    const std::size_t count = options.points;
    std::vector<double> density(leaves.size());
    parallel_for(leaves.size(), 1024, [&](std::size_t i) {
        const ElementId e = leaves[i];
        const double reduction = stage.is_unlit(tree.region(e)) ? unlit_density : 1;
        const double expected = mean_error > 0 ? 0.5 + 0.5 * own[i].error / mean_error : 1.0;
        density[i] = reduction * stage.rooms.weight(tree, e) * (expected + (narrow[e] ? of_narrow : 0));
    });
    const auto weight_of = [&](std::size_t i) { return tree.area(leaves[i]) * density[i]; };
    double total = 0;
    for (std::size_t i = 0; i < leaves.size(); ++i) total += weight_of(i);
    const double share_of_all = total / stage.area;  // 1 if no leaf is unlit or narrow
    const ScrambledSobol points(hash(seed, static_cast<std::uint64_t>(Stream::certificate)));
    std::vector<WeightedSample> out;
    for_strata(points, count, leaves.size(), total, weight_of, [&](std::uint32_t k, std::size_t leaf) {
        const ElementId e = leaves[leaf];
        const TowardsEnds s(points(k, 1)), t(points(k, 2));
        out.push_back({{e, tree.uniform(e, s.at, t.at)},
                       share_of_all * s.share * t.share / (density[leaf] * static_cast<double>(count))});
    });
    return out;
}

std::vector<WeightedSample> places_on_body(const ElementTree& tree, std::span<const ElementId> leaves,
                                           std::size_t count, std::uint64_t seed) {
    double total = 0;
    for (ElementId e : leaves) total += tree.area(e);
    const ScrambledSobol points(hash(seed, static_cast<std::uint64_t>(Stream::certificate)));
    std::vector<WeightedSample> out;
    const auto weight_of = [&](std::size_t i) { return tree.area(leaves[i]); };
    for_strata(points, count, leaves.size(), total, weight_of, [&](std::uint32_t k, std::size_t leaf) {
        const ElementId e = leaves[leaf];
        out.push_back({{e, tree.uniform(e, points(k, 1), points(k, 2))}, 1 / static_cast<double>(count)});
    });
    return out;
}

std::vector<WeightedSample> in_turn(const std::vector<ElementTree::Place>& places, std::size_t count) {
    std::vector<WeightedSample> out;
    for (std::size_t k = 0; k < count; ++k) out.push_back({places[k % places.size()], 1 / static_cast<double>(count)});
    return out;
}

}  // namespace exitance
