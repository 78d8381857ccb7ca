#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "exitance/geometry/bvh.hpp"
#include "exitance/joining/weld.hpp"

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

/// A region, a part of one, or a pane in the surface that is looked for.
struct BorderedFace {
    std::vector<std::vector<Point>> loops;  ///< Its border; where parts have an edge in common, that cancels out.
    std::vector<Triangle> triangles;
    int sense = 1;  ///< -1: the pane's corners run clockwise seen from within; 0: not known.
    bool is_in = true;
    double border = 0;                                      ///< Its length, metres.
    std::vector<std::pair<std::uint32_t, int>> edges = {};  ///< And the sense of each.
};

/// The borders of faces, cut at each other's corners, and how they cancel out.
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

    /// Turns panes, from `first` on, so that their borders cancel those beside them. Where these cancel each other, as
    /// around a hole through a solid wall, `guess(f)` tells: 1, -1, or 0 for no answer, and then the result is false.
    template <class Guess>
    bool turn_panes(std::size_t first, const Guess& guess) {
        turn_by_neighbours(first);
        for (std::size_t f = first; f < faces_.size(); ++f) {
            if (faces_[f].sense != 0) continue;
            faces_[f].sense = guess(f);
            if (faces_[f].sense == 0) return false;
            turn_by_neighbours(first);
        }
        return true;
    }

    /// Leaves faces aside until no edge is free: those whose own edge is too much, the face with most such border
    /// first. False where edges of panes, from `first` on, are left.
    bool close(std::size_t first) {
        std::set<std::pair<double, std::uint32_t>> open;
        std::vector<double> share(faces_.size());
        const auto update = [&](std::uint32_t f) {
            if (share[f] > 0) open.erase({-share[f], f});
            share[f] = f < first && faces_[f].is_in ? free_share(faces_[f]) : 0;
            if (share[f] > 0) open.insert({-share[f], f});
        };
        for (std::uint32_t f = 0; f < faces_.size(); ++f) update(f);
        while (!open.empty()) {
            const std::uint32_t f = open.begin()->second;
            faces_[f].is_in = false;
            update(f);
            std::set<std::uint32_t> beside;
            for (const auto& [e, sense] : faces_[f].edges)
                for (const auto& [other, s] : users_[e]) beside.insert(other);
            for (const std::uint32_t other : beside) update(other);
        }
        for (std::size_t f = 0; f < faces_.size(); ++f)
            if (faces_[f].is_in && free_share(faces_[f]) > 0) return false;
        keep_what_hangs_together(first);
        return true;
    }

    const BorderedFace& face(std::size_t f) const { return faces_[f]; }

  private:
    void turn_by_neighbours(std::size_t first) {
        for (bool changed = true; changed;) {
            changed = false;
            for (std::size_t f = first; f < faces_.size(); ++f) {
                BorderedFace& pane = faces_[f];
                if (pane.sense != 0) continue;
                double wanted = 0;
                for (const auto& [e, sense] : pane.edges) wanted -= sense * net(e) * length_[e];
                if (wanted == 0) continue;
                pane.sense = wanted > 0 ? 1 : -1;
                changed = true;
            }
        }
    }

    /// Of a face, between two corners: cut where other corners lie on it.
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
                edges_.try_emplace(std::minmax(p, q), static_cast<std::uint32_t>(length_.size()));
            if (fresh) length_.push_back(norm(at_[q] - at_[p])), users_.emplace_back();
            const int sense = p < q ? 1 : -1;
            faces_[f].edges.push_back({entry->second, sense});
            faces_[f].border += length_[entry->second];
            users_[entry->second].push_back({f, sense});
        }
    }

    /// Leaves aside what no chain of edges joins to faces from `first` on: solids in a room.
    void keep_what_hangs_together(std::size_t first) {
        std::vector<std::uint8_t> reached(faces_.size(), false);
        std::vector<std::uint32_t> open(faces_.size() - first);
        std::iota(open.begin(), open.end(), static_cast<std::uint32_t>(first));
        for (const std::uint32_t f : open) reached[f] = true;
        while (!open.empty()) {
            const std::uint32_t f = open.back();
            open.pop_back();
            for (const auto& [e, sense] : faces_[f].edges)
                for (const auto& [other, s] : users_[e])
                    if (faces_[other].is_in && !std::exchange(reached[other], true)) open.push_back(other);
        }
        for (std::size_t f = 0; f < faces_.size(); ++f) faces_[f].is_in = faces_[f].is_in && reached[f];
    }

    int net(std::uint32_t edge) const {
        int sum = 0;
        for (const auto& [f, sense] : users_[edge])
            if (faces_[f].is_in) sum += sense * faces_[f].sense;
        return sum;
    }

    /// Share of a face's border of which there is too much.
    double free_share(const BorderedFace& face) const {
        double length = 0;
        for (const auto& [e, sense] : face.edges) length += sense * face.sense * net(e) > 0 ? length_[e] : 0;
        return length / face.border;
    }

    std::vector<BorderedFace> faces_;
    double tolerance_;
    std::vector<Point> at_;
    std::vector<std::uint32_t> place_of_, places_;  ///< Of a corner; those that stand for themselves.
    Bvh tree_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edges_;
    std::vector<double> length_;
    std::vector<std::vector<std::pair<std::uint32_t, int>>> users_;
};

}  // namespace exitance
