#pragma once

#include <map>

#include "exitance/io/scenes/radiance/rad_distribution.hpp"

namespace exitance {

/// Makes the materials of emitting faces. If a pattern makes the emission depend on direction, each orientation of a
/// face relative to the lamp's axes gets a material of its own, since the flux from its front differs.
class RadEmission {
  public:
    RadEmission(RadMaterials& materials, RadFindings& findings, const std::string& scene_file)
        : materials_(materials), findings_(findings), scene_file_(scene_file) {}

    /// Returns the material of an emitting face with the unit normal `n` in world coordinates. Empty, with one error
    /// per pattern, if the emission cannot be read.
    std::optional<std::uint32_t> material_of(const RadMeaning& meaning, const RadPrimitive& face,
                                             const std::string& file, const Normal& n);

    std::vector<EmissionProfile> profiles;

  private:
    struct Lamp {
        bool is_read = false;
        DirectedEmission emission;
    };
    const Lamp& lamp_of(const RadMeaning& meaning, const RadPrimitive& face, const std::string& file);
    double flux(ProfileId profile, const Normal& in_lamp);

    RadMaterials& materials_;
    RadFindings& findings_;
    const std::string& scene_file_;
    std::map<std::uint32_t, Lamp> lamps_;  ///< Keyed by pattern.
    /// Keyed by the words of the pattern: copies of a lamp share its table.
    std::map<std::string, ProfileId> by_words_;
    std::map<std::array<std::int64_t, 4>, double> flux_;  ///< Keyed by profile and rounded normal.
    /// Keyed by material, profile, rounded axes and normal.
    std::map<std::array<std::int64_t, 14>, std::uint32_t> by_turn_;
};

}  // namespace exitance
