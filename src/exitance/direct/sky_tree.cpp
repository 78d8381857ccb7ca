#include "exitance/direct/sky_tree.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

#include "exitance/base/quadrature.hpp"

namespace exitance {
namespace {

constexpr std::size_t cells_of_formula = 256;   ///< Maximum number of cells per hemisphere.
constexpr std::size_t cells_of_picture = 2048;  ///< Per half if a sky is a picture: cells of about 3 degrees.

bool has_picture(const DistantLight& light) {
    return std::any_of(light.domes.begin(), light.domes.end(),
                       [](const auto& d) { return d.model.picture != nullptr; });
}

/// Returns the Gauss points of a cell. A picture, which is linear between points 2.8 degrees apart, needs more.
std::span<const PlanarNode> cell_rule(const DistantLight& light) {
    return square_rule(has_picture(light) ? 4 : 2);
}

}  // namespace

/// Measures a cell. priority: how much its flux varies within it.
void SkyTree::look_at(std::uint32_t number, const DistantLight& light, Leaf& leaf, double& priority) const {
    const Node& node = nodes_[number];
    const double dz = node.z1 - node.z0, turns = node.turn1 - node.turn0, solid_angle = 2 * pi * dz * turns;
    leaf.middle = direction_at(0.5 * (node.z0 + node.z1), 0.5 * (node.turn0 + node.turn1));
    leaf.radius = 0;
    for (int i = 0; i <= 2; ++i)
        for (int k = 0; k <= 2; ++k) {
            const Vec3 w = direction_at(node.z0 + 0.5 * i * dz, node.turn0 + 0.5 * k * turns);
            leaf.radius = std::max(leaf.radius, std::acos(std::clamp(dot(w, leaf.middle), -1.0, 1.0)));
        }
    double least = HUGE_VAL, most = 0;
    leaf.flux = 0;
    for (const PlanarNode& at : cell_rule(light)) {
        const double L =
            mean(light.radiosity(direction_at(node.z0 + at.at.x * dz, node.turn0 + at.at.y * turns), false));
        least = std::min(least, L), most = std::max(most, L);
        leaf.flux += at.weight * solid_angle * L;
    }
    priority = (most - least) * solid_angle + leaf.flux * leaf.radius;
}

SkyTree::SkyTree(const DistantLight& light) {
    struct Open {
        double priority;
        std::uint32_t node;
        bool operator<(const Open& o) const { return std::tie(priority, o.node) < std::tie(o.priority, node); }
    };
    std::priority_queue<Open> open;
    const auto add = [&](std::uint32_t node) {
        Leaf leaf;
        double priority = 0;
        look_at(node, light, leaf, priority);
        open.push({priority, node});
    };
    const auto has = [&](bool below) {
        return std::any_of(light.domes.begin(), light.domes.end(),
                           [&](const auto& d) { return d.model.below == below && max(d.irradiance) > 0; });
    };
    const bool is_above = has(false), is_below = has(true);
    if (!is_above && !is_below) return;
    nodes_.push_back({is_below ? -1.0 : 0.0, is_above ? 1.0 : 0.0, 0, 1});
    std::size_t cells = 1;
    const auto split = [&](std::uint32_t number, bool splits_z) {
        Node low = nodes_[number], high = low;
        const auto first = static_cast<std::uint32_t>(nodes_.size());
        nodes_[number].first_child = first, nodes_[number].splits_z = splits_z;
        if (splits_z)
            low.z1 = high.z0 = 0.5 * (low.z0 + low.z1);
        else
            low.turn1 = high.turn0 = 0.5 * (low.turn0 + low.turn1);
        nodes_.push_back(low), nodes_.push_back(high);
        add(first), add(first + 1);
        ++cells;
    };
    if (is_above && is_below)
        split(0, true);  // divide at the horizon, where domes end
    else
        add(0);
    const std::size_t most =
        (has_picture(light) ? cells_of_picture : cells_of_formula) * (is_above && is_below ? 2 : 1);
    while (cells < most) {
        const std::uint32_t number = open.top().node;
        open.pop();
        const Node& node = nodes_[number];
        const double nearest = node.z0 * node.z1 <= 0 ? 0 : std::min(std::abs(node.z0), std::abs(node.z1));
        const double across = 2 * pi * (node.turn1 - node.turn0) * std::sqrt(1 - nearest * nearest);
        split(number, std::asin(node.z1) - std::asin(node.z0) > across);
    }
    make_leaves(light);
}

void SkyTree::make_leaves(const DistantLight& light) {
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
        Node& node = nodes_[i];
        if (node.first_child != 0) continue;
        node.leaf = static_cast<std::uint32_t>(leaves_.size());
        double priority = 0;
        look_at(i, light, leaves_.emplace_back(), priority);
        const double dz = node.z1 - node.z0, turns = node.turn1 - node.turn0;
        for (const PlanarNode& at : cell_rule(light)) {
            const Vec3 w = direction_at(node.z0 + at.at.x * dz, node.turn0 + at.at.y * turns);
            samples_.push_back({w, 2 * dz * turns * at.weight * light.radiosity(w, false)});
        }
    }
}

void SkyTree::aim(const Normal& n, Aim& out) const {
    if (!out.weight.empty() && out.n == n) return;
    out.n = n, out.open = Spectrum();
    out.weight.resize(nodes_.size());
    for (const Sample& sample : samples_) out.open += std::max(0.0, dot(n, sample.w)) * sample.light;
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        const Node& node = nodes_[i];
        if (node.first_child != 0) {
            out.weight[i] = out.weight[node.first_child] + out.weight[node.first_child + 1];
            continue;
        }
        const Leaf& leaf = leaves_[node.leaf];
        const double c = dot(n, leaf.middle), r = leaf.radius;
        // Mean of a cosine that changes linearly from c - r to c + r, without its negative part.
        out.weight[i] = leaf.flux * (c >= r ? c : c <= -r ? 0 : (c + r) * (c + r) / (4 * r));
    }
}

SkyTree::Direction SkyTree::direction(const Aim& aim, double s, double t) const {
    std::uint32_t i = 0;
    while (nodes_[i].first_child != 0) {
        double& u = nodes_[i].splits_z ? s : t;
        const std::uint32_t first = nodes_[i].first_child;
        const double share = aim.weight[first] / aim.weight[i];
        if (u < share) {
            u /= share, i = first;
        } else {
            u = (u - share) / (1 - share), i = first + 1;
        }
        u = std::min(u, 1 - 0x1p-53);
    }
    const Node& node = nodes_[i];
    const double dz = node.z1 - node.z0, turns = node.turn1 - node.turn0;
    return {direction_at(node.z0 + s * dz, node.turn0 + t * turns),
            aim.weight[i] / aim.weight[0] / (2 * pi * dz * turns)};
}

}  // namespace exitance
