#include "exitance/lab/bsp/bsp_tree.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/random.hpp"

namespace exitance {

/// A convex polygon that is being inserted.
struct BspPart {
    std::vector<Point> outline;
    Plane plane;
    PieceId piece;
};

namespace {

struct Sides {
    bool front = false, behind = false;
    bool is_cut() const { return front && behind; }
};

Sides sides_of(const BspPart& part, const Plane& plane, double thickness) {
    Sides out;
    for (const Point& p : part.outline) {
        const double d = plane.signed_distance(p);
        out.front |= d > thickness;
        out.behind |= d < -thickness;
    }
    return out;
}

/// Splits a polygon at a plane that it crosses. Corners within the thickness belong to both parts.
std::pair<BspPart, BspPart> cut(const BspPart& part, const Plane& plane, double thickness) {
    std::pair<BspPart, BspPart> out{{{}, part.plane, part.piece}, {{}, part.plane, part.piece}};
    const std::size_t n = part.outline.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Point &p = part.outline[i], &q = part.outline[(i + 1) % n];
        const double a = plane.signed_distance(p), b = plane.signed_distance(q);
        if (a >= -thickness) out.first.outline.push_back(p);
        if (a <= thickness) out.second.outline.push_back(p);
        if ((a > thickness && b < -thickness) || (a < -thickness && b > thickness)) {
            const Point x = p + a / (a - b) * (q - p);
            out.first.outline.push_back(x);
            out.second.outline.push_back(x);
        }
    }
    return out;
}

}  // namespace

struct BspTree::Builder {
    struct Job {
        std::vector<BspPart> parts;
        std::uint32_t parent;
        bool is_front;
        std::uint16_t depth;
    };

    const Plane& choose(const std::vector<BspPart>& parts) {
        std::size_t best = 0;
        double least = HUGE_VAL;
        for (std::size_t k = 0; k < std::min(tries, parts.size()); ++k) {
            const std::size_t i = tries >= parts.size() ? k : random.bits() % parts.size();
            double cuts = 0, balance = 0;
            for (const BspPart& part : parts) {
                const Sides sides = sides_of(part, parts[i].plane, tree.thickness_);
                cuts += sides.is_cut();
                balance += static_cast<double>(sides.front) - static_cast<double>(sides.behind);
            }
            constexpr double weight_of_balance = 0.3;  // one cut costs as much as an imbalance of about three polygons
            const double cost = cuts + weight_of_balance * std::abs(balance);
            if (cost < least) least = cost, best = i;
        }
        return parts[best].plane;
    }

    void add_fragment(const BspPart& part, const Plane& plane) {
        tree.fragments_.push_back({static_cast<std::uint32_t>(tree.corners_.size()),
                                   static_cast<std::uint32_t>(part.outline.size()), part.piece,
                                   dot(part.plane.n, plane.n) > 0});
        tree.corners_.insert(tree.corners_.end(), part.outline.begin(), part.outline.end());
    }

    void run(std::vector<BspPart> all) {
        std::vector<Job> jobs;
        jobs.push_back({std::move(all), none, true, 0});
        while (!jobs.empty()) {
            Job job = std::move(jobs.back());
            jobs.pop_back();
            if (job.parts.empty()) continue;
            const auto id = static_cast<std::uint32_t>(tree.nodes_.size());
            if (job.parent != none)
                (job.is_front ? tree.nodes_[job.parent].front : tree.nodes_[job.parent].behind) = id;
            const Plane plane = choose(job.parts);
            Node node{.plane = plane, .parent = job.parent, .depth = job.depth};
            node.first_fragment = static_cast<std::uint32_t>(tree.fragments_.size());
            const auto below = static_cast<std::uint16_t>(job.depth + 1);
            Job front{{}, id, true, below}, behind{{}, id, false, below};
            for (BspPart& part : job.parts) {
                const Sides sides = sides_of(part, plane, tree.thickness_);
                if (sides.is_cut()) {
                    auto [f, b] = cut(part, plane, tree.thickness_);
                    if (f.outline.size() >= 3) front.parts.push_back(std::move(f));
                    if (b.outline.size() >= 3) behind.parts.push_back(std::move(b));
                } else if (sides.front || sides.behind) {
                    (sides.front ? front : behind).parts.push_back(std::move(part));
                } else {
                    add_fragment(part, plane);
                }
            }
            node.fragment_count = static_cast<std::uint32_t>(tree.fragments_.size()) - node.first_fragment;
            tree.nodes_.push_back(node);
            jobs.push_back(std::move(behind));
            jobs.push_back(std::move(front));
        }
    }

    BspTree& tree;
    std::size_t tries;
    RandomStream random;
};

