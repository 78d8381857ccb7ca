#include "exitance/measure/light_maps/curved_light.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/processes/distributed.hpp"
#include "exitance/transport/open_points.hpp"

namespace exitance {
namespace {

/// Rays of a node. Derived from the error n^(-3/4) of stratified rays: 0.5% of the light of a uniform surround.
constexpr unsigned node_rays = 512;
constexpr int max_steps = 256;
/// Maximum number of rays of direct light at a place. Derived from the number for a pixel of a flat texel
/// (measure/pictures/tile_cells.cpp).
constexpr unsigned max_rays = 1024;
constexpr double alike = 0.01;  ///< Relative difference of light that counts as linear; derived from TileLight::alike.

constexpr std::size_t node_count(int steps) {
    return static_cast<std::size_t>((steps + 1) * (steps + 2) / 2);
}

/// Index of the node `i` steps towards corner 1 and `j` steps towards corner 2.
std::size_t node_index(int steps, int i, int j) {
    return static_cast<std::size_t>(j * (steps + 1) - j * (j - 1) / 2 + i);
}

double longest_side(const NormalTriangle& t) {
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, norm(t.corner[(k + 1) % 3] - t.corner[k]));
    return longest;
}

/// True if values differ by less than 1%, or by less than the noise of their rays explains.
/// variance  largest variance of a value, (W/m^2)^2
bool are_alike(std::span<const Spectrum> values, double variance) {
    constexpr double range_of_noise = 4;  // standard deviations, within which 97% of sets of four values are
    double least = HUGE_VAL, most = 0;
    for (const Spectrum& v : values) least = std::min(least, mean(v)), most = std::max(most, mean(v));
    return most - least <= alike * most + range_of_noise * std::sqrt(variance);
}

}  // namespace

CurvedLight::CurvedLight(const RadiosityFunction& light, const CurvedFaces& faces, double spacing,
                         const StopRequest& stop)
    : light_(light),
      faces_(faces),
      accuracy_(point_accuracy(light.solution().statistics.relative_error_estimate.value_or(1))) {
    accuracy_.max_rays = max_rays;
    std::size_t nodes = 0;
    for (const NormalTriangle& t : faces.triangles()) {
        const double steps = std::clamp(std::ceil(longest_side(t) / spacing), 1.0, 1.0 * max_steps);
        lattices_.push_back({nodes, static_cast<int>(steps)});
        nodes += node_count(lattices_.back().steps);
    }
    reflected_.resize(nodes);
    constexpr std::size_t grain = 4;
    shared_ranges(
        lattices_.size(), grain,
        [&](std::size_t begin, std::size_t end) {
            Workspace workspace;
            for (std::size_t t = begin; t < end && !stop.requested(); ++t) gather_nodes(t, workspace);
        },
        [&](std::size_t t) {
            return std::span(reflected_).subspan(lattices_[t].first, node_count(lattices_[t].steps));
        },
        {"nodes"});
}

/// Gathers the reflected light of all nodes of a triangle.
void CurvedLight::gather_nodes(std::size_t triangle, Workspace& workspace) {
    const auto [first, steps] = lattices_[triangle];
    for (int j = 0; j <= steps; ++j)
        for (int i = 0; i + j <= steps; ++i) {
            const double second = 1.0 * i / steps, third = 1.0 * j / steps;
            reflected_[first + node_index(steps, i, j)] =
                gather(triangle, {1 - second - third, second, third}, workspace);
        }
}

/// Moves a place off its face far enough for rays. A surface that is between the face and the curved patch limits the
/// distance, so that no light comes from beyond it.
Point CurvedLight::off_face(const Point& on_face, const CurvedPlace& place, RegionId region) const {
    const Stage& stage = light_.stage();
    const Normal& front = stage.scene.regions()[region].plane.n;
    const double missing = light_.places().step() - dot(front, place.x - on_face);
    const Point off = missing > 0 ? place.x + missing * front : place.x;
    const Vec3 way = off - on_face;
    RayHit hit;
    stage.tracer.nearest(std::span(&way, 1), on_face, region, std::span(&hit, 1));
    return hit.distance < 1 ? on_face + 0.5 * hit.distance * way : off;
}

ProbePoint CurvedLight::above(const MeasuredPlace& place) const {
    const std::optional<CurvedPlace> curved = faces_.find(place.surface, place.x);
    const Normal& n = light_.stage().scene.regions()[place.region].plane.n;
    if (!curved) return {place.x + light_.places().step() * n, n};
    return {off_face(place.x, *curved, place.region), curved->n};
}

