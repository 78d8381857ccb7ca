#include "exitance/io/scenes/radiance/rad_sky.hpp"

#include <fmt/format.h>

#include <cmath>

#include "exitance/io/files/text_lines.hpp"

namespace exitance {
namespace {

Error no_sky(std::string message) {
    return {ErrorCode::bad_input, std::move(message), "", "skies as gensky and gendaylit print them are known"};
}

/// Direction of the sun in the world. Error: the pattern's transform tilts the sky.
Result<Normal> sun_of(const RadPattern& pattern, const Vec3& given) {
    const Vec3 up = pattern.to_world.vector({0, 0, 1}), sun = pattern.to_world.vector(given);
    constexpr double slack = 1e-6;
    if (!(norm(up) > 0) || norm(normalized(up) - Vec3{0, 0, 1}) > slack) return no_sky("its transform tilts the sky");
    if (!(norm(sun) > 0)) return no_sky("it has no direction of the sun");
    return normalized(sun);
}

enum class Kind { clear = 1, overcast = 2, uniform = 3, intermediate = 4 };

/// Returns gensky's sky, defined by Radiance's skybright.cal.
Result<SkyModel> gensky(const RadPattern& pattern) {
    const std::vector<double>& v = pattern.primitive.numbers;
    if (v.size() != 3 && v.size() != 7) return no_sky(fmt::format("skybr has {} numbers, not 3 or 7", v.size()));
    const auto kind = static_cast<Kind>(static_cast<int>(v[0]));
    SkyModel sky;
    sky.ground = v[2], sky.blends_ground = true;
    if (v.size() == 7) {
        const Result<Normal> sun = sun_of(pattern, {v[4], v[5], v[6]});
        if (!sun) return sun.error();
        sky.sun = *sun;
    } else if (kind == Kind::clear || kind == Kind::intermediate) {
        return no_sky("a sky with a sun has 7 numbers");
    }
    const double by_sun = v.size() == 7 ? v[1] / v[3] : 0;
    switch (kind) {
        case Kind::clear:
            sky.a = -1, sky.b = -0.32;
            sky.f0 = 0.91 * by_sun, sky.c = 10 * by_sun, sky.d = -3, sky.e = 0.45 * by_sun;
            return sky;
        case Kind::overcast:
            sky.f0 = v[1] / 3, sky.g = 2;
            return sky;
        case Kind::uniform:
            sky.f0 = v[1];
            return sky;
        case Kind::intermediate:
            sky.f0 = by_sun, sky.intermediate = true;
            return sky;
    }
    return no_sky(fmt::format("skybr has no kind {:g}", v[0]));
}

/// Returns gendaylit's sky, defined by Radiance's perezlum.cal.
Result<SkyModel> gendaylit(const RadPattern& pattern) {
    const std::vector<double>& v = pattern.primitive.numbers;
    if (v.size() != 10) return no_sky(fmt::format("skybright has {} numbers, not 10", v.size()));
    const Result<Normal> sun = sun_of(pattern, {v[7], v[8], v[9]});
    if (!sun) return sun.error();
    SkyModel sky;
    sky.ground = v[1], sky.blends_ground = true;
    sky.a = v[2], sky.b = v[3], sky.f0 = v[0], sky.c = v[0] * v[4], sky.d = v[5], sky.e = v[0] * v[6];
    sky.sun = *sun;
    return sky;
}

}  // namespace

Result<SkyModel> sky_of_pattern(const RadPattern& pattern) {
    const std::vector<std::string>& words = pattern.primitive.words;
    if (pattern.primitive.type != "brightfunc" || words.size() < 2)
        return no_sky(fmt::format("{} '{}' is not a sky", pattern.primitive.type, shown(pattern.primitive.name)));
    for (const double v : pattern.primitive.numbers)
        if (!std::isfinite(v)) return no_sky("it has a number that is not finite");
    Result<SkyModel> sky = words[0] == "skybr" && words[1].ends_with("skybright.cal") ? gensky(pattern)
                           : words[0] == "skybright" && words[1].ends_with("perezlum.cal")
                               ? gendaylit(pattern)
                               : no_sky(fmt::format("its function is '{}' of '{}'", shown(words[0]), shown(words[1])));
    if (sky && !sky->is_sane()) return no_sky("it has numbers that no sky has");
    return sky;
}

std::optional<DistantLight> light_of_source(const Vec3& towards, double angle, const Spectrum& radiance,
                                            const SkyModel* pattern) {
    constexpr double slack = 1e-4;
    const bool is_half = std::abs(angle - pi)<slack, is_all = angle> 2 * pi - slack;
    const bool is_upright = std::abs(towards.z) > 1 - slack;
    DistantLight out;
    if (is_all || (is_half && is_upright)) {
        for (const bool below : {false, true}) {
            if (!is_all && below != (towards.z < 0)) continue;
            SkyModel model = pattern ? *pattern : uniform_sky();
            model.below = below;
            if (!model.normalize()) continue;
            out.domes.push_back({model, (pi / model.scale) * radiance});
        }
        return out;
    }
    if (0.5 * angle > widest_disc || pattern) return std::nullopt;
    const double sine = std::sin(0.5 * angle);
    out.discs.push_back({towards, 0.5 * angle, (pi * sine * sine) * radiance});
    return out;
}

}  // namespace exitance