BspTree::BspTree(const Occluders& occluders, std::size_t tries, std::uint64_t seed, double thickness)
    : occluders_(&occluders), thickness_(thickness > 0 ? thickness : occluders.rounding()) {
    std::vector<BspPart> parts;
    for (PieceId p : occluders.pieces().ids()) {
        const auto corners = occluders.corners(p);
        // A piece may deviate from its own plane by its thickness, because of rounding.
        thickness_ = std::max(thickness_, occluders.pieces()[p].thickness);
        parts.push_back({{corners.begin(), corners.end()}, occluders.pieces()[p].plane, p});
    }
    Builder{*this, std::max<std::size_t>(1, tries), RandomStream(seed, Stream::mesh)}.run(std::move(parts));
}

std::size_t BspTree::depth() const {
    std::size_t most = 0;
    for (const Node& node : nodes_) most = std::max<std::size_t>(most, node.depth + 1u);
    return most;
}

std::size_t BspTree::memory_bytes() const {
    return nodes_.size() * sizeof(Node) + fragments_.size() * sizeof(Fragment) + corners_.size() * sizeof(Point);
}

/// Returns whether a point in the node's plane is on the fragment.
bool BspTree::hits(const Fragment& fragment, const Node& node, const Point& p) const {
    const auto corners = outline(fragment);
    const double sign = fragment.faces_front ? 1 : -1;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Point &a = corners[i], &b = corners[(i + 1) % corners.size()];
        if (sign * dot(cross(b - a, p - a), node.plane.n) < -thickness_ * norm(b - a)) return false;
    }
    return true;
}

namespace {

/// Position of a ray's stretch [first, last] relative to a plane. The ray starts in front of the plane, behind it or in
/// it, and leads away from it, along it or towards it; in the last case it crosses the plane before, within or beyond
/// the stretch. In each of the thirteen cases the ray visits the near side, the far side, or both, with or without the
/// plane in between.
enum class RayCase : std::uint8_t {
    front_away,
    front_along,
    front_before,
    front_within,
    front_beyond,
    behind_away,
    behind_along,
    behind_before,
    behind_within,
    behind_beyond,
    in_upwards,
    in_downwards,
    in_along,
};

/// Classifies a ray. `height`: of its origin over the plane, metres; `rise`: change of height per length of the
/// direction. Sets `crossing` if the ray crosses the plane.
RayCase classify(double height, double rise, double thickness, double first, double last, double& crossing) {
    if (std::abs(height) <= thickness)
        return rise > 0 ? RayCase::in_upwards : rise < 0 ? RayCase::in_downwards : RayCase::in_along;
    const bool front = height > 0;
    if (rise == 0) return front ? RayCase::front_along : RayCase::behind_along;
    if ((rise > 0) == front) return front ? RayCase::front_away : RayCase::behind_away;
    crossing = -height / rise;
    if (crossing < first) return front ? RayCase::front_before : RayCase::behind_before;
    if (crossing > last) return front ? RayCase::front_beyond : RayCase::behind_beyond;
    return front ? RayCase::front_within : RayCase::behind_within;
}

}  // namespace

BspTree::Hit BspTree::nearest(const Point& origin, const Vec3& direction, double least) const {
    struct Stretch {
        std::uint32_t node;
        double first, last;
        bool is_plane;  ///< Visit the node's own fragments, at `first`.
    };
    Hit best;
    if (nodes_.empty()) return best;
    std::vector<Stretch> stack{{0, least, HUGE_VAL, false}};
    const auto later = [&](std::uint32_t n, double first, double last) {
        if (n != none && first <= last) stack.push_back({n, first, last, false});
    };
    const double slack = thickness_ / norm(direction);  // fragments extend this far beyond the planes that cut them
    while (!stack.empty()) {
        const Stretch s = stack.back();
        stack.pop_back();
        const Node& node = nodes_[s.node];
        if (s.is_plane) {
            if (s.first < least) continue;
            for (const Fragment& f : fragments(node))
                if (hits(f, node, origin + s.first * direction))
                    return {f.piece, s.first, (dot(direction, node.plane.n) < 0) == f.faces_front};
            continue;
        }
        double t = 0;
        switch (classify(node.plane.signed_distance(origin), dot(direction, node.plane.n), thickness_, s.first - slack,
                         s.last + slack, t)) {
            case RayCase::front_away:
            case RayCase::front_along:
            case RayCase::front_beyond:
            case RayCase::behind_before:
            case RayCase::in_upwards:
                later(node.front, s.first, s.last);
                break;
            case RayCase::behind_away:
            case RayCase::behind_along:
            case RayCase::behind_beyond:
            case RayCase::front_before:
            case RayCase::in_downwards:
                later(node.behind, s.first, s.last);
                break;
            case RayCase::in_along:  // polygons in the plane are edge-on: no ray hits them
                later(node.behind, s.first, s.last);
                later(node.front, s.first, s.last);
                break;
            case RayCase::front_within:
                later(node.behind, t - slack, s.last);
                stack.push_back({s.node, t, t, true});
                later(node.front, s.first, t + slack);
                break;
            case RayCase::behind_within:
                later(node.front, t - slack, s.last);
                stack.push_back({s.node, t, t, true});
                later(node.behind, s.first, t + slack);
                break;
        }
    }
    return best;
}

}  // namespace exitance
