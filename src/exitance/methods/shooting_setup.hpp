#pragma once

#include "exitance/methods/methods.hpp"
#include "exitance/solve/shooting.hpp"
#include "exitance/transport/passed_light.hpp"
#include "exitance/transport/patch_transfer.hpp"

namespace exitance {

/// Memory for columns that shooting keeps for later shots, bytes: a quarter of the memory limit, at most 1 GiB.
std::size_t column_memory_bytes(const SolveOptions& options);

/// Common parts of the shooting methods: elements grouped into patches, cached columns of form factors, and the light
/// before the first shot.
class ShootingSetup {
  public:
    /// Copies the mesh of `first`; each of its leaves is a patch.
    ShootingSetup(const MethodInput& input, const DirectProjection& first);

    /// Shoots until the unshot power is below the requested residual. Adds the arriving light to the irradiance of the
    /// leaves.
    SolveReport run();
    /// Moves the results out. The setup must not be used afterwards.
    GlobalLight finish(const SolveReport& report);

    /// True if the emitters' own light is shot as well (`--visibility fractional`), false if direct light is exact and
    /// separate. Point lights and skies have no patch to shoot from, and patches shoot diffusely: direct light is
    /// separate if there are any, or if an emitter is directed.
    bool shoots_direct_light() const {
        return input_.options.visibility == VisibilityKind::fractional && !input_.stage.scene.has_light_apart() &&
               !input_.stage.scene.has_directed_emission();
    }

    ElementTree tree;
    std::vector<ElementId> patches;      ///< The leaves of the tree as given.
    std::vector<double> patch_area;      ///< m^2
    std::vector<Spectrum> unshot, sent;  ///< Light still to be shot, and light shot so far, per patch, W/m^2.

    /// One entry per leaf of the current mesh, in all arrays below.
    LeafNumbering numbering;
    std::vector<std::uint32_t> patch_of;
    std::vector<Spectrum> reflectance, direct, irradiance;
    std::vector<double> area;

    /// Splits leaves. Every new leaf gathers the light that all patches have sent, and its own direct light.
    void split(const std::vector<ElementId>& leaves);
    /// Recomputes the patches' mean reflected light from their leaves; the difference becomes unshot light.
    void update_patches();

  private:
    Spectrum mean_direct_light(ElementId e, PlaceLight::Workspace& workspace) const;
    std::span<const float> column(std::size_t patch);
    Spectrum light_of_patches(std::size_t leaf, PatchTransfer::Workspace& workspace) const;

    const MethodInput& input_;
    PatchTransfer transfer_;
    PassedLight passed_;  ///< Light transmitted by diffusing panes, between the present leaves.
    std::vector<std::vector<float>> columns_;
    std::vector<float> fresh_;
    std::size_t kept_bytes_ = 0;
    double first_power_ = 0;
};

}  // namespace exitance
