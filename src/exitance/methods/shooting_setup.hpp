#pragma once

#include "exitance/methods/methods.hpp"
#include "exitance/solve/shooting.hpp"
#include "exitance/transport/passed_light.hpp"
#include "exitance/transport/patch_transfer.hpp"

namespace exitance {

/// Bytes of columns that shooting keeps for later shots: a quarter of the memory limit, at most 1 GiB.
std::size_t column_memory_bytes(const SolveOptions& options);

/// What the shooting methods share: elements in patches, columns of form factors that are kept while they fit, and the
/// light that is there before the first shot.
class ShootingSetup {
  public:
    /// The mesh of `first` is taken over; each of its leaves is a patch.
    ShootingSetup(const MethodInput& input, const DirectProjection& first);

    /// Shoots until little is left; adds what arrives to the irradiance of the leaves.
    SolveReport run();
    /// Hands over what was found. The setup is empty afterwards.
    GlobalLight finish(const SolveReport& report);

    /// Is the emitters' own light shot too (`--visibility fractional`), or exact and apart? Lights without extent and
    /// skies have no patch to shoot from, and patches shoot diffusely: with any of them, or of directed emitters, it is
    /// apart.
    bool shoots_direct_light() const {
        return input_.options.visibility == VisibilityKind::fractional && !input_.stage.scene.has_light_apart() &&
               !input_.stage.scene.has_directed_emission();
    }

    ElementTree tree;
    std::vector<ElementId> patches;      ///< Leaves of the tree as it was given.
    std::vector<double> patch_area;      ///< m^2
    std::vector<Spectrum> unshot, sent;  ///< By patch, W/m^2: yet to be sent, and sent so far.

    /// Of the present leaves:
    LeafNumbering numbering;
    std::vector<std::uint32_t> patch_of;
    std::vector<Spectrum> reflectance, direct, irradiance;
    std::vector<double> area;

    /// Cuts leaves; every new one gathers what all patches have sent, and its own direct light.
    void split(const std::vector<ElementId>& leaves);
    /// Takes the patches' mean reflected light from their leaves anew; the change is to be shot.
    void update_patches();

  private:
    Spectrum mean_direct_light(ElementId e, ClusteredLight::Workspace& workspace) const;
    std::span<const float> column(std::size_t patch);
    Spectrum light_of_patches(std::size_t leaf, PatchTransfer::Workspace& workspace) const;

    const MethodInput& input_;
    PatchTransfer transfer_;
    PassedLight passed_;  ///< Between the present leaves.
    std::vector<std::vector<float>> columns_;
    std::vector<float> fresh_;
    std::size_t kept_bytes_ = 0;
    double first_power_ = 0;
};

}  // namespace exitance
