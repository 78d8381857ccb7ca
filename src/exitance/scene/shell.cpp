#include "exitance/scene/shell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "exitance/base/bvh.hpp"
#include "exitance/base/random.hpp"
#include "exitance/scene/joining/hash_chains.hpp"
#include "exitance/scene/joining/weld.hpp"

namespace exitance {
namespace {

struct Edge {
    std::uint32_t from, to;
    SurfaceId face;
    std::uint32_t first = 0;  ///< Index of the first edge between the same two points, in either direction.
};

/// The edges between two points: their number, and the first two.
struct Meeting {
    std::uint32_t count = 0, one = 0, other = 0;
};

class Inspector {
  public:
    explicit Inspector(const Scene& scene) : scene_(scene), tolerance_(1e-8 * scene.size()) {
        std::vector<Point> corners;
        for (SurfaceId s : scene.surfaces().ids())
            corners.insert(corners.end(), scene.outline(s).begin(), scene.outline(s).end());
        const std::vector<std::uint32_t> place = weld(corners, tolerance_);
        points_ = std::move(corners);
        std::uint32_t first = 0;
        for (SurfaceId s : scene.surfaces().ids()) {
            const auto n = static_cast<std::uint32_t>(scene.outline(s).size());
            for (std::uint32_t k = 0; k < n; ++k) {
                const std::uint32_t from = place[first + k], to = place[first + (k + 1) % n];
                if (from != to) edges_.push_back({from, to, s});
            }
            first += n;
        }
        meet();
    }

    Shell run() {
        find_open_edges();
        find_turned_faces();
        find_inside_out_bodies();
        return std::move(out_);
    }

  private:
    void meet();
    void find_open_edges();
    void find_turned_faces();
    /// Returns the edge of the face on the other side of an edge; null unless exactly two faces share it.
    const Edge* edge_across(std::uint32_t e) const;
    // `first`: index in edges_ of the first edge of every face, and the number of edges.
    std::vector<std::vector<std::uint32_t>> patches_of(const std::vector<std::uint32_t>& faces,
                                                       const std::vector<std::uint32_t>& first) const;
    bool is_turned(const std::vector<std::uint32_t>& patch, const std::vector<std::uint32_t>& first) const;
    void find_inside_out_bodies();

    const Scene& scene_;
    double tolerance_;
    std::vector<Point> points_;
    std::vector<Edge> edges_;
    std::vector<Meeting> meetings_;  ///< Per pair of points; indexed by the first edge between them.
    Shell out_;
};

void Inspector::meet() {
    HashChains chains(edges_.size());
    meetings_.resize(edges_.size());
    const auto ends_of = [&](std::uint32_t e) {
        return std::pair(std::min(edges_[e].from, edges_[e].to), std::max(edges_[e].from, edges_[e].to));
    };
    const auto key_of = [&](std::uint32_t e) { return hash(ends_of(e).first, ends_of(e).second); };
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
        if (e + HashChains::ahead < edges_.size()) chains.prefetch(key_of(e + HashChains::ahead));
        edges_[e].first = e;
        for (std::uint32_t o = chains.first(key_of(e)); o != HashChains::end; o = chains.next(o))
            if (ends_of(o) == ends_of(e)) {
                edges_[e].first = edges_[o].first;
                break;
            }
        chains.add(key_of(e));
        Meeting& meeting = meetings_[edges_[e].first];
        (meeting.count == 0 ? meeting.one : meeting.other) = e;
        ++meeting.count;
    }
}

void Inspector::find_open_edges() {
    std::vector<std::uint32_t> lone;
    std::vector<Box> boxes;
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
        if (edges_[e].first != e || meetings_[e].count != 1) continue;
        lone.push_back(e);
        boxes.emplace_back();
        boxes.back().add(points_[edges_[e].from]), boxes.back().add(points_[edges_[e].to]);
    }
    const Bvh tree(boxes);
    const Vec3 around{tolerance_, tolerance_, tolerance_};
    constexpr std::size_t max_boxes = 256;  // limit on the boxes tested around a point; exceeded only by piles of faces
    /// Calls take() for the unpaired edges, other than `own`, that have p in their interior.
    const auto visit_containing_edges = [&](const Point& p, std::uint32_t own, const auto& take) {
        Box box;
        box.add(p - around), box.add(p + around);
        std::size_t near = 0;
        tree.visit_box(box, [&](std::uint32_t i) {
            const Point &a = points_[edges_[lone[i]].from], &b = points_[edges_[lone[i]].to];
            const double length = norm(b - a), along = dot(p - a, b - a) / length;
            if (lone[i] != own && along > tolerance_ && along < length - tolerance_ &&
                norm(cross(p - a, b - a)) <= tolerance_ * length)
                take(i);
            return ++near == max_boxes;
        });
    };
    std::vector<bool> joined(lone.size());
    std::vector<std::uint32_t> ends;
    for (const std::uint32_t e : lone) ends.insert(ends.end(), {edges_[e].from, edges_[e].to});
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    for (const std::uint32_t p : ends)
        visit_containing_edges(points_[p], HashChains::end, [&](std::uint32_t i) { joined[i] = true; });
    for (std::size_t k = 0; k < lone.size(); ++k) {
        const Point &a = points_[edges_[lone[k]].from], &b = points_[edges_[lone[k]].to];
        bool within = joined[k];
        if (!within) visit_containing_edges(0.5 * (a + b), lone[k], [&](std::uint32_t) { within = true; });
        if (within) continue;
        ++out_.open_edges;
        out_.open_length += norm(b - a);
        out_.marks.push_back({Mark::Kind::open, {a, b}});
    }
}

