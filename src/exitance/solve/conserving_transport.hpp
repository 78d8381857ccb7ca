#pragma once

#include "exitance/solve/relaxation.hpp"

namespace exitance {

/// True if at least 98% of the power `sent` arrives at surfaces, W per band. With a larger loss the escaping power is
/// not known accurately enough to scale the rest.
bool is_kept(const Spectrum& arriving, const Spectrum& sent);

/// Factor per band by which received power becomes the power that should arrive. 1 in bands where they differ by over
/// 5%: that is not a small loss but some other error.
Spectrum conserving_scale(const Spectrum& arriving, const Spectrum& received);

/// E = s F b, with a factor s per band such that no light is lost except light that escapes from the scene:
///
///     sum_i A_i E_i = sum_j k_j A_j b_j,
///
/// where the share k_j of the light that leaves element j arrives at some front; 1 in a closed scene. F misses about
/// the same share of the light everywhere and in every reflection. In a bright room these losses add up to more than
/// the error of any link. s - 1 is that share, and small.
class ConservingTransport final : public TransportOperator {
  public:
    /// `area`: of each unknown, m^2; `kept`: k of each unknown, all 1 if empty. All arguments must outlive the object.
    /// Initially s = 1.
    ConservingTransport(const TransportOperator& F, std::span<const double> area, std::span<const double> kept = {})
        : F_(F), area_(area), kept_(kept) {}

    /// Computes s for the light b by one gather. Returns false and keeps s if much light escapes (`is_kept`).
    bool conserve(std::span<const Spectrum> b);
    const Spectrum& scale() const { return scale_; }

    std::size_t size() const override { return F_.size(); }
    void gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const override;
    Spectrum gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const override {
        return scale_ * F_.gather_at(receiver, radiosity);
    }
    std::size_t memory_bytes() const override { return F_.memory_bytes(); }
    DealtUnknowns dealt() const override { return F_.dealt(); }
    void gather_own(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const override;

  private:
    void multiply(std::span<Spectrum> irradiance) const;

    const TransportOperator& F_;
    std::span<const double> area_, kept_;
    Spectrum scale_{1.0};
};

/// Solves b = rhs + rho s F b, starting from the given b; `F` must be system.F. Solves with the present s and, if the
/// scene is closed, up to twice more with the s of the light found; s hardly depends on b. The report contains the
/// ratio of the first to the last solution's reflected power (`unscaled`).
SolveReport solve_conserving(const RadiositySystem& system, ConservingTransport& F, bool closed, Relaxation method,
                             std::span<Spectrum> b, StopRule stop);

}  // namespace exitance
