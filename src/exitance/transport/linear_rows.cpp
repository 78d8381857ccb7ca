#include "exitance/transport/linear_rows.hpp"

#include <limits>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/basis/element_fit.hpp"
#include "exitance/form_factors/met_directions.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/transport/light_portals.hpp"

namespace exitance {
namespace {

/// Stored number of a coordinate of 1.
constexpr double quantised_one = std::numeric_limits<std::uint16_t>::max();

std::uint16_t quantised(double t) {
    return static_cast<std::uint16_t>(std::clamp(t, 0.0, 1.0) * quantised_one + 0.5);
}

/// Nodes of a leaf. A cell with many corners uses eight of the rule's nodes.
std::vector<WeightedPlace> leaf_nodes(const ElementTree& tree, ElementId e) {
    std::vector<WeightedPlace> nodes = element_rule(tree, e, RuleOrder::nodes);
    while (nodes.size() > 8) nodes.pop_back();
    double sum = 0;
    for (const WeightedPlace& node : nodes) sum += node.weight;
    for (WeightedPlace& node : nodes) node.weight /= sum;
    return nodes;
}

/// Aims the second half of a node's rays at openings if that reduces the noise, and sets the rays' weights.
void aim(const Stage& stage, const Point& x, const Normal& n, RegionId region, const ScrambledSobol& points,
         std::span<Vec3> directions, std::span<float> counts) {
    const std::span<const PortalCell> cells = portals_worth_aiming(stage, region, x, n);
    if (cells.empty()) return;
    PortalAim aim;
    aim.set(cells, x, n);
    const std::size_t half = directions.size() / 2;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        double weight = i < half && !aim.is_aimed_at(directions[i]) ? 1 : 0;
        if (i >= half) {
            const auto index = static_cast<std::uint32_t>(i);
            const PortalAim::Ray ray = aim.aimed(points(index, 0), points(index, 1));
            directions[i] = ray.direction, weight = ray.weight;
        }
        counts[i] = static_cast<float>(PortalAim::share * weight);
    }
}

}  // namespace

LinearRows::LinearRows(const Stage& stage, const DirectProjection& direct, const LeafNumbering& numbering,
                       const ElementLocator& locator, RayBudget budget, std::uint64_t seed)
    : ids_(numbering.leaves) {
    cast(stage, number_nodes(stage, direct.tree, budget), numbering, locator, seed);
    find_what_is_met();
}

/// Numbers the nodes of all leaves and the rays of the own nodes. Returns the position of every node.
std::vector<LinearRows::NodePlace> LinearRows::number_nodes(const Stage& stage, const ElementTree& tree,
                                                            const RayBudget& budget) {
    std::vector<std::vector<WeightedPlace>> nodes_of(ids_.size());
    leaves_.resize(ids_.size());
    parallel_for(ids_.size(), 64, [&](std::size_t i) {
        const ElementId e = ids_[i];
        const std::vector<WeightedPlace>& nodes = nodes_of[i] = leaf_nodes(tree, e);
        Leaf& leaf = leaves_[i];
        leaf = {.node_count = static_cast<std::uint32_t>(nodes.size()),
                .triangle = tree.patch(e).is_triangle(),
                .reflectance = stage.scene.material(tree.region(e)).reflectance};
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            // The polynomial with value 1 at node k and 0 at the others gives the weights of that node.
            std::vector<Spectrum> unit(nodes.size());
            unit[k] = Spectrum(1.0);
            const ElementFit fit(tree, e, nodes, unit);
            for (int c = 0; c < tree.patch(e).corner_count(); ++c)
                leaf.to_corner[static_cast<std::size_t>(c)][k] = static_cast<float>(fit.corner(c)[0]);
        }
    });
    std::vector<NodePlace> places;
    std::vector<unsigned> rays;
    const double mean_area = stage.area / static_cast<double>(ids_.size());
    for (std::size_t i = 0; i < ids_.size(); ++i) {
        const ElementId e = ids_[i];
        leaves_[i].first_node = static_cast<std::uint32_t>(nodes_.size());
        for (const WeightedPlace& node : nodes_of[i]) {
            nodes_.push_back({.area = node.weight * tree.area(e)});
            places.push_back({tree.patch(e).at(node.uv), tree.region(e)});
            rays.push_back(budget.rays(tree.area(e), mean_area));
            rays_ += rays.back();
        }
    }
    dealt_ = DealtUnknowns(nodes_.size(), dealt_block(nodes_.size()));
    std::size_t at = 0;
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
        nodes_[k].first_ray = at;
        nodes_[k].last_ray = at += dealt_.is_own(k) ? rays[k] : 0;
    }
    hits_.resize(at);
    if (stage.rooms.portals()) counts_.assign(at, 1);
    if (!stage.glass.empty()) colours_.assign(at, Spectrum(1.0));
    return places;
}

