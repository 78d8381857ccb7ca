#include "exitance/scene/enclosure.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "exitance/geometry/bvh.hpp"
#include "exitance/geometry/triangulation.hpp"
#include "exitance/joining/weld.hpp"

namespace exitance {
namespace {

constexpr double one_place = 1e-6;  ///< Of the scene's size: nearer places are the same.

using Triangle = std::array<Point, 3>;

Box box_of(std::span<const Point> points) {
    Box box;
    for (const Point& p : points) box.add(p);
    return box;
}

Box grown(Box box, double by) {
    const Vec3 d{by, by, by};
    return {box.lo - d, box.hi + d};
}

/// A region's or a pane's border in the surface that is looked for.
struct Face {
    std::vector<std::vector<Point>> loops;
    int sense = 1;  ///< -1: the pane's corners run clockwise seen from within; 0: not known.
    bool is_in = true;
    double border = 0;                                      ///< Its length, metres.
    std::vector<std::pair<std::uint32_t, int>> edges = {};  ///< And the sense of each.
};

/// The borders of faces, cut at each other's corners, and how they cancel out.
class Borders {
  public:
    Borders(std::vector<Face> faces, double tolerance) : faces_(std::move(faces)), tolerance_(tolerance) {
        std::vector<Point> corners;
        for (const Face& face : faces_)
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

    /// Turns panes, from `first` on, so that their borders cancel those beside them. False where one has no say.
    bool turn_panes(std::size_t first) {
        for (bool changed = true; changed;) {
            changed = false;
            for (std::size_t f = first; f < faces_.size(); ++f) {
                Face& pane = faces_[f];
                if (pane.sense != 0) continue;
                double wanted = 0;
                for (const auto& [e, sense] : pane.edges) wanted -= sense * net(e) * length_[e];
                if (wanted == 0) continue;
                pane.sense = wanted > 0 ? 1 : -1;
                changed = true;
            }
        }
        return std::all_of(faces_.begin(), faces_.end(), [](const Face& f) { return f.sense != 0; });
    }

    /// Leaves faces aside until no edge is free. False where a face from `first` on would have to go.
    bool close(std::size_t first) {
        std::set<std::pair<double, std::uint32_t>> open;
        std::vector<double> share(faces_.size());
        const auto update = [&](std::uint32_t f) {
            if (share[f] > 0) open.erase({-share[f], f});
            share[f] = faces_[f].is_in ? free_share(faces_[f]) : 0;
            if (share[f] > 0) open.insert({-share[f], f});
        };
        for (std::uint32_t f = 0; f < faces_.size(); ++f) update(f);
        while (!open.empty()) {
            const std::uint32_t f = open.begin()->second;
            if (f >= first) return false;
            faces_[f].is_in = false;
            update(f);
            std::set<std::uint32_t> beside;
            for (const auto& [e, sense] : faces_[f].edges)
                for (const auto& [other, s] : users_[e]) beside.insert(other);
            for (const std::uint32_t other : beside) update(other);
        }
        keep_what_hangs_together(first);
        return true;
    }

    const Face& face(std::size_t f) const { return faces_[f]; }

  private:
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

    double free_share(const Face& face) const {
        double length = 0;
        for (const auto& [e, sense] : face.edges) length += net(e) != 0 ? length_[e] : 0;
        return length / face.border;
    }

    std::vector<Face> faces_;
    double tolerance_;
    std::vector<Point> at_;
    std::vector<std::uint32_t> place_of_, places_;  ///< Of a corner; those that stand for themselves.
    Bvh tree_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edges_;
    std::vector<double> length_;
    std::vector<std::vector<std::pair<std::uint32_t, int>>> users_;
};

/// The closed surface as triangles, their fronts within.
class Hull {
  public:
    void add(const Triangle& t) { triangles_.push_back(t); }
    void finish() {
        std::vector<Box> boxes;
        for (const Triangle& t : triangles_) boxes.push_back(box_of(t));
        tree_ = Bvh(boxes);
        for (const Box& box : boxes) all_.add(box);
    }

    /// Does it wind about a point? By three ways out, which must agree.
    bool winds_about(const Point& x) const {
        constexpr std::array<Vec3, 3> ways{
            Vec3{0.5361, 0.3217, 0.7803}, {-0.7193, 0.5881, 0.3697}, {0.2719, -0.8017, 0.5323}};
        return std::all_of(ways.begin(), ways.end(), [&](const Vec3& way) { return crossings(x, way) > 0; });
    }

    /// Does it run through a triangle by more than `slack`?
    bool crosses(const Triangle& t, double slack) const {
        return tree_.visit_box(box_of(t), [&](std::uint32_t i) { return runs_through(t, triangles_[i], slack); });
    }

  private:
    /// How often more the way leaves than it enters.
    int crossings(const Point& x, const Vec3& way) const {
        int sum = 0;
        const Vec3 d = (2 * all_.diagonal() + norm(x - all_.centre())) * way;
        tree_.visit_segment(x, d, 1, [&](std::uint32_t i) {
            const Triangle& t = triangles_[i];
            const Vec3 a = t[0] - x, b = t[1] - x, c = t[2] - x;
            const double ab = dot(d, cross(a, b)), bc = dot(d, cross(b, c)), ca = dot(d, cross(c, a));
            const bool front = ab > 0 && bc > 0 && ca > 0, back = ab < 0 && bc < 0 && ca < 0;
            if (!front && !back) return 1.0;
            const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
            if (dot(n, a) * dot(n, d) > 0) sum += dot(n, d) < 0 ? 1 : -1;
            return 1.0;
        });
        return sum;
    }

