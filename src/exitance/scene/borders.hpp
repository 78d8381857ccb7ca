#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/scene/joining/weld.hpp"

namespace exitance {

/// Corners, counter-clockwise seen from the front.
using Triangle = std::array<Point, 3>;

inline Box box_of(std::span<const Point> points) {
    Box box;
    for (const Point& p : points) box.add(p);
    return box;
}

inline Box grown(Box box, double by) {
    const Vec3 d{by, by, by};
    return {box.lo - d, box.hi + d};
}

/// A region, a part of a region, or a pane.
struct BorderedFace {
    /// Its border, one loop per part; an edge common to two parts has no effect.
    std::vector<std::vector<Point>> loops;
    std::vector<Triangle> triangles;
    Normal n;  ///< Unit normal, towards the front.
    /// Indices of the face's edges, and the face's direction along each (1 or -1).
    std::vector<std::pair<std::uint32_t, int>> edges = {};
};

/// The front or the back of a face.
struct FaceSide {
    std::uint32_t face;
    bool is_front;
};

/// The borders of faces, split at each other's corners, and the adjacency of face sides about each edge.
class Borders {
  public:
    Borders(std::vector<BorderedFace> faces, double tolerance) : faces_(std::move(faces)), tolerance_(tolerance) {
        std::vector<Point> corners;
        for (const BorderedFace& face : faces_)
            for (const auto& loop : face.loops) corners.insert(corners.end(), loop.begin(), loop.end());
        place_of_ = weld(corners, tolerance);
        at_ = std::move(corners);
        for (std::uint32_t i = 0; i < at_.size(); ++i)
            if (place_of_[i] == i) places_.push_back(i);
        std::vector<Box> boxes;
        for (const std::uint32_t i : places_) boxes.push_back(box_of({&at_[i], 1}));
        tree_ = Bvh(boxes);
        std::uint32_t next = 0;
        for (std::uint32_t f = 0; f < faces_.size(); ++f)
            for (const auto& loop : faces_[f].loops) {
                const auto count = static_cast<std::uint32_t>(loop.size());
                for (std::uint32_t i = 0; i < count; ++i)
                    add_edge(f, place_of_[next + i], place_of_[next + (i + 1) % count]);
                next += count;
            }
    }

    /// Returns all sides that can be reached from `start` by steps over edges. A step over a shared edge leads to the
    /// side that faces the current one, a step over a free edge to the back of the face. No step leads through a face,
    /// so that the sides bound one connected part of space, and the faces of which only one side is reached form a
    /// closed surface. Returns nothing if two coincident faces with the same orientation meet at a visited edge.
    std::vector<FaceSide> sides_reached_from(const FaceSide& start) const {
        std::vector<FaceSide> reached{start};
        std::vector<std::array<std::uint8_t, 2>> is_reached(faces_.size());
        is_reached[start.face][start.is_front ? 1 : 0] = 1;
        for (std::size_t i = 0; i < reached.size(); ++i) {
            const FaceSide side = reached[i];
            for (const auto& [e, sense] : faces_[side.face].edges) {
                const auto next = beyond(side, e, sense);
                if (!next) return {};
                if (!std::exchange(is_reached[next->face][next->is_front ? 1 : 0], std::uint8_t{1}))
                    reached.push_back(*next);
            }
        }
        return reached;
    }

    /// The components into which steps across edges divide all sides; part_of[face][is front] is that of a side.
    /// Bodies that touch along an edge, or whose faces coincide there, are separate components (`separate_bodies`).
    struct Parts {
        std::vector<std::array<std::uint32_t, 2>> part_of;
        std::vector<bool> is_sure;  ///< For every component: false if a step from it met two coincident faces.
    };
    Parts parts() const {
        constexpr std::uint32_t none = 0xffffffff;
        const Bodies bodies = separate_bodies();
        Parts out{std::vector<std::array<std::uint32_t, 2>>(faces_.size(), {none, none}), {}};
        std::vector<FaceSide> open;
        for (std::uint32_t k = 0; k < 2 * faces_.size(); ++k) {
            if (out.part_of[k / 2][k % 2] != none) continue;
            const auto part = static_cast<std::uint32_t>(out.is_sure.size());
            out.is_sure.push_back(true);
            out.part_of[k / 2][k % 2] = part;
            open.push_back({k / 2, k % 2 == 1});
            while (!open.empty()) {
                const FaceSide side = open.back();
                open.pop_back();
                for (const auto& [e, sense] : faces_[side.face].edges) {
                    const auto next = beyond(side, e, sense, &bodies);
                    std::uint32_t* const there = next ? &out.part_of[next->face][next->is_front ? 1 : 0] : nullptr;
                    // A step that is not reversible, or that leads into another component, is at coincident faces.
                    if (!there || (*there != none && *there != part)) out.is_sure[part] = false;
                    if (there && *there != none && *there != part) out.is_sure[*there] = false;
                    if (there && *there == none) *there = part, open.push_back(*next);
                }
            }
        }
        return out;
    }

    const BorderedFace& face(std::size_t f) const { return faces_[f]; }