void LinearRows::cast(const Stage& stage, std::span<const NodePlace> places, const LeafNumbering& numbering,
                      const ElementLocator& locator, std::uint64_t seed) {
    parallel_own_ranges(nodes_.size(), dealt_.block(), [&](std::size_t begin, std::size_t end) {
        std::vector<Vec3> directions;
        std::vector<RayHit> found;
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t first = nodes_[k].first_ray, count = nodes_[k].last_ray - first;
            const auto& [place, region] = places[k];
            const Normal& n = stage.scene.regions()[region].plane.n;
            const ScrambledSobol points(hash(seed, static_cast<std::uint64_t>(Stream::rows), k));
            directions.resize(count), found.resize(count);
            for (std::uint32_t i = 0; i < count; ++i)
                directions[i] = met_direction(stage.scene, region, n, points(i, 0), points(i, 1));
            if (!counts_.empty())
                aim(stage, place, n, region, points, directions, std::span(counts_).subspan(first, count));
            stage.tracer.nearest(directions, place, region, found, Mirrored::followed);
            for (std::size_t i = 0; i < count; ++i) {
                if (found[i].surface.is_none() || !found[i].front) continue;
                if (!colours_.empty()) colours_[first + i] = stage.glass.of(found[i], place, directions[i]);
                const Point y = place_of(stage.scene, found[i], place, directions[i]);
                const auto [element, uv] = locator.find(stage.scene.surfaces()[found[i].surface].region, y);
                hits_[first + i] = {numbering.number[element], quantised(uv.x), quantised(uv.y)};
            }
        }
    });
}

/// Finds the leaves that own rows read, and replaces leaf numbers in `hits_` by indices of `met_`.
void LinearRows::find_what_is_met() {
    std::vector<std::uint8_t> met(leaves_.size(), 0), marked(nodes_.size(), 0);
    do_own_share([&] {
        parallel_for(dealt_.own_count(), 256, [&](std::size_t at) {
            const Node& node = nodes_[dealt_.unknown(at)];
            for (std::size_t i = node.first_ray; i < node.last_ray; ++i)
                if (hits_[i].leaf != missed) FetchedValues::mark(met[hits_[i].leaf], dealt_, at);
        });
    });
    std::vector<std::uint32_t> place(leaves_.size(), 0);
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
        if (met[i] == 0) continue;
        place[i] = static_cast<std::uint32_t>(met_.size());
        met_.push_back(static_cast<std::uint32_t>(i));
        std::fill_n(marked.begin() + leaves_[i].first_node, leaves_[i].node_count, met[i]);
    }
    parallel_for(hits_.size(), 4096, [&](std::size_t i) {
        if (hits_[i].leaf != missed) hits_[i].leaf = place[hits_[i].leaf];
    });
    fetched_ = FetchedValues(dealt_, marked);
    const std::vector<std::uint32_t> places = fetched_.places();
    for (const std::uint32_t i : met_) {
        first_read_.push_back(static_cast<std::uint32_t>(read_.size()));
        for (std::size_t k = 0; k < leaves_[i].node_count; ++k) read_.push_back(places[leaves_[i].first_node + k]);
    }
}

Spectrum LinearRows::read(const std::vector<Corners>& corners, const Node& node) const {
    Spectrum sum;
    for (std::size_t i = node.first_ray; i < node.last_ray; ++i) {
        const Hit& hit = hits_[i];
        if (hit.leaf == missed) continue;
        const double u = hit.u / quantised_one, v = hit.v / quantised_one;
        const Spectrum counts = weight(i);
        const Corners& c = corners[hit.leaf];
        if (leaves_[met_[hit.leaf]].triangle)
            sum += counts * ((1 - u - v) * c[0] + u * c[1] + v * c[2]);
        else
            sum += counts * ((1 - v) * ((1 - u) * c[0] + u * c[1]) + v * ((1 - u) * c[3] + u * c[2]));
    }
    return sum / static_cast<double>(node.last_ray - node.first_ray);
}

