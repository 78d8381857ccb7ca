#include "exitance/scene/locator.hpp"

#include <algorithm>

namespace exitance {

struct Locator::Candidate {
    SurfaceId surface;
    double distance = HUGE_VAL;
    bool holds = false;
};

namespace {

constexpr std::uint32_t faces_per_leaf = 4;

bool holds(const Box& box, const Point& p) {
    return p.x >= box.lo.x && p.x <= box.hi.x && p.y >= box.lo.y && p.y <= box.hi.y && p.z >= box.lo.z &&
           p.z <= box.hi.z;
}

double squared_distance_to_border(std::span<const Point> outline, const Point& p) {
    double best = HUGE_VAL;
    for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
        const Vec3 edge = outline[i] - outline[j], w = p - outline[j];
        const double along = std::clamp(dot(w, edge) / squared_norm(edge), 0.0, 1.0);
        best = std::min(best, squared_norm(w - along * edge));
    }
    return best;
}

}  // namespace

Locator::Locator(const Scene& scene) : scene_(&scene), tolerance_(1e-5 * scene.size()) {
    std::vector<Box> boxes(scene.surfaces().size());
    const Vec3 margin = {tolerance_, tolerance_, tolerance_};
    for (SurfaceId s : scene.surfaces().ids()) {
        for (const Point& p : scene.outline(s)) boxes[s.value].add(p);
        boxes[s.value].lo -= margin, boxes[s.value].hi += margin;
        order_.push_back(s);
    }
    if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()), boxes);
}

/// Halves the faces at the median of their centres along the longest axis of these.
std::uint32_t Locator::build(std::uint32_t first, std::uint32_t last, const std::vector<Box>& boxes) {
    const auto node = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    Box box, centres;
    for (std::uint32_t i = first; i < last; ++i) {
        box.add(boxes[order_[i].value]);
        centres.add(boxes[order_[i].value].centre());
    }
    nodes_[node].box = box;
    if (last - first <= faces_per_leaf) {
        nodes_[node].first = first, nodes_[node].count = last - first;
        return node;
    }
    const Vec3 size = centres.size();
    const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t middle = first + (last - first) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                     [&](SurfaceId a, SurfaceId b) {
                         const double ca = boxes[a.value].centre()[axis], cb = boxes[b.value].centre()[axis];
                         return ca != cb ? ca < cb : a < b;
                     });
    build(first, middle, boxes);
    const std::uint32_t second = build(middle, last, boxes);
    nodes_[node].first = second;
    return node;
}

void Locator::look_at(SurfaceId s, const Point& p, const Normal& n, Candidate& best) const {
    const Surface& surface = scene_->surfaces()[s];
    if (!(dot(surface.normal, n) > 0.999)) return;
    const std::span<const Point> outline = scene_->outline(s);
    const double height = dot(surface.normal, p - outline[0]);
    if (!(std::abs(height) <= tolerance_)) return;

    Candidate found = {s, std::abs(height), contains(outline, surface.normal, p)};
    if (!found.holds) found.distance = std::sqrt(squared_distance_to_border(outline, p));
    if (!(found.distance <= tolerance_)) return;
    // Distances that differ by the rounding of a text file's digits are equal.
    const double gain = best.distance - found.distance, rounding = 1e-4 * tolerance_;
    if (std::abs(gain) <= rounding) {
        if (found.holds != best.holds ? found.holds : s < best.surface) best = found;
    } else if (gain > 0) {
        best = found;
    }
}

SurfaceId Locator::find(const Point& p, const Normal& n) const {
    Candidate best;
    if (nodes_.empty()) return best.surface;
    std::uint32_t stack[64];  // halving never goes deeper than 32
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
        const std::uint32_t i = stack[--top];
        const Node& node = nodes_[i];
        if (!holds(node.box, p)) continue;
        if (node.count > 0) {
            for (std::uint32_t k = 0; k < node.count; ++k) look_at(order_[node.first + k], p, n, best);
            continue;
        }
        stack[top++] = node.first;
        stack[top++] = i + 1;
    }
    return best.surface;
}

}  // namespace exitance
