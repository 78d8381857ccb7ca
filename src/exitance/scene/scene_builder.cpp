#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "exitance/core/random.hpp"
#include "exitance/geometry/triangulation.hpp"
#include "exitance/joining/border.hpp"
#include "exitance/joining/hash_chains.hpp"
#include "exitance/joining/outline.hpp"
#include "exitance/joining/regions.hpp"
#include "exitance/joining/weld.hpp"
#include "exitance/scene/findings.hpp"
#include "exitance/scene/overlaps.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

Tolerances tolerances(const Box& box, double short_edge) {
    const Vec3 far = max(max(box.hi, -box.hi), max(box.lo, -box.lo));
    const double spacing = std::max({far.x, far.y, far.z}) * std::numeric_limits<double>::epsilon();
    Tolerances t;
    t.place = std::max(std::min(1e-9 * box.diagonal(), 1e-5 * short_edge), 4 * spacing);
    t.plane = std::max(1e-5 * box.diagonal(), t.place);
    return t;
}

/// Makes a scene step by step; findings gather on the way.
class SceneBuilder {
  public:
    explicit SceneBuilder(SceneDescription description) : in_(std::move(description)) {}
    CheckedScene build();

  private:
    void check_materials();
    void check_lights();
    void place_corners();
    void check_faces();
    void check_face(std::uint32_t f);
    void check_shape(std::uint32_t f, std::span<const std::uint32_t> outline);
    void add_face(std::uint32_t f, std::span<const std::uint32_t> outline, const Vec3& area);
    void add_triangles(std::uint32_t f, std::span<const std::uint32_t> outline, std::span<const Point> corners,
                       const Normal& n);
    void report_bent();
    void drop_duplicates();
    void check_light();
    void check_overlaps(const Scene& scene);
    bool is_one_polygon(std::span<const std::uint32_t> outline, const Vec3& area) const;
    Scene make();
    void add_regions(Scene& scene, const std::vector<JoinedFaces>& joined);

    void find(Finding::Kind kind, int line, std::string message, std::string hint = "") {
        findings_.push_back({kind, in_.file, line, std::move(message), std::move(hint)});
    }
    void error(int line, std::string message, std::string hint = "") {
        find(Finding::Kind::error, line, std::move(message), std::move(hint));
    }
    /// About a face, which is named by its line or, where files have none, by its group; marked as `mark`. Of repairs
    /// and warnings of one kind only the first are listed; `rest` says what the others are ("faces without area").
    void find(Finding::Kind kind, const SceneDescription::Face& face, Mark::Kind mark, std::string message,
              std::string hint = "", const char* rest = nullptr);
    void error(const SceneDescription::Face& face, std::string message, std::string hint = "") {
        find(Finding::Kind::error, face, Mark::Kind::broken, std::move(message), std::move(hint));
    }
    void report_unlisted();
    std::string name_of(const SceneDescription::Face& face) const;
    bool has_errors() const { return exitance::has_errors(findings_); }

    SceneDescription in_;
    std::vector<Finding> findings_;
    std::vector<std::uint32_t> place_;  // of every point: the first point at its place
    Tolerances tol_;
    FaceMesh mesh_;
    std::vector<std::uint32_t> origin_;  // face of the mesh -> face of the description
    Box box_;
    /// Faces out of plane by more than rounding.
    struct Bent {
        std::size_t count = 0;
        double farthest = 0;  ///< m
        int first_line = 0;

        void add(const SceneDescription::Face& face, double off) {
            if (count++ == 0) first_line = face.line;
            farthest = std::max(farthest, off);
        }
    };
    Bent flattened_, split_;  // within the tolerance; beyond it
    std::vector<Mark> marks_;
    struct Listed {
        Finding::Kind kind;
        std::size_t count;
        int first_unlisted;
    };
    std::map<std::string, Listed> listed_;  ///< What `rest` says -> how many there were.
    struct Alike {
        std::size_t finding, more = 0;
    };
    std::map<std::string, Alike> alike_;  ///< Messages without lines: where each is told, and how often again.
};