/// Gathers reflected light at a node. Nodes are slightly inside their triangle, so that a wall that meets it at its
/// border is on the right side of them.
CurvedLight::NodeLight CurvedLight::gather(std::size_t triangle, const std::array<double, 3>& weight,
                                           Workspace& workspace) const {
    constexpr double inwards = 0.01;  // share of the way to the centroid; derived from the distance between nodes
    const NormalTriangle& t = faces_.triangles()[triangle];
    std::array<double, 3> inside{};
    Point on_face;
    for (std::size_t k = 0; k < 3; ++k) {
        inside[k] = (1 - inwards) * weight[k] + inwards / 3;
        on_face += inside[k] * t.corner[k];
    }
    const Stage& stage = light_.stage();
    const RegionId region = stage.scene.surfaces()[t.surface].region;
    if (!is_in_open(stage, on_face, stage.scene.regions()[region].plane.n, region)) return {};
    const Point x = off_face(on_face, faces_.at(triangle, inside), region);
    const std::uint64_t key = hash(static_cast<std::uint64_t>(Stream::gather), std::uint64_t(0));
    const Spectrum E =
        light_.gathered({x, faces_.at(triangle, weight).n}, RegionId(), node_rays, key, workspace.gather_);
    NodeLight out{{}, true};
    for (std::size_t b = 0; b < bands; ++b) out.irradiance[b] = static_cast<float>(E[b]);
    return out;
}

/// Interpolates the light of the nodes around a place. Where all of them are covered, it is gathered at the place.
Spectrum CurvedLight::reflected(const CurvedPlace& place, Workspace& workspace) const {
    const auto [first, steps] = lattices_[place.triangle];
    const double a = place.weight[1] * steps, b = place.weight[2] * steps;
    const int i = std::clamp(static_cast<int>(a), 0, steps - 1);
    const int j = std::clamp(static_cast<int>(b), 0, steps - 1 - i);
    const double s = a - i, t = b - j;
    struct Node {
        int i, j;
        double weight;
    };
    std::array<Node, 3> nodes{{{i, j, 1 - s - t}, {i + 1, j, s}, {i, j + 1, t}}};
    if (s + t > 1 && i + j + 2 <= steps) nodes = {{{i + 1, j + 1, s + t - 1}, {i, j + 1, 1 - s}, {i + 1, j, 1 - t}}};
    Spectrum sum;
    double known = 0;
    for (const Node& node : nodes) {
        const NodeLight& light = reflected_[first + node_index(steps, node.i, node.j)];
        if (!light.is_known) continue;
        known += node.weight;
        for (std::size_t k = 0; k < bands; ++k) sum[k] += node.weight * static_cast<double>(light.irradiance[k]);
    }
    constexpr double min_known = 0.1;  ///< Minimum weight of known nodes; derived from a lattice with one node near.
    if (known > min_known) return sum / known;
    const NodeLight here = gather(place.triangle, place.weight, workspace);
    Spectrum out;
    for (std::size_t k = 0; k < bands; ++k) out[k] = static_cast<double>(here.irradiance[k]);
    return out;
}

CurvedLight::PlaceParts CurvedLight::at(const MeasuredPlace& place, Component component, Workspace& workspace) const {
    const std::optional<CurvedPlace> curved = faces_.find(place.surface, place.x);
    if (!curved) {
        const ProbePoint flat{place.x, light_.stage().scene.regions()[place.region].plane.n};
        const Spectrum all = light_.at(std::span(&flat, 1)).front().irradiance;
        return {all,
                component == Component::total ? all : light_.at(std::span(&flat, 1), component).front().irradiance};
    }
    const Point x = off_face(place.x, *curved, place.region);
    const PlaceLight::Estimate estimate =
        light_.stage().place_light.at(x, curved->n, RegionId(), accuracy_, workspace.direct_);
    const Spectrum& direct = estimate.irradiance;
    const Spectrum indirect = reflected(*curved, workspace), all = direct + indirect;
    return {all,
            component == Component::total    ? all
            : component == Component::direct ? direct
                                             : indirect,
            estimate.variance};
}

CurvedLight::Mean CurvedLight::mean_at(std::span<const MeasuredPlace> places, bool is_whole, Component component,
                                       Workspace& workspace) const {
    std::vector<Spectrum> values;
    Spectrum sum;
    double variance = 0;
    for (const MeasuredPlace& place : places) {
        const PlaceParts light = at(place, component, workspace);
        values.push_back(light.all), sum += light.component;
        variance = std::max(variance, light.variance);
        const bool may_end = (values.size() == 2 && is_whole) || values.size() == 4;
        if (may_end && are_alike(values, variance)) break;
    }
    return {values.empty() ? sum : sum / static_cast<double>(values.size()), values.size()};
}

}  // namespace exitance
