#pragma once

#include "exitance/solve/relaxation.hpp"

namespace exitance {

/// Is so much of what is sent sure to arrive (power, W, by band) that none of it need be lost? Where over 2% escapes,
/// it is not known well enough how much.
bool is_kept(const Spectrum& arriving, const Spectrum& sent);

/// What makes power received into power that arrives, band by band; 1 where they are over 5% apart, which is no small
/// loss but some other fault.
Spectrum conserving_scale(const Spectrum& arriving, const Spectrum& received);

/// E = s F b, with a factor s a band for which no light is lost between elements but what escapes:
///
///     sum_i A_i E_i = sum_j k_j A_j b_j,
///
/// where the share k_j of what leaves element j arrives at some front: all of it in a closed scene. What F misses is
/// alike from place to place, comes back from every reflection, and so makes all of a bright room too dark by more than
/// any link's error; s - 1 is that share, and small.
class ConservingTransport final : public TransportOperator {
  public:
    /// `area`: of each unknown, m^2; `kept`: k of each, all 1 if empty. All must outlive it. To begin with, s = 1.
    ConservingTransport(const TransportOperator& F, std::span<const double> area, std::span<const double> kept = {})
        : F_(F), area_(area), kept_(kept) {}

    /// Sets s for the light b. One gather. False, and s stays, where much escapes (`is_kept`).
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

/// b = rhs + rho s F b, from the b given; `F` is system.F. Solves for the s that there is, and, in a closed scene, for
/// that of the light found, twice: s hardly depends on b. What the first of these found, by the last, is reported.
SolveReport solve_conserving(const RadiositySystem& system, ConservingTransport& F, bool closed, Relaxation method,
                             std::span<Spectrum> b, StopRule stop);

}  // namespace exitance
