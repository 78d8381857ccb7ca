#include "exitance/mesh/discontinuity/six_node_mesh.hpp"

#include <algorithm>

namespace exitance {
namespace {

/// Distance of a point from its triangle that rounding may cause, as a share of the scene's size; derived from double
/// precision.
constexpr double slack_share = 1e-9;

}  // namespace

std::array<double, 6> six_node_weights(Vec2 st) {
    const double l[3] = {1 - st.x - st.y, st.x, st.y};
    std::array<double, 6> w;
    for (std::size_t i = 0; i < 3; ++i) {
        w[i] = l[i] * (2 * l[i] - 1);
        w[3 + i] = 4 * l[i] * l[(i + 1) % 3];
    }
    return w;
}

Spectrum SixNodeMesh::value(std::uint32_t node) const {
    Spectrum out;
    for (std::size_t b = 0; b < bands; ++b) out[b] = static_cast<double>(values[node][b]);
    return out;
}

CloughTocher SixNodeMesh::element(std::uint32_t triangle, std::size_t band) const {
    const auto& n = nodes[triangle];
    CloughTocher::Data data{};
    for (std::size_t i = 0; i < 3; ++i) {
        data.value[i] = static_cast<double>(values[n[i]][band]);
        const auto& gradient = gradients[gradient_of[triangle][i]];
        const Vec3 g{static_cast<double>(gradient[0][band]), static_cast<double>(gradient[1][band]),
                     static_cast<double>(gradient[2][band])};
        for (std::size_t k = 0; k < 2; ++k) data.to_next[i][k] = dot(g, points[n[(i + 1 + k) % 3]] - points[n[i]]);
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const EdgeFrame frame(points[n[i]], points[n[(i + 1) % 3]], points[n[(i + 2) % 3]]);
        data.across[i] =
            frame.along * slope_along(data, i) + frame.height * static_cast<double>(slopes[triangle][i][band]);
    }
    return CloughTocher(data);
}

Spectrum SixNodeMesh::mean(std::uint32_t triangle) const {
    if (!is_clough_tocher()) {  // The mean of a quadratic polynomial is that of its values at the edge middles.
        const auto& n = nodes[triangle];
        return (1.0 / 3) * (value(n[3]) + value(n[4]) + value(n[5]));
    }
    Spectrum out;
    for (std::size_t b = 0; b < bands; ++b) out[b] = element(triangle, b).mean();
    return out;
}

Spectrum SixNodeMesh::at(std::uint32_t triangle, Vec2 st) const {
    if (is_clough_tocher()) {
        Spectrum smooth;
        for (std::size_t b = 0; b < bands; ++b) smooth[b] = element(triangle, b).at({1 - st.x - st.y, st.x, st.y});
        return smooth;
    }
    const std::array<double, 6> w = six_node_weights(st);
    Spectrum out;
    for (std::size_t i = 0; i < 6; ++i) out += w[i] * value(nodes[triangle][i]);
    return out;
}

double SixNodeMesh::area(std::uint32_t triangle) const {
    const auto& n = nodes[triangle];
    return 0.5 * norm(cross(points[n[1]] - points[n[0]], points[n[2]] - points[n[0]]));
}

Point SixNodeMesh::centre(std::uint32_t triangle) const {
    const auto& n = nodes[triangle];
    return (1.0 / 3) * (points[n[0]] + points[n[1]] + points[n[2]]);
}

double SixNodeMesh::mean_radius_ratio() const {
    double sum = 0;
    for (std::uint32_t t = 0; t < size(); ++t) {
        double side[3];
        for (std::size_t i = 0; i < 3; ++i) side[i] = norm(points[nodes[t][(i + 1) % 3]] - points[nodes[t][i]]);
        const double perimeter = side[0] + side[1] + side[2], a = area(t), product = side[0] * side[1] * side[2];
        if (product > 0) sum += 8 * a * a / (perimeter * product);  // r / R = (2 A / p) / (a b c / 4 A)
    }
    return empty() ? 0 : sum / static_cast<double>(size());
}

SixNodeLocator::SixNodeLocator(const SixNodeMesh& mesh, const Scene& scene)
    : mesh_(&mesh), trees_(scene.regions().size()), first_(scene.regions().size()), slack_(slack_share * scene.size()) {
    std::vector<std::uint32_t> count(scene.regions().size() + 1);
    for (const RegionId r : mesh.region) ++count[r.value + 1];
    for (std::size_t r = 0; r < scene.regions().size(); ++r) count[r + 1] += count[r];
    order_.resize(mesh.size());
    std::vector<std::uint32_t> next(count.begin(), count.end() - 1);
    for (std::uint32_t t = 0; t < mesh.size(); ++t) order_[next[mesh.region[t].value]++] = t;
    const Vec3 slack = Vec3{1, 1, 1} * slack_;
    std::vector<Box> boxes;
    for (const RegionId r : scene.regions().ids()) {
        first_[r] = count[r.value];
        boxes.assign(count[r.value + 1] - count[r.value], Box());
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            for (std::size_t k = 0; k < 3; ++k) boxes[i].add(mesh.points[mesh.nodes[order_[first_[r] + i]][k]]);
            boxes[i].lo -= slack, boxes[i].hi += slack;
        }
        trees_[r] = Bvh(boxes);
    }
}

SixNodeLocator::Place SixNodeLocator::find(RegionId region, const Point& p) const {
    Place best;
    if (region.is_none() || !is_finite(p)) return best;
    double best_inside = -HUGE_VAL;
    const auto look = [&](std::uint32_t i) {
        const std::uint32_t t = order_[first_[region] + i];
        const auto& n = mesh_->nodes[t];
        const Point& o = mesh_->points[n[0]];
        const Vec3 a = mesh_->points[n[1]] - o, b = mesh_->points[n[2]] - o, w = p - o;
        const double aa = dot(a, a), ab = dot(a, b), bb = dot(b, b), det = aa * bb - ab * ab;
        // Minimum height over length. Derived from the root of double precision: thinner triangles contain no point
        // that their neighbours do not.
        constexpr double min_aspect = 1e-7;
        const double longest = std::max({aa, bb, aa + bb - 2 * ab});
        if (!(det > min_aspect * min_aspect * longest * longest)) return false;
        const double s = (bb * dot(a, w) - ab * dot(b, w)) / det, u = (aa * dot(b, w) - ab * dot(a, w)) / det;
        const double inside = std::min({s, u, 1 - s - u});
        if (inside > best_inside) best_inside = inside, best = {t, {s, u}};
        return inside >= 0;
    };
    // Searched in boxes of growing size; derived from sizes between rounding and a thousandth of the scene.
    constexpr double farthest = 1e6, step = 1e3;
    Box box;
    for (double reach = slack_; best.triangle == none && reach <= farthest * slack_; reach *= step) {
        const Vec3 around = Vec3{1, 1, 1} * reach;
        box.lo = p - around, box.hi = p + around;
        trees_[region].visit_box(box, look);
    }
    if (best.triangle == none) return best;
    double& s = best.st.x;
    double& t = best.st.y;
    s = std::clamp(s, 0.0, 1.0), t = std::clamp(t, 0.0, 1.0);
    if (const double sum = s + t; sum > 1) s /= sum, t /= sum;
    return best;
}

Spectrum SixNodeLocator::at(RegionId region, const Point& p) const {
    const Place place = find(region, p);
    return place.triangle == none ? Spectrum() : mesh_->at(place.triangle, place.st);
}

}  // namespace exitance