void LinearRows::read_own(const std::vector<Corners>& corners, std::span<Spectrum> out) const {
    const auto read_nodes = [&] {
        parallel_for(out.size(), 64, [&](std::size_t at) { out[at] = read(corners, nodes_[dealt_.unknown(at)]); });
    };
    if (dealt_.is_spread())
        do_own_share(read_nodes);
    else
        read_nodes();
}

std::array<Spectrum, 4> LinearRows::corners(std::size_t leaf, std::span<const Spectrum> nodal) const {
    const Leaf& l = leaves_[leaf];
    Corners out{};
    for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t k = 0; k < l.node_count; ++k)
            out[c] += static_cast<double>(l.to_corner[c][k]) * nodal[l.first_node + k];
    return out;
}

Spectrum LinearRows::mean(std::size_t leaf, std::span<const Spectrum> nodal) const {
    const Leaf& l = leaves_[leaf];
    Spectrum sum;
    double area = 0;
    for (std::size_t k = l.first_node; k < l.first_node + l.node_count; ++k) {
        sum += nodes_[k].area * nodal[k];
        area += nodes_[k].area;
    }
    return sum / area;
}

std::vector<LinearRows::Corners> LinearRows::reflected(std::span<const Spectrum> values) const {
    std::vector<Corners> out(met_.size());
    parallel_for(met_.size(), 256, [&](std::size_t m) {
        const Leaf& l = leaves_[met_[m]];
        for (std::size_t c = 0; c < 4; ++c) {
            for (std::size_t k = 0; k < l.node_count; ++k)
                out[m][c] += static_cast<double>(l.to_corner[c][k]) * values[read_[first_read_[m] + k]];
            out[m][c] *= l.reflectance;
        }
    });
    return out;
}

void LinearRows::gather(std::span<const Spectrum> nodal, std::span<Spectrum> out) const {
    if (dealt_.is_spread()) return gather_dealt(nodal, out);
    read_own(reflected(nodal), out);
}

void LinearRows::gather_own(std::span<const Spectrum> nodal, std::span<Spectrum> out) const {
    if (!dealt_.is_spread()) return gather(nodal, out);
    read_own(reflected(fetched_.with_fetched(nodal)), out);
}

Spectrum LinearRows::gather_at(std::size_t node, std::span<const Spectrum> nodal) const {
    EXI_CHECK(!dealt_.is_spread());
    Spectrum sum;
    for (std::size_t i = nodes_[node].first_ray; i < nodes_[node].last_ray; ++i) {
        const Hit& hit = hits_[i];
        if (hit.leaf == missed) continue;
        const std::size_t leaf = met_[hit.leaf];
        const double u = hit.u / quantised_one, v = hit.v / quantised_one;
        const Corners c = corners(leaf, nodal);
        const Spectrum E = leaves_[leaf].triangle
                               ? (1 - u - v) * c[0] + u * c[1] + v * c[2]
                               : (1 - v) * ((1 - u) * c[0] + u * c[1]) + v * ((1 - u) * c[3] + u * c[2]);
        sum += weight(i) * leaves_[leaf].reflectance * E;
    }
    return sum / static_cast<double>(nodes_[node].last_ray - nodes_[node].first_ray);
}

std::vector<Spectrum> LinearRows::first_reflection(const DirectProjection& direct) const {
    std::vector<Corners> reflected(met_.size());
    for (std::size_t m = 0; m < met_.size(); ++m) {
        reflected[m] = direct.fit[ids_[met_[m]]].corners;
        for (Spectrum& c : reflected[m]) c *= leaves_[met_[m]].reflectance;
    }
    std::vector<Spectrum> own(dealt_.own_count()), out(nodes_.size());
    read_own(reflected, own);
    dealt_.tell<Spectrum>(own, out, "solve");
    return out;
}

std::vector<double> LinearRows::node_areas() const {
    std::vector<double> out;
    out.reserve(nodes_.size());
    for (const Node& node : nodes_) out.push_back(node.area);
    return out;
}

}  // namespace exitance