constexpr std::size_t most_listed = 20;
constexpr std::size_t most_corners = 10'000;  ///< Of a face: triangulations take their square.
constexpr double farthest = 1e15;             ///< Metres from the origin: powers of areas stay finite.
constexpr double brightest = 1e30;            ///< W/m^2, cd, lx: float holds 3e38, and light is added up in it.

bool is_near(const Point& p) {
    return std::abs(p.x) <= farthest && std::abs(p.y) <= farthest && std::abs(p.z) <= farthest;
}

std::string SceneBuilder::name_of(const SceneDescription::Face& face) const {
    if (face.line > 0 || face.group >= in_.groups.size()) return fmt::format("the face of line {}", face.line);
    return fmt::format("a face of '{}'", in_.groups[face.group]);
}

void SceneBuilder::find(Finding::Kind kind, const SceneDescription::Face& face, Mark::Kind mark, std::string message,
                        std::string hint, const char* rest) {
    Mark& marked = marks_.emplace_back(mark, std::vector<Point>());
    for (std::uint32_t c : face.corners)
        if (c < in_.points.size() && is_finite(in_.points[c])) marked.outline.push_back(in_.points[c]);
    if (face.line == 0) {
        if (face.group < in_.groups.size()) message = fmt::format("in '{}': {}", in_.groups[face.group], message);
        const auto [told, is_new] = alike_.try_emplace(message, Alike{findings_.size()});
        if (!is_new) return void(++told->second.more);
    }
    if (rest) {
        Listed& listed = listed_.try_emplace(rest, Listed{kind, 0, face.line}).first->second;
        if (++listed.count == most_listed + 1) listed.first_unlisted = face.line;
        if (listed.count > most_listed) return;
    }
    find(kind, face.line, std::move(message), std::move(hint));
}

void SceneBuilder::report_unlisted() {
    for (const auto& [message, alike] : alike_)
        if (alike.more > 0 && alike.finding < findings_.size() && findings_[alike.finding].message == message)
            findings_[alike.finding].message += fmt::format(" (and {} more like this)", alike.more);
    alike_.clear();
    for (const auto& [rest, listed] : listed_)
        if (listed.count > most_listed)
            find(listed.kind, listed.first_unlisted, fmt::format("{} more {}", listed.count - most_listed, rest));
    listed_.clear();
}

void SceneBuilder::check_materials() {
    static constexpr const char* rgb[3] = {"R", "G", "B"};
    const auto band = [](std::size_t b) { return bands == 3 ? std::string(rgb[b]) : std::to_string(b); };
    for (const Material& m : in_.materials)
        for (std::size_t b = 0; b < bands; ++b) {
            if (!(m.reflectance[b] >= 0 && m.reflectance[b] < 1))
                error(0,
                      fmt::format("material '{}' has reflectance {:g} in band {}", m.name, m.reflectance[b], band(b)),
                      "reflectances lie in [0, 1): at 1 light would never die out");
            if (!(m.exitance[b] >= 0 && m.exitance[b] <= brightest))
                error(0, fmt::format("material '{}' has exitance {:g} in band {}", m.name, m.exitance[b], band(b)),
                      fmt::format("emission is not negative, and at most {:g} W/m^2", brightest));
        }
}

void SceneBuilder::check_lights() {
    for (const PunctualLight& light : in_.lights) {
        if (!std::all_of(light.intensity.value.begin(), light.intensity.value.end(),
                         [](double v) { return v >= 0 && v <= brightest; }))
            error(0, fmt::format("light '{}' has an intensity that is negative, too large or not finite", light.name));
        if (!is_near(light.position) || !(std::abs(norm(light.direction) - 1) < 1e-6))
            error(0, fmt::format("light '{}' has no place or no direction", light.name));
        if (light.kind == PunctualLight::Kind::spot &&
            !(light.inner_cone >= 0 && light.inner_cone < light.outer_cone && light.outer_cone <= pi / 2))
            error(0,
                  fmt::format("spot '{}' has cones of {:g} and {:g} radians", light.name, light.inner_cone,
                              light.outer_cone),
                  "the inner one is at least 0 and less than the outer one, that one at most pi / 2");
    }
}

