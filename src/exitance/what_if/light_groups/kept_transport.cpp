#include "exitance/what_if/light_groups/kept_transport.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/mesh/element_locator.hpp"

namespace exitance {
namespace {

/// Distance from a corner at which a leaf is evaluated, since light may jump at its border; in units of the leaf.
constexpr double inwards = 1e-3;  // derived from the tolerance of points, which is less than a thousandth of an element

/// For every element of `indirect` that is a receiver or a part of one: the receiver's row in the transport.
Field<ElementId, std::uint32_t> rows_of(const ElementTree& tree, std::span<const std::uint32_t> receivers) {
    Field<ElementId, std::uint32_t> row(tree.size(), TransportLayout::none);
    for (std::uint32_t i = 0; i < receivers.size(); ++i) row[ElementId(receivers[i])] = i;
    for (const ElementId e : tree.ids())
        if (row[e] == TransportLayout::none && !tree.parent(e).is_none()) row[e] = row[tree.parent(e)];
    return row;
}

/// A point of a receiver's plane, interpolated from the receiver's corners among those of all receivers.
Between on_receiver(const ElementTree& tree, std::span<const std::uint32_t> receivers, std::uint32_t row,
                    const Point& x) {
    if (row == TransportLayout::none) return {};
    const Patch& patch = tree.patch(ElementId(receivers[row]));
    return {4 * row, corner_weights(patch, patch.coordinates(x))};
}

/// Lists the sources, the share of every leaf in the mean of its source, and that of every child in its parent's mean.
void find_sources(const Solution& solution, TransportLayout& out) {
    const ElementTree& tree = solution.interpolant.tree;
    out.number.resize(tree.size(), TransportLayout::none);
    for (const ElementId e : tree.ids()) {
        if (!is_base(tree, e)) continue;
        out.number[e] = static_cast<std::uint32_t>(out.sources.size());
        out.sources.push_back(e), out.area.push_back(tree.area(e));
        out.material.push_back(solution.scene.regions()[tree.region(e)].material);
    }
    for (const ElementId e : tree.leaves()) {
        const ElementId base = is_base(tree, e) ? e : tree.parent(e);
        const Between at{solution.interpolant.first_value[e], corner_weights(tree.patch(e), tree.centre(e))};
        out.source_mean.push_back({out.number[base], tree.area(e) / tree.area(base), at});
    }
    for (std::size_t i = tree.size(); i-- > 0;) {
        const ElementId e(i), parent = tree.parent(e);
        if (parent.is_none() || out.number[parent] != TransportLayout::none || !(tree.area(parent) > 0)) continue;
        out.pulls.push_back({parent.value, e.value, tree.area(e) / tree.area(parent)});
    }
}

}  // namespace

std::array<float, 4> corner_weights(const Patch& patch, Vec2 uv) {
    const auto [u, v] = uv;
    const auto f = [](double w) { return static_cast<float>(w); };
    if (patch.is_triangle()) return {f(1 - u - v), f(u), f(v), 0};
    return {f((1 - u) * (1 - v)), f(u * (1 - v)), f(u * v), f((1 - u) * v)};
}

bool is_base(const ElementTree& tree, ElementId e) {
    const ElementId parent = tree.parent(e);
    if (!parent.is_none() && tree.cut_of(parent) == Cut::fan) return false;
    return tree.is_leaf(e) || tree.cut_of(e) == Cut::fan;
}

TransportLayout make_layout(const Solution& solution, std::span<const std::uint32_t> receivers) {
    TransportLayout out;
    const ElementFunction &indirect = solution.indirect, &interpolant = solution.interpolant;
    find_sources(solution, out);
    const Field<ElementId, std::uint32_t> row = rows_of(indirect.tree, receivers);
    const ElementLocator locator(indirect.tree, solution.scene.regions().size());
    out.source_at.resize(out.sources.size());
    parallel_for(out.sources.size(), 256, [&](std::size_t i) {
        const ElementId e = out.sources[i];
        const Point x = interpolant.tree.patch(e).at(interpolant.tree.centre(e));
        const ElementId below = locator.find(interpolant.tree.region(e), x).element;
        if (!below.is_none()) out.source_at[i] = on_receiver(indirect.tree, receivers, row[below], x);
    });
    out.corner_at.resize(indirect.values.size()), out.interpolant_at.resize(interpolant.values.size());
    const auto each_corner = [](const ElementFunction& f, const auto& place) {
        const std::vector<ElementId> leaves = f.tree.leaves();
        parallel_for(leaves.size(), 64, [&](std::size_t i) {
            for (int k = 0; k < f.tree.patch(leaves[i]).corner_count(); ++k)
                place(leaves[i], k, f.first_value[leaves[i]] + static_cast<std::uint32_t>(k));
        });
    };
    each_corner(indirect, [&](ElementId e, int k, std::uint32_t value) {
        out.corner_at[value] = on_receiver(indirect.tree, receivers, row[e], indirect.tree.patch(e).corner(k));
    });
    each_corner(interpolant, [&](ElementId e, int k, std::uint32_t value) {
        const Patch& patch = interpolant.tree.patch(e);
        const Vec2 centre = interpolant.tree.centre(e);
        const Point inside = patch.at(centre + (1 - inwards) * (patch.corner_uv(k) - centre));
        const ElementId on = locator.find(interpolant.tree.region(e), inside).element;
        if (on.is_none()) return;
        const Patch& below = indirect.tree.patch(on);
        out.interpolant_at[value] = {indirect.first_value[on],
                                     corner_weights(below, below.coordinates(patch.corner(k)))};
    });
    out.node = number_nodes(indirect, solution.scene.size(), out.node_count);
    return out;
}

std::vector<std::uint32_t> number_nodes(const ElementFunction& f, double scene_size, std::size_t& count) {
    const double grid = 1e-6 * scene_size;  // derived from the single precision of corners in other programs
    struct Corner {
        std::array<std::int64_t, 4> place;
        std::array<std::uint32_t, bands> value;
        std::uint32_t number;

        auto operator<=>(const Corner&) const = default;
    };
    std::vector<Corner> corners;
    for (const ElementId e : f.tree.leaves()) {
        const Patch& patch = f.tree.patch(e);
        for (int i = 0; i < patch.corner_count(); ++i) {
            const Point p = patch.corner(i);
            Corner corner{
                {f.tree.region(e).value, std::llround(p.x / grid), std::llround(p.y / grid), std::llround(p.z / grid)},
                {},
                f.first_value[e] + static_cast<std::uint32_t>(i)};
            for (std::size_t band = 0; band < bands; ++band)
                corner.value[band] = std::bit_cast<std::uint32_t>(f.values[corner.number][band]);
            corners.push_back(corner);
        }
    }
    std::sort(corners.begin(), corners.end());
    constexpr std::uint32_t unused = 0xffffffffu;
    std::vector<std::uint32_t> out(f.values.size(), unused);
    count = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const bool is_new =
            i == 0 || corners[i].place != corners[i - 1].place || corners[i].value != corners[i - 1].value;
        if (is_new) ++count;
        out[corners[i].number] = static_cast<std::uint32_t>(count - 1);
    }
    // values that belong to no corner, as in constant functions, share one node
    if (std::find(out.begin(), out.end(), unused) != out.end())
        std::replace(out.begin(), out.end(), unused, static_cast<std::uint32_t>(count++));
    return out;
}

