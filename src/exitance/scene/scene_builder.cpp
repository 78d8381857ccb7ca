#include "exitance/scene/scene_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "exitance/base/distinct_numbers.hpp"
#include "exitance/base/random.hpp"
#include "exitance/scene/joining/hash_chains.hpp"
#include "exitance/scene/joining/outline.hpp"
#include "exitance/scene/joining/weld.hpp"
#include "exitance/scene/overlaps.hpp"
#include "exitance/scene/shell.hpp"

namespace exitance {

Tolerances tolerances(const Box& box, double short_edge) {
    const Vec3 far = max(max(box.hi, -box.hi), max(box.lo, -box.lo));
    const double spacing = std::max({far.x, far.y, far.z}) * std::numeric_limits<double>::epsilon();
    Tolerances t;
    t.place = std::max(std::min(1e-9 * box.diagonal(), 1e-5 * short_edge), 4 * spacing);
    t.plane = std::max(1e-5 * box.diagonal(), t.place);
    return t;
}

constexpr std::size_t max_corners = 10'000;  ///< Maximum per face, since the time of triangulation is quadratic in it.
constexpr double max_coordinate = 1e15;      ///< Metres from the origin: powers of areas stay finite.
constexpr double max_exitance = 1e30;        ///< W/m^2, cd, lx: light is accumulated in float, whose maximum is 3e38.
/// Metres; measured by solving closed boxes: view factors are inaccurate from 1e-15 m on, and areas vanish below.
constexpr double min_size = 1e-12;
/// W/m^2, cd, lx; derived from float, whose smallest accurate number is 1.2e-38: weaker light would be lost.
constexpr double min_brightness = 1e-30;

bool is_near(const Point& p) {
    return std::abs(p.x) <= max_coordinate && std::abs(p.y) <= max_coordinate && std::abs(p.z) <= max_coordinate;
}

std::string SceneBuilder::name_of(const SceneDescription::Face& face) const {
    if (face.line > 0 || face.group >= in_.groups.size()) return fmt::format("the face of line {}", face.line);
    return fmt::format("a face of '{}'", in_.groups[face.group]);
}

void SceneBuilder::find(Finding::Kind kind, const SceneDescription::Face& face, Mark::Kind mark, std::string message,
                        std::string hint, const char* rest) {
    Mark& marked = marks_.emplace_back(Mark{mark, {}});
    for (std::uint32_t c : face.corners)
        if (c < in_.points.size() && is_finite(in_.points[c])) marked.outline.push_back(in_.points[c]);
    if (face.line == 0 && face.group < in_.groups.size())
        message = fmt::format("in '{}': {}", in_.groups[face.group], message);
    // In files without lines, faces are identified only by their group.
    if (rest || face.line == 0) {
        const auto [told, is_new] =
            alike_.try_emplace(rest ? rest : message, Alike{findings_.size(), 0, rest ? rest : "like this"});
        if (!is_new) return void(++told->second.more);
    }
    find(kind, face.line, std::move(message), std::move(hint));
}

void SceneBuilder::report_alike() {
    for (const auto& [key, alike] : alike_)
        if (alike.more > 0)
            findings_[alike.finding].message += fmt::format(" (and {} more {})", alike.more, alike.rest);
    alike_.clear();
}

void SceneBuilder::check_materials() {
    static constexpr const char* rgb[3] = {"R", "G", "B"};
    const auto band = [](std::size_t b) { return bands == 3 ? std::string(rgb[b]) : std::to_string(b); };
    std::size_t white_ones = 0;
    std::string first;
    for (Material& m : in_.materials) {
        if (mend_reflectance(m.reflectance) && ++white_ones == 1) first = m.name;
        for (std::size_t b = 0; b < bands; ++b) {
            if (!(m.reflectance[b] >= 0 && m.reflectance[b] < 1))
                error(0,
                      fmt::format("material '{}' has reflectance {} in band {}", m.name,
                                  distinct_texts(m.reflectance[b], 1, 6).first, band(b)),
                      "reflectances lie in [0, 1): at 1 reflections would never fade");
            if (!(m.exitance[b] >= 0 && m.exitance[b] <= max_exitance))
                error(0,
                      fmt::format("material '{}' has exitance {} in band {}", m.name,
                                  distinct_texts(m.exitance[b], max_exitance, 6).first, band(b)),
                      fmt::format("emission is not negative, and at most {:g} W/m^2", max_exitance));
        }
    }
    if (white_ones > 0)
        find(Finding::Kind::repair, 0,
             fmt::format("material '{}'{} reflects all light: {} is used instead of 1", first,
                         white_ones > 1 ? fmt::format(" (and {} more)", white_ones - 1) : "", mended_reflectance));
}

void SceneBuilder::check_lights() {
    for (const PunctualLight& light : in_.lights) {
        if (!std::all_of(light.intensity.value.begin(), light.intensity.value.end(),
                         [](double v) { return v >= 0 && v <= max_exitance; }))
            error(0, fmt::format("light '{}' has an intensity that is negative, too large or not finite", light.name));
        if (!is_near(light.position) || !(std::abs(norm(light.direction) - 1) < 1e-6))
            error(0, fmt::format("light '{}' has no position or no direction", light.name));
        if (light.kind == PunctualLight::Kind::spot &&
            !(light.inner_cone >= 0 && light.inner_cone < light.outer_cone && light.outer_cone <= pi / 2))
            error(0,
                  fmt::format("spot '{}' has cones of {:g} and {:g} radians", light.name, light.inner_cone,
                              light.outer_cone),
                  "the inner one is at least 0 and less than the outer one, that one at most pi / 2");
    }
    if (!in_.distant.is_sane())
        error(0, "a sky or a sun has no direction, or its light is negative, too large or not finite");
}

void SceneBuilder::add_pane_faces() {
    first_pane_face_ = static_cast<std::uint32_t>(in_.faces.size());
    for (const Pane& pane : in_.panes) {
        SceneDescription::Face& face = in_.faces.emplace_back();
        face.line = pane.line, face.group = static_cast<std::uint32_t>(in_.groups.size());
        for (const Point& corner : pane.corners) {
            face.corners.push_back(static_cast<std::uint32_t>(in_.points.size()));
            in_.points.push_back(corner);
        }
    }
}

void SceneBuilder::check_panes() {
    in_.faces.resize(first_pane_face_);
    in_.panes = std::move(panes_);
    for (const Pane& pane : in_.panes)
        if (!pane.is_sane()) error(pane.line, "a pane of glass lets more light through than arrives");
}

/// Computes the scene's box and finds the points at equal positions.
void SceneBuilder::place_corners() {
    std::vector<float> lengths;  // lengths of all edges; only their order of magnitude matters
    for (std::uint32_t f = 0; f < in_.faces.size(); ++f) {
        const auto& face = in_.faces[f];
        if (is_pane(f) && first_pane_face_ > 0) break;
        const Point* before = nullptr;
        for (std::uint32_t c : face.corners) {
            if (c >= in_.points.size() || !is_near(in_.points[c])) continue;
            const Point& p = in_.points[c];
            box_.add(p);
            if (before && p != *before) lengths.push_back(static_cast<float>(norm(p - *before)));
            before = &p;
        }
    }
    const Vec3 extent = box_.size();
    const double size = std::max({extent.x, extent.y, extent.z});
    if (size > 0 && size < min_size)
        error(0, fmt::format("the scene is only {:.4g} m large", size),
              fmt::format("scale it: scenes of {:g} m or more are supported", min_size));
    if (is_sky_alone()) box_.add(Point{-0.5, -0.5, -0.5}), box_.add(Point{0.5, 0.5, 0.5});
    constexpr std::size_t one_in = 100;
    const auto percentile = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / one_in);
    if (!lengths.empty()) std::nth_element(lengths.begin(), percentile, lengths.end());
    tol_ = tolerances(box_, lengths.empty() ? HUGE_VAL : static_cast<double>(*percentile));
    place_ = weld(in_.points, tol_.place);
}

