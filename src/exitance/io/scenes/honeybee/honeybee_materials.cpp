#include "exitance/io/scenes/honeybee/honeybee_materials.hpp"

#include <fmt/format.h>

#include <cctype>

#include "exitance/io/files/text_lines.hpp"

namespace exitance {
namespace {

/// Returns the type of a modifier in the spelling of today's schema; older models have small letters.
std::string type_of_modifier(const Json& json) {
    const auto small = [](std::string word) {
        for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        return word;
    };
    const std::string said = text_in(json, "type");
    for (const char* known : {"Plastic", "Metal", "Trans", "Glass", "Light", "Glow", "Mirror", "BSDF", "Void"})
        if (small(said) == small(known)) return known;
    return said;
}

/// Returns the default of a number. Honeybee leaves out numbers that have it.
double default_of(const std::string& type, std::string_view key) {
    if (type == "Metal" && key == "specularity") return 0.9;  // honeybee-schema
    return type == "Mirror" ? 1 : 0;
}

}  // namespace

const Json& honeybee_radiance(const Json& object) {
    return member(member(object, "properties"), "radiance");
}

std::string honeybee_modifier_name(const Json& value) {
    return value.is_string() ? value.get<std::string>() : text_in(value, "identifier");
}

std::vector<RadPrimitive> HoneybeeMaterials::read(const Json& properties) {
    const Json& global = member(properties, "global_modifier_set");
    add_modifiers(entries(properties, "modifiers"));
    add_modifiers(entries(global, "modifiers"));
    read_set(global, global_);
    for (const Json& set : entries(properties, "modifier_sets")) {
        add_modifiers(entries(set, "modifiers"));
        read_set(set, sets_[text_in(set, "identifier")]);
    }
    for (RadPrimitive& modifier : generic_modifiers())
        if (names_.insert(modifier.name).second) modifiers_.push_back(std::move(modifier));
    return std::move(modifiers_);
}

const HoneybeeModifierSet* HoneybeeMaterials::find_set(const std::string& name) const {
    const auto found = sets_.find(name);
    return found == sets_.end() ? nullptr : &found->second;
}

std::string HoneybeeMaterials::from_sets(const std::string& key, const HoneybeeModifierSet* set) const {
    if (set)
        if (const auto own = set->find(key); own != set->end()) return own->second;
    if (const auto own = global_.find(key); own != global_.end()) return own->second;
    return generic_modifier_set().at(key);
}

std::string HoneybeeMaterials::modifier_of(const Json& object, std::size_t state, const std::string& key,
                                           const HoneybeeModifierSet* set) const {
    const Json& states = entries(honeybee_radiance(object), "states");
    if (state < states.size())
        if (const std::string name = honeybee_modifier_name(member(states[state], "modifier")); !name.empty())
            return name;
    const std::string name = honeybee_modifier_name(member(honeybee_radiance(object), "modifier"));
    return name.empty() ? from_sets(key, set) : name;
}

void HoneybeeMaterials::read_set(const Json& json, HoneybeeModifierSet& set) {
    for (const auto& [key, generic] : generic_modifier_set()) {
        const std::size_t dot = key.find('.');
        const Json& group = dot == std::string::npos ? json : member(json, key.substr(0, dot).c_str());
        const Json& value = member(group, key.substr(dot == std::string::npos ? 0 : dot + 1).c_str());
        if (value.is_object()) add_modifier(value);
        if (const std::string name = honeybee_modifier_name(value); !name.empty()) set[key] = name;
    }
}

void HoneybeeMaterials::add_modifiers(const Json& list) {
    for (const Json& modifier : list) add_modifier(modifier);
}

void HoneybeeMaterials::add_modifier(const Json& json) {
    RadPrimitive p;
    p.modifier = "void", p.name = text_in(json, "identifier");
    if (p.name.empty() || !names_.insert(p.name).second) return;
    const std::string type = type_of_modifier(json);
    if (member(json, "modifier").is_object() && text_in(member(json, "modifier"), "type") != "Void")
        warn(fmt::format("the pattern that changes material '{}' is left out", shown(p.name)));
    const auto take = [&](std::initializer_list<const char*> keys) {
        for (const char* key : keys) {
            const Json& value = member(json, key);
            p.numbers.push_back(value.is_number() ? value.get<double>() : default_of(type, key));
        }
    };
    if (type == "Plastic" || type == "Metal" || type == "Trans") {
        take({"r_reflectance", "g_reflectance", "b_reflectance", "specularity", "roughness"});
        if (type == "Trans") take({"transmitted_diff", "transmitted_spec"});
        p.type = type == "Plastic" ? "plastic" : type == "Metal" ? "metal" : "trans";
    } else if (type == "Glass") {
        take({"r_transmissivity", "g_transmissivity", "b_transmissivity"});
        take_refraction(json, p);
        p.type = "glass";
    } else if (type == "Light" || type == "Glow") {
        take({"r_emittance", "g_emittance", "b_emittance"});
        if (type == "Glow") take({"max_radius"});
        p.type = type == "Light" ? "light" : "glow";
    } else if (type == "Mirror") {
        take({"r_reflectance", "g_reflectance", "b_reflectance"});
        p.type = "mirror";
    } else if (type == "BSDF") {
        return add_bsdf(json, p);
    } else if (type == "Void") {
        return;  // surfaces of a void material are omitted
    } else {
        return error(fmt::format("material '{}' is of the unknown type '{}'", shown(p.name), shown(type)));
    }
    modifiers_.push_back(std::move(p));
}

/// Takes the index of refraction of glass. Some programs write 0 where none was chosen.
void HoneybeeMaterials::take_refraction(const Json& json, RadPrimitive& p) {
    const Json& index = member(json, "refraction_index");
    if (!index.is_number()) return;
    if (index.get<double>() != 0) return p.numbers.push_back(index.get<double>());
    warn(fmt::format("glass '{}' has an index of refraction of 0: that of window glass is taken", shown(p.name)),
         "give the modifier a refraction_index, or none");
}

/// A BSDF is replaced by the diffuse pane of its diffuse reflectance and transmittance, if the model names them.
void HoneybeeMaterials::add_bsdf(const Json& json, RadPrimitive& p) {
    const std::optional<Vec3> through = vector_of(member(json, "diffuse_transmittance")),
                              front = vector_of(member(json, "front_diffuse_reflectance"));
    if (!through && !front)
        return error(
            fmt::format("material '{}' is a table of scattered light (BSDF), which is not read", shown(p.name)),
            "replace it by glass or by a translucent material, or give its diffuse reflectance and "
            "transmittance");
    const Vec3 r = front.value_or(Vec3()), t = through.value_or(Vec3());
    const double all = r.x + r.y + r.z + t.x + t.y + t.z;
    const double share = all > 0 ? (t.x + t.y + t.z) / all : 0;
    p.type = "trans";
    p.numbers = {r.x + t.x, r.y + t.y, r.z + t.z, 0, 0, share, 0};
    warn(fmt::format("only the diffuse part of material '{}' (BSDF) is used", shown(p.name)));
    modifiers_.push_back(std::move(p));
}

void HoneybeeMaterials::error(std::string message, std::string hint) {
    findings_.push_back({Finding::Kind::error, path_, 0, std::move(message), std::move(hint)});
}

void HoneybeeMaterials::warn(std::string message, std::string hint) {
    findings_.push_back({Finding::Kind::warning, path_, 0, std::move(message), std::move(hint)});
}

}  // namespace exitance
