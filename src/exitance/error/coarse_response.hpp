#pragma once

#include <optional>
#include <span>
#include <vector>

#include "exitance/error/residual_samples.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {

/// The smooth part of the error that a certificate reports, on the coarse mesh of the method's light. It is the light
/// that arises by further reflections from the mean residuals r of the regions:
///
///     (I - rho H)^-1 r - r = rho H r + (rho H)^2 r + ...
///
/// H: form factors between the leaves of the mesh, from random rays.
class CoarseResponse {
  public:
    /// Casts the rays of H, and solves for unit light. `coarse` finds the leaves of the mesh of `light`. All arguments
    /// must outlive the object.
    CoarseResponse(const Stage& stage, const GlobalLight& light, const ElementLocator& coarse,
                   const CertificateOptions& options);

    /// Returns a bound on the norm of (I - rho H)^-1 in the mean square; 1 if there is no light.
    double constant() const { return constant_; }
    /// Returns the number of rays that H took.
    std::size_t rays() const { return H_.rays() + (other_H_ ? other_H_->rays() : 0); }

    /// Returns the mean reflected radiosity of every room as found by the method, W/m^2; one entry if the scene is one
    /// room.
    std::vector<double> reflected_by_room() const;

    /// Returns the smooth part of the error, by leaf number, W/m^2. The responses to the two gathers of every sample
    /// share it, while the noise of their rays is independent. In every room, the mean of both is scaled such that its
    /// mean square is the mean product of the two responses.
    std::vector<Spectrum> smooth_error(std::span<const ResidualSample> samples) const;

  private:
    std::size_t room_of_leaf(std::size_t i) const { return room_of_.empty() ? 0 : room_of_[i]; }
    std::vector<Spectrum> light_of_rooms() const;
    std::vector<Spectrum> mean_residuals_of(std::span<const ResidualSample> samples, double first) const;
    std::vector<Spectrum> response_to(std::span<const ResidualSample> samples, double first, const RayRows& H) const;
    void balance(std::span<const Spectrum> residuals, std::span<Spectrum> errors) const;

    const Stage& stage_;
    const GlobalLight& light_;
    const CertificateOptions& options_;
    double mean_reflected_;
    double constant_ = 1;
    std::vector<Spectrum> rho_;
    std::vector<double> area_;
    std::vector<std::uint32_t> room_of_;  ///< Room of every leaf; empty if the scene is one room.
    RayRows H_;
    std::optional<RayRows> other_H_;  ///< Like `H_`, from other random rays; only if there are several rooms.
    /// Irradiance from light that arrives uniformly on all surfaces; in each room in proportion to the room's light.
    std::vector<Spectrum> even_;
};

}  // namespace exitance