void SceneBuilder::check_faces() {
    mesh_.first.push_back(0);
    for (std::uint32_t f = 0; f < in_.faces.size(); ++f) check_face(f);
    report_flattened();
    check_panes();
    if (is_sky_alone()) return;
    if (in_.faces.empty() && in_.panes.empty())
        error(1, "there are no polygons", "a scene needs at least one face, or a sky (solve --sky)");
    else if (in_.faces.empty())
        error(in_.panes[0].line, "all faces are panes of clear glass", "a scene needs at least one opaque face");
    else if (mesh_.size() == 0 && !has_errors())
        error(in_.faces[0].line, "no polygon is left after faces without area were removed");
}

/// Appends the face to the mesh if it is valid; otherwise reports why not.
void SceneBuilder::check_face(std::uint32_t f) {
    const SceneDescription::Face& face = in_.faces[f];
    if (!is_pane(f) && (face.material >= in_.materials.size() || face.group >= in_.groups.size()))
        return error(face, "face has no material or no group");
    if (face.corners.size() > max_corners)
        return error(face, fmt::format("face has {} corners; {} are the most", face.corners.size(), max_corners),
                     "make its outline simpler, or cut it up");
    std::vector<std::uint32_t> outline = face.corners;
    for (std::uint32_t& c : outline) {
        if (c >= in_.points.size())
            return error(
                face, fmt::format("face refers to corner {}, but the scene has {} points", c + 1, in_.points.size()));
        if (!is_finite(in_.points[c])) return error(face, "a corner of the face is not a finite point");
        if (!is_near(in_.points[c]))
            return error(face,
                         fmt::format("a corner of the face lies at ({:g}, {:g}, {:g}) m", in_.points[c].x,
                                     in_.points[c].y, in_.points[c].z),
                         fmt::format("mend it, or scale the scene: coordinates go up to {:g} m", max_coordinate));
        c = place_[c];
    }
    const std::size_t given = outline.size(), dropped = drop_repeated_corners(outline);
    if (outline.size() < 3)
        return repair(face,
                      fmt::format("face of {} corners doubles back on itself and has no area: it is left out", given),
                      "faces without area", "remove it, or give it three corners that are not in line");
    if (dropped > 0)
        repair(face,
               fmt::format("{} of the face's {} corners coincide with a neighbour: they are merged", dropped, given),
               "faces with such corners");
    check_shape(f, std::move(outline));
}

