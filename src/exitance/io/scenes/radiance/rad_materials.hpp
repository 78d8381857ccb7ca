#pragma once

#include <limits>
#include <unordered_map>

#include "exitance/io/scenes/affine.hpp"
#include "exitance/io/scenes/radiance/rad_findings.hpp"
#include "exitance/io/scenes/radiance/rad_words.hpp"

namespace exitance {

/// A pattern that changes what its material sends: which file and place it stands in decides where its data are.
struct RadPattern {
    RadPrimitive primitive;
    std::string file;
    Affine to_world;  ///< Of the file that it stands in.
};

/// What the name of a modifier stands for: a material, or patterns that have none yet.
struct RadMeaning {
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    enum class Kind : std::uint8_t { pattern, reflects, emits, glass, left_out };
    Kind kind = Kind::pattern;
    std::uint32_t material = 0;       ///< Of the scene; of glass its index in `RadMaterials::glass`.
    std::uint32_t pattern = none;     ///< Of those that change light, the uppermost.
    std::uint32_t pattern_count = 0;  ///< How many lie on one another.
};

/// The modifiers of Radiance's files, by name: materials by their diffuse parts, patterns, aliases, mixtures.
class RadMaterials {
  public:
    explicit RadMaterials(RadFindings& findings) : findings_(findings) {}

    /// Takes a primitive that is no surface.
    void take(RadPrimitive p, const std::string& file, const Affine& to_world);

    /// What the modifier of a surface stands for; nothing, and an error, where it is no material.
    const RadMeaning* meaning_of(const RadPrimitive& surface, const std::string& file);

    std::vector<Material> materials;
    std::vector<Pane> glass;  ///< Without corners.
    std::vector<RadPattern> patterns;

  private:
    bool take_material(const RadPrimitive& p, const std::string& file);
    void take_alias(const RadPrimitive& p, const std::string& file);
    void take_mixture(const RadPrimitive& p, const std::string& file);
    void take_pattern(RadPrimitive p, const std::string& file, const Affine& to_world);
    void add_glass(const RadPrimitive& p, const std::string& file);
    void add_material(const RadPrimitive& p, RadMeaning::Kind kind, const Spectrum& reflectance,
                      const Spectrum& radiance);
    Spectrum reflectance_of(const RadPrimitive& p, const std::string& file);
    /// What lies under a primitive; nothing for void. An error where the name is not known.
    RadMeaning below(const RadPrimitive& p, const std::string& file);

    RadFindings& findings_;
    std::unordered_map<std::string, RadMeaning> meanings_;
};

}  // namespace exitance