/// Finds the scene's box and the points that stand at one place.
void SceneBuilder::place_corners() {
    std::vector<float> lengths;  // of all edges; only their magnitude matters
    for (const auto& face : in_.faces) {
        const Point* before = nullptr;
        for (std::uint32_t c : face.corners) {
            if (c >= in_.points.size() || !is_near(in_.points[c])) continue;
            const Point& p = in_.points[c];
            box_.add(p);
            if (before && p != *before) lengths.push_back(static_cast<float>(norm(p - *before)));
            before = &p;
        }
    }
    constexpr std::size_t one_in = 100;
    const auto percentile = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / one_in);
    if (!lengths.empty()) std::nth_element(lengths.begin(), percentile, lengths.end());
    tol_ = tolerances(box_, lengths.empty() ? HUGE_VAL : static_cast<double>(*percentile));
    place_ = weld(in_.points, tol_.place);
}

void SceneBuilder::check_faces() {
    mesh_.first.push_back(0);
    for (std::uint32_t f = 0; f < in_.faces.size(); ++f) check_face(f);
    report_bent();
    if (in_.faces.empty())
        error(1, "there are no polygons", "a scene needs at least one face");
    else if (mesh_.size() == 0 && !has_errors())
        error(in_.faces[0].line, "no polygon is left once faces without area are taken out");
}

/// Appends the face to the mesh if it can be used; reports why not otherwise.
void SceneBuilder::check_face(std::uint32_t f) {
    const SceneDescription::Face& face = in_.faces[f];
    if (face.material >= in_.materials.size() || face.group >= in_.groups.size())
        return error(face, "face has no material or no group");
    if (face.corners.size() > most_corners)
        return error(face, fmt::format("face has {} corners; {} are the most", face.corners.size(), most_corners),
                     "make its outline simpler, or cut it up");
    std::vector<std::uint32_t> outline = face.corners;
    for (std::uint32_t& c : outline) {
        if (c >= in_.points.size())
            return error(face, fmt::format("face names corner {} of {} points", c + 1, in_.points.size()));
        if (!is_finite(in_.points[c])) return error(face, "a corner of the face is not a finite point");
        if (!is_near(in_.points[c]))
            return error(face,
                         fmt::format("a corner of the face lies at ({:g}, {:g}, {:g}) m", in_.points[c].x,
                                     in_.points[c].y, in_.points[c].z),
                         fmt::format("mend it, or scale the scene: coordinates go up to {:g} m", farthest));
        c = place_[c];
    }
    const std::size_t given = outline.size(), dropped = drop_repeated_corners(outline);
    if (outline.size() < 3) {
        find(Finding::Kind::repair, face, Mark::Kind::left_out,
             fmt::format("face of {} corners goes to and fro and has no area: it is left out", given),
             "remove it, or give it three corners that are not in line", "faces without area are left out");
        return;
    }
    if (dropped > 0)
        find(Finding::Kind::repair, face, Mark::Kind::left_out,
             fmt::format("{} of the face's {} corners stand where a neighbour stands: they are merged", dropped, given),
             "", "faces have corners that stand where a neighbour stands");
    check_shape(f, outline);
}

void SceneBuilder::add_face(std::uint32_t f, std::span<const std::uint32_t> outline, const Vec3& area) {
    mesh_.corners.insert(mesh_.corners.end(), outline.begin(), outline.end());
    mesh_.first.push_back(static_cast<std::uint32_t>(mesh_.corners.size()));
    mesh_.material.push_back(in_.faces[f].material);
    mesh_.area_vector.push_back(area);
    origin_.push_back(f);
}