const Edge* Inspector::edge_across(std::uint32_t e) const {
    const Meeting& meeting = meetings_[edges_[e].first];
    return meeting.count == 2 ? &edges_[meeting.one == e ? meeting.other : meeting.one] : nullptr;
}

/// Divides faces into patches that are connected over edges of exactly two faces.
std::vector<std::vector<std::uint32_t>> Inspector::patches_of(const std::vector<std::uint32_t>& faces,
                                                              const std::vector<std::uint32_t>& first) const {
    std::vector<std::vector<std::uint32_t>> out;
    std::set<std::uint32_t> left(faces.begin(), faces.end());
    while (!left.empty()) {
        std::vector<std::uint32_t>& patch = out.emplace_back(1, *left.begin());
        left.erase(left.begin());
        for (std::size_t i = 0; i < patch.size(); ++i)
            for (std::uint32_t e = first[patch[i]]; e < first[patch[i] + 1]; ++e)
                if (const Edge* across = edge_across(e); across && left.erase(across->face.value) > 0)
                    patch.push_back(across->face.value);
    }
    return out;
}

/// Returns whether a patch, whose faces are oriented against those around it, is turned. It is not if no neighbour
/// belongs to one of its objects and less than two thirds of its border edges are shared: then it only touches them,
/// such as a ceiling at an outer wall, or a board of open shelves.
bool Inspector::is_turned(const std::vector<std::uint32_t>& patch, const std::vector<std::uint32_t>& first) const {
    const std::set<std::uint32_t> own(patch.begin(), patch.end());
    std::set<GroupId> objects;
    for (const std::uint32_t f : patch) objects.insert(scene_.surfaces()[SurfaceId(f)].group);
    std::size_t border = 0, shared = 0;  // edges
    for (const std::uint32_t f : patch)
        for (std::uint32_t e = first[f]; e < first[f + 1]; ++e) {
            const Edge* const across = edge_across(e);
            if (across && own.contains(across->face.value)) continue;
            ++border;
            if (!across) continue;
            if (objects.contains(scene_.surfaces()[across->face].group)) return true;
            ++shared;
        }
    // Three of the four sides of a wall, but not two: a ceiling may touch two outer walls.
    return 3 * shared >= 2 * border;
}

