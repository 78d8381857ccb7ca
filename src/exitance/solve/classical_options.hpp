#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace exitance {

enum class ClassicalDirect : std::uint8_t { apart, carried };
enum class MeshKind : std::uint8_t { aligned, uniform };
enum class TransferKernel : std::uint8_t { point, disc, exact };
enum class RefineWhen : std::uint8_t { during, after };
enum class ClassicalRelaxation : std::uint8_t { sor, direct };
enum class ShootingReceivers : std::uint8_t { vertex, middle };
/// Oracles of published forms, in addition to those of LinkOracle.
enum class ClassicalOracle : std::uint8_t { kernel };

inline constexpr std::array<std::pair<ClassicalDirect, std::string_view>, 2> classical_direct_names{
    {{ClassicalDirect::apart, "apart"}, {ClassicalDirect::carried, "carried"}}};
inline constexpr std::array<std::pair<MeshKind, std::string_view>, 2> mesh_kind_names{
    {{MeshKind::aligned, "aligned"}, {MeshKind::uniform, "uniform"}}};
inline constexpr std::array<std::pair<TransferKernel, std::string_view>, 3> transfer_kernel_names{
    {{TransferKernel::point, "point"}, {TransferKernel::disc, "disc"}, {TransferKernel::exact, "exact"}}};
inline constexpr std::array<std::pair<RefineWhen, std::string_view>, 2> refine_when_names{
    {{RefineWhen::during, "during"}, {RefineWhen::after, "after"}}};
inline constexpr std::array<std::pair<ClassicalRelaxation, std::string_view>, 2> classical_relaxation_names{
    {{ClassicalRelaxation::sor, "sor"}, {ClassicalRelaxation::direct, "direct"}}};
inline constexpr std::array<std::pair<ShootingReceivers, std::string_view>, 2> shooting_receiver_names{
    {{ShootingReceivers::vertex, "vertex"}, {ShootingReceivers::middle, "middle"}}};
inline constexpr std::array<std::pair<ClassicalOracle, std::string_view>, 1> classical_oracle_names{
    {{ClassicalOracle::kernel, "kernel"}}};

/// Options that only classical forms have. Empty optionals: not set.
struct ClassicalOptions {
    std::optional<ClassicalDirect> direct;  ///< apart: E_dir exact; carried: transported by the method.
    std::optional<MeshKind> mesh;
    std::optional<bool> gather;   ///< final gather
    std::optional<bool> certify;  ///< on: the standard form, which always estimates its error; off: classical form
    /// Threshold of the oracle: F_eps (no unit), or BF_eps (W in the brightest band), likewise of the kernel oracle.
    std::optional<double> threshold;
    std::optional<ClassicalOracle> oracle;  ///< Replaces `oracle` of SolveOptions.
    /// Number of rounds in which the threshold is halved down to the requested one.
    std::optional<std::size_t> multigrid;
    std::optional<TransferKernel> kernel;
    std::optional<double> refine_gradient;  ///< Largest difference of radiosity across an element, W/m^2.
    std::optional<RefineWhen> refine;
    std::optional<ClassicalRelaxation> relaxation;
    std::optional<double> sor_factor;  ///< Factor omega of over-relaxation, in (0, 2).
    std::optional<ShootingReceivers> receivers;
    bool ambient = false;

    /// True if any option requests a classical form.
    bool any() const {
        return oracle || direct || mesh || gather || certify == false || threshold || multigrid || kernel ||
               refine_gradient || refine || relaxation || sor_factor || receivers || ambient;
    }
    bool carried() const { return direct == ClassicalDirect::carried; }
};

}  // namespace exitance