void SceneBuilder::add_face(std::uint32_t f, std::span<const std::uint32_t> outline, const Vec3& area) {
    if (is_pane(f)) {
        Pane& pane = panes_.emplace_back(in_.panes[f - first_pane_face_]);
        pane.corners.clear();
        for (const std::uint32_t c : outline) pane.corners.push_back(in_.points[c]);
        pane.n = normalized(area);
        return;
    }
    mesh_.corners.insert(mesh_.corners.end(), outline.begin(), outline.end());
    mesh_.first.push_back(static_cast<std::uint32_t>(mesh_.corners.size()));
    mesh_.material.push_back(in_.faces[f].material);
    mesh_.area_vector.push_back(area);
    origin_.push_back(f);
}

void SceneBuilder::report_flattened() {
    if (flattened_.count > 0)
        find(Finding::Kind::repair, flattened_.first_line,
             fmt::format("{} out of plane by up to {:.3g} m, the first of them here: corners are moved into the plane",
                         flattened_.count == 1 ? "1 face is" : fmt::format("{} faces are", flattened_.count),
                         flattened_.farthest));
}

/// Removes faces that repeat an earlier one with the same corners and orientation: which of the two receives the light
/// would be arbitrary.
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
            repair(in_.faces[origin_[f]],
                   fmt::format("face repeats {} corner by corner: it is left out", name_of(*same)),
                   "faces that repeat an earlier one", "remove one of the two");
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

void SceneBuilder::turn_bodies() {
    BodyFaces faces;
    faces.size = box_.diagonal();
    for (std::uint32_t f = 0; f < mesh_.size(); ++f) {
        std::vector<Point> corners;
        for (const std::uint32_t c : mesh_.outline(f)) corners.push_back(in_.points[c]);
        faces.add(corners, normalized(mesh_.area_vector[f]), in_.materials[mesh_.material[f]].emits());
    }
    faces.add_lights(in_.lights, in_.distant);
    for (const InsideOut& body : find_inside_out(faces)) {
        const SceneDescription::Face& first = in_.faces[origin_[body.faces[0]]];
        const Finding repaired = finding_of(body, in_.groups[first.group], Finding::Kind::repair);
        repair(first, repaired.message, "bodies that are inside out");
        for (const std::uint32_t f : body.faces) {
            const auto corners = mesh_.corners.begin();
            std::reverse(corners + mesh_.first[f], corners + mesh_.first[f + 1]);
            mesh_.area_vector[f] = -mesh_.area_vector[f];
        }
    }
}