void SceneBuilder::add_triangles(std::uint32_t f, std::span<const std::uint32_t> outline,
                                 std::span<const Point> corners, const Normal& n) {
    for (const auto& [a, b, c] : triangulate(corners, n)) {
        const Vec3 area = 0.5 * cross(corners[b] - corners[a], corners[c] - corners[a]);
        const double longest =
            std::max({norm(corners[b] - corners[a]), norm(corners[c] - corners[b]), norm(corners[a] - corners[c])});
        if (norm(area) > tol_.place * longest) add_face(f, std::array{outline[a], outline[b], outline[c]}, area);
    }
}

void SceneBuilder::check_shape(std::uint32_t f, std::span<const std::uint32_t> outline) {
    const SceneDescription::Face& face = in_.faces[f];
    std::vector<Point> corners;
    for (std::uint32_t c : outline) corners.push_back(in_.points[c]);
    const Vec3 area = area_vector(corners);
    Box box;
    for (const Point& p : corners) box.add(p);
    if (norm(area) <= tol_.place * box.diagonal()) {
        if (is_collinear(corners, 2 * tol_.place))
            find(Finding::Kind::repair, face, Mark::Kind::left_out,
                 fmt::format("face of {} corners has no area, they are in line: it is left out", face.corners.size()),
                 "", "faces without area are left out");
        else
            error(face, "face crosses itself: its parts cancel out", "order its corners counter-clockwise");
        return;
    }
    const Normal n = normalized(area);
    const double off = out_of_plane(corners, n);
    // A face may be bent by as much as its neighbours may be tilted.
    const bool is_bent = off > std::max(tol_.place, std::min(tol_.plane, tol_.tilt * box.diagonal()));
    if (is_bent && !in_.split_bent)
        return find(Finding::Kind::error, face, Mark::Kind::broken,
                    fmt::format("face of {} corners is {:.3g} m out of plane", corners.size(), off),
                    "split it into triangles, or have it done: --split-bent", "faces are out of plane");
    EdgePair where{};
    if (crosses_itself(corners, n, tol_.place, where)) {
        const std::size_t m = corners.size();
        error(face,
              fmt::format("face crosses itself: the edge from corner {} to {} meets the edge from corner {} to {}",
                          where.first + 1, (where.first + 1) % m + 1, where.second + 1, (where.second + 1) % m + 1),
              "order its corners counter-clockwise, or split it");
        return;
    }
    if (!is_one_polygon(outline, area))
        return error(face, "face crosses itself in a corner: a part of it is turned over", "split it there");
    if (is_bent) return split_.add(face, off), add_triangles(f, outline, corners, n);
    if (off > tol_.place) flattened_.add(face, off);
    add_face(f, outline, area);
}

void SceneBuilder::report_bent() {
    const auto report = [&](const Bent& bent, const char* remedy) {
        if (bent.count > 0)
            find(Finding::Kind::repair, bent.first_line,
                 fmt::format("{} {} out of plane by up to {:.3g} m, the first of them here: {}", bent.count,
                             bent.count == 1 ? "face is" : "faces are", bent.farthest, remedy));
    };
    report(flattened_, "corners are moved into the plane");
    report(split_, "they are split into triangles, each a surface of its own");
}

