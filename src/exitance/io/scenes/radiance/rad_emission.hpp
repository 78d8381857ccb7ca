#pragma once

#include <map>

#include "exitance/io/scenes/radiance/rad_distribution.hpp"

namespace exitance {

/// The materials of emitting faces: where a pattern says how their light depends on direction, each way in which a
/// face turns to the lamp's axes makes a material of its own, since the flux from its front is another.
class RadEmission {
  public:
    RadEmission(RadMaterials& materials, RadFindings& findings, const std::string& scene_file)
        : materials_(materials), findings_(findings), scene_file_(scene_file) {}

    /// The material of a face of an emitter with this unit normal, in the world. Nothing, and an error once a pattern,
    /// where the light cannot be read.
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
    std::map<std::uint32_t, Lamp> lamps_;                            ///< By pattern.
    std::map<std::string, ProfileId> by_words_;                      ///< Copies of a lamp share its table.
    std::map<std::array<std::int64_t, 4>, double> flux_;             ///< By profile and rounded normal.
    std::map<std::array<std::int64_t, 14>, std::uint32_t> by_turn_;  ///< Material, profile, rounded axes and normal.
};

}  // namespace exitance
