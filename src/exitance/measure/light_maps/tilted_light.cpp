#include "exitance/measure/light_maps/tilted_light.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/transport/open_points.hpp"

namespace exitance {
namespace {

/// Rays per node and normal. Derived from the error n^(-3/4) of stratified rays: 0.8% of the light of a uniform
/// surround.
constexpr unsigned tilted_rays = 256;

/// Returns the position of a node along a side of a chart, in texels.
int node_at(int index, int length) {
    return std::min(node_texels * index, length - 1);
}

/// Fits the irradiances that E(normal) returns.
template <class Irradiance>
DirectedIrradiance fit(const Normal& n, const Irradiance& E) {
    const Frame frame(n);
    std::array<Spectrum, tilted_count> at_tilted;
    for (std::size_t k = 0; k < tilted_count; ++k) at_tilted[k] = E(tilted(frame, k));
    return fit_irradiance(frame, E(n), at_tilted);
}

}  // namespace

void TiltedLight::start(const Chart& chart, int x, int y, Workspace& workspace) const {
    workspace.chart_ = &chart, workspace.x_ = x, workspace.y_ = y;
    workspace.nodes_.fill({}), workspace.in_block_.fill({});
}

/// Returns a point slightly above a place, and the surface's normal there.
ProbePoint TiltedLight::above(const MeasuredPlace& place) const {
    if (curved_ && curved_->is_curved(place.region)) return curved_->above(place);
    const Normal& n = light_.stage().scene.regions()[place.region].plane.n;
    return {place.x + light_.places().step() * n, n};
}

DirectedIrradiance TiltedLight::direct(const ProbePoint& at, Workspace& workspace) const {
    return fit(at.n, [&](const Normal& n) { return light_.direct_at({at.x, n}, RegionId(), workspace.direct_); });
}

DirectedIrradiance TiltedLight::gather(const ProbePoint& at, Workspace& workspace) const {
    const std::uint64_t key = hash(static_cast<std::uint64_t>(Stream::gather), std::uint64_t(0));
    return fit(at.n, [&](const Normal& n) {
        return light_.gathered({at.x, n}, RegionId(), tilted_rays, key, workspace.gather_);
    });
}

/// Returns the reflected light of a node of the tile; none if the node is covered or off its region.
const TiltedLight::Known& TiltedLight::node(int i, int j, Workspace& workspace) const {
    std::optional<Known>& known = workspace.nodes_[static_cast<std::size_t>(j * Workspace::nodes + i)];
    if (known) return *known;
    known.emplace();
    const Chart& chart = *workspace.chart_;
    const Normal& n = light_.stage().scene.regions()[chart.region].plane.n;
    const int x = node_at(workspace.x_ / node_texels + i, chart.width);
    const int y = node_at(workspace.y_ / node_texels + j, chart.height);
    const MeasuredPlace place = light_.places().find(chart.at({x + 0.5, y + 0.5}), n);
    if (place.region == chart.region && is_in_open(light_.stage(), place.x, n, chart.region))
        *known = gather(above(place), workspace);
    return *known;
}

/// Interpolates between the nodes around a texel.
DirectedIrradiance TiltedLight::reflected(int x, int y, const MeasuredPlace& place, Workspace& workspace) const {
    const Chart& chart = *workspace.chart_;
    const int i = (x - workspace.x_) / node_texels, j = (y - workspace.y_) / node_texels;
    const auto weight_of = [](int at, int index, int length) {
        const int first = node_at(index, length), last = node_at(index + 1, length);
        return last > first ? 1.0 * (at - first) / (last - first) : 0;
    };
    const double s = weight_of(x, workspace.x_ / node_texels + i, chart.width);
    const double t = weight_of(y, workspace.y_ / node_texels + j, chart.height);
    DirectedIrradiance sum;
    double weight = 0;
    for (const int down : {0, 1})
        for (const int right : {0, 1}) {
            const double w = (right == 1 ? s : 1 - s) * (down == 1 ? t : 1 - t);
            if (w == 0) continue;
            const Known& light = node(i + right, j + down, workspace);
            if (!light) continue;
            DirectedIrradiance part = *light;
            part *= w, sum += part, weight += w;
        }
    constexpr double min_known = 0.1;  ///< Minimum weight of known nodes; derived from a lattice with one node near.
    if (weight > min_known) return sum *= 1 / weight;
    Known& in_block = workspace.in_block_[static_cast<std::size_t>(j * Workspace::blocks + i)];
    if (!in_block) in_block = gather(above(place), workspace);
    return *in_block;
}

DirectedIrradiance TiltedLight::at(int x, int y, std::span<const MeasuredPlace> open, const Spectrum& irradiance,
                                   Workspace& workspace) const {
    constexpr std::size_t max_points = 4;
    constexpr double alike = 0.1;  ///< Relative difference without a shadow edge; derived from slopes of a few percent.

    const ProbePoint first = above(open.front());
    DirectedIrradiance out, straight;
    if (component_ != Component::direct) out = reflected(x, y, open.front(), workspace);
    if (component_ != Component::indirect) {
        straight = direct(first, workspace);
        const double found = mean((out.at(first.n) + straight.at(first.n)));
        if (std::abs(found - mean(irradiance)) > alike * mean(irradiance)) {
            const std::size_t count = std::min(max_points, open.size());
            for (const MeasuredPlace& place : open.subspan(1, count - 1)) straight += direct(above(place), workspace);
            straight *= 1.0 / static_cast<double>(count);
        }
        out += straight;
    }
    constrain(out, first.n, irradiance);
    if (form_ == Directions::dominant) align_to_dominant(out, first.n);
    return out;
}

}  // namespace exitance