/// Leaves out faces that repeat an earlier one, corner by corner and to the same side: which of the two light meets
/// would be left to chance.
void SceneBuilder::drop_duplicates() {
    HashChains chains(mesh_.size());
    std::vector<std::uint32_t> rotated, other, kept;
    const auto start_at_smallest = [&](std::uint32_t f, std::vector<std::uint32_t>& out) {
        const auto outline = mesh_.outline(f);
        out.assign(outline.begin(), outline.end());
        std::rotate(out.begin(), std::min_element(out.begin(), out.end()), out.end());
    };
    FaceMesh left;
    left.first.push_back(0);
    std::vector<std::uint32_t> left_origin;
    for (std::uint32_t f = 0; f < mesh_.size(); ++f) {
        start_at_smallest(f, rotated);
        std::uint64_t key = rotated.size();
        for (std::uint32_t c : rotated) key = hash(key, c);
        const SceneDescription::Face* same = nullptr;
        for (std::uint32_t e = chains.first(key); e != HashChains::end && !same; e = chains.next(e)) {
            start_at_smallest(e, other);
            if (other == rotated) same = &in_.faces[origin_[e]];
        }
        chains.add(key);
        if (same) {
            find(Finding::Kind::repair, in_.faces[origin_[f]], Mark::Kind::left_out,
                 fmt::format("face repeats {} corner by corner: it is left out", name_of(*same)),
                 "remove one of the two", "faces repeat an earlier one and are left out");
            continue;
        }
        left_origin.push_back(origin_[f]);
        left.corners.insert(left.corners.end(), mesh_.outline(f).begin(), mesh_.outline(f).end());
        left.first.push_back(static_cast<std::uint32_t>(left.corners.size()));
        left.material.push_back(mesh_.material[f]);
        left.area_vector.push_back(mesh_.area_vector[f]);
    }
    mesh_ = std::move(left);
    origin_ = std::move(left_origin);
}

void SceneBuilder::check_light() {
    const bool lit =
        std::any_of(in_.lights.begin(), in_.lights.end(), [](const auto& l) { return max(l.intensity) > 0; }) ||
        std::any_of(origin_.begin(), origin_.end(),
                    [&](std::uint32_t f) { return in_.materials[in_.faces[f].material].emits(); });
    if (!lit)
        find(Finding::Kind::warning, in_.faces.empty() ? 0 : in_.faces[0].line,
             "nothing emits light: all results are 0", "give a material an emission (in MTL: Ke r g b)");
}

/// Warns of faces that cover each other, in the order of the file.
void SceneBuilder::check_overlaps(const Scene& scene) {
    // Rays that start this near a face cannot tell the two apart.
    const Overlaps overlaps = find_overlaps(scene, 100 * tol_.place);
    for (const Overlap& overlap : overlaps.pairs) {
        const SceneDescription::Face &first = in_.faces[origin_[overlap.first.value]],
                                     &second = in_.faces[origin_[overlap.second.value]];
        find(Finding::Kind::warning, second, Mark::Kind::covering,
             fmt::format("face covers {:.3g} m^2 of {}, in the same plane: which of the two is seen is left to chance",
                         overlap.area, name_of(first)),
             "cut the one from the other, or move it a little off", "pairs of faces cover each other");
    }
    if (overlaps.gave_up)
        find(Finding::Kind::warning, 0, "so many faces lie over one another in one plane that not all were compared",
             "leave out all but those that light is to meet");
}

/// An outline that comes back to a corner bounds one polygon with holes, not lobes of opposite sense.
bool SceneBuilder::is_one_polygon(std::span<const std::uint32_t> outline, const Vec3& area) const {
    std::vector<std::uint32_t> sorted(outline.begin(), outline.end());
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end()) return true;
    std::vector<BorderEdge> edges;
    for (std::size_t i = 0; i < outline.size(); ++i) edges.push_back({outline[i], outline[(i + 1) % outline.size()]});
    const auto loops = border_loops(in_.points, std::move(edges), area, tol_.place);
    if (loops.empty()) return false;
    std::vector<Point> outer, hole;
    for (std::uint32_t c : loops[0]) outer.push_back(in_.points[c]);
    for (std::size_t i = 1; i < loops.size(); ++i) {
        hole.clear();
        for (std::uint32_t c : loops[i]) hole.push_back(in_.points[c]);
        if (dot(area_vector(hole), area) > 0) continue;  // a second outer loop
        for (std::uint32_t c : loops[i])
            if (std::find(loops[0].begin(), loops[0].end(), c) == loops[0].end() &&
                !contains(outer, normalized(area), in_.points[c]))
                return false;
    }
    return true;
}