/// Assigns a side to each face of a connected component (over edges of exactly two faces): equal across an edge that
/// the faces traverse in opposite directions.
void Inspector::find_turned_faces() {
    const std::size_t n = scene_.surfaces().size();
    std::vector<std::uint32_t> first(n + 1, 0);  // first edge of every face; edges are sorted by face
    for (const Edge& e : edges_) ++first[e.face.value + 1];
    for (std::size_t f = 0; f < n; ++f) first[f + 1] += first[f];
    enum : char { unseen, same, opposite };
    std::vector<char> side(n, unseen);
    std::vector<std::uint32_t> together;
    for (std::uint32_t start = 0; start < n; ++start) {
        if (side[start] != unseen) continue;
        together.assign(1, start);
        side[start] = same;
        bool is_orientable = true;
        for (std::size_t i = 0; i < together.size(); ++i)
            for (std::uint32_t e = first[together[i]]; e < first[together[i] + 1]; ++e) {
                const Edge* const across = edge_across(e);
                if (!across) continue;
                const bool turns = across->from == edges_[e].from;
                const char expected = (side[together[i]] == same) != turns ? same : opposite;
                char& there = side[across->face.value];
                if (there == unseen)
                    there = expected, together.push_back(across->face.value);
                else
                    is_orientable &= there == expected;
            }
        const auto count = static_cast<std::size_t>(
            std::count_if(together.begin(), together.end(), [&](std::uint32_t f) { return side[f] == opposite; }));
        const std::size_t fewer = std::min(count, together.size() - count);
        if (!is_orientable || fewer == 0 || 3 * fewer > together.size()) continue;
        const char wrong = count == fewer ? opposite : same;
        std::vector<std::uint32_t> turned;
        for (const std::uint32_t f : together)
            if (side[f] == wrong) turned.push_back(f);
        for (const std::vector<std::uint32_t>& patch : patches_of(turned, first))
            if (is_turned(patch, first))
                for (const std::uint32_t f : patch) out_.turned.push_back(SurfaceId(f));
    }
    std::sort(out_.turned.begin(), out_.turned.end());
    for (const SurfaceId s : out_.turned)
        out_.marks.push_back({Mark::Kind::turned, {scene_.outline(s).begin(), scene_.outline(s).end()}});
}

void Inspector::find_inside_out_bodies() {
    BodyFaces faces;
    faces.size = scene_.size();
    for (const SurfaceId s : scene_.surfaces().ids())
        faces.add(scene_.outline(s), scene_.surfaces()[s].normal, scene_.material(s).emits());
    faces.add_lights(scene_.lights(), scene_.distant());
    out_.inside_out = find_inside_out(faces);
    for (const InsideOut& body : out_.inside_out)
        for (const std::uint32_t f : body.faces)
            out_.marks.push_back(
                {Mark::Kind::turned, {scene_.outline(SurfaceId(f)).begin(), scene_.outline(SurfaceId(f)).end()}});
}

}  // namespace

Shell inspect_shell(const Scene& scene) {
    return Inspector(scene).run();
}

Finding finding_of(const InsideOut& body, const std::string& group, Finding::Kind kind) {
    const bool is_repair = kind == Finding::Kind::repair;
    const char* const wrong = body.is_room ? "look outwards, away from the light" : "look inwards";
    return {kind, "", 0,
            fmt::format("the {} faces of a closed body of '{}' {}: {}", body.faces.size(), group, wrong,
                        is_repair ? "they are turned" : "it is inside out"),
            is_repair ? "" : "--turn-bodies turns such faces; or reverse the order of their corners"};
}

std::vector<Finding> findings_of(const Shell& shell, const Scene& scene) {
    std::map<GroupId, std::pair<SurfaceId, std::size_t>> groups;
    for (const SurfaceId s : shell.turned)
        ++groups.try_emplace(scene.surfaces()[s].group, s, std::size_t(0)).first->second.second;
    std::vector<Finding> out;
    for (const auto& [group, turned] : groups)
        out.push_back(
            {Finding::Kind::warning, scene.file(), scene.surfaces()[turned.first].line,
             fmt::format("{} of '{}' {} the other way than the faces around: {} front is where those have "
                         "their backs",
                         turned.second == 1 ? "a face" : fmt::format("{} faces", turned.second), scene.groups()[group],
                         turned.second == 1 ? "looks" : "look", turned.second == 1 ? "its" : "their"),
             "reverse the order of corners"});
    for (const InsideOut& body : shell.inside_out) {
        const Surface& first = scene.surfaces()[SurfaceId(body.faces[0])];
        Finding& finding = out.emplace_back(finding_of(body, scene.groups()[first.group], Finding::Kind::warning));
        finding.file = scene.file(), finding.line = first.line;
    }
    return out;
}

}  // namespace exitance
