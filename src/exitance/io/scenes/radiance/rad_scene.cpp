#include "exitance/io/scenes/radiance/rad_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "exitance/base/polygon.hpp"
#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/scenes/radiance/rad_shapes.hpp"
#include "exitance/io/scenes/radiance/rad_sky.hpp"

namespace exitance {
namespace {

Normal normal_of(const SceneDescription::Face& face, const std::vector<Point>& points) {
    std::vector<Point> corners;
    for (const std::uint32_t c : face.corners) corners.push_back(points[c]);
    const Vec3 area = area_vector(corners);
    return norm(area) > 0 ? normalized(area) : Normal{0, 0, 1};
}

}  // namespace

/// Notes that patterns on reflecting materials are omitted.
void RadScene::note_patterns(const RadMeaning& meaning) {
    if (meaning.pattern_count == 0) return;
    const RadPattern& pattern = materials_.patterns[meaning.pattern];
    findings_.note("patterns and textures", {pattern.file, pattern.primitive.line});
}

void RadScene::take_surface(const RadPrimitive& p, const RadCall& call) {
    const std::string& file = *call.name;
    const RadMeaning* meaning = materials_.meaning_of(p, file);
    const std::optional<RadShape> shape = meaning ? rad_shape(p, file, findings_) : std::nullopt;
    if (!shape || meaning->kind == RadMeaning::Kind::left_out) return;
    const bool emits = meaning->kind == RadMeaning::Kind::emits;
    if (!emits) note_patterns(*meaning);
    auto& d = out_.description;
    // Limits the number of faces: one line can request any number of copies. Few scenes have more faces than this.
    if (const std::size_t max_faces = 300'000 + bytes_ / 20; d.faces.size() + 2 * shape->facets.size() > max_faces) {
        if (!findings_.failed())
            findings_.error({file, p.line}, fmt::format("copies make more than {} faces", max_faces),
                            "write the copies to a file with Radiance's own xform, and read that");
        return;
    }
    const std::string name = call.prefix + shown(p.name);
    const auto [group, is_new] = groups_.try_emplace(name, static_cast<std::uint32_t>(d.groups.size()));
    if (is_new) d.groups.push_back(name);
    if (emits && shape->is_closed && shape->inwards && meaning->pattern_count == 0)
        bubbles_.push_back({d.faces.size(), d.faces.size() + shape->facets.size(), meaning->material});
    const bool turned = shape->inwards != (call.to_world.determinant() < 0);
    for (const std::vector<Point>& facet : shape->facets) {
        SceneDescription::Face face;
        face.material = meaning->material, face.group = group->second;
        face.line = call.command_line > 0 ? call.command_line : call.first_line + p.line;
        for (const Point& corner : facet) {
            face.corners.push_back(static_cast<std::uint32_t>(d.points.size()));
            d.points.push_back(call.to_world.point(corner));
        }
        if (meaning->kind == RadMeaning::Kind::glass) {
            Pane pane = materials_.glass[meaning->material];
            if (glass_names_.insert(p.modifier).second)
                out_.glazed_by.push_back(fmt::format("glass '{}' ({}:{})", shown(p.modifier), file, p.line));
            for (const std::uint32_t c : face.corners) pane.corners.push_back(d.points[c]);
            pane.line = face.line;
            d.panes.push_back(std::move(pane));
            out_.pane_labels.push_back({p.modifier, name});
            continue;
        }
        if (turned) std::reverse(face.corners.begin(), face.corners.end());
        if (emits) {
            const std::optional<std::uint32_t> material =
                emission_.material_of(*meaning, p, file, normal_of(face, d.points));
            if (!material) return;
            face.material = *material;
        }
        d.faces.push_back(face);
        if (meaning->kind != RadMeaning::Kind::reflects) continue;  // reflecting surfaces have two sides
        std::reverse(face.corners.begin(), face.corners.end());
        d.faces.push_back(std::move(face));
    }
}

/// Adds a distant light: the sun's disc, a sky, or the reflected light of the ground.
void RadScene::take_source(const RadPrimitive& p, const RadCall& call) {
    const RadPlace at{*call.name, p.line};
    const RadMeaning* meaning = materials_.meaning_of(p, at.file);
    if (!meaning) return;
    if (p.numbers.size() != 4)
        return findings_.error(at, fmt::format("source '{}' has {} numbers", p.name, p.numbers.size()));
    const Vec3 towards = call.to_world.vector({p.numbers[0], p.numbers[1], p.numbers[2]});
    const double length = norm(towards), angle = p.numbers[3] * pi / 180;
    if (!(length > 0) || !(angle > 0))
        return findings_.error(at, fmt::format("source '{}' has no direction or size", p.name));
    if (meaning->kind != RadMeaning::Kind::emits) return findings_.note("sources that do not emit", at);
    std::optional<SkyModel> pattern;
    if (meaning->pattern_count > 0) {
        const Result<SkyModel> sky = meaning->pattern_count == 1
                                         ? sky_of_pattern(materials_.patterns[meaning->pattern])
                                         : Error{ErrorCode::bad_input, "it modifies another pattern", "", ""};
        constexpr double max_disc_angle = 0.2;  // radians; larger than any sun
        if (!sky && angle > max_disc_angle)
            return findings_.note("skies with patterns that gensky and gendaylit do not print", at);
        if (!sky)
            return findings_.error(at,
                                   fmt::format("the light of source '{}' has a pattern, which is not read: {}",
                                               shown(p.name), sky.error().message),
                                   sky.error().hint);
        pattern = *sky;
    }
    const Spectrum radiance = radiance_of_exitance(materials_.materials[meaning->material].exitance);
    const std::optional<DistantLight> light =
        light_of_source(towards / length, angle, radiance, pattern ? &*pattern : nullptr);
    if (!light) return findings_.note("wide sources that are neither half of the sky nor the whole sky", at);
    out_.description.distant.append(*light);
}

void RadScene::take(RadPrimitive p, const RadCall& call) {
    if (const bool is_surface = is_rad_shape(p.type); is_surface || p.type == "source") {
        if (!call.material.empty()) p.modifier = call.material;
        return is_surface ? take_surface(p, call) : take_source(p, call);
    }
    materials_.take(std::move(p), *call.name, call.to_world);
}

/// Replaces a sphere that emits evenly inwards and contains the whole scene by a uniform sky above and below, which
/// gives every point the same light at any radius. Light that reaches the sphere is lost to the sky.
void RadScene::open_up() {
    SceneDescription& d = out_.description;
    if (bubbles_.size() != 1) return;
    const Bubble& bubble = bubbles_.front();
    Box box, rest;
    for (std::size_t i = 0; i < d.faces.size(); ++i)
        for (const std::uint32_t c : d.faces[i].corners)
            (i >= bubble.first && i < bubble.last ? box : rest).add(d.points[c]);
    const Vec3 half = 0.5 * box.size();
    // Shares of the radius: a limit for the deviation of facets from the sphere, and for the scene inside it.
    constexpr double ball = 1e-2, well_within = 0.9;
    const double radius = half.x;
    const bool is_ball = std::abs(half.y - radius) < ball * radius && std::abs(half.z - radius) < ball * radius;
    if (!is_ball || rest.is_empty()) return;
    for (std::size_t i = 0; i < d.faces.size(); ++i) {
        if (i >= bubble.first && i < bubble.last) continue;
        for (const std::uint32_t c : d.faces[i].corners)
            if (norm(d.points[c] - box.centre()) > well_within * radius) return;
    }
    const Spectrum radiance = radiance_of_exitance(materials_.materials[bubble.material].exitance);
    if (const auto light = light_of_source({0, 0, 1}, 2 * pi, radiance, nullptr)) d.distant.append(*light);
    d.faces.erase(d.faces.begin() + static_cast<std::ptrdiff_t>(bubble.first),
                  d.faces.begin() + static_cast<std::ptrdiff_t>(bubble.last));
    opened_ = true;
}

void RadScene::finish() {
    if (!findings_.failed()) open_up();
    out_.description.materials = std::move(materials_.materials);
    out_.description.profiles = std::move(emission_.profiles);
}

}  // namespace exitance