/// Regions with their planes, points moved into them where they stand off by more than rounding.
void SceneBuilder::add_regions(Scene& scene, const std::vector<JoinedFaces>& joined) {
    scene.regions_.reserve(joined.size());
    for (const JoinedFaces& set : joined) {
        Region region;
        region.material = MaterialId(mesh_.material[set.faces[0]]);
        const RegionId id(scene.regions_.size());
        Vec3 area;
        double mean = 0, farthest = 0;
        std::size_t count = 0;
        const Point& origin = in_.points[set.loops[0][0]];
        for (const auto& loop : set.loops) {
            std::vector<Point>& corners = region.loops.emplace_back();
            for (std::uint32_t c : loop) corners.push_back(in_.points[c]);
            area += area_vector(corners);
        }
        const Normal n = normalized(area);
        for (const auto& loop : region.loops)
            for (const Point& p : loop) mean += dot(n, p - origin), ++count;
        mean /= static_cast<double>(count);
        region.plane = {n, dot(n, origin) + mean};
        region.area = norm(area);
        for (std::uint32_t f : set.faces)
            for (std::uint32_t c : mesh_.outline(f))
                farthest = std::max(farthest, std::abs(dot(n, in_.points[c] - origin) - mean));
        const auto into_plane = [&](Point& p) { p -= (dot(n, p - origin) - mean) * n; };
        if (farthest > tol_.place)
            for (auto& loop : region.loops) std::for_each(loop.begin(), loop.end(), into_plane);
        for (std::uint32_t f : set.faces) {
            region.surfaces.push_back(SurfaceId(f));
            Surface& surface = scene.surfaces_[SurfaceId(f)];
            surface.region = id;
            surface.normal = n;
            auto outline = std::span(scene.corners_).subspan(surface.first_corner, surface.corner_count);
            if (farthest > tol_.place) std::for_each(outline.begin(), outline.end(), into_plane);
        }
        scene.regions_.add(std::move(region));
    }
}

Scene SceneBuilder::make() {
    mesh_.points = in_.points;
    Scene scene;
    scene.file_ = in_.file;
    scene.box_ = box_;
    scene.surfaces_.resize(mesh_.size());
    scene.corners_.reserve(mesh_.corners.size());
    for (std::uint32_t c : mesh_.corners) scene.corners_.push_back(in_.points[c]);
    for (std::uint32_t f = 0; f < mesh_.size(); ++f) {
        const SceneDescription::Face& face = in_.faces[origin_[f]];
        Surface& surface = scene.surfaces_[SurfaceId(f)];
        surface.first_corner = mesh_.first[f];
        surface.corner_count = mesh_.first[f + 1] - mesh_.first[f];
        surface.material = MaterialId(face.material);
        surface.group = GroupId(face.group);
        surface.line = face.line;
        surface.area = norm(mesh_.area_vector[f]);
        if (in_.materials[face.material].emits()) scene.emitters_.push_back(SurfaceId(f));
    }
    add_regions(scene, join_coplanar(mesh_, tol_));
    for (Material& m : in_.materials) scene.materials_.add(std::move(m));
    for (const std::string& g : in_.groups) scene.groups_.add(g);
    for (PunctualLight& light : in_.lights)
        if (max(light.intensity) > 0) scene.lights_.push_back(std::move(light));
    scene.cameras_ = std::move(in_.cameras);
    return scene;
}

CheckedScene SceneBuilder::build() {
    check_materials();
    check_lights();
    place_corners();
    check_faces();
    report_unlisted();
    if (!has_errors()) {
        drop_duplicates();
        check_light();
        report_unlisted();
    }
    sort_findings(findings_);
    if (has_errors()) {
        Error first = error_of(findings_);
        return {std::move(first), std::move(findings_), std::move(marks_)};
    }
    Scene scene = make();
    check_overlaps(scene);
    report_unlisted();
    sort_findings(findings_);
    return {std::move(scene), std::move(findings_), std::move(marks_)};
}

CheckedScene make_scene(SceneDescription description) {
    return SceneBuilder(std::move(description)).build();
}

}  // namespace exitance
