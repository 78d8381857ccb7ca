#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "exitance/base/parallel.hpp"
#include "exitance/lab/cie171/cases.hpp"
#include "exitance/lab/cie171/exact_sky.hpp"
#include "exitance/samples/polygon_kit.hpp"

namespace exitance {
namespace {

using Case = Cie171Case;
constexpr std::array<double, 6> wall_heights{2.75, 2.25, 1.75, 1.25, 0.75, 0.25};
constexpr std::array<double, 8> floor_depths{0.25, 0.75, 1.25, 1.75, 2.25, 2.75, 3.25, 3.75};

/// A hole in a wall: range along x, and along the wall's other direction.
struct Hole {
    double x0, x1, b0, b1;
};

/// Common data of all skies of one scene.
struct Setting {
    const char *study, *scene;
    SceneDescription description;
    SkyOpening opening;
    std::vector<std::string> names;
    std::vector<ProbePoint> points;
    std::vector<SkyOpening> visible = {};  ///< Visible part of the opening for each point; empty: all of it.
};

/// Adds a wall 4 m long in x, from 0 to `length` in direction v from `o`, around a hole.
void add_frame(PolygonKit& kit, const Point& seen, const Point& o, const Vec3& v, double length, const Hole& h) {
    const auto part = [&](double x0, double x1, double b0, double b1) {
        if (x1 - x0 < 1e-12 || b1 - b0 < 1e-12) return;
        const auto at = [&](double x, double b) { return o + Vec3{x, 0, 0} + b * v; };
        kit.facing(seen, "frame", "room", {at(x0, b0), at(x1, b0), at(x1, b1), at(x0, b1)});
    };
    part(0, h.x0, 0, length), part(h.x1, 4, 0, length), part(h.x0, h.x1, 0, h.b0), part(h.x0, h.x1, h.b1, length);
}

/// A black room of 4 x 4 x 3 m with a hole in its roof, or in its wall y = 0.
PolygonKit room_with(const char* name, bool roof, const Hole& hole) {
    PolygonKit kit(name);
    kit.material("room", 0);
    const Point middle{2, 2, 1.5};
    const auto face = [&](const char* group, std::vector<Point> outline) {
        kit.facing(middle, group, "room", std::move(outline));
    };
    face("floor", {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
    face("wall_y1", {{0, 4, 0}, {4, 4, 0}, {4, 4, 3}, {0, 4, 3}});
    face("wall_x0", {{0, 0, 0}, {0, 4, 0}, {0, 4, 3}, {0, 0, 3}});
    face("wall_x1", {{4, 0, 0}, {4, 4, 0}, {4, 4, 3}, {4, 0, 3}});
    if (roof) {
        face("wall_y0", {{0, 0, 0}, {4, 0, 0}, {4, 0, 3}, {0, 0, 3}});
        add_frame(kit, middle, {0, 0, 3}, {0, 1, 0}, 4, hole);
    } else {
        face("ceiling", {{0, 0, 3}, {4, 0, 3}, {4, 4, 3}, {0, 4, 3}});
        add_frame(kit, middle, {0, 0, 0}, {0, 0, 1}, 3, hole);
    }
    return kit;
}

std::string letter(std::size_t i) {
    return std::string(1, static_cast<char>('A' + i));
}

std::vector<Setting> roofs() {
    std::vector<Setting> out;
    for (const auto& [name, a] : {std::pair{"roof_1x1", 0.5}, {"roof_4x4", 2.0}}) {
        Setting s{"5.9", name, {}, {{0, 0, 3}, {1, 0, 0}, {0, 1, 0}, 2 - a, 2 + a, 2 - a, 2 + a}, {}, {}};
        s.description = room_with(name, true, {2 - a, 2 + a, 2 - a, 2 + a}).take();
        for (const double z : wall_heights) s.points.push_back({{2, 0, z}, {0, 1, 0}});
        for (const double y : floor_depths) s.points.push_back({{2, y, 0}, {0, 0, 1}});
        for (std::size_t i = 0; i < s.points.size(); ++i) s.names.push_back(letter(i));
        out.push_back(std::move(s));
    }
    return out;
}

std::vector<Setting> facades() {
    std::vector<Setting> out;
    for (const auto& [name, h] :
         {std::pair{"facade_2x1", Hole{1, 3, 1, 2}}, std::pair{"facade_4x3", Hole{0, 4, 0, 3}}}) {
        Setting s{"5.11", name, {}, {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, h.x0, h.x1, h.b0, h.b1}, {}, {}};
        s.description = room_with(name, false, h).take();
        for (const double z : wall_heights) s.points.push_back({{2, 4, z}, {0, -1, 0}});
        for (const double y : floor_depths) s.points.push_back({{2, 4 - y, 0}, {0, 0, 1}});
        for (std::size_t i = 0; i < s.points.size(); ++i) s.names.push_back(letter(i));
        for (std::size_t i = 0; i < floor_depths.size(); ++i) {
            s.points.push_back({{2, 4 - floor_depths[i], 3}, {0, 0, -1}});
            s.names.push_back(letter(6 + i) + "'");
        }
        out.push_back(std::move(s));
    }
    return out;
}

/// Black masks: overhangs of several floor_depths over the opening, and walls of several wall_heights 6 m in front of
/// it.
std::vector<Setting> masks() {
    std::vector<Setting> out;
    const auto add = [&](const char* study, const char* name, std::vector<Point> mask, auto seen) {
        Setting s{study, name, {}, {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 1, 3, 1, 2}, {}, {}};
        PolygonKit kit = room_with(name, false, {1, 3, 1, 2});
        kit.facing({2, 0, 1}, "mask", "room", std::move(mask));
        s.description = std::move(kit).take();
        for (std::size_t i = 0; i < floor_depths.size(); ++i) {
            const double y = 4 - floor_depths[i];
            s.points.push_back({{2, y, 0}, {0, 0, 1}}), s.names.push_back(letter(i));
            SkyOpening& part = s.visible.emplace_back(s.opening);
            const auto [from, to] = seen(y);
            part.b0 = std::clamp(from, 1.0, 2.0), part.b1 = std::clamp(to, 1.0, 2.0);
        }
        out.push_back(std::move(s));
    };
    for (const auto& [name, depth] : {std::pair{"overhang_0.5", 0.5}, {"overhang_1.0", 1.0}, {"overhang_2.0", 2.0}})
        add("5.13", name, {{-4, 0, 3}, {8, 0, 3}, {8, -depth, 3}, {-4, -depth, 3}},
            [d = depth](double y) { return std::pair(1.0, 3 * y / (y + d)); });
    for (const auto& [name, height] : {std::pair{"wall_3", 3.0}, {"wall_6", 6.0}, {"wall_9", 9.0}})
        add("5.14", name, {{-13, -6, 0}, {17, -6, 0}, {17, -6, height}, {-13, -6, height}},
            [h = height](double y) { return std::pair(h * y / (y + 6), 2.0); });
    return out;
}

/// Table of radiance by direction: light that leaves the sky downwards, and the ground upwards.
EmissionProfile sky_profile(const Cie171Skies& skies, std::size_t sky) {
    constexpr double theta_step = 0.25, near_step = 0.5, far_step = 1, near = 40;
    EmissionProfile p;
    std::vector<double> theta, phi;
    for (int i = 0; i * theta_step < 90 - 1e-9; ++i) theta.push_back(i * theta_step);
    theta.insert(theta.end(), {89.9999, 90, 180});
    // Light from the sun's side travels in the opposite direction: use smaller steps there.
    double opposite = std::atan2(-skies.sun().y, -skies.sun().x) / degree;
    if (opposite < 0) opposite += 360;
    for (double a = 0; a <= 360 + 1e-9;) {
        phi.push_back(std::min(a, 360.0));
        const double off = std::abs(std::remainder(a - opposite, 360));
        a += off < near ? near_step : far_step;
    }
    p.axes[0] = {EmissionProfile::Angle::phi, 0, phi};
    p.axes[1] = {EmissionProfile::Angle::theta, 0, theta};
    for (const double b : phi)
        for (const double a : theta) {
            const double t = a * degree, f = b * degree;
            const Normal w{-std::sin(t) * std::cos(f), -std::sin(t) * std::sin(f), std::cos(t)};
            p.values.push_back(a >= 90 ? cie171_ground_luminance : skies.luminance(w)[sky]);
        }
    return p;
}

/// Adds a box around everything whose faces emit inwards with the sky's radiance. As radiance depends on direction
/// only, the position of the faces does not matter.
void add_sky(SceneDescription& scene, const Cie171Skies& skies, std::size_t sky) {
    constexpr double half = 40;
    const Point middle{2, 0, 0};
    scene.profiles.push_back(sky_profile(skies, sky));
    scene.photometric = true;
    const auto group = static_cast<std::uint32_t>(scene.groups.size());
    scene.groups.push_back("sky");
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            Normal n;
            n[axis] = -side;
            const Frame frame(n);
            Material material;
            material.name = "sky";
            const double flux = exitance_of(scene.profiles.back(), n);
            material.exitance = Spectrum(flux);
            material.emission.profile = ProfileId(scene.profiles.size() - 1), material.emission.scale = pi / flux;
            SceneDescription::Face face;
            face.material = static_cast<std::uint32_t>(scene.materials.size()), face.group = group;
            scene.materials.push_back(material);
            for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
                face.corners.push_back(static_cast<std::uint32_t>(scene.points.size()));
                scene.points.push_back(middle + half * (a * frame.u + b * frame.v - n));
            }
            scene.faces.push_back(std::move(face));
        }
}

}  // namespace

std::vector<Cie171Case> cie171_sky_cases(const Cie171Options& options) {
    std::vector<Setting> settings = roofs();
    for (auto& more : {facades(), masks()}) settings.insert(settings.end(), more.begin(), more.end());
    if (!options.only.empty()) std::erase_if(settings, [&](const Setting& s) { return s.study != options.only; });
    const double c = std::cos(60 * degree), s = std::sin(60 * degree);
    std::vector<Case> out;
    for (const Setting& setting : settings) {
        const bool roof = std::string(setting.study) == "5.9";
        // the sun faces the wall with the points, or is in front of the facade
        const Cie171Skies skies({0, roof ? c : -c, s});
        std::vector<SkyValues> exact(setting.points.size());
        parallel_for(exact.size(), 1, [&](std::size_t i) {
            const SkyOpening& seen = setting.visible.empty() ? setting.opening : setting.visible[i];
            exact[i] = illuminance_through(seen, setting.points[i].x, setting.points[i].n, skies);
        });
        for (std::size_t sky = 0; sky < cie171_skies; ++sky) {
            if (options.quick && sky != 0 && sky != 4 && sky != 11 && sky != 14) continue;
            Case one;
            one.study = setting.study, one.scene = setting.scene, one.parameter = fmt::format("sky={}", sky + 1);
            one.description = setting.description, one.names = setting.names, one.points = setting.points;
            one.direct_only = true;  // all black
            for (const SkyValues& values : exact) one.exact.push_back(values[sky]);
            add_sky(one.description, skies, sky);
            out.push_back(std::move(one));
        }
    }
    return out;
}

}  // namespace exitance