void average_at_nodes(std::span<const std::uint32_t> node, std::size_t count, std::vector<Spectrum>& values) {
    std::vector<Spectrum> sum(count);
    std::vector<double> meet(count, 0);
    for (std::size_t i = 0; i < values.size(); ++i) sum[node[i]] += values[i], meet[node[i]] += 1;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = sum[node[i]] * (1 / meet[node[i]]);
}

std::vector<Spectrum> KeptOperator::at_receivers(std::span<const Spectrum> radiosity) const {
    std::vector<Spectrum> mean(elements_);
    for (std::size_t i = 0; i < radiosity.size(); ++i) mean[layout_.sources[i].value] = radiosity[i];
    for (const TransportLayout::Pull& pull : layout_.pulls) mean[pull.parent] += pull.share * mean[pull.child];
    std::vector<Spectrum> out(4 * transport_.receiver.size());
    parallel_for(transport_.receiver.size(), 64, [&](std::size_t i) {
        std::array<Spectrum, 4> sum;
        for (std::uint32_t k = transport_.first[i]; k < transport_.first[i + 1]; ++k) {
            const Spectrum& b = mean[transport_.source[k]];
            for (std::size_t c = 0; c < 4; ++c) sum[c] += static_cast<double>(transport_.weight[k][c]) * b;
        }
        std::copy(sum.begin(), sum.end(), out.begin() + static_cast<std::ptrdiff_t>(4 * i));
    });
    return out;
}

std::vector<Spectrum> KeptOperator::at_corners(const std::vector<Spectrum>& receivers) const {
    std::vector<Spectrum> out(layout_.corner_at.size());
    parallel_for(out.size(), 4096, [&](std::size_t i) { out[i] = layout_.corner_at[i].of(receivers); });
    average_at_nodes(layout_.node, layout_.node_count, out);
    return out;
}

void KeptOperator::gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const {
    const std::vector<Spectrum> receivers = at_receivers(radiosity);
    parallel_for(irradiance.size(), 4096, [&](std::size_t i) { irradiance[i] = layout_.source_at[i].of(receivers); });
}

Spectrum KeptOperator::gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const {
    return layout_.source_at[receiver].of(at_receivers(radiosity));
}

}  // namespace exitance
