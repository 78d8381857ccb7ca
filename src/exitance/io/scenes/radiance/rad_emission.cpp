#include "exitance/io/scenes/radiance/rad_emission.hpp"

#include <fmt/format.h>

#include <cmath>

#include "exitance/io/files/text_lines.hpp"

namespace exitance {
namespace {

constexpr double direction_tolerance = 1e-9;  ///< Directions that differ by less are equal.

std::int64_t rounded(double v) {
    return std::llround(v / direction_tolerance);
}

}  // namespace

const RadEmission::Lamp& RadEmission::lamp_of(const RadMeaning& meaning, const RadPrimitive& face,
                                              const std::string& file) {
    const auto [at, is_new] = lamps_.try_emplace(meaning.pattern);
    Lamp& lamp = at->second;
    if (!is_new) return lamp;
    const RadPattern& pattern = materials_.patterns[meaning.pattern];
    const std::string name = fmt::format("{} '{}'", pattern.primitive.type, shown(pattern.primitive.name));
    const std::string by = fmt::format("'{}' emits by the {}, which cannot be read: ", shown(face.name), name);
    if (meaning.pattern_count > 1) {
        findings_.error({file, face.line}, by + "it modifies another pattern", "an emitter has one distribution");
        return lamp;
    }
    Result<RadDistribution> read = read_distribution(pattern, scene_file_);
    if (!read) {
        const std::string hint = read.error().hint;
        findings_.error({file, face.line}, by + read.error().message,
                        hint.empty() ? "without it the light would be wrong" : hint);
        return lamp;
    }
    if (!pattern.primitive.words.empty() && pattern.primitive.words[0].starts_with("lboxcorr"))
        findings_.note("what lboxcorr changes near a lamp", {pattern.file, pattern.primitive.line});
    const Affine& to_world = read->to_world;
    if (!(std::abs(to_world.determinant()) > 0)) {
        findings_.error({file, face.line}, by + "its transform has a scale of 0");
        return lamp;
    }
    lamp.emission.x = normalized(to_world.x), lamp.emission.y = normalized(to_world.y);
    lamp.emission.z = normalized(to_world.z);
    std::string key = pattern.file;
    for (const std::string& word : pattern.primitive.words) key += '\n' + word;
    for (const double number : pattern.primitive.numbers) key += fmt::format(" {}", number);
    const auto [known, is_first] = by_words_.try_emplace(key, ProfileId(profiles.size()));
    if (is_first) profiles.push_back(std::move(read->profile));
    lamp.emission.profile = known->second;
    lamp.is_read = true;
    return lamp;
}

double RadEmission::flux(ProfileId profile, const Normal& n) {
    const std::array<std::int64_t, 4> key{profile.value, rounded(n.x), rounded(n.y), rounded(n.z)};
    const auto [at, is_new] = flux_.try_emplace(key);
    if (is_new) at->second = exitance_of(profiles[profile.value], n);
    return at->second;
}

std::optional<std::uint32_t> RadEmission::material_of(const RadMeaning& meaning, const RadPrimitive& face,
                                                      const std::string& file, const Normal& n) {
    if (meaning.pattern_count == 0) return meaning.material;
    const Lamp& lamp = lamp_of(meaning, face, file);
    if (!lamp.is_read) return std::nullopt;
    DirectedEmission emission = lamp.emission;
    std::array<std::int64_t, 14> key{meaning.material, emission.profile.value};
    std::size_t next = 2;
    for (const Vec3& v : {emission.x, emission.y, emission.z, n})
        for (const double c : {v.x, v.y, v.z}) key[next++] = rounded(c);
    const auto [at, is_new] = by_turn_.try_emplace(key, static_cast<std::uint32_t>(materials_.materials.size()));
    if (!is_new) return at->second;
    const double flux_per_radiance = flux(emission.profile, emission.in_lamp(n));
    Material material = materials_.materials[meaning.material];
    material.exitance = flux_per_radiance * radiance_of_exitance(material.exitance);
    emission.scale = flux_per_radiance > 0 ? pi / flux_per_radiance : 1;
    material.emission = emission;
    materials_.materials.push_back(std::move(material));
    return at->second;
}

}  // namespace exitance