  private:
    /// Faces joined by edges that exactly two faces share have the same number in `of_face`. `are_apart` is true for an
    /// edge at which every such body has two faces, and there are several: each of these bodies is closed there.
    struct Bodies {
        std::vector<std::uint32_t> of_face;
        std::vector<bool> are_apart;
    };
    Bodies separate_bodies() const {
        Bodies out{std::vector<std::uint32_t>(faces_.size()), std::vector<bool>(users_.size())};
        std::vector<std::uint32_t>& parent = out.of_face;
        std::iota(parent.begin(), parent.end(), 0u);
        const auto root = [&](std::uint32_t f) {
            while (parent[f] != f) f = parent[f] = parent[parent[f]];
            return f;
        };
        for (const auto& users : users_)
            if (users.size() == 2) parent[root(users[0].first)] = root(users[1].first);
        for (std::uint32_t f = 0; f < parent.size(); ++f) parent[f] = root(f);
        for (std::size_t e = 0; e < users_.size(); ++e) {
            if (users_[e].size() < 4 || users_[e].size() % 2 != 0) continue;
            std::vector<std::uint32_t> at_edge;
            for (const auto& user : users_[e]) at_edge.push_back(out.of_face[user.first]);
            std::sort(at_edge.begin(), at_edge.end());
            bool are_pairs = true;
            for (std::size_t i = 0; i < at_edge.size(); i += 2)
                are_pairs &= at_edge[i] == at_edge[i + 1] && (i == 0 || at_edge[i] != at_edge[i - 1]);
            out.are_apart[e] = are_pairs;
        }
        return out;
    }

    /// Adds the edge of a face between two corners, split at other corners that are on it.
    void add_edge(std::uint32_t f, std::uint32_t a, std::uint32_t b) {
        if (a == b) return;
        const Vec3 d = at_[b] - at_[a];
        const double length = norm(d);
        std::vector<std::pair<double, std::uint32_t>> on{{0, a}, {1, b}};
        const std::array<Point, 2> ends{at_[a], at_[b]};
        tree_.visit_box(grown(box_of(ends), tolerance_), [&](std::uint32_t k) {
            const std::uint32_t p = places_[k];
            const double t = dot(at_[p] - at_[a], d) / (length * length);
            if (p != a && p != b && t > 0 && t < 1 && norm(at_[p] - (at_[a] + t * d)) <= tolerance_)
                on.push_back({t, p});
        });
        std::sort(on.begin(), on.end());
        for (std::size_t i = 0; i + 1 < on.size(); ++i) {
            const std::uint32_t p = on[i].second, q = on[i + 1].second;
            const auto [entry, fresh] =
                edges_.try_emplace(std::minmax(p, q), static_cast<std::uint32_t>(users_.size()));
            if (fresh) users_.emplace_back(), along_.push_back(normalized(at_[std::max(p, q)] - at_[std::min(p, q)]));
            const int sense = p < q ? 1 : -1;
            faces_[f].edges.push_back({entry->second, sense});
            users_[entry->second].push_back({f, sense});
        }
    }

    /// Unit vector from an edge into the face, perpendicular to the edge.
    Vec3 inwards(std::uint32_t f, std::uint32_t e, int sense) const { return sense * cross(faces_[f].n, along_[e]); }

    /// Returns the side that faces `side` across an edge: the first one met when turning about the edge. Two coincident
    /// faces with opposite orientation count as a sheet with its fronts outside; with the same orientation there is no
    /// result. At edges where `bodies` are apart, only faces of the same body count.
    std::optional<FaceSide> beyond(const FaceSide& side, std::uint32_t e, int sense,
                                   const Bodies* bodies = nullptr) const {
        const Vec3 from = inwards(side.face, e, sense);
        const Vec3 up = side.is_front ? Vec3(faces_[side.face].n) : -Vec3(faces_[side.face].n);
        const Vec3 axis = cross(from, up);
        constexpr double all_round = 2 * pi;
        FaceSide next{side.face, !side.is_front};
        // if no other face is found, the next side is the other side of this face
        double nearest = all_round + 2 * one_direction;
        for (const auto& [f, s] : users_[e]) {
            if (f == side.face && s == sense) continue;
            if (bodies && bodies->are_apart[e] && bodies->of_face[f] != bodies->of_face[side.face]) continue;
            const Vec3 to = inwards(f, e, s);
            double angle = std::atan2(dot(to, up), dot(to, from));
            if (angle < 0) angle += all_round;
            const bool meets_front = dot(cross(axis, to), faces_[f].n) < 0;
            if (std::min(angle, all_round - angle) < one_direction) {
                if (meets_front != side.is_front) return std::nullopt;
                angle = side.is_front ? all_round : 0;
            }
            const bool lies_on_next = std::abs(angle - nearest) < one_direction;
            if (lies_on_next && meets_front == next.is_front) return std::nullopt;
            if (lies_on_next ? !meets_front : angle > nearest) continue;
            nearest = angle, next = {f, meets_front};
        }
        return next;
    }

    static constexpr double one_direction = 1e-6;  ///< Faces at a smaller angle, in radians, coincide.

    std::vector<BorderedFace> faces_;
    double tolerance_;
    std::vector<Point> at_;
    /// Per corner: the corner that represents its position. `places_` lists these representatives.
    std::vector<std::uint32_t> place_of_, places_;
    Bvh tree_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edges_;
    std::vector<Vec3> along_;  ///< Per edge: unit vector along it, from the end with the lower index.
    std::vector<std::vector<std::pair<std::uint32_t, int>>> users_;
};

}  // namespace exitance