    static bool runs_through(const Triangle& t, const Triangle& of, double slack) {
        const Vec3 area = cross(of[1] - of[0], of[2] - of[0]);
        if (!(norm(area) > 0)) return false;
        const Normal n = normalized(area);
        std::array<double, 3> h;
        for (std::size_t i = 0; i < 3; ++i) h[i] = dot(n, t[i] - of[0]);
        if (*std::min_element(h.begin(), h.end()) >= -slack || *std::max_element(h.begin(), h.end()) <= slack)
            return false;
        std::vector<Point> ends;  // of where t meets the plane
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t k = (i + 1) % 3;
            if (h[i] == 0) ends.push_back(t[i]);
            if (h[i] * h[k] < 0) ends.push_back(t[i] + (h[i] / (h[i] - h[k])) * (t[k] - t[i]));
        }
        if (ends.size() < 2) return false;
        double from = 0, to = 1;
        const Vec3 along = ends[1] - ends[0];
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 edge = of[(i + 1) % 3] - of[i], inward = normalized(cross(n, edge));
            const double at = dot(inward, ends[0] - of[i]) - slack, more = dot(inward, along);
            if (more == 0 && at < 0) return false;
            if (more > 0) from = std::max(from, -at / more);
            if (more < 0) to = std::min(to, -at / more);
        }
        return (to - from) * norm(along) > slack;
    }

    std::vector<Triangle> triangles_;
    Bvh tree_;
    Box all_;
};

std::vector<Triangle> triangles_of(std::span<const Point> outline, const Normal& n) {
    std::vector<Triangle> out;
    for (const auto& t : triangulate(outline, n)) out.push_back({outline[t[0]], outline[t[1]], outline[t[2]]});
    return out;
}

std::vector<Triangle> triangles_of(const Scene& scene, RegionId r) {
    std::vector<Triangle> out;
    for (const SurfaceId s : scene.regions()[r].surfaces)
        for (const Triangle& t : triangles_of(scene.outline(s), scene.surfaces()[s].normal)) out.push_back(t);
    return out;
}

/// Do all windows lie in the box?
bool is_in(const Box& box, const std::vector<Pane>& windows, double slack) {
    const Box larger = grown(box, slack);
    return std::all_of(windows.begin(), windows.end(), [&](const Pane& window) {
        return std::all_of(window.corners.begin(), window.corners.end(), [&](const Point& p) {
            return p.x >= larger.lo.x && p.y >= larger.lo.y && p.z >= larger.lo.z && p.x <= larger.hi.x &&
                   p.y <= larger.hi.y && p.z <= larger.hi.z;
        });
    });
}

/// Does nothing lie beyond a window?
bool hides_nothing(const Scene& scene, const std::vector<Pane>& windows, double slack) {
    const bool are_in = is_in(scene.box(), windows, slack);
    for (const Pane& window : windows) {
        const auto is_beyond = [&](const Point& p) { return dot(window.n, p - window.corners[0]) < -slack; };
        const Box& box = scene.box();  // of most buildings it tells enough
        const Point farthest{window.n.x > 0 ? box.lo.x : box.hi.x, window.n.y > 0 ? box.lo.y : box.hi.y,
                             window.n.z > 0 ? box.lo.z : box.hi.z};
        if (are_in && !is_beyond(farthest)) continue;
        for (const SurfaceId s : scene.surfaces().ids())
            if (const auto outline = scene.outline(s); std::any_of(outline.begin(), outline.end(), is_beyond))
                return false;
        for (const Pane& other : windows)
            if (std::any_of(other.corners.begin(), other.corners.end(), is_beyond)) return false;
    }
    return true;
}

/// Does the hull wind about all of a region, in front of it?
bool winds_about(const Scene& scene, RegionId r, const Hull& hull, double slack) {
    constexpr double inwards = 1e-3;  // of the way from a triangle's corner to its middle
    const Normal& n = scene.regions()[r].plane.n;
    for (const Triangle& t : triangles_of(scene, r)) {
        if (hull.crosses(t, slack)) return false;
        const Point middle = (t[0] + t[1] + t[2]) / 3;
        for (const Point& p : {middle, t[0], t[1], t[2]})
            if (!hull.winds_about(p + inwards * (middle - p) + slack * n)) return false;
    }
    return true;
}

}  // namespace

Enclosure find_enclosure(const Scene& scene) {
    if (scene.panes().empty() || scene.distant().domes.empty()) return {};
    const double tolerance = one_place * scene.size();
    std::vector<Face> faces;
    for (const RegionId r : scene.regions().ids()) faces.push_back({scene.regions()[r].loops});
    const std::size_t first = faces.size();
    for (const Pane& pane : scene.panes()) faces.push_back({{pane.corners}, 0});
    Borders borders(std::move(faces), tolerance);
    if (!borders.turn_panes(first) || !borders.close(first)) return {};
    Enclosure out;
    for (std::size_t i = 0; i < scene.panes().size(); ++i) {
        Pane window = scene.panes()[i];
        if (borders.face(first + i).sense < 0) std::reverse(window.corners.begin(), window.corners.end());
        window.n = normalized(area_vector(window.corners));
        out.windows.push_back(std::move(window));
    }
    if (!hides_nothing(scene, out.windows, tolerance)) return {};
    Hull hull;
    for (const RegionId r : scene.regions().ids())
        if (borders.face(r.value).is_in)
            for (const Triangle& t : triangles_of(scene, r)) hull.add(t);
    for (const Pane& window : out.windows)
        for (const Triangle& t : triangles_of(window.corners, window.n)) hull.add(t);
    hull.finish();
    out.is_within.resize(scene.regions().size());
    for (const RegionId r : scene.regions().ids()) out.is_within[r] = winds_about(scene, r, hull, 2 * tolerance);
    return out;
}

}  // namespace exitance
