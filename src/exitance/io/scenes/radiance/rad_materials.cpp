#include "exitance/io/scenes/radiance/rad_materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "exitance/io/files/text_lines.hpp"

namespace exitance {
namespace {

bool is_one_of(const std::string& type, std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(), [&](const char* name) { return type == name; });
}

Spectrum spread(const std::vector<double>& rgb, double factor) {
    Spectrum out;
    if (bands == 1) return Spectrum(factor * (rgb[0] + rgb[1] + rgb[2]) / 3);
    for (std::size_t b = 0; b < bands; ++b) out[b] = factor * rgb[b * 3 / bands];
    return out;
}

/// Minimum number of numeric arguments of a material type.
std::size_t numbers_of(const std::string& type) {
    if (type.starts_with("trans")) return type.ends_with('2') ? 6 : 7;
    if (is_one_of(type, {"plastic", "metal"})) return 5;
    if (is_one_of(type, {"plastic2", "metal2", "glow"})) return 4;
    return 3;
}

/// Converts a material whose gloss depends on a function or table to the plain material with the same diffuse part.
/// Empty for other materials and if numbers are missing. For BRTDfunc, the front's values apply to both sides.
std::optional<RadPrimitive> without_function(const RadPrimitive& p) {
    RadPrimitive plain = p;
    const bool passes = is_one_of(p.type, {"transfunc", "transdata"}), is_brtd = p.type == "BRTDfunc",
               is_ashik = p.type == "ashik2";
    const bool reflects = is_one_of(p.type, {"plasfunc", "plasdata", "metfunc", "metdata"});
    const std::size_t min_numbers = passes ? 6 : is_brtd ? 9 : is_ashik ? 8 : 4;
    if ((!passes && !is_brtd && !is_ashik && !reflects) || p.numbers.size() < min_numbers) return std::nullopt;
    const std::vector<double>& n = p.numbers;
    plain.type = passes ? "trans" : "plastic";
    plain.numbers = {n[0], n[1], n[2], is_brtd || is_ashik ? 0 : n[3], 0};
    if (passes) plain.numbers.insert(plain.numbers.end(), {n[4], n[5]});
    return plain;
}

}  // namespace

void RadMaterials::add_material(const RadPrimitive& p, RadMeaning::Kind kind, const Spectrum& reflectance,
                                const Spectrum& radiance) {
    meanings_[p.name].kind = kind, meanings_[p.name].material = static_cast<std::uint32_t>(materials.size());
    materials.push_back({shown(p.name), reflectance, exitance_of_radiance(radiance)});
}

Spectrum RadMaterials::reflectance_of(const RadPrimitive& p, const std::string& file) {
    const RadPlace at{file, p.line};
    const double specular = p.numbers[3];
    // The specular reflectance is followed by one or two roughnesses; the transmitted shares are last.
    const bool passes = p.type.starts_with("trans");
    const double through = passes ? p.numbers[p.numbers.size() - 2] : 0, clear = passes ? p.numbers.back() : 0;
    if (passes && !(through >= 0 && through <= 1 && clear >= 0 && clear <= 1))
        findings_.error(at, fmt::format("'{}' lets {:g} through, {:g} of it straight", shown(p.name), through, clear),
                        "shares lie in [0, 1]");
    if (specular > 0 || through * clear > 0) findings_.note("a specular part", at);
    const Spectrum reflectance = spread(p.numbers, (1 - specular) * (1 - through * clear));
    if (!(max(reflectance) <= whitest_reflectance) ||
        !std::all_of(reflectance.value.begin(), reflectance.value.end(), [](double v) { return v >= 0; }))
        findings_.error(at, fmt::format("material '{}' reflects {:g}", shown(p.name), max(reflectance)),
                        "diffuse reflectances lie in [0, 1]");
    return reflectance;
}

/// Reads glass mod id 0 0 3 R G B, or with 4 numbers, the last of which is the index of refraction.
void RadMaterials::add_glass(const RadPrimitive& p, const std::string& file) {
    const RadPlace at{file, p.line};
    Pane pane;
    if (p.numbers.size() != 3 && p.numbers.size() != 4)
        return findings_.error(at,
                               fmt::format("'{}' has {} numbers, glass has 3 or 4", shown(p.name), p.numbers.size()));
    for (std::size_t i = 0; i < 3; ++i)
        if (!(p.numbers[i] >= 0 && p.numbers[i] <= whitest_reflectance))
            return findings_.error(at,
                                   fmt::format("glass '{}' has a transmissivity of {:g}", shown(p.name), p.numbers[i]),
                                   "transmissivities lie in [0, 1]");
    pane.transmissivity = spread(p.numbers, 1);
    for (double& v : pane.transmissivity.value) v = std::min(v, 1.0);
    if (p.numbers.size() == 4) pane.index = p.numbers[3];
    if (!(pane.index >= 1 && pane.index <= 4))
        return findings_.error(at,
                               fmt::format("glass '{}' has an index of refraction of {:g}", shown(p.name), pane.index));
    if (meanings_[p.name].pattern_count > 0) findings_.note("patterns and textures", at);
    meanings_[p.name].kind = RadMeaning::Kind::glass;
    meanings_[p.name].material = static_cast<std::uint32_t>(glass.size());
    glass.push_back(std::move(pane));
}

