#pragma once

#include <limits>
#include <unordered_map>

#include "exitance/io/scenes/affine.hpp"
#include "exitance/io/scenes/radiance/rad_findings.hpp"
#include "exitance/io/scenes/radiance/rad_words.hpp"

namespace exitance {

/// A pattern that changes the light of its material. Its data are searched relative to `file`.
struct RadPattern {
    RadPrimitive primitive;
    std::string file;
    Affine to_world;  ///< Transform of the file that contains the pattern.
};

/// Meaning of a modifier's name: a material, or patterns without a material.
struct RadMeaning {
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    enum class Kind : std::uint8_t { pattern, reflects, emits, glass, left_out };
    Kind kind = Kind::pattern;
    std::uint32_t material = 0;       ///< Index into the scene's materials; for glass, into `RadMaterials::glass`.
    std::uint32_t pattern = none;     ///< Uppermost pattern that changes light.
    std::uint32_t pattern_count = 0;  ///< Number of nested patterns.
};

/// The modifiers of Radiance files by name: materials (only their diffuse parts), patterns, aliases, mixtures.
class RadMaterials {
  public:
    explicit RadMaterials(RadFindings& findings) : findings_(findings) {}

    /// Adds a primitive that is not a surface.
    void take(RadPrimitive p, const std::string& file, const Affine& to_world);

    bool has(const std::string& name) const { return meanings_.count(name) > 0; }
    /// Meaning of a surface's modifier; null, with an error, if it is not a material.
    const RadMeaning* meaning_of(const RadPrimitive& surface, const std::string& file);

    std::vector<Material> materials;
    std::vector<Pane> glass;  ///< Panes without corners.
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
    /// Meaning of a primitive's own modifier; empty for void. An unknown name is an error.
    RadMeaning below(const RadPrimitive& p, const std::string& file);

    RadFindings& findings_;
    std::unordered_map<std::string, RadMeaning> meanings_;
};

}  // namespace exitance