void SceneBuilder::check_light() {
    double brightest = 0;
    for (const DistantLight::Dome& dome : in_.distant.domes) brightest = std::max(brightest, max(dome.irradiance));
    for (const DistantLight::Disc& disc : in_.distant.discs) brightest = std::max(brightest, max(disc.irradiance));
    for (const PunctualLight& light : in_.lights) brightest = std::max(brightest, max(light.intensity));
    for (const std::uint32_t f : origin_)
        brightest = std::max(brightest, max(in_.materials[in_.faces[f].material].exitance));
    if (brightest > 0 && brightest < min_brightness)
        error(0, fmt::format("the brightest light of the scene is only {:.4g} W/m^2 (or cd, lx)", brightest),
              fmt::format("scale the light: {:g} or more is supported", min_brightness));
    if (brightest == 0)
        find(Finding::Kind::warning, in_.faces.empty() ? 0 : in_.faces[0].line,
             "nothing emits light: all results are 0",
             "give a material an emission (in MTL: Ke r g b), or the scene a sky (solve --sky)");
}

/// Stacks overlapping faces: counts the regions under each region, and reports the overlaps. A face that emits light is
/// on top of one that does not, like a panel in the plane of a ceiling; otherwise the later one is on top.
void SceneBuilder::stack_overlaps(Scene& scene) {
    // Rays that start this near to a face cannot distinguish the two.
    const Overlaps overlaps = find_overlaps(scene, 100 * tol_.place);
    const auto emits = [&](SurfaceId s) { return scene.material(s).emits(); };
    std::vector<std::pair<SurfaceId, SurfaceId>> lower_and_upper;
    for (const Overlap& overlap : overlaps.pairs) {
        SurfaceId lower = overlap.first, upper = overlap.second;
        const bool both_emit = emits(lower) && emits(upper), is_panel = emits(lower) && !emits(upper);
        if (is_panel) std::swap(lower, upper);
        lower_and_upper.emplace_back(lower, upper);
        const char* const which = both_emit  ? "in the same plane: both emit light, also where one covers the other"
                                  : is_panel ? "in the same plane: the one that emits light is on top"
                                             : "in the same plane: the later one is on top";
        find(Finding::Kind::warning, in_.faces[origin_[upper.value]], Mark::Kind::covering,
             fmt::format("face covers {:.3g} m^2 of {}, {}", overlap.area, name_of(in_.faces[origin_[lower.value]]),
                         which),
             "cut one face out of the other, or move it away from the plane of the other",
             both_emit ? "faces that cover another that emits light" : "faces that cover another");
    }
    if (overlaps.gave_up)
        find(Finding::Kind::warning, 0, "so many faces lie over one another in one plane that not all were compared",
             "keep only the faces that light can reach");
    for (bool changed = true; std::exchange(changed, false);)
        for (const auto& [lower, upper] : lower_and_upper) {
            const std::uint8_t under = scene.regions_[scene.surfaces_[lower].region].level;
            std::uint8_t& over = scene.regions_[scene.surfaces_[upper].region].level;
            if (over > under || under == max_stacked) continue;
            over = static_cast<std::uint8_t>(under + 1), changed = true;
        }
}

CheckedScene SceneBuilder::build() {
    add_other_sides();
    check_materials();
    check_lights();
    add_pane_faces();
    place_corners();
    check_faces();
    report_alike();
    if (!has_errors()) {
        drop_duplicates();
        if (turn_bodies_) turn_bodies();
        check_light();
        report_alike();
    }
    sort_findings(findings_);
    if (has_errors()) {
        Error first = error_of(findings_);
        return {std::move(first), std::move(findings_), std::move(marks_)};
    }
    Scene scene = make();
    stack_overlaps(scene);
    pair_sides(scene);
    report_alike();
    sort_findings(findings_);
    if (has_errors()) {
        Error first = error_of(findings_);
        return {std::move(first), std::move(findings_), std::move(marks_)};
    }
    return {std::move(scene), std::move(findings_), std::move(marks_)};
}

bool mend_reflectance(Spectrum& reflectance) {
    bool mended = false;
    for (double& r : reflectance.value)
        if (r >= 1 && r <= whitest_reflectance) r = mended_reflectance, mended = true;
    return mended;
}

CheckedScene make_scene(SceneDescription description) {
    return SceneBuilder(std::move(description)).build();
}

}  // namespace exitance