/// Adds a material by its diffuse part; false if the primitive is not a material.
bool RadMaterials::take_material(const RadPrimitive& p, const std::string& file) {
    const RadPlace at{file, p.line};
    if (const std::optional<RadPrimitive> plain = without_function(p)) {
        findings_.note(fmt::format("all but the diffuse reflection of {}", p.type), at);
        return take_material(*plain, file);
    }
    const bool reflects = is_one_of(p.type, {"plastic", "metal", "plastic2", "metal2", "trans", "trans2"});
    const bool emits = is_one_of(p.type, {"light", "glow", "illum", "spotlight"});
    const bool clear =
        is_one_of(p.type, {"glass", "dielectric", "interface", "mirror", "mist", "antimatter", "prism1", "prism2"});
    if (!reflects && !emits && !clear) return false;
    if (!clear && p.numbers.size() < numbers_of(p.type)) {
        findings_.error(at, fmt::format("'{}' has {} numbers, {} has {}", shown(p.name), p.numbers.size(), p.type,
                                        numbers_of(p.type)));
        return true;
    }
    meanings_[p.name] = below(p, file);  // a pattern below the material in the modifier chain also changes its light
    if (reflects) {
        add_material(p, RadMeaning::Kind::reflects, reflectance_of(p, file), {});
        if (p.type.starts_with("trans")) {
            // Diffusely transmitted share of the light that leaves diffusely: both parts have the material's colour.
            const double through = p.numbers[p.numbers.size() - 2], diffuse = through * (1 - p.numbers.back());
            if (diffuse > 0) materials.back().through = std::min(1.0, diffuse / (1 - through + diffuse));
        }
    } else if (emits) {
        if (p.type == "spotlight") findings_.note("the cone of a spotlight, which shines everywhere", at);
        if (p.type == "glow" && p.numbers[3] != 0) findings_.note("the radius of a glow", at);
        if (std::any_of(p.numbers.begin(), p.numbers.begin() + 3, [](double v) { return v < 0; }))
            findings_.error(at, fmt::format("'{}' has a negative emission", shown(p.name)));
        add_material(p, RadMeaning::Kind::emits, {}, spread(p.numbers, 1));
    } else if (p.type == "glass") {
        add_glass(p, file);
    } else if (p.type == "mirror") {
        findings_.note("a mirror, which is black", at);
        add_material(p, RadMeaning::Kind::reflects, {}, {});
    } else {
        findings_.note(fmt::format("surfaces of {}, which light passes", p.type), at);
        meanings_[p.name].kind = RadMeaning::Kind::left_out;
    }
    return true;
}

RadMeaning RadMaterials::below(const RadPrimitive& p, const std::string& file) {
    const auto found = meanings_.find(p.modifier);
    if (found != meanings_.end()) return found->second;
    if (p.modifier != "void")
        findings_.error({file, p.line},
                        fmt::format("'{}' is not defined before '{}'", shown(p.modifier), shown(p.name)));
    return {};
}

const RadMeaning* RadMaterials::meaning_of(const RadPrimitive& p, const std::string& file) {
    const RadPlace at{file, p.line};
    const auto found = meanings_.find(p.modifier);
    if (found == meanings_.end() && p.modifier != "void")
        findings_.error(at, fmt::format("material '{}' is not defined before '{}'", shown(p.modifier), shown(p.name)),
                        "files of one scene are read in the order given, materials first");
    else if (found == meanings_.end())  // void surfaces occur, for example, in files for mkillum
        findings_.note("surfaces of void, which light passes", at);
    else if (found->second.kind == RadMeaning::Kind::pattern)
        findings_.error(at, fmt::format("'{}' has no supported material", shown(p.name)),
                        "its modifier is a pattern, or of a kind that is not known here");
    else
        return &found->second;
    return nullptr;
}

void RadMaterials::take_alias(const RadPrimitive& p, const std::string& file) {
    const auto meaning = meanings_.find(p.words[0]);
    if (meaning == meanings_.end() && p.words[0] != "void")
        return findings_.error({file, p.line}, fmt::format("alias '{}' refers to '{}', which is not defined",
                                                           shown(p.name), shown(p.words[0])));
    const RadMeaning same = meaning == meanings_.end() ? RadMeaning() : meaning->second;
    meanings_[p.name] = same;
}

/// A mixture is replaced by its first material, or by the second if the first is void.
void RadMaterials::take_mixture(const RadPrimitive& p, const std::string& file) {
    findings_.note("mixtures, for which their first material is used", {file, p.line});
    for (std::size_t i = 0; i < std::min<std::size_t>(2, p.words.size()); ++i) {
        const auto found = meanings_.find(p.words[i]);
        if (found == meanings_.end()) continue;
        const RadMeaning same = found->second;
        meanings_[p.name] = same;
        return;
    }
    findings_.error({file, p.line}, fmt::format("mixture '{}' has no material that is defined", shown(p.name)));
}

void RadMaterials::take_pattern(RadPrimitive p, const std::string& file, const Affine& to_world) {
    RadMeaning meaning = below(p, file);
    const bool turns_normals_only = is_one_of(p.type, {"texfunc", "texdata"});
    if (!turns_normals_only) {
        meaning.pattern = static_cast<std::uint32_t>(patterns.size());
        ++meaning.pattern_count;
    }
    meanings_[p.name] = meaning;
    if (!turns_normals_only) patterns.push_back({std::move(p), file, to_world});
}

void RadMaterials::take(RadPrimitive p, const std::string& file, const Affine& to_world) {
    if (p.type == "alias") return take_alias(p, file);
    if (take_material(p, file)) return;
    if (p.type == "mesh" || p.type == "instance")
        return findings_.error(
            {file, p.line}, fmt::format("{} '{}' is in a compiled file, which is not supported", p.type, shown(p.name)),
            "put its polygons here, with !xform");
    if (p.type.starts_with("mix")) return take_mixture(p, file);
    take_pattern(std::move(p), file, to_world);
}

}  // namespace exitance
